"""Quality of a scan in sentences: noise floor, filter, roll-off, steps."""

import json
import math

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.text import height_unit, length_words, percent, plain
from .fractal_range import NO_POWER_LAW
from .spectra import STRIPS

AXES = ("x", "y")
#: Least ratio of the noise along one axis to that along the other of noise in the scan's lines.
UNEQUAL = 2.0
#: Least exponent 1 + 2H known of rock; below it spikes and noise look alike.
FLATTEST = 1.5


def interval_words(values: xr.Dataset, name: str, unit: str | None = None) -> str:
    """Scalar length with its 95 % interval, if any: three digits, in mm or a suitable unit."""
    value, low, high = Estimate.read(values, name).ends
    unit, size = (unit, 1.0) if unit == "mm" else height_unit(value)
    interval = f" [{plain(low / size)}, {plain(high / size)}]" if math.isfinite(low) else ""
    return f"{plain(value / size)}{interval} {unit}"


def noise_words(quality: xr.Dataset, face: str) -> str:
    """Sentence on the noise floor of a face, "lower" or "upper", with its possible origin."""
    of_face = quality.sel(face=face)
    if not any(of_face["form"].values):
        return "too small for a spectrum, so its noise is unknown"
    along = [_noise_along(axis, of_face.sel(axis=axis)) for axis in AXES]
    words = f"noise floor {', '.join(along)}"
    rms, limit = of_face["noise_rms"].values, of_face["noise_limit"].values
    for axis, own, other in zip(AXES, rms, np.fmin(rms, limit)[::-1], strict=True):
        if own > UNEQUAL * other:
            across = AXES[1 - AXES.index(axis)]
            words += f"; more along {axis}: scan lines along {across} are shifted in height"
    return words


def _noise_along(axis, of_axis) -> str:
    """Noise along one axis, in words."""
    if of_axis["noise_rms"].notnull():
        return f"{interval_words(of_axis, 'noise_rms')} rms along {axis}"
    limit = f"(at most {length_words(of_axis['noise_limit'].item())})"
    if of_axis["misfit"] > math.log(NO_POWER_LAW):
        factor = math.exp(of_axis["misfit"].item())
        return (
            f"undetermined along {axis} {limit}, where the spectrum is no power law: off the "
            f"model by a factor {factor:.2g}"
        )
    return f"none seen along {axis} {limit}"


def range_words(quality: xr.Dataset, face: str) -> str:
    """Sentence on filter, roll-off, steps and misfit of a face; "" without any."""
    of_face = quality.sel(face=face)
    words = []
    for axis in AXES:
        of_axis = of_face.sel(axis=axis)
        if np.isfinite(of_axis["filter_wavelength"]):
            words.append(
                f"low-pass filtered along {axis}, halved at a wavelength of "
                f"{interval_words(of_axis, 'filter_wavelength', 'mm')}"
            )
        if np.isfinite(of_axis["roll_off_wavelength"]):
            words.append(
                f"rolls off along {axis} at {interval_words(of_axis, 'roll_off_wavelength', 'mm')}"
            )
        if of_axis["line_exponent"] < FLATTEST and np.isnan(of_axis["noise_rms"]):
            words.append(f"spectrum along {axis} so flat that noise and relief cannot be separated")
        if of_axis["strips_left_out"] >= 0.5:
            words.append(
                f"{of_axis['strips_left_out']:.0f} of {STRIPS} strips of profiles along {axis} "
                "left out of the spectrum for spikes or steps"
            )
    step = of_face["height_step"].item()
    if math.isfinite(step):
        words.append(
            f"heights are multiples of {length_words(step)}, which alone adds "
            f"{length_words(step / math.sqrt(12))} rms of noise"
        )
    return "; ".join(words)


def file_warnings(specimen: xr.Dataset) -> list[str]:
    """Warnings from reading the files of a specimen, a sentence each."""
    sentences = []
    for face in ("lower", "upper"):
        attrs = json.loads(specimen.attrs.get(f"{face}_scan", "{}"))
        sentences += [
            f"{attrs['source']}: {words}"
            for words in attrs.get("warnings", "").split("\n")
            if words
        ]
    note = json.loads(specimen.attrs.get("registration", "{}")).get("note", "")
    return sentences + [part.removesuffix("; ") for part in note.split("NOTE: ")[1:] if part]


def suspect_words(specimen: xr.Dataset) -> str:
    """Counts of lone spikes and of cells far from any point; "" without any."""
    counts = {
        "lone spikes": int(specimen["spike"].sum()) if "spike" in specimen else 0,
        "cells far from any point": int(specimen["sparse"].sum()) if "sparse" in specimen else 0,
    }
    return ", ".join(f"{count} {what}" for what, count in counts.items() if count)


def overlap_words(specimen: xr.Dataset, quality: xr.Dataset) -> str:
    """Clause on the overlap of two faces as scanned; "" for one face."""
    if "overlap_cells" not in quality:
        return ""
    record = json.loads(specimen.attrs.get("registration", "{}"))
    if record.get("gap_mean_before_mm", 0.0) is None:
        return "overlap is unknown, as the height of the upper face was not measured"
    window, scan = (quality.sel(region=region) for region in ("window", "scan"))
    elsewhere = f"{int(scan['overlap_cells'])} in the whole scan"
    if not window["overlap_cells"]:
        return f"the faces overlap in no cell of the window ({elsewhere})"
    count = int(window["overlap_cells"])
    return (
        f"the faces overlap as scanned in {count} cell{'s' * (count > 1)} of the window "
        f"({percent(float(window['overlap_fraction']))}, up to "
        f"{length_words(float(window['overlap_depth']))} deep; {elsewhere})"
    )


def cells_words(specimen: xr.Dataset, quality: xr.Dataset) -> str:
    """Clause on cells missing, outlying, filled and suspicious."""
    missing = [f"{plain(100 * share, 2)} %" for share in quality["missing_share"].values]
    which = " (lower and upper face)" if len(missing) > 1 else ""
    words = [f"{' and '.join(missing)} of the cells have no height{which}"]
    if not quality["missing_share"].values.any():
        words = ["every cell has a height"]
    if outliers := specimen.attrs.get("outlier_count"):
        treated = {"keep": "kept", "mask": "masked", "fill": "filled"}
        how = treated.get(str(specimen.attrs.get("outliers")), "")
        words.append(f"{outliers} outlier{'s' * (outliers > 1)} {how}".rstrip())
    elif outliers is not None:
        words.append("no outlier")
    if filled := specimen.attrs.get("filled_count"):
        words.append(f"{filled} cells filled")
    return ", ".join(filter(None, [*words, suspect_words(specimen)]))


def statements(specimen: xr.Dataset, quality: xr.Dataset) -> dict[str, str]:
    """Clauses on a scan by name, as attributes of the stage ``quality``.

    ``lower_face`` and, if there is one, ``upper_face``: noise floor and other features of the
    spectra; ``cells``; ``overlap``, empty of one face.
    """
    of_faces = {
        f"{face}_face": "; ".join(
            filter(None, (noise_words(quality, face), range_words(quality, face)))
        )
        for face in quality["face"].values
    }
    cells, overlap = cells_words(specimen, quality), overlap_words(specimen, quality)
    return of_faces | {"cells": cells, "overlap": overlap}
