"""Panels of the quality sheet: mask, heights, profiles and spectra of the faces of a scan."""

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
from ..kit.axes import label_short_span
from ..kit.drawing import COLOURS
from ..kit.empty import say_empty
from ..kit.legends import mark
from ..kit.maps import MISSING, draw_map, missing_patch, scan_extent, window_outline
from ..kit.words import length_unit

#: Outliers up to this many are ringed, so that single cells can be seen.
FEW_OUTLIERS = 400
OUTLIER, FILLED, PRESENT, SPIKE = COLOURS[2], COLOURS[1], "0.96", COLOURS[0]
FACE_COLOURS = {"lower": COLOURS[0], "upper": COLOURS[4]}
AXIS_COLOURS = {"x": COLOURS[6], "y": COLOURS[5]}
#: The fractal range, and what lies in it; where profiles run; what heights are compared with.
RANGE, GAUSSIAN = COLOURS[3], "0.6"
_PROFILES: dict[str, Any] = {"color": "0.4", "lw": 0.7, "ls": (0, (6, 2, 1, 2))}
_WINDOW = "0.9"


# -- maps ------------------------------------------------------------------------------------------


def draw_mask(
    axes: Axes, specimen: xr.Dataset, faces: Sequence[str], sides: Sequence[float]
) -> list[Artist]:
    """What of the scan is missing, filled or an outlier; the entries of a legend."""
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


# -- heights ---------------------------------------------------------------------------------------


def draw_histogram(axes: Axes, quality: xr.Dataset, faces: Sequence[str]) -> None:
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


# -- spectra ---------------------------------------------------------------------------------------


def draw_spectrum(axes: Axes, quality: xr.Dataset, face: str) -> None:
    """Spectra of profiles of one face with their models, floor and end; resolutions on top."""
    found = quality.sel(face=face)
    for axis, marker in zip(AXIS_COLOURS, "os", strict=True):
        of_axis, colour = found.sel(axis=axis), AXIS_COLOURS[axis]
        waves = of_axis["wavelength"].values
        style: dict[str, Any] = {"color": colour, "lw": 0.9}
        hollow = {"color": colour, "ms": 2.5, "mfc": "none", "mew": 0.7}
        axes.loglog(waves, of_axis["spectrum"].values, marker, **hollow)
        axes.loglog(waves, of_axis["spectrum_model"].values, **style)
        if np.isfinite(waves).any() and of_axis["form"].item():
            axes.loglog(waves, of_axis["self_affine_line"].values, **style | {"lw": 0.7, "ls": ":"})
            if np.isfinite(of_axis["noise_floor"]):
                axes.axhline(of_axis["noise_floor"].item(), **style | {"lw": 0.8, "ls": "--"})
    _mark_range(axes, quality)
    measured = found["spectrum"].values[found["spectrum"].values > 0]
    if measured.size:
        axes.set_ylim(measured.min() / 4, measured.max() * 4)
    else:
        say_empty(axes, "too small for a spectrum")
    axes.set(xlabel="wavelength (mm)", ylabel="spectrum of profiles (mm³)")
    label_short_span(axes.xaxis)


def _mark_range(axes, quality):
    """The fractal range, shaded, and 2 s of every resolution at the upper edge."""
    axes.axvspan(*_range(quality), color=RANGE, alpha=0.13, lw=0, zorder=0)
    for side, below in zip(
        quality["resolution"].values, quality["below_range"].values, strict=True
    ):
        face = "white" if below else RANGE
        at = axes.get_xaxis_transform()
        axes.plot(
            2 * side, 0.985, "v", ms=5, transform=at, clip_on=False, color=RANGE, mfc=face, zorder=5
        )


def _range(quality):
    """Wavelengths (mm) of the fractal range: those measured, from its end to any roll-off."""
    waves = [quality[f"{of}wavelength"].values.ravel() for of in ("", "radial_")]
    waves = np.concatenate([*waves, 2 * quality["resolution"].values])
    waves = waves[np.isfinite(waves)]
    low, high = 0.95 * waves.min(), 1.05 * waves.max()  # markers at the ends stand inside
    end, off = quality["range_end"].item(), quality["roll_off_wavelength"].values
    off = off[np.isfinite(off)]
    return end if np.isfinite(end) else low, off.min() if off.size else high


def draw_radial(axes: Axes, quality: xr.Dataset, faces: Sequence[str]) -> None:
    """Radially averaged spectra, with the floor that the profiles have."""
    for face in faces:
        found = quality.sel(face=face)
        waves, level = found["radial_wavelength"].values, found["radial_spectrum"].values
        axes.loglog(
            waves, level, "o-", ms=2.5, mfc="none", mew=0.7, color=FACE_COLOURS[face], lw=0.8
        )
        if np.isfinite(found["radial_noise_floor"]):
            floor = found["radial_noise_floor"].item()
            axes.axhline(floor, color=FACE_COLOURS[face], lw=0.8, ls="--")
    _mark_range(axes, quality)
    if not np.isfinite(quality["radial_spectrum"]).any():
        say_empty(axes, "too small for a spectrum")
    axes.set(xlabel="wavelength (mm)", ylabel="radial spectrum (mm⁴)")
    label_short_span(axes.xaxis)


def spectrum_entries(quality: xr.Dataset, faces: Sequence[str]) -> list[Artist]:
    """Entries of the legend for what stands in the lower panels."""
    entries: list[Artist] = [
        mark(color=FACE_COLOURS[face], lw=1, label=f"{face} face") for face in faces
    ]
    entries += [
        mark(
            color=AXIS_COLOURS[axis],
            marker="os"[i],
            ms=3,
            mfc="none",
            lw=0.9,
            label=f"profiles along ${axis}$, model",
        )
        for i, axis in enumerate(AXIS_COLOURS)
    ]
    entries.append(mark(color="0.3", ls=":", lw=0.8, label="self-affine line"))
    if quality["noise_rms"].notnull().any():
        entries.append(mark(color="0.3", ls="--", lw=0.8, label="noise floor"))
    entries.append(mark(color=GAUSSIAN, lw=0.8, label="Gaussian of the same rms"))
    entries.append(Patch(color=RANGE, alpha=0.13, lw=0, label="fractal range"))
    below = quality["below_range"].values
    for which, label in ((False, "2 $s$ of a resolution"), (True, "2 $s$, below the range")):
        if (below == which).any():
            style: dict[str, Any] = {"color": RANGE, "mfc": "white" if which else RANGE}
            entries.append(mark(ls="none", marker="v", label=label, **style))
    return entries
