"""Joint roughness coefficient: Z2 of the faces and the JRC by Tse and Cruden's relation."""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled, labelled_dataset
from ..core.estimate import NO_ESTIMATE, Estimate, names_of, rows_of
from ..core.intervals import t_quantile
from ..core.limits import JRC_RANGE, JRC_SAMPLING
from ..core.mean_plane import without_mean_plane
from ..core.window import faces, spacing_of
from ..roughness.grasselli import grasselli
from .barton import joint_roughness
from .joint import direction_spacing, sliding_axis

#: Step of Tse and Cruden's relation, mm.
JRC_STEP = 1.27
#: Steps over which slopes are taken for Z2, mm, by name; None is the scan's own spacing. Tse &
#: Cruden (1979) state 1.27 mm. Their profiles of 100 mm had 200 such steps, so that they must have
#: been enlarged 2.5 times: a step of 0.508 mm on the rock, which is given too.
JRC_SAMPLINGS = {"scan": None, "0.508 mm": 0.508, "1.27 mm": JRC_STEP}
#: Fits of the JRC to Z2 of Barton's ten profiles, each with the step they were digitised with, mm:
#: one number without step and fit means nothing. Tse & Cruden (1979), their step as enlarged; Yang,
#: Lo & Di (2001) Rock Mech. Rock Eng. 34, 243; Yu & Vayssade (1991) Int. J. Rock Mech. 28, 333;
#: Tatone & Grasselli (2010) Rock Mech. Rock Eng. 43, 451.
FITS: dict[str, tuple[float, Callable[[Any], Any]]] = {
    "Tse and Cruden 1979, 0.5 mm": (0.5, joint_roughness),
    "Yang et al. 2001, 0.5 mm": (0.5, lambda z2: 32.69 + 32.98 * np.log10(z2)),
    "Yu and Vayssade 1991, 0.25 mm": (0.25, lambda z2: 60.32 * z2 - 4.51),
    "Yu and Vayssade 1991, 0.5 mm": (0.5, lambda z2: 61.79 * z2 - 3.47),
    "Yu and Vayssade 1991, 1 mm": (1.0, lambda z2: 64.22 * z2 - 2.31),
    "Tatone and Grasselli 2010, 0.5 mm": (0.5, lambda z2: 51.85 * z2**0.60 - 10.37),
    "Tatone and Grasselli 2010, 1 mm": (1.0, lambda z2: 55.03 * z2**0.74 - 6.10),
}
#: Rounding of a step of whole cells.
_ROUNDING = 1e-9
#: Largest relative difference between a step of whole cells and that of a fit.
_NEAR = 0.25
#: Fewest steps of a profile whose Z2 counts in the scatter, and fewest such profiles.
_MIN_STEPS, _MIN_PROFILES = 10, 3
#: Largest step over that of a fit: beyond it there is no JRC.
MAX_STEP_RATIO = 2.0
#: Meaning of the intervals of Z2 and JRC.
_OF_PROFILES = "of the profiles of the face"
_TABLE = {
    "step": ("sampling", "mm", "step of Z2, whole cells"),
    **{
        name: (dims, unit, words)
        for dims, of in {
            "sampling": {
                "z2": ("1", "rms slope Z2 of profiles along the sliding, whole face"),
                "jrc": (
                    "1",
                    "JRC = 32.2 + 32.47 log10 Z2; missing where the step is more than twice "
                    "that of the fit",
                ),
            },
            (): {
                "z2_of_law": ("1", f"rms slope Z2 at {JRC_SAMPLING}"),
                "jrc_of_law": ("1", f"JRC at {JRC_SAMPLING}"),
                "jrc_used": (
                    "1",
                    f"JRC at {JRC_SAMPLING}, kept within {JRC_RANGE[0]:g}-{JRC_RANGE[1]:g}",
                ),
            },
            "fit": {
                "jrc_by_fit": (
                    "1",
                    "JRC by each published fit; missing where no step is near the fit's",
                ),
            },
        }.items()
        for row, (unit, long_name) in of.items()
        for name, (unit, words) in rows_of(row, unit, long_name, f"95 % {_OF_PROFILES}").items()
    },
    "fit_step": ("fit", "mm", "step of Z2 of each published fit, whole cells"),
}


