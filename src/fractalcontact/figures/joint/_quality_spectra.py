"""Spectra of the quality sheet: profiles and radial ones, floors, fractal range."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Patch

from ..kit.axes import label_short_span
from ..kit.drawing import COLOURS
from ..kit.empty import say_empty
from ..kit.legends import mark
from ._quality_panels import FACE_COLOURS, GAUSSIAN

#: Colours of the fractal range, and of profiles along each axis.
RANGE = COLOURS[3]
AXIS_COLOURS = {"x": COLOURS[6], "y": COLOURS[5]}


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


def spectrum_entries(quality: xr.Dataset, faces: Mapping[str, str]) -> list[Artist]:
    """Entries of the legend for the lower panels."""
    entries: list[Artist] = [
        mark(color=FACE_COLOURS[face], lw=1, label=words) for face, words in faces.items()
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
