"""Panels of the quality sheet: mask, heights and profiles of the faces of a scan."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.patches import Patch

from ...core.labels import length_words
from ...core.window import window_slices
from ..kit.drawing import COLOURS
from ..kit.legends import mark
from ..kit.maps import MISSING, draw_map, missing_patch, scan_extent, window_outline
from ..kit.words import length_unit

#: Outliers up to this many are ringed, so that single cells can be seen.
FEW_OUTLIERS = 400
OUTLIER, FILLED, PRESENT, SPIKE = COLOURS[2], COLOURS[1], "0.96", COLOURS[0]
FACE_COLOURS = {"lower": COLOURS[0], "upper": COLOURS[4]}
_PROFILES: dict[str, Any] = {"color": "0.4", "lw": 0.7, "ls": (0, (6, 2, 1, 2))}
_WINDOW = "0.9"
#: What heights are compared with.
GAUSSIAN = "0.6"


def draw_mask(
    axes: Axes, specimen: xr.Dataset, faces: Sequence[str], sides: Sequence[float]
) -> list[Artist]:
    """Mask of missing, filled and outlying cells, with the entries of its legend."""
    missing = np.isnan([specimen[face].values for face in faces]).any(axis=0)
    image = np.full((*missing.shape, 3), to_rgb(PRESENT))
    image[missing] = to_rgb(MISSING)
    marks: list[Artist] = [Patch(facecolor=PRESENT, edgecolor="0.6", lw=0.5, label="measured")]
    marks += [missing_patch()] if missing.any() else []
    if "filled" in specimen and specimen["filled"].any():
        image[specimen["filled"].values] = to_rgb(FILLED)
        marks.append(Patch(facecolor=FILLED, label="filled"))
    spikes = specimen["spike"].values if "spike" in specimen else np.zeros_like(missing)
    if spikes.any():
        image[spikes] = to_rgb(SPIKE)
        marks.append(Patch(facecolor=SPIKE, label="lone spike"))
    outliers = specimen["outlier"].values if "outlier" in specimen else np.zeros_like(missing)
    image[outliers] = to_rgb(OUTLIER)
    draw_map(axes, image, sides)
    _, size = length_unit(max(sides))
    if outliers.any():
        marks.append(Patch(facecolor=OUTLIER, label="outlier"))
    if 0 < outliers.sum() <= FEW_OUTLIERS:
        y, x = np.nonzero(outliers)
        places = [
            (cells + 0.5) * specimen.attrs[f"spacing_{axis}"] / size
            for cells, axis in ((x, "x"), (y, "y"))
        ]
        axes.plot(*places, "o", ms=4, mfc="none", mec=OUTLIER, mew=0.7)
    axes.add_patch(window_outline(specimen, size, lw=1))
    for axis, start in zip("yx", _middle(specimen), strict=True):
        at = (start + 0.5) * specimen.attrs[f"spacing_{axis}"] / size
        (axes.axhline if axis == "y" else axes.axvline)(at, **_PROFILES)
    marks.append(mark(label="where profiles run", **_PROFILES))
    marks.append(Patch(facecolor=_WINDOW, label="profiles: the window"))
    return marks


def _middle(specimen):
    """Row and column through the middle of the window."""
    return tuple((cells.start + cells.stop) // 2 for cells in window_slices(specimen))


def draw_histogram(axes: Axes, quality: xr.Dataset, faces: Sequence[str]) -> None:
    """Distribution of the heights of each face, beside the Gaussian of the same rms."""
    unit, size = length_unit(float(np.ptp(quality["edge"].values)))
    for face in faces:
        of_face = quality.sel(face=face)
        axes.stairs(
            of_face["density"].values * size,
            quality["edge"].values / size,
            color=FACE_COLOURS[face],
            lw=1,
        )
    first = quality.sel(face=faces[0])
    rms, z = first["rms"].item() / size, quality["edge"].values / size
    axes.plot(z, np.exp(-((z / rms) ** 2) / 2) / rms / np.sqrt(2 * np.pi), color=GAUSSIAN, lw=0.8)
    axes.set(xlabel=f"height ({unit})", ylabel=f"fraction of cells (1/{unit})", ylim=(0, None))
    words = "\n".join(
        f"{face}: rms {length_words(float(q['rms']))}\n"
        f"skew {q['skewness']:.2f}, kurt. {q['kurtosis']:.1f}"
        for face, q in ((face, quality.sel(face=face)) for face in faces)
    )
    axes.text(0.02, 0.97, words, transform=axes.transAxes, va="top", fontsize=6)
    axes.set_ylim(top=(1.2 + 0.3 * len(faces)) * axes.get_ylim()[1])  # room for the words


def profile(specimen: xr.Dataset, face: str, axis: str) -> xr.Dataset:
    """Places and heights along one axis, through the middle of the window."""
    row, column = _middle(specimen)
    z = specimen[face].values
    z = z[row] if axis == "x" else z[:, column]
    place = (np.arange(z.size) + 0.5) * specimen.attrs[f"spacing_{axis}"]
    mm = {"units": "mm"}
    return xr.Dataset({"place": ("node", place, mm), "height": ("node", z, mm)})


def draw_profile(axes: Axes, specimen: xr.Dataset, faces: Sequence[str], axis: str) -> None:
    """Profiles of the faces along one axis, the window shaded."""
    place_unit, place = length_unit(max(scan_extent(specimen)))
    profiles = {face: profile(specimen, face, axis) for face in faces}
    heights = np.concatenate([one["height"] for one in profiles.values()])
    span = np.ptp(heights[np.isfinite(heights)]) if np.isfinite(heights).any() else 1.0
    unit, size = length_unit(span)
    for face, one in profiles.items():
        axes.plot(one["place"] / place, one["height"] / size, color=FACE_COLOURS[face], lw=0.7)
    cells = dict(zip("yx", window_slices(specimen), strict=True))[axis]
    spacing = specimen.attrs[f"spacing_{axis}"] / place
    axes.axvspan(cells.start * spacing, cells.stop * spacing, color=_WINDOW, zorder=0)
    axes.set(xlabel=f"${axis}$ ({place_unit})", ylabel=f"height ({unit})")
    axes.margins(x=0)
