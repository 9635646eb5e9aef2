"""Exponents of strength, contact area and separation over the side, at equal v and at equal v/b."""

from collections.abc import Mapping
from fractions import Fraction
from itertools import pairwise, product
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled
from fractalcontact.core.labels import cf_attrs
from fractalcontact.core.limits import LARGEST_FRICTION_ANGLE

from .size_decision import (
    MIN_ROLL_OFFS,
    NO_EFFECT,
    UNKNOWN,
    Exponent,
    paired_exponent,
    size_exponent,
)
from .strength_decision import (
    friction_ratio,
    joint_verdict,
    linear_strengths,
    mean_strength,
    size_verdict,
    strength_exponent,
)
from .units import SPACING

_CLASS = ("hurst", "law")
_AT_V = (*_CLASS, "interval", "reduced_pressure")
_AT_FRACTION = (*_CLASS, "fraction", "reduced_pressure")
_OF_SIZE = (*_CLASS, "side", "interval", "reduced_pressure")

#: Exponents over the side, and the strength itself: dimensions and long name.
EXPONENTS: dict[str, tuple[tuple[str, ...], str]] = {
    "strength": (_OF_SIZE, "tau/sigma_0 = tan(phi_b + i) of the mean rate, not truncated"),
    "strength_exponent": (_AT_V, "exponent of tau/sigma_0 over the side b at equal v"),
    "area_exponent": (_AT_V, "exponent of the corrected A_r/A_0 over b at the interval's end"),
    "separation_exponent": (_AT_V, "exponent of the separation over b at the interval's end"),
    "pooled_exponent": (
        (*_CLASS, "reduced_pressure"),
        "exponent over b of the geometric mean of tau/sigma_0 over all intervals of v",
    ),
    "scaled_strength_exponent": (_AT_FRACTION, "exponent of tau/sigma_0 over b at equal v/b"),
    "predicted_exponent": (_AT_FRACTION, "that of tau/sigma_0 by v alone, from the largest joints"),
    "beyond_exponent": (_AT_FRACTION, "exponent of tau/sigma_0 at equal v/b less that by v alone"),
}
#: Verdicts by the exponent they are of, and their long names.
VERDICTS = {
    "strength_exponent": "verdict on the strength at equal v",
    "area_exponent": "verdict on the contact area at equal v",
    "separation_exponent": "verdict on the separation at equal v",
    "pooled_exponent": "verdict on the strength at equal v, all intervals together",
    "scaled_strength_exponent": "verdict on the strength at equal v/b",
    "beyond_exponent": "verdict on the strength at equal v/b beyond what v alone makes of it",
}
#: Numbers without an interval: dimensions, unit and long name.
NUMBERS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "truncated_share": (
        _OF_SIZE,
        "1",
        f"fraction of joints whose phi_b + i passes {LARGEST_FRICTION_ANGLE:g} degrees or is "
        "negative",
    ),
    "theory_strength": (_AT_V, "1", "tau/sigma_0 from S(v), the separation in its square root"),
    "theory_exponent": (_AT_FRACTION, "1", "exponent of theory_strength over b at equal v/b"),
}
#: Exponents that decide a class, at equal v and at equal v/b.
_DECIDING = ("pooled_exponent", "scaled_strength_exponent", "predicted_exponent")


class _Sample(NamedTuple):
    """Joints of one Hurst exponent under one law and load."""

    sides: np.ndarray
    rates: np.ndarray  # (surface, interval)
    shares: np.ndarray  # (surface, offset), corrected
    separations: np.ndarray
    numbers: np.ndarray


def dilatancy_rates(states: xr.Dataset) -> np.ndarray:
    """Rates d delta/dv (surface, law, interval, reduced_pressure) between successive displacements.

    The displacements begin with mated faces. Rates are secants, as
    :func:`laws.strength.dilatancy_angle` takes them: the scatter of one joint cancels, and every
    state serves two secants. States are those of :func:`experiments.size_strength.sliding_states`.
    """
    delta = states["separation"].transpose("surface", "law", "offset", "reduced_pressure").values
    delta = np.concatenate([np.zeros_like(delta[:, :, :1]), delta], axis=2)
    step = np.diff(np.r_[0.0, states["offset"].values])
    return np.diff(delta, axis=2) / step[:, np.newaxis]


