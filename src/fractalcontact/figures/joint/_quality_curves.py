"""Curves of the quality sheet: heights, profiles, spectra, gap, load on suspicious cells."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from ...core.limits import DECISIVE
from ...core.text import compact, length_unit, length_words, number
from ...core.window import window_slices
from .. import kit
from ._quality_maps import OVERLAP, middle

FACE_COLOURS = {"lower": kit.COLOURS[0], "upper": kit.COLOURS[4]}
AXIS_STYLES = {"x": (kit.COLOURS[6], "o"), "y": (kit.COLOURS[5], "s")}
#: Colour of the fractal range.
RANGE = kit.COLOURS[3]
_GAUSSIAN: dict[str, Any] = {"color": "0.6", "lw": 0.8}
_POINTS: dict[str, Any] = {"ms": 2.5, "mfc": "none", "mew": 0.7}
#: Maximum number of offsets drawn.
_OFFSETS = 5


def draw_histogram(panel: kit.Panel, quality: xr.Dataset, faces: Sequence[str]) -> None:
    """Distribution of the heights of each face, beside the Gaussian of the same rms."""
    axes, edges = panel.axes, quality["edge"].values
    unit, size = length_unit(float(np.ptp(edges)))
    words = []
    for face in faces:
        one = quality.sel(face=face)
        axes.stairs(one["density"] * size, edges / size, color=FACE_COLOURS[face], lw=1)
        panel.keep(one, "bin_height", "density")
        rms = length_words(float(one["rms"]))
        words.append(
            f"{face}: rms {rms}\nskew {number(one['skewness'])}, kurt. {number(one['kurtosis'], 1)}"
        )
    rms = quality.sel(face=faces[0])["rms"].item()
    axes.plot(
        edges / size,
        np.exp(-((edges / rms) ** 2) / 2) / rms * size / np.sqrt(2 * np.pi),
        **_GAUSSIAN,
    )
    axes.set(xlabel=f"height ({unit})", ylabel=f"fraction of cells (1/{unit})")
    axes.text(0.02, 0.97, "\n".join(words), transform=axes.transAxes, va="top", fontsize=6)
    axes.set_ylim(0, (1.2 + 0.3 * len(faces)) * axes.get_ylim()[1])  # room for the words


def draw_profile(panel: kit.Panel, specimen: xr.Dataset, faces: Sequence[str], axis: str) -> None:
    """Profiles of the faces along one axis through the middle of the window, which is shaded."""
    which, spacing = "yx".index(axis), specimen.attrs[f"spacing_{axis}"]
    across = "x" if axis == "y" else "y"
    lines = specimen[list(faces)].isel({across: middle(specimen)[1 - which]})
    values = lines.to_array()
    mm = {"units": "mm"}
    place = (np.arange(lines.sizes[axis]) + 0.5) * spacing
    place_unit, place_size = length_unit(max(kit.scan_extent(specimen)))
    unit, size = length_unit(float(values.max() - values.min()) if values.notnull().any() else 1.0)
    for face in faces:
        one = {"place": ("node", place, mm), "height": ("node", lines[face].values, mm)}
        line: dict[str, Any] = {"color": FACE_COLOURS[face], "lw": 0.7, "ls": "-"}
        data = xr.Dataset(one, {"face": face, "axis": axis})
        panel.curve(data, "place", "height", unit=(place_size, size), **line)
    cells = window_slices(specimen)[which]
    ends = cells.start * spacing / place_size, cells.stop * spacing / place_size
    panel.axes.axvspan(*ends, color="0.9", zorder=0)
    panel.axes.set(xlabel=f"${axis}$ ({place_unit})", ylabel=f"height ({unit})")
    panel.axes.margins(x=0)


def draw_spectrum(panel: kit.Panel, quality: xr.Dataset, face: str) -> None:
    """Spectra of profiles of one face with their models, floor and end."""
    axes, spectra = panel.axes, quality.sel(face=face)
    for axis, (colour, marker) in AXIS_STYLES.items():
        one = spectra.sel(axis=axis)
        style: dict[str, Any] = {"color": colour, "lw": 0.9}
        points: dict[str, Any] = {"color": colour, "marker": marker, **_POINTS}
        panel.curve(one, "wavelength", "spectrum", keep=("spectrum_model",), **points)
        axes.plot(one["wavelength"], one["spectrum_model"], **style)
        if one["form"].item():
            axes.plot(one["wavelength"], one["self_affine_line"], **style | {"ls": ":"})
            if np.isfinite(one["noise_floor"]):
                axes.axhline(one["noise_floor"].item(), **style | {"ls": "--"})
    _finish(axes, quality, spectra["spectrum"])
    measured = spectra["spectrum"].where(spectra["spectrum"] > 0)
    if measured.notnull().any():
        axes.set_ylim(float(measured.min()) / 4, float(measured.max()) * 4)
    axes.set_ylabel("spectrum of profiles (mm³)")


def draw_radial(panel: kit.Panel, quality: xr.Dataset, faces: Sequence[str]) -> None:
    """Radially averaged spectra, with the floor that the profiles have."""
    for face in faces:
        spectra = quality.sel(face=face)
        style: dict[str, Any] = {"color": FACE_COLOURS[face], "lw": 0.8}
        line = style | _POINTS | {"marker": "o", "ls": "-"}
        panel.curve(spectra, "radial_wavelength", "radial_spectrum", **line)
        if np.isfinite(spectra["radial_noise_floor"]):
            panel.axes.axhline(spectra["radial_noise_floor"].item(), ls="--", **style)
    _finish(panel.axes, quality, quality["radial_spectrum"])
    panel.axes.set_ylabel("radial spectrum (mm⁴)")


def _finish(axes: Axes, quality: xr.Dataset, spectrum: xr.DataArray) -> None:
    """Axes of a spectrum; its fractal range shaded, 2 s of every resolution at the upper edge."""
    axes.set(xscale="log", yscale="log", xlabel="wavelength (mm)")
    axes.axvspan(*_range(quality), color=RANGE, alpha=0.13, lw=0, zorder=0)
    below = quality["below_range"].values
    for side, hollow in zip(quality["resolution"].values, below, strict=True):
        place: dict[str, Any] = {"transform": axes.get_xaxis_transform(), "clip_on": False}
        face = "white" if hollow else RANGE
        axes.plot(2 * side, 0.985, "v", color=RANGE, mfc=face, ms=5, zorder=5, **place)
    if not spectrum.notnull().any():
        kit.say_empty(axes, "too small for a spectrum")


def _range(quality: xr.Dataset) -> tuple[float, float]:
    """Wavelengths (mm) of the fractal range: those measured, from its end to any roll-off."""
    waves = [quality[f"{of}wavelength"].values.ravel() for of in ("", "radial_")]
    every = np.concatenate([*waves, 2 * quality["resolution"].values])
    end, off = quality["range_end"].item(), float(quality["roll_off_wavelength"].min())
    low, high = 0.95 * np.nanmin(every), 1.05 * np.nanmax(every)  # markers there stand inside
    return end if np.isfinite(end) else low, off if np.isfinite(off) else high


def draw_gap_heights(panel: kit.Panel, quality: xr.Dataset) -> None:
    """Distribution of the gap; negative gaps are overlaps."""
    counts, edges = quality["gap_cells"].values, quality["gap_edge"].values
    unit, size = length_unit(np.ptp(edges))
    panel.axes.stairs(counts, edges / size, color=kit.COLOURS[0], lw=1)
    below = edges <= 0
    if below.sum() > 1:
        overlaps = counts[: below.sum() - 1]
        panel.axes.stairs(overlaps, edges[below] / size, color=OVERLAP, fill=True)
    panel.axes.axvline(0, color="0.4", lw=0.6)
    panel.axes.set(xlabel=f"gap ({unit})", ylabel="cells (1)", yscale="log", ylim=(0.6, None))
    panel.keep(quality, "gap", "gap_cells")


def draw_load_share(panel: kit.Panel, curves: xr.Dataset) -> None:
    """Fraction of the load on suspicious cells against the nominal pressure, by offset."""
    shown = curves.isel(offset=kit.spread(curves.sizes["offset"], _OFFSETS))
    labels = [compact(offset) for offset in shown["offset"].values]
    style: dict[str, Any] = {"marker": "o", "ls": "-", "ms": 3, "lw": 0.9, "labels": labels}
    panel.curves(shown, "nominal_pressure", "suspect_load_share", hue="offset", **style)
    panel.axes.axhline(DECISIVE, color="0.4", lw=0.7, ls="-.")
    panel.axes.set(xlabel=f"{kit.NOMINAL_PRESSURE} (MPa)", xscale="log", ylim=(-0.04, 1.04))
    panel.axes.set_ylabel("load on suspicious cells (fraction)")
    panel.axes.legend(title="$v$ (mm)", fontsize=6, title_fontsize=6, loc="best")


def curve_entries(faces: Mapping[str, str], *, pair: bool) -> list[Artist]:
    """Entries of the legend for all these panels."""
    axes: list[Artist] = [
        kit.mark(
            color=colour, marker=marker, lw=0.9, label=f"profiles along ${axis}$, model", **_POINTS
        )
        for axis, (colour, marker) in AXIS_STYLES.items()
    ]
    down: dict[str, Any] = {"ls": "none", "marker": "v", "color": RANGE}
    return [
        Patch(facecolor="0.9", label="profiles: the window"),
        *(kit.mark(color=FACE_COLOURS[face], lw=1, label=words) for face, words in faces.items()),
        *axes,
        kit.mark(color="0.3", ls=":", lw=0.8, label="self-affine line"),
        kit.mark(color="0.3", ls="--", lw=0.8, label="noise floor, if seen"),
        kit.mark(label="Gaussian of the same rms", **_GAUSSIAN),
        Patch(color=RANGE, alpha=0.13, lw=0, label="fractal range"),
        kit.mark(label="2 $s$ of a resolution", **down),
        kit.mark(label="hollow: below the range", mfc="white", **down),
        *([kit.mark(color="0.4", ls="-.", lw=0.7, label="half of the load")] if pair else []),
    ]
