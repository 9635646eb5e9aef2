"""History of the files of a specimen, in words."""

import json
from collections.abc import Sequence

import xarray as xr

from ..core.labels import printable
from ..core.limits import STEEP_TILT
from ..core.text import compact
from ..core.window import face_words, window_sides

#: Longest file name and note that a page shows whole; of longer ones it shows both ends.
MAX_NAME, MAX_NOTE = 60, 400


def history(specimen: xr.Dataset, faces: Sequence[str]) -> list[str]:
    """Paragraphs on the file of each face, and on the processing of both."""
    paragraphs = [_file_words(specimen, face) for face in faces]
    return [*paragraphs, _faces_words(specimen)]


def _file_words(specimen, face):
    """Name, reader, units, grid and every note of one face's file."""
    attrs = json.loads(specimen.attrs[f"{face}_scan"])
    spacing = " × ".join(f"{compact(specimen.attrs[f'spacing_{axis}'], 5)}" for axis in "xy")
    words = [
        f"{face_words(specimen, face).capitalize()}: {printable(attrs['source'], MAX_NAME)} "
        f"(SHA-256 {attrs['sha256'][:12]}…), "
        f"read by {attrs.get('reader', 'nothing stated')}, {attrs.get('layout', 'matrix')}, "
        f"unit {attrs.get('file_unit', 'mm')}; "
        f"{specimen.sizes['x']} × {specimen.sizes['y']} cells of {spacing} mm (x, y)"
    ]
    if "points" in attrs:
        words.append(
            f"{attrs['points']} points, {attrs.get('duplicated_points', 0)} of them repeated, "
            f"{compact(attrs.get('points_per_cell', float('nan')))} in a measured cell"
        )
    if attrs.get("levelled_degrees"):
        words.append(f"turned by {compact(attrs['levelled_degrees'])} degrees before gridding")
    overrides = attrs.get("overrides", "")
    words.append(f"the sidecar overrides: {overrides}" if overrides else "")
    words += [attrs.get("gridding", ""), attrs.get("notes", "")]
    return ". ".join(printable(_sentence(part), MAX_NOTE) for part in words if part) + "."


def _sentence(words):
    return words[0].upper() + words[1:]


def _faces_words(specimen):
    """Cleaning, registration, levelling and window."""
    attrs = specimen.attrs
    words = [attrs.get("cleaning", ""), _registration_words(attrs.get("registration"))]
    steep = f" (above {compact(STEEP_TILT, 6)} degrees heights are not normal to the plane)"
    words.append(f"Levelled: {attrs['levelling'].split('. NOTE')[0]}")
    words[-1] += steep if attrs["tilt_degrees"] > STEEP_TILT else ""
    sides = window_sides(specimen)
    note = f" ({attrs['window_note']})" if attrs["window_note"] else ""
    words.append(f"Window {compact(sides[1], 4)} × {compact(sides[0], 4)} mm (x, y){note}")
    return ". ".join(_sentence(part).rstrip(".") for part in words if part) + "."


def _registration_words(text):
    """Motion of the upper face and its effect on the gap, in words."""
    if not text:
        return ""
    motion = json.loads(text)
    gap = ", ".join(
        f"{name} {_known(motion[f'{key}_before{unit}'])} → {_known(motion[f'{key}_after{unit}'])}"
        for name, key, unit in (
            ("gap sd in mm", "gap_sd", "_mm"),
            ("mean", "gap_mean", "_mm"),
            ("correlation", "correlation", ""),
        )
    )
    gap += "".join(f"; {part}" for part in motion.get("note", "").split("; ") if "NOTE" in part)
    if not motion["applied"]:
        return f"Registration ({motion['mode']}): upper face not moved; {gap}"
    return (
        f"Registration ({motion['mode']}): upper face moved by "
        f"{compact(motion['shift_x_mm'], 4)} mm in x, "
        f"{compact(motion['shift_y_mm'], 4)} mm in y, turned by "
        f"{compact(motion['rotation_degrees'])} degrees, "
        f"tilted by {compact(motion['tilt_x_degrees'])} and "
        f"{compact(motion['tilt_y_degrees'])} degrees; {gap}"
    )


def _known(value):
    """A number before the faces had a common frame is not known."""
    return "unknown" if value is None else compact(value, 4)
