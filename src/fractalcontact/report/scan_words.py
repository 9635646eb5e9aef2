"""Sentences on a specimen that was read: its gap, and what to check."""

import json
import re

import numpy as np
import xarray as xr

from ..core.directions import APERTURE
from ..core.limits import STEEP_TILT
from ..core.text import length_words, short
from ..roughness.quality_words import overlap_words
from ..scan.draft import OPENING

#: Least distance of outliers, in reliefs, that are hardly spikes of an instrument.
FAR_OUT = 3.0
#: Least correlation of two faces that lie as they did in the rock.
REGISTERED = 0.9
#: Largest motion by registration of faces that lie as they did in the rock, in its standard errors.
MAX_ERRORS = 3.0
_NO_FACE = re.compile(rf"{OPENING.pattern}|(?<![a-z])depth(?![a-z])", re.IGNORECASE)


def warnings_of_specimen(specimen: xr.Dataset, quality: xr.Dataset) -> list[str]:
    """Warnings to look at before a study is run."""
    attrs = specimen.attrs
    warnings = [quality.attrs["warning"]] if quality.attrs["warning"] else []
    if attrs.get("outlier_count") and attrs.get("outliers") == "keep":
        warnings.append(outlier_words(specimen))
    if attrs["tilt_degrees"] > STEEP_TILT:
        warnings.append(f"tilted by {short(attrs['tilt_degrees'])} degrees; heights stay vertical")
    warnings += filter(None, (_same_file_words(specimen), _moved_words(specimen)))
    name = str(attrs.get("specimen", attrs.get("name", "")))
    if attrs["opposite"] != APERTURE and _NO_FACE.search(name):
        warnings.append(
            "its name suggests the opening of a joint, or depths: if this is right, write 'kind: "
            "aperture', or 'heights: down', into the sidecar"
        )
    if "overlap_cells" in quality and quality["overlap_cells"].sel(region="window"):
        filled = attrs["outliers"] == "fill"
        remedy = "" if filled else "; 'outliers: fill' in the sidecar fills lone and deep ones"
        warnings.append(
            f"{overlap_words(specimen, quality)}: contact at zero offset rests on errors of the "
            f"scans{remedy}"
        )
    return warnings


def _same_file_words(specimen):
    """Warning of one file given as both faces."""
    files = [specimen.attrs.get(f"{face}_scan") for face in ("lower", "upper")]
    if None in files or len({json.loads(file)["sha256"] for file in files}) > 1:
        return ""
    return (
        "both faces are one file, byte for byte: the gap is the same everywhere; if only one face "
        "was scanned, keep one file; the other face is then its match"
    )


def _moved_words(specimen):
    """Warning of faces in one frame that registration moves by more than its own error."""
    if "registration" not in specimen.attrs or "registration_shift_x" not in specimen:
        return ""
    motion = json.loads(specimen.attrs["registration"])
    if not motion["applied"] or (motion["correlation_before"] or 0) < REGISTERED:
        return ""
    shift = np.hypot(motion["shift_x_mm"], motion["shift_y_mm"])
    error = np.hypot(*(float(specimen[f"registration_shift_{axis}"].std()) for axis in "xy"))
    if shift <= MAX_ERRORS * error:
        return ""
    return (
        f"the faces fit as scanned (correlation {short(motion['correlation_before'])}), and "
        f"registration moves the upper one by {length_words(shift)}, with an error of "
        f"{length_words(error)}: write 'registration: none' if the files share one frame"
    )


def outlier_words(specimen: xr.Dataset, treated: str = "kept") -> str:
    """Sentence on outliers of a specimen that has their heights: number, distance, likely cause.

    ``treated`` says what becomes of them.
    """
    # An atlas gives back numbers of numpy, and masks as whole numbers.
    count, cells = int(specimen.attrs["outlier_count"]), specimen["outlier"].values.astype(bool)
    heights = [specimen[face].values for face in ("lower", "upper") if face in specimen]
    highest = max(np.nanmax(abs(z[cells])) for z in heights)
    rest = np.concatenate([z[~cells & np.isfinite(z)] for z in heights])
    relief = np.ptp(rest)
    words = (
        f"{count} outlier{'s' * (count > 1)} {treated}, up to {length_words(highest)} from the "
        f"mean plane where the relief of all other cells is {length_words(relief)}; "
    )
    if highest > FAR_OUT * relief:
        words += (
            "so far out that they probably mark missing cells, or the file is misread: check it, "
            "and write 'missing' into the sidecar; "
        )
    return words + "'outliers: mask' in the sidecar makes them missing"


def gap_words(specimen: xr.Dataset) -> str:
    """Statistics of the gap, and whether the upper face was moved to the lower one."""
    gap = (specimen["upper"] - specimen["lower"]).values
    words = f"gap: mean {length_words(np.nanmean(gap))}, sd {length_words(np.nanstd(gap))}"
    if "registration" not in specimen.attrs:
        return words
    motion = json.loads(specimen.attrs["registration"])
    words += f"; registration ({motion['mode']}): {motion['note']}"
    if motion["applied"]:
        before = motion["gap_sd_before_mm"]
        spread = "unknown" if before is None else length_words(before)
        shift = ", ".join(short(motion[f"shift_{axis}_mm"]) for axis in "xy")
        words += f", shift {shift} mm (x, y), sd before {spread}"
    return words
