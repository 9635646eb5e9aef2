"""Effect of a roll-off on rigid dilatancy: many joints with one, and the same joints without.

One joint is not conclusive. The dilatancy is a largest height, which scatters from surface to
surface by more than it grows over the second half of the offsets.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled, labelled_dataset, titled
from fractalcontact.core.directions import DIRECTIONS
from fractalcontact.core.fitting import fit_line
from fractalcontact.core.intervals import mean_interval
from fractalcontact.core.labels import cf_attrs
from fractalcontact.core.limits import LEVEL_CHANGE
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.core.verdicts import FALLING, LEVEL, RISING
from fractalcontact.core.window import faces, window_slices
from fractalcontact.joint.joint import (
    RIGID_SLIDE,
    direction_spacing,
    face_correlation,
    over_spread,
    rigid_dilatancy,
)
from fractalcontact.joint.plateau import relative_change, second_half
from fractalcontact.roughness.dimension import slope_statistics
from fractalcontact.surface.embedded import embedded_surface
from fractalcontact.surface.specimen import largest_offset, make_specimen

from .units import SURFACES

#: Number of offsets, from zero to the largest.
N_OFFSETS = 50


@titled("rigid dilatancy of synthetic joints with and without a roll-off")
def roll_off_effect(recipe: Mapping[str, Any], window: float, seeds: Sequence[int]) -> xr.Dataset:
    """Rigid dilatancy of embedded joints with their roll-off, and without.

    Parameters
    ----------
    recipe : mapping
        Of an embedded specimen, from :func:`study.configuration.resolve_embedded`, with a
        ``roll_off``. Its seed is not used.
    window : float
        Side of the window, mm; the joint slides as far as every direction allows.
    seeds : sequence of int

    Returns
    -------
    xr.Dataset
        ``rigid_dilatancy``, ``composite_rms`` and ``face_correlation`` over (surface, seed,
        direction, rigid_offset); ``face_rms`` and ``rms_slope`` over (surface, seed); over
        (surface,) ``slope`` of the dilatancy over the second half of the offsets, mean over seeds,
        with its interval, its ``change`` there and its ``trend``.

    Notes
    -----
    Without the roll-off the spectrum goes on to the longest wave. Heights are scaled to the rms
    slope of the same seed with the roll-off, so that the short waves are as high.
    """
    by_surface = {
        surface: [_slide(heights, recipe["spacing"], window) for heights in surfaces]
        for surface, surfaces in _surfaces(recipe, seeds).items()
    }
    reach = min(len(slid["rigid_offset"]) for slides in by_surface.values() for slid in slides)
    result = xr.concat(
        [
            xr.concat(
                [slid.isel(rigid_offset=slice(reach)) for slid in by_surface[surface]], "seed"
            )
            for surface in SURFACES
        ],
        "surface",
    )
    result = result.assign_coords(surface=list(SURFACES))
    result["seed"] = ("seed", list(seeds), cf_attrs("1", "seed of the surface"))
    add_trend(result)
    add_means(result)
    result.attrs = {"roll_off": recipe["roll_off"], "window": window}
    return result


def add_trend(result: xr.Dataset) -> None:
    """Add slope, change and trend of the dilatancy over the second half of the offsets.

    ``result`` has ``rigid_dilatancy`` over (surface, seed, direction, rigid_offset) and gets
    ``slope``, its mean over the seeds, with its interval, ``change`` and ``trend`` over (surface,).
    """
    v = result["rigid_offset"].values
    half = second_half(v)
    opened = result["rigid_dilatancy"].mean("direction").transpose("surface", "seed", ...).values
    opened = opened[..., half]
    slope = mean_interval(
        [[fit_line(v[half], row).slope.value for row in rows] for rows in opened], axis=1
    )
    words = "slope of the rigid dilatancy over the second half of v, mean over seeds"
    result.update(slope.variables("slope", "surface", "1", words))
    changes = relative_change(slope.value, v[half], opened.mean(axis=(1, 2)))
    trends = [_trend(*ends) for ends in zip(changes, slope.low, slope.high, strict=True)]
    table = {
        "change": ("surface", "1", "change over the second half of v, a fraction of the mean"),
        "trend": ("surface", "1", f"{LEVEL}, {RISING}, {FALLING}, or empty where none is certain"),
    }
    result.update(labelled(table, {"change": changes, "trend": np.array(trends)}))


def add_means(result: xr.Dataset) -> None:
    """Add means over the directions of each joint, and the first offset of the slope.

    ``result`` of :func:`roll_off_effect` gets ``joint_dilatancy``, ``joint_rms``,
    ``joint_rms_expected`` and ``joint_dilatancy_over_rms`` over (surface, seed, rigid_offset).
    """
    order = ("surface", "seed", "direction", "rigid_offset")
    slides = result.transpose(*order)
    expected = slides["face_rms"] * np.sqrt(np.maximum(2 - 2 * slides["face_correlation"], 0))
    opened, spread, by_faces = (
        values.transpose(*order).mean("direction").values
        for values in (slides["rigid_dilatancy"], slides["composite_rms"], expected)
    )
    v = result["rigid_offset"].values
    values = {
        "joint_dilatancy": opened,
        "joint_rms": spread,
        "joint_rms_expected": by_faces,
        "joint_dilatancy_over_rms": over_spread(opened, spread),
        "slope_offset_min": v[second_half(v)][0],
    }
    result.update(labelled(_MEANS, values))


_OF_JOINTS = ("surface", "seed", "rigid_offset")
_MEANS = {
    "joint_dilatancy": (_OF_JOINTS, "mm", "rigid dilatancy, mean of the directions"),
    "joint_rms": (
        _OF_JOINTS,
        "mm",
        "standard deviation of the composite topography, mean of the directions",
    ),
    "joint_rms_expected": (
        _OF_JOINTS,
        "mm",
        "the same by heights and correlation of the faces",
    ),
    "joint_dilatancy_over_rms": (_OF_JOINTS, "1", "rigid dilatancy over that deviation"),
    "slope_offset_min": ((), "mm", "smallest offset that the slope is taken over"),
}


def _trend(change: float, low: float, high: float) -> str:
    """Trend of many joints: level by its change, else a direction only where the slopes agree."""
    if abs(change) <= LEVEL_CHANGE:
        return LEVEL
    return RISING if low > 0 else FALLING if high < 0 else ""


def _surfaces(recipe: Mapping[str, Any], seeds: Sequence[int]) -> dict[str, list[np.ndarray]]:
    """Heights by surface, a list over the seeds."""
    with_it = [embedded_surface({**recipe, "seed": seed}) for seed in seeds]
    without = [embedded_surface({**recipe, "seed": seed, "roll_off": None}) for seed in seeds]

    def slope(heights: np.ndarray) -> float:
        return float(slope_statistics(heights, recipe["spacing"])["rms_slope"])

    scaled = [
        longer * (slope(short) / slope(longer))
        for short, longer in zip(with_it, without, strict=True)
    ]
    return dict(zip(SURFACES, (with_it, scaled), strict=True))


_TABLE = RIGID_SLIDE | {
    "face_rms": ((), "mm", "standard deviation of a face's heights"),
    "rms_slope": ((), "1", "rms slope of the surface"),
}


def _slide(heights: np.ndarray, spacing: float, window: float) -> xr.Dataset:
    """One joint over its offsets."""
    coords = [spacing * (np.arange(n) + 0.5) for n in heights.shape]
    scan = xr.DataArray(
        heights,
        dims=("y", "x"),
        coords=coords,
        attrs={"spacing_x": spacing, "spacing_y": spacing, "source": "made"},
    )
    specimen = make_specimen(scan, window=window, name="synthetic surface")
    reach = min(largest_offset(specimen, direction) for direction in DIRECTIONS)
    cells = np.unique(np.linspace(0, reach, N_OFFSETS).astype(int))
    dilatancy, spread = zip(*(rigid_dilatancy(specimen, d, cells) for d in DIRECTIONS), strict=True)
    lower = without_mean_plane(faces(specimen)[0][window_slices(specimen)])
    slid = cells * direction_spacing(specimen, "E")
    return labelled_dataset(
        _TABLE,
        {
            "rigid_dilatancy": list(dilatancy),
            "composite_rms": list(spread),
            "face_correlation": [face_correlation(specimen, d, cells) for d in DIRECTIONS],
            "face_rms": lower.std(),
            "rms_slope": slope_statistics(heights, spacing)["rms_slope"].item(),
        },
        coords={
            "direction": list(DIRECTIONS),
            "rigid_offset": ("rigid_offset", slid, cf_attrs("mm", "shear offset v")),
        },
    )