def strength_exponents(states: xr.Dataset, recipe: Mapping[str, Any]) -> xr.Dataset:
    """Size effect from states of sliding joints, :func:`experiments.size_strength.sliding_states`.

    The dataset has the states; :data:`EXPONENTS` with ``_error``, ``_low`` and ``_high`` (99 % over
    surfaces), :data:`VERDICTS` after ``_verdict``; ``theory_strength`` and ``theory_exponent`` from
    S(v); ``truncated_share``. Only sides from :data:`MIN_ROLL_OFFS` roll-offs on enter exponents.
    The recipe is that of :func:`experiments.size_strength.size_strength`.
    """
    offsets = np.r_[0.0, states["offset"].values]
    sides = np.unique(states["of_size"].values)
    smallest = MIN_ROLL_OFFS * recipe["roll_off"]
    classes = equal_fractions(sides[sides >= smallest] * SPACING, offsets)
    sizes = dict(states.sizes) | {
        "side": len(sides),
        "interval": len(offsets) - 1,
        "fraction": len(classes),
    }
    numbers = {
        name: np.full([sizes[dim] for dim in dims], np.nan) for name, (dims, *_) in NUMBERS.items()
    }
    basic = float(recipe["basic_friction_angle"])
    exponents: dict[str, dict[tuple[int, ...], Exponent]] = {name: {} for name in EXPONENTS}
    for (i, j, k), sample in _samples(states).items():
        for name, values in _one_class(sample, sides, smallest, classes, basic).items():
            middle = np.ndindex(*(sizes[dim] for dim in EXPONENTS[name][0][2:-1]))
            places = ((i, j, *place, k) for place in middle)
            exponents[name] |= dict(zip(places, values, strict=True))
        numbers["truncated_share"][i, j, ..., k] = _truncated_share(sample, sides, basic)
        difference = states["height_difference"].values[i]
        for name, values in _by_theory(sample, difference, offsets, classes, basic).items():
            numbers[name][i, j, ..., k] = values
    variables = _variables(exponents, sizes) | labelled(NUMBERS, numbers)
    result = states.merge(xr.Dataset(variables, _coords(offsets, sides, classes)), join="exact")
    result.attrs = {
        "smallest_side": int(smallest),
        "bound": NO_EFFECT,
        "cut_off": float(recipe["cut_off"]),
        "roll_off": float(recipe["roll_off"]),
        "rms_slope": float(recipe["rms_slope"]),
        "basic_friction_angle": basic,
        "largest_friction_angle": LARGEST_FRICTION_ANGLE,
        **({"hardness": float(recipe["hardness"])} if "hardness" in recipe else {}),
    }
    return result


def _samples(states: xr.Dataset) -> dict[tuple[int, int, int], _Sample]:
    """Joints by the numbers of their Hurst exponent, law and load."""
    rates, hursts = dilatancy_rates(states), states["hurst"].values
    shape = (states.sizes[dim] for dim in (*_CLASS, "reduced_pressure"))
    samples = {}
    for i, j, k in product(*map(range, shape)):
        of_hurst = states["of_hurst"].values == hursts[i]
        joints = states.isel(surface=of_hurst, law=j, reduced_pressure=k)
        samples[i, j, k] = _Sample(
            joints["of_size"].values,
            rates[of_hurst][:, j, :, k],
            joints["corrected_share"].transpose("surface", "offset").values,
            joints["separation"].transpose("surface", "offset").values,
            joints["number"].values,
        )
    return samples