#: Grasselli's parameters of the lower face at the scan's spacing.
_GRASSELLI = {
    name: ((), *of)
    for parameter, unit, words in (
        ("theta_max", "degree", "largest apparent dip theta*_max"),
        ("c", "1", "exponent C"),
        ("a_0", "1", "fraction A_0 of the area that faces the sliding"),
        ("roughness", "degree", "roughness theta*_max / (C + 1)"),
    )
    for name, of in rows_of(
        f"grasselli_{parameter}",
        unit,
        f"{words} of Grasselli's law, lower face, along the sliding",
        "95 % of quarters of the face",
    ).items()
}


def profile_roughness(specimen: xr.Dataset, direction: str) -> xr.Dataset:
    """Z2, joint roughness coefficient and Grasselli's parameters of the whole face.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : {"E", "N", "W", "S"}

    Returns
    -------
    xr.Dataset
        Over `sampling` (:data:`JRC_SAMPLINGS`): the `step` in whole cells (mm), `z2` (rms slope
        over that step, of both faces if two were scanned) and `jrc` as Tse & Cruden's relation
        gives it. Over `fit` (:data:`FITS`) the `jrc_by_fit`, each at its `fit_step`. `z2_of_law`
        and `jrc_of_law` at :data:`JRC_SAMPLING`, `jrc_used` kept within :data:`JRC_RANGE`. Each has
        `_low` and `_high`, between which 95 % of the profiles of the face lie.
        `grasselli_theta_max`, `_c`, `_a_0` and `_roughness` of
        :func:`roughness.grasselli.grasselli`, with the ends between which quarters of it lie.

    Notes
    -----
    Roughness needs no room to slide, so that it is that of the face and not of the window. Tse &
    Cruden's relation is a regression over Barton's ten profiles and leaves 0-20 as soon as a face
    is steeper than they are. The law of strength was measured within, and its correction for scale
    has the JRC in exponents, where values beyond make no sense: both get the value kept within.
    """
    axis = sliding_axis(direction)
    scanned = faces(specimen)[: 1 + (specimen.attrs["opposite"] == "scanned")]
    levelled = [without_mean_plane(z) for z in scanned]
    profiles = [np.moveaxis(z, axis, 0) for z in levelled]
    roughness = roughness_of_profiles(profiles, direction_spacing(specimen, direction))
    # Grasselli's law describes the lower face, because the upper block climbs it.
    law = grasselli_with_scatter(levelled[0], spacing_of(specimen), direction)
    values = {
        of: end
        for name, estimate in law.items()
        for of, end in zip(names_of(f"grasselli_{name}"), estimate.ends, strict=True)
    }
    return roughness.assign(labelled(_GRASSELLI, values))


