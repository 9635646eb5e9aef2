"""Joint roughness coefficient: Z2 of the faces and the JRC by Tse and Cruden's relation."""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled, labelled_dataset
from ..core.limits import JRC_RANGE, JRC_SAMPLING
from ..core.mean_plane import without_mean_plane
from ..core.window import faces, spacing_of, window_slices
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
#: Largest relative difference between a step of whole cells and that of a fit.
_NEAR = 0.25
_TABLE = {
    "step": ("sampling", "mm", "step of Z2, whole cells"),
    "z2": ("sampling", "1", "rms slope Z2 of profiles along the sliding"),
    "jrc": ("sampling", "1", "JRC = 32.2 + 32.47 log10 Z2"),
    "fit_step": ("fit", "mm", "step of Z2 of each published fit, whole cells"),
    "jrc_by_fit": (
        "fit",
        "1",
        "JRC by each published fit; missing where no step is near the fit's",
    ),
    "jrc_used": ((), "1", f"JRC at {JRC_SAMPLING}, kept within {JRC_RANGE[0]:g}-{JRC_RANGE[1]:g}"),
}


#: Grasselli's parameters of the lower face at the scan's spacing.
_GRASSELLI = {
    f"grasselli_{name}": ((), unit, f"{words} of Grasselli's law, lower face, along the sliding")
    for name, unit, words in (
        ("theta_max", "degree", "largest apparent dip theta*_max"),
        ("c", "1", "exponent C"),
        ("a_0", "1", "fraction A_0 of the area that faces the sliding"),
        ("roughness", "degree", "roughness theta*_max / (C + 1)"),
    )
}


def profile_roughness(specimen: xr.Dataset, direction: str) -> xr.Dataset:
    """Z2 and joint roughness coefficient of the faces under the window, along the sliding.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : {"E", "N", "W", "S"}

    Returns
    -------
    xr.Dataset
        Over `sampling` (:data:`JRC_SAMPLINGS`): the `step` in whole cells (mm), `z2` (rms slope
        over that step, with every place of the first sample; both faces if two were scanned) and
        `jrc` as Tse & Cruden's relation gives it. Over `fit` (:data:`FITS`) the `jrc_by_fit`, each
        at its `fit_step`. `jrc_used`, the one of :data:`JRC_SAMPLING` kept within
        :data:`JRC_RANGE`. `grasselli_theta_max`, `_c`, `_a_0` and `_roughness` of
        :func:`roughness.grasselli.grasselli`.

    Notes
    -----
    Tse & Cruden's relation is a regression over Barton's ten profiles and leaves 0-20 as soon as a
    face is steeper than they are. The law of strength was measured within, and its correction for
    scale has the JRC in exponents, where values beyond make no sense: both get the value kept
    within.
    """
    axis = sliding_axis(direction)
    window = window_slices(specimen)
    levelled = [without_mean_plane(z[window]) for z in faces(specimen)]
    profiles = [np.moveaxis(z, axis, 0) for z in levelled]
    roughness = roughness_of_profiles(profiles, direction_spacing(specimen, direction))
    # Grasselli's law describes the lower face, because the upper block climbs it.
    law = grasselli(levelled[0], spacing_of(specimen), direction)
    return roughness.assign(
        labelled(_GRASSELLI, {f"grasselli_{name}": value for name, value in law._asdict().items()})
    )


def roughness_of_profiles(levelled: list[np.ndarray], spacing: float) -> xr.Dataset:
    """Profile roughness of levelled heights (n, m), mm, along the first axis of arrays."""
    lags = [1 if step is None else max(1, round(step / spacing)) for step in JRC_SAMPLINGS.values()]
    z2 = np.array([_rms_slope(levelled, lag, spacing) for lag in lags])
    jrc = np.array([joint_roughness(value) if value > 0 else np.nan for value in z2])
    steps, by_fit = _by_fits(levelled, spacing)
    chosen = list(JRC_SAMPLINGS).index(JRC_SAMPLING)
    values = {
        "step": spacing * np.array(lags),
        "z2": z2,
        "jrc": jrc,
        "fit_step": steps,
        "jrc_by_fit": by_fit,
        "jrc_used": np.clip(jrc[chosen], *JRC_RANGE),
    }
    return labelled_dataset(
        _TABLE, values, coords={"sampling": list(JRC_SAMPLINGS), "fit": list(FITS)}
    )


def _rms_slope(profiles: list[np.ndarray], lag: int, spacing: float) -> float:
    """Rms slope over a step of ``lag`` cells along the first axis; NaN if it is too long."""
    if lag >= len(profiles[0]):
        return np.nan
    squares = [np.mean((z[lag:] - z[:-lag]) ** 2) for z in profiles]
    return np.sqrt(np.mean(squares)) / (lag * spacing)


def _by_fits(profiles: list[np.ndarray], spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Step, mm, and JRC of each of :data:`FITS`; no JRC where whole cells come near no step."""
    lags = [max(1, round(step / spacing)) for step, _ in FITS.values()]
    jrc = np.full(len(FITS), np.nan)
    for i, (lag, (step, fit)) in enumerate(zip(lags, FITS.values(), strict=True)):
        z2 = _rms_slope(profiles, lag, spacing)
        if abs(lag * spacing / step - 1) <= _NEAR and z2 > 0:
            jrc[i] = fit(z2)
    return spacing * np.array(lags), jrc