def equal_fractions(
    sides: np.ndarray, offsets: np.ndarray
) -> dict[tuple[float, float], dict[float, int]]:
    """Intervals of v that are one fraction of the side, for two sides or more.

    The numbers of the intervals by side, for each pair of ends (v/b). Sides and offsets are in mm;
    the offsets include zero and ascend.
    """
    numbers: dict[tuple[Fraction, Fraction], dict[float, int]] = {}
    for side in sides:
        for k, ends in enumerate(pairwise(offsets)):
            low, high = (Fraction(float(v)) / Fraction(float(side)) for v in ends)
            numbers.setdefault((low, high), {})[float(side)] = k
    return {
        (float(low), float(high)): numbers[low, high]
        for low, high in sorted(numbers)
        if len(numbers[low, high]) > 1
    }


def _coords(
    offsets: np.ndarray, sides: np.ndarray, classes: Mapping[tuple[float, float], Any]
) -> dict[str, Any]:
    ends = np.array(list(classes), float).reshape(-1, 2)
    long = "of v/b, {} of the interval"
    return {
        "side": ("side", sides * SPACING, cf_attrs("mm", "side b")),
        "interval": (
            "interval",
            (offsets[1:] + offsets[:-1]) / 2,
            cf_attrs("mm", "middle of an interval of v"),
        ),
        "interval_low": ("interval", offsets[:-1], cf_attrs("mm", "start of an interval of v")),
        "interval_high": ("interval", offsets[1:], cf_attrs("mm", "end of an interval of v")),
        "fraction": ("fraction", ends.mean(axis=1), cf_attrs("1", long.format("middle"))),
        "fraction_low": ("fraction", ends[:, 0], cf_attrs("1", long.format("start"))),
        "fraction_high": ("fraction", ends[:, 1], cf_attrs("1", long.format("end"))),
    }


def _variables(
    exponents: Mapping[str, Mapping[tuple[int, ...], Exponent]], sizes: Mapping[Any, int]
) -> dict[str, tuple]:
    """:data:`EXPONENTS` by their places and the verdicts on them, as ``xr.Dataset`` takes them."""
    variables: dict[str, tuple] = {}
    for name, (dims, words) in EXPONENTS.items():
        shape = [sizes[dim] for dim in dims]
        members = [exponents[name][place] for place in np.ndindex(*shape)]
        variables |= Exponent.stack(members, shape).variables(name, dims, "1", words)
        if name in VERDICTS:
            verdicts = np.reshape(
                np.array([size_verdict(member) for member in members], object), shape
            )
            variables[f"{name}_verdict"] = (dims, verdicts, cf_attrs("1", VERDICTS[name]))
    overall = [
        [_verdict(exponents, i, j) for j in range(sizes["law"])] for i in range(sizes["hurst"])
    ]
    words = "whether the strength has a size effect, and of what"
    return variables | {"overall": (_CLASS, np.array(overall, object), cf_attrs("1", words))}


def _verdict(exponents: Mapping[str, Mapping[tuple[int, ...], Exponent]], i: int, j: int) -> str:
    """Verdict of a Hurst exponent and law over all loads."""
    deciding = (
        [exponent for place, exponent in exponents[name].items() if place[:2] == (i, j)]
        for name in _DECIDING
    )
    return joint_verdict(*deciding)


def _truncated_share(sample: _Sample, sides: np.ndarray, basic: float) -> list[np.ndarray]:
    """Fraction of joints of each side whose phi_b + i is beyond the range of Barton's law."""
    angles = basic + np.degrees(np.arctan(sample.rates))
    out = (angles > LARGEST_FRICTION_ANGLE) | (angles < 0)
    return [out[sample.sides == side].mean(axis=0) for side in sides]