def grasselli_with_scatter(
    levelled: np.ndarray, spacing: tuple[float, float], direction: str
) -> dict[str, Estimate]:
    """Grasselli's parameters of a face (ny, nx), mm, by name, with the scatter of its quarters.

    Arguments as of :func:`roughness.grasselli.grasselli`. No ends where a quarter has no law.
    """
    whole = grasselli(levelled, spacing, direction)
    halves = [(slice(None, n // 2), slice(n // 2, None)) for n in levelled.shape]
    quarters = [
        grasselli(levelled[rows, columns], spacing, direction)
        for rows in halves[0]
        for columns in halves[1]
    ]
    scatter = t_quantile(len(quarters) - 1) * np.std(quarters, axis=0, ddof=1)
    return {
        name: Estimate.about(value, half, 0.0)
        for name, value, half in zip(whole._fields, whole, scatter, strict=True)
    }


def roughness_of_profiles(levelled: list[np.ndarray], spacing: float) -> xr.Dataset:
    """Profile roughness of levelled heights (n, m), mm, along the first axis of arrays.

    Heights may be missing (NaN). A single profile has no scatter, and no ends.
    """
    stated = [JRC_STEP if step is None else step for step in JRC_SAMPLINGS.values()]
    lags = [1 if step is None else max(1, round(step / spacing)) for step in JRC_SAMPLINGS.values()]
    z2 = [_z2(levelled, lag, spacing) for lag in lags]
    jrc = [
        _by_relation(joint_roughness, *of)
        if lag * spacing <= MAX_STEP_RATIO * step * (1 + _ROUNDING)
        else NO_ESTIMATE
        for of, lag, step in zip(z2, lags, stated, strict=True)
    ]
    chosen = list(JRC_SAMPLINGS).index(JRC_SAMPLING)
    of_law, fits = jrc[chosen], _by_fits(levelled, spacing)
    estimates = {
        "z2": Estimate.stack([_about(*of) for of in z2]),
        "jrc": Estimate.stack(jrc),
        "z2_of_law": _about(*z2[chosen]),
        "jrc_of_law": of_law,
        "jrc_used": of_law.within(*JRC_RANGE),
        "jrc_by_fit": Estimate.stack([of for _, of in fits]),
    }
    values: dict[str, Any] = {
        of: end
        for name, estimate in estimates.items()
        for of, end in zip(names_of(name), estimate.ends, strict=True)
    }
    values |= {"step": spacing * np.array(lags), "fit_step": [step for step, _ in fits]}
    return labelled_dataset(
        _TABLE, values, coords={"sampling": list(JRC_SAMPLINGS), "fit": list(FITS)}
    )


def _z2(profiles: list[np.ndarray], lag: int, spacing: float) -> tuple[float, np.ndarray]:
    """Rms slope of the face over a step of ``lag`` cells along the first axis, and of its profiles.

    NaN if the step is too long. Profiles count if they have half of the steps of the longest one.
    """
    if lag >= len(profiles[0]):
        return np.nan, np.empty(0)
    squares = np.concatenate([(z[lag:] - z[:-lag]) ** 2 for z in profiles], axis=1)
    squares /= (lag * spacing) ** 2
    known = np.isfinite(squares)
    steps, sums = known.sum(axis=0), np.where(known, squares, 0.0).sum(axis=0)
    if not steps.any():
        return np.nan, np.empty(0)
    counted = steps >= max(_MIN_STEPS, steps.max() / 2)
    return float(np.sqrt(sums.sum() / steps.sum())), np.sqrt(sums[counted] / steps[counted])


def _by_relation(relation: Callable[[Any], Any], z2: float, each: np.ndarray) -> Estimate:
    """JRC of the face by a relation to Z2, with the ends between which 95 % of its profiles lie."""
    if not z2 > 0:
        return NO_ESTIMATE
    return _about(float(relation(z2)), relation(each[each > 0]))


def _about(value: float, each: np.ndarray) -> Estimate:
    """Value of the face with the scatter of its profiles: 95 % of them lie between the ends."""
    half = t_quantile(each.size - 1) * each.std(ddof=1) if each.size >= _MIN_PROFILES else np.nan
    return Estimate.about(value, half, 0.0)


def _by_fits(profiles: list[np.ndarray], spacing: float) -> list[tuple[float, Estimate]]:
    """Step, mm, and JRC of each of :data:`FITS`; no JRC where whole cells come near no step."""
    found = []
    for step, relation in FITS.values():
        lag = max(1, round(step / spacing))
        is_near = abs(lag * spacing / step - 1) <= _NEAR
        jrc = _by_relation(relation, *_z2(profiles, lag, spacing)) if is_near else NO_ESTIMATE
        found.append((spacing * lag, jrc))
    return found
