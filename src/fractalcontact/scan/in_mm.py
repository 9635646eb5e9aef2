"""Numbers of a file converted to mm by its sidecar; checks of `confirmed`."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.directions import APERTURE
from ..core.errors import InputError
from ..core.file_names import split_file_name
from ..core.units import length_factor
from ..gridding.plausible import check_spacing
from ..gridding.points import refuse_one_place, single_precision_note
from ..gridding.ungridded import NOTE, UngriddedScan, warnings_of
from .draft import draft_line
from .options import (
    MATRIX_KEYS,
    NO_MARK,
    POINT_KEYS,
    ScanOptions,
    has_own_units,
    length_mm,
    spacing_mm,
)
from .raw import IncompleteSidecar, RawScan
from .undeclared import refuse_or_warn

#: Largest relative difference from a confirmed relief, which is written with four digits.
SAME_RELIEF = 2e-3
LARGEST_NUMBER = 1e12  # mm; coordinates of a country's grid reach 1e10


class ScanFile(NamedTuple):
    """Path, content in its own units, and checksum of a file."""

    path: Path
    raw: RawScan
    checksum: str


def in_mm(file: ScanFile, options: ScanOptions, *, are_heights: bool = True) -> UngriddedScan:
    """Content of a file converted to mm, with the keys of the sidecar."""
    path, raw = file.path, file.raw
    _refuse_idle_keys(raw, options, path)
    _refuse_known_rows(raw, options, path)
    overrides: list[str] = []
    notes = list(raw.notes)
    _refuse_one_unit_for_two(raw, options, path)
    unit_xy = _choose_unit("unit_xy", raw.unit_xy, options, overrides)
    unit_z = _choose_unit("unit_z", raw.unit_z, options, overrides)
    _require_units(raw, options, unit_xy, unit_z, path)
    assert unit_z is not None
    missing = options.missing
    is_matrix = raw.layout == "matrix"
    heights = _without_missing(raw.values if is_matrix else raw.values[:, 2], options.marks)
    is_aperture = options.kind == APERTURE
    size = size_and_relief(heights, raw.layout)
    _refuse_unconfirmed(size, raw, options, path)
    # Zeros of an aperture map are contact, however many there are.
    judged = heights[heights != 0] if is_aperture else heights
    judges = are_heights and missing != NO_MARK
    if judges and (doubt := refuse_or_warn(judged, path, raw.triangles)):
        notes.append(f"{NOTE}{doubt}")
    down = _choose("heights", raw.heights, options, overrides) == "down"
    sign = -1 if down or is_aperture else 1
    heights *= sign * length_factor(unit_z, f"{path}: unit_z")
    if is_matrix:
        values = heights
        if _choose("first_row", raw.first_row, options, overrides) == "top":
            values = values[::-1].copy()
        spacing = _choose_spacing(raw, options, unit_xy, path, overrides)
    else:
        refuse_one_place(raw.values, path)
        if note := single_precision_note(raw.values):
            notes.append(note)
        assert unit_xy is not None  # points were required to have one
        values = np.require(raw.values, requirements="W")  # changed in place: not shared
        values[:, 2] = heights
        values[:, :2] *= length_factor(unit_xy, f"{path}: unit_xy")
        spacing = None
    _refuse_enormous(values, path)
    notes += [f"{NOTE}{override}" for override in overrides]
    grid = options.grid
    if grid is not None:
        grid = length_mm(grid, unit_xy, f"{path}: key 'grid'")
    provenance = {
        "source": path.name,
        "sha256": file.checksum,
        "reader": raw.reader,
        "file_unit": unit_z if unit_xy in (None, unit_z) else f"x, y {unit_xy}; z {unit_z}",
        "layout": raw.layout,
        "notes": "; ".join(notes),
        "warnings": warnings_of(notes),
        "overrides": "; ".join(overrides),
    }
    return UngriddedScan(
        path, raw.layout, values, spacing, grid, provenance, raw.triangles, not is_aperture, size
    )


def _refuse_enormous(values: np.ndarray, path: Path) -> None:
    """Refuse numbers such as 1e300, which are damage or an undeclared mark and make arithmetic
    overflow.
    """
    finite = np.isfinite(values)
    low, high = values.min(where=finite, initial=np.inf), values.max(where=finite, initial=-np.inf)
    largest = max(low, high, key=abs) if finite.any() else 0.0
    if abs(largest) > LARGEST_NUMBER:
        raise InputError(
            f"{path}: it holds {largest:g} mm, which no instrument measures; if this number marks "
            "missing cells, write it into the sidecar ('missing: -9999', in the file's own unit), "
            "else export the file again"
        )


def _refuse_idle_keys(raw: RawScan, options: ScanOptions, path: Path) -> None:
    """Refuse a key that would change nothing: it was meant to change something."""
    idle = POINT_KEYS if raw.layout == "matrix" else MATRIX_KEYS
    for key in idle:
        is_by_cell = key == "columns" and options.layout == "points"
        if getattr(options, key) is not None and not is_by_cell:
            hint = "'grid'" if key == "spacing" else "'spacing'" if key == "grid" else "'layout'"
            raise InputError(
                f"{path}: key '{key}' has no meaning for a scan read as {raw.layout}; "
                f"remove it (did you mean {hint}?)"
            )


def _refuse_known_rows(raw: RawScan, options: ScanOptions, path: Path) -> None:
    """Refuse ``first_row`` where the coordinates of a matrix determine it."""
    if options.axes == "both" and options.spacing is None and options.first_row is not None:
        raise InputError(
            f"{path}: its coordinates determine where the first row lies ({raw.first_row}); "
            "remove 'first_row'"
        )


def _choose(key: str, stated, options: ScanOptions, overrides: list):
    """The sidecar's value, else the file's; recorded where they differ."""
    given = getattr(options, key)
    if given is None:
        return stated
    if stated is not None and given != stated:
        overrides.append(f"{key} {given} from the sidecar, the file says {stated}")
    return given


def _choose_unit(key: str, stated: str | None, options: ScanOptions, overrides: list) -> str | None:
    """The sidecar's unit, else the file's; recorded where they differ."""
    given = getattr(options, key) or options.unit
    if given and stated and length_factor(given, key) != length_factor(stated, key):
        overrides.append(f"{key} {given} from the sidecar, the file says {stated}")
    return given or stated


def _refuse_one_unit_for_two(raw: RawScan, options: ScanOptions, path: Path) -> None:
    """Refuse ``unit`` where the file gives x and y a unit that heights do not share.

    Its owner most likely means the unit of the heights, and the key would change the spacing as
    well.
    """
    if options.unit is None or raw.unit_xy is None or (options.unit_xy and options.unit_z):
        return
    lateral = length_factor(raw.unit_xy, f"{path}: unit_xy")
    if raw.unit_z is not None and length_factor(raw.unit_z, f"{path}: unit_z") == lateral:
        return
    given = length_factor(options.unit, f"{path}: unit")
    of_spacing = raw.layout != "matrix" or (raw.spacing is not None and options.spacing is None)
    if options.unit_xy is None and of_spacing and not math.isclose(given, lateral):
        heights = f"heights in {raw.unit_z}" if raw.unit_z else "no unit of heights"
        raise InputError(
            f"{path}: the file has x and y in {raw.unit_xy} and {heights}, but its sidecar states "
            f"'unit: {options.unit}' for all; write 'unit_z: {options.unit}' if you meant the "
            f"heights, or 'unit_xy: {options.unit}' if the file is wrong"
        )


def _require_units(raw: RawScan, options: ScanOptions, unit_xy, unit_z, path: Path) -> None:
    """Request all missing keys in one message, ready to be copied."""
    stated_spacing = options.spacing if options.spacing is not None else raw.spacing
    lacks_spacing = raw.layout == "matrix" and stated_spacing is None
    needs_unit_xy = raw.layout != "matrix" or (
        not lacks_spacing and not has_own_units(options.spacing)
    )
    lacks = []
    if unit_z is None:
        lacks.append("unit" if unit_xy is None else "unit_z")
    elif needs_unit_xy and unit_xy is None:
        lacks.append("unit_xy")
    if lacks_spacing:
        lacks.append("spacing")
    if lacks:
        name, _ = split_file_name(path.name)
        raise IncompleteSidecar(
            f"{path}: the file states no {' and '.join(lacks)}. Write into "
            f"{path.with_name(name + '.yaml')}, with your own values:",
            "\n".join(f"    {draft_line(key, None)}" for key in lacks),
        )


def _choose_spacing(raw, options, unit_xy, path: Path, overrides: list) -> tuple[float, float]:
    """The sidecar's spacing, else the file's, in mm; recorded where they differ."""
    stated = None
    if raw.spacing is not None and unit_xy is not None:
        factor = length_factor(unit_xy, f"{path}: unit_xy")
        stated = factor * raw.spacing[0], factor * raw.spacing[1]
    spacing = stated
    if options.spacing is not None:
        spacing = spacing_mm(options.spacing, unit_xy, f"{path}: key 'spacing'")
    assert spacing is not None  # it was required, with its unit
    check_spacing(spacing, path)
    if stated and not np.allclose(spacing, stated, rtol=1e-6, atol=0):
        overrides.append(
            f"spacing {spacing[0]:.6g} x {spacing[1]:.6g} mm from the sidecar, the file says "
            f"{stated[0]:.6g} x {stated[1]:.6g} mm"
        )
    return spacing


def _without_missing(values: np.ndarray, marks: tuple[float, ...]) -> np.ndarray:
    """A copy, in file units, with the missing numbers and infinities as NaN."""
    absent = ~np.isfinite(values)
    for mark in marks:
        # Text and float32 change the last digits of markers such as 3.4e38.
        absent |= np.isclose(values, mark, rtol=1e-6, atol=0)
    return np.where(absent, np.nan, values)


def _refuse_unconfirmed(size: dict, raw: RawScan, options: ScanOptions, path: Path) -> None:
    """Refuse a file of another size or relief than its owner has looked at and confirmed."""
    if options.confirmed is None:
        return
    for key, value in options.confirmed.items():
        if key not in size:
            raise InputError(
                f"{path}: its sidecar confirms {key!r}, but it is read as {raw.layout} with "
                f"{', '.join(size)}; run 'make describe FILE={path}' and confirm that"
            )
        if not np.allclose(value, size[key], rtol=SAME_RELIEF, atol=0):
            raise InputError(
                f"{path}: its sidecar confirms {key} {_plain(value)}, the file holds "
                f"{_plain(size[key])}: this is another file, or its sidecar was changed; 'make "
                f"describe FILE={path}' draws it, then write '{key}: {_plain(size[key])}' under "
                "'confirmed'"
            )


def size_and_relief(heights: np.ndarray, layout: str) -> dict:
    """Properties of a file for ``confirmed``: ``shape`` or ``points``, and ``relief``.

    The relief is the highest less the lowest number of the file; NaN are missing.
    """
    size = {"shape": heights.shape} if layout == "matrix" else {"points": len(heights)}
    if not np.isfinite(heights).any():
        return size
    return size | {"relief": float(f"{np.nanmax(heights) - np.nanmin(heights):.4g}")}


def _plain(value) -> str:
    return f"[{', '.join(map(str, value))}]" if isinstance(value, tuple | list) else f"{value:g}"
