"""Symmetries of every result: other units of length and stress, and x and y exchanged.

What a result is multiplied by in other units follows from the units that it states itself.
"""

import re

import numpy as np
import xarray as xr

from fractalcontact.states.states import SOLVER_ERROR

#: New units of length and stress in the old ones: powers of two, which cost no digit.
LENGTH, STRESS = 64.0, 1 / 8
#: Powers of both in each unit.
_POWERS = {"mm": (1, 0), "MPa": (0, 1), "N": (2, 1), "1": (0, 0), "%": (0, 0), "degree": (0, 0)}
_UNIT = rf"(/?) ?({'|'.join(_POWERS)})(-?\d+)?"
#: Units that depend on Delta_sigma.
_FRACTAL = r"(?:(N) )?mm\^(-?)delta_sigma"
#: Units that another variable states.
_STATED_BY = {"unit of the quantity": "unit", "see measure_units": "measure_units"}
#: What an iteration leaves when it ends, beside the bounds that say so in their long names.
_LEFTOVER = re.compile(r"residual|energy_error|iterations|flow_imbalance_.*")
#: Factor between two such numbers of one state, where another rounding ends an iteration one step
#: later. A unit forgotten is a factor of 8 at least.
LEFTOVER_FACTOR = 4.0
#: Fraction of the largest such number below which one counts as zero: what is left may be nothing.
LEFTOVER_FLOOR = 0.01
#: Errors as fractions of what they are errors of, those of the solver among others.
_FRACTIONS = {"error", "relative_error"}
_EXCHANGED = dict(zip("xyENWS", "yxNESW", strict=True))


def scale_of(units: str) -> float:
    """Factor of numbers in some units where lengths and stresses grow."""
    assert re.fullmatch(f"({_UNIT})+", units), f"unknown units {units!r}"
    scale = 1.0
    for over, unit, power in re.findall(_UNIT, units):
        lengths, stresses = _POWERS[unit]
        times = int(power or 1) * (-1 if over else 1)
        scale *= (LENGTH**lengths * STRESS**stresses) ** times
    return scale


def grown(dataset: xr.Dataset) -> xr.Dataset:
    """A result whose lengths and stresses have grown, by the units that its variables state."""
    return dataset.map(lambda one: _grown(one, dataset)).assign_coords(
        {name: _grown(one, dataset) for name, one in dataset.coords.items()}
    )


def _grown(one, dataset):
    units = one.attrs.get("units", "1")
    if one.dtype.kind not in "fi" or units == "1":
        return one
    if units in _STATED_BY:
        stated = dataset[_STATED_BY[units]]
        scale = stated.copy(data=[scale_of(unit) for unit in stated.values])
    elif fractal := re.fullmatch(_FRACTAL, units):
        dimension = dataset["delta_sigma"]
        if "estimator" in one.dims and "estimator" not in dimension.dims:
            by = [dataset[f"delta_sigma_{name}"] for name in one["estimator"].values]
            dimension = xr.concat(by, one["estimator"])
        dimension = -dimension if fractal[2] else dimension
        scale = scale_of(fractal[1] or "1") * LENGTH**dimension
    else:
        scale = scale_of(units)
    return one.copy(data=(one * scale).transpose(*one.dims))


def exchanged(text: str) -> str:
    """A name or words with x and y, and the directions along them, exchanged."""
    return re.sub(r"(?<![A-Za-z])[xyENWS](?![A-Za-z*])", lambda found: _EXCHANGED[found[0]], text)


def with_axes_exchanged(dataset: xr.Dataset) -> xr.Dataset:
    """A result with x for y: its dimensions, variables, directions and words."""
    named = dataset.rename({name: exchanged(name) for name in {*dataset.variables, *dataset.dims}})
    words = {
        name: one.copy(data=np.vectorize(exchanged, otypes=[object])(one.values))
        for name, one in named.variables.items()
        if one.dtype.kind in "OU"
    }
    return named.assign(words)


def is_leftover(name: str, variable: xr.DataArray) -> bool:
    """A number that depends on where an iteration ended: an error bound of the solver, say."""
    stated = SOLVER_ERROR in variable.attrs.get("long_name", "")
    return stated or _LEFTOVER.fullmatch(name) is not None


def _scale(name, variable):
    """1 for errors that are fractions of their value, else 0: then the values say what is small."""
    return float(name in _FRACTIONS and variable.attrs.get("units") == "1")


def within_factor(found, expected, factor, floor=0.0):
    """Where two arrays agree within a factor; what lies below the floor is raised to it first."""
    missing = np.isnan(found) | np.isnan(expected)
    small = np.maximum(np.minimum(found, expected), floor)
    agree = np.maximum(found, expected) <= factor * small
    return np.where(missing, np.isnan(found) == np.isnan(expected), agree)


def differences(found, expected, *, rtol, atol=0.0, unordered=()):
    """Variables that differ, by name: how many of their values, and one pair.

    Values are compared by ``rtol`` and ``atol``; what an iteration left when it ended
    (:func:`is_leftover`) rests on the rounding of the processor, and is compared by a factor.

    Parameters
    ----------
    found, expected : xr.Dataset
        In any order along directions.
    rtol : float
    atol : float, optional
        A fraction of the largest value of a variable.
    unordered : tuple of str, optional
        Dimensions along which the order does not count either.
    """
    assert set(found.variables) == set(expected.variables)
    for dim in set(expected.dims) & set(expected.coords):
        if expected[dim].dtype.kind in "OU":
            found = found.sel({dim: expected[dim].values})
    different = {}
    for name, one in expected.variables.items():
        wanted, values = one.values, found[name].transpose(*one.dims).values
        if one.dtype.kind in "OU":
            same = values == wanted
        else:
            wanted, values = wanted.astype(float), values.astype(float)
            for dim in set(unordered) & set(one.dims):
                wanted, values = (np.sort(v, one.dims.index(dim)) for v in (wanted, values))
            largest = np.abs(wanted[np.isfinite(wanted)]).max(initial=_scale(name, one))
            if is_leftover(name, one):
                floor = max(atol, LEFTOVER_FLOOR) * largest
                same = within_factor(values, wanted, LEFTOVER_FACTOR, floor)
            else:
                same = np.isclose(values, wanted, rtol, atol * largest, equal_nan=True)
        if not np.all(same):
            at = tuple(np.argwhere(~same)[0])
            different[name] = f"{np.sum(~same)} values, {values[at]} for {wanted[at]}"
    return different