def _one_class(
    sample: _Sample,
    sides: np.ndarray,
    smallest: float,
    classes: Mapping[tuple[float, float], Mapping[float, int]],
    basic: float,
) -> dict[str, list[Exponent]]:
    """:data:`EXPONENTS` of one class at one load."""
    intervals = range(sample.rates.shape[1])
    of_side = {side: sample.rates[sample.sides == side] for side in sides}
    entering = sample.sides >= smallest
    compared = _Sample(*(column[entering] for column in sample))
    linear = np.array([linear_strengths(compared.sides, rate, basic) for rate in compared.rates.T])
    with np.errstate(invalid="ignore", divide="ignore"):
        pooled = np.exp(np.log(linear).mean(axis=0))
    return {
        "strength": [mean_strength(of_side[s][:, k], basic) for s in sides for k in intervals],
        "strength_exponent": [
            strength_exponent(compared.sides, r, basic) for r in compared.rates.T
        ],
        "area_exponent": [size_exponent(compared.sides, share) for share in compared.shares.T],
        "separation_exponent": [
            size_exponent(compared.sides, gap) for gap in compared.separations.T
        ],
        "pooled_exponent": [size_exponent(compared.sides, pooled)],
    } | _scaled(compared, linear, classes, basic)


def _scaled(
    sample: _Sample,
    linear: np.ndarray,
    classes: Mapping[tuple[float, float], Mapping[float, int]],
    basic: float,
) -> dict[str, list[Exponent]]:
    """Exponents at equal v/b, and the prediction from v alone for the largest joints."""
    of_fractions: dict[str, list[Exponent]] = {
        name: [] for name, (dims, _) in EXPONENTS.items() if dims == _AT_FRACTION
    }
    largest = sample.sides == sample.sides.max(initial=0)
    for intervals in classes.values():
        exponents = {
            "scaled_strength_exponent": _over_sides(sample, intervals, linear),
            "predicted_exponent": _by_largest(
                sample.rates[largest], sample.numbers[largest], intervals, basic
            ),
        }
        exponents["beyond_exponent"] = exponents["scaled_strength_exponent"].less(
            exponents["predicted_exponent"]
        )
        for name, exponent in exponents.items():
            of_fractions[name].append(exponent)
    return of_fractions


def _over_sides(sample: _Sample, intervals: Mapping[float, int], linear: np.ndarray) -> Exponent:
    """Exponent over sides of the strength (interval, surface), of each side at its own interval.

    At equal v/b the strength follows v, and not along a straight line.
    """
    of_side = {side: sample.sides * SPACING == side for side in intervals}
    sides = np.concatenate(
        [np.full(np.count_nonzero(mask), side) for side, mask in of_side.items()]
    )
    values = np.concatenate([linear[intervals[side]][mask] for side, mask in of_side.items()])
    return size_exponent(sides, values, equal=True)


def _by_largest(
    rates: np.ndarray, numbers: np.ndarray, intervals: Mapping[float, int], basic: float
) -> Exponent:
    """Exponent over the sides of the largest joints' strengths at the intervals of all sides."""
    if len(rates) < 2:
        return UNKNOWN
    columns = [linear_strengths(numbers * 0, rates[:, k], basic) for k in intervals.values()]
    sides = np.repeat(list(intervals), len(numbers))
    return paired_exponent(sides, np.concatenate(columns), np.tile(numbers, len(intervals)))


def _by_theory(
    sample: _Sample,
    difference: np.ndarray,
    offsets: np.ndarray,
    classes: Mapping[tuple[float, float], Mapping[float, int]],
    basic: float,
) -> dict[str, Any]:
    """Strength if the separation is in proportion to sqrt(S(v)), the factor of the largest joints.

    A Gaussian composite of one h'_rms and under one pressure opens in proportion to its
    rms height but for the effect of the shape of its spectrum.
    """
    root = np.sqrt(difference)
    largest = sample.sides == sample.sides.max()
    factor = float(np.mean(sample.separations[largest] / root))
    rates = np.diff(factor * np.r_[0.0, root]) / np.diff(offsets)
    strength = friction_ratio(rates, basic)
    exponents = []
    for intervals in classes.values():
        lever = np.log(list(intervals)) - np.mean(np.log(list(intervals)))
        logs = np.log(strength[list(intervals.values())])
        exponents.append(float(lever @ logs / (lever @ lever)))
    return {"theory_strength": strength, "theory_exponent": exponents}
