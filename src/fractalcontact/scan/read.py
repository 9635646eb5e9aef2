"""Scan files of any kind as heights (y, x) in mm, with missing cells and provenance."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from ..core.errors import InputError
from ..core.file_names import split_file_name
from ..core.units import length_factor
from .confined import read_confined
from .faces import grid_one, grid_pair
from .files import is_unchanged, regular_file, sha256
from .measured import Measured
from .options import (
    MATRIX_KEYS,
    PAIR_KEYS,
    POINT_KEYS,
    ScanOptions,
    length_mm,
    parse_options,
    spacing_mm,
)
from .plausible import check_spacing
from .points import single_precision_note
from .raw import RawScan

__all__ = ["read_faces", "read_matrix", "read_scan"]

LARGEST_NUMBER = 1e12  # mm; coordinates of a country's grid reach 1e10


def read_scan(path: Path | str, options: Mapping | None = None) -> xr.DataArray:
    """Read one scan file.

    Parameters
    ----------
    path : path-like
        A matrix, a point cloud, a mesh or an instrument's file; its extension says which.
    options : mapping, optional
        Keys of the sidecar: ``unit``, ``unit_xy``, ``unit_z``, ``spacing``, ``layout``,
        ``first_row``, ``variable``, ``columns``, ``missing``, ``grid``. They win over the file.

    Returns
    -------
    DataArray
        ``height`` (y, x) in mm, NaN where missing; x and y in mm, ascending, cell centres. A tilt
        is left in, but scattered points and meshes steeper than 5 degrees are turned level first.

    Raises
    ------
    InputError
        If the file is damaged, lacks a unit or spacing, or cannot be the scan of a rough surface.
    """
    return grid_one(_measure(Path(path), options))


def read_faces(
    lower_path: Path | str,
    upper_path: Path | str | None = None,
    options: Mapping | None = None,
) -> tuple[xr.DataArray, xr.DataArray | None]:
    """Read the faces of one joint onto one common grid, brought together.

    Points are gridded at the coarser of the two spacings, after one turn for both where they lie
    steeply; matrices must have the same spacing. The upper face is moved to where the gap is most
    even, see `pairs.register`, and both are cropped to the rectangle they cover.

    Parameters
    ----------
    lower_path : path-like
    upper_path : path-like or None
        None if one face was scanned.
    options : mapping, optional
        As for `read_scan`, for both faces; and ``registration`` (rigid, translation or none) and
        ``mirror_upper`` (x or y).

    Returns
    -------
    lower : DataArray
    upper : DataArray or None
        With the attribute ``registration``: what was done, as JSON.

    Raises
    ------
    InputError
        As `read_scan`; also if the two grids differ, a mirror image of the upper face matches
        instead of the face, or the faces share no area.
    """
    pair = parse_options(options, str(lower_path))
    if upper_path is None:
        for key in PAIR_KEYS:
            if getattr(pair, key) is not None:
                raise InputError(
                    f"{lower_path}: key '{key}' needs two faces, here is one; remove it"
                )
        return read_scan(lower_path, options), None
    lower, upper = (_measure(Path(path), options) for path in (lower_path, upper_path))
    return grid_pair(lower, upper, pair.registration or "rigid", pair.mirror_upper)


def read_matrix(
    path: Path | str, options: Mapping | None = None
) -> tuple[np.ndarray, tuple[float, float], dict]:
    """Read a file that holds a matrix, whatever its numbers mean.

    Parameters
    ----------
    path : path-like
    options : mapping, optional
        As for `read_scan`.

    Returns
    -------
    values : (ny, nx) ndarray
        Times the length of ``unit_z`` in mm; NaN where missing, y ascending.
    spacing : (float, float)
        (dx, dy) in mm.
    provenance : dict

    Raises
    ------
    InputError
        As `read_scan`, but for numbers that cannot be heights; also if the file holds points.
    """
    measured = _measure(Path(path), options)
    if measured.layout != "matrix":
        raise InputError(f"{path}: holds points, a matrix is needed; 'layout: matrix' if it is one")
    assert measured.spacing is not None  # a matrix has one
    return measured.values, measured.spacing, measured.provenance


def _measure(path: Path, options) -> Measured:
    """Read a file and convert it to mm, with what the sidecar says."""
    options = parse_options(options, str(path))
    before = regular_file(path)
    raw = read_confined(path, options)
    checksum = sha256(path)
    if not is_unchanged(before, regular_file(path)):
        raise InputError(
            f"{path}: the file changed while it was read; wait until the copy or export has "
            "finished, then run again"
        )
    _refuse_idle_keys(raw, options, path)
    overrides: list[str] = []
    notes = list(raw.notes)
    unit_xy = _choose_unit("unit_xy", raw.unit_xy, options, overrides)
    unit_z = _choose_unit("unit_z", raw.unit_z, options, overrides)
    _require_units(raw, options, unit_xy, unit_z, path)
    assert unit_z is not None
    missing = _choose("missing", raw.missing, options, overrides)
    if raw.layout == "matrix":
        values = _without_missing(raw.values, missing)
        values *= length_factor(unit_z, f"{path}: unit_z")
        if _choose("first_row", raw.first_row, options, overrides) == "top":
            values = values[::-1].copy()
        spacing = _choose_spacing(raw, options, unit_xy, path, overrides)
    else:
        if note := single_precision_note(raw.values):
            notes.append(note)
        assert unit_xy is not None  # points were required to have one
        values = _own(raw.values)
        values[:, 2] = _without_missing(raw.values[:, 2], missing)
        values[:, :2] *= length_factor(unit_xy, f"{path}: unit_xy")
        values[:, 2] *= length_factor(unit_z, f"{path}: unit_z")
        spacing = None
    _refuse_enormous(values, path)
    grid = options.grid
    if grid is not None:
        grid = length_mm(grid, unit_xy, f"{path}: key 'grid'")
    provenance = {
        "source": path.name,
        "sha256": checksum,
        "reader": raw.reader,
        "file_unit": unit_z if unit_xy in (None, unit_z) else f"x, y {unit_xy}; z {unit_z}",
        "layout": raw.layout,
        "notes": "; ".join(notes),
        "overrides": "; ".join(overrides),
    }
    return Measured(path, raw.layout, values, spacing, grid, provenance, raw.triangles)


def _own(values: np.ndarray) -> np.ndarray:
    """Numbers that were read, to be changed in place: nobody else has them."""
    return values if values.flags.writeable else values.copy()


def _refuse_enormous(values: np.ndarray, path: Path) -> None:
    """Numbers such as 1e300 are damage or an undeclared mark, and make arithmetic overflow."""
    finite = np.isfinite(values)
    low, high = values.min(where=finite, initial=np.inf), values.max(where=finite, initial=-np.inf)
    largest = max(low, high, key=abs) if finite.any() else 0.0
    if abs(largest) > LARGEST_NUMBER:
        raise InputError(
            f"{path}: it holds {largest:g} mm, which no instrument measures; if that marks missing "
            "cells, say so in the sidecar ('missing: -9999', in the file's own unit), else export "
            "the file again"
        )


def _refuse_idle_keys(raw: RawScan, options: ScanOptions, path: Path) -> None:
    """A key that would change nothing was meant to change something."""
    idle = POINT_KEYS if raw.layout == "matrix" else MATRIX_KEYS
    for key in idle:
        if getattr(options, key) is not None:
            hint = "'grid'" if key == "spacing" else "'spacing'" if key == "grid" else "'layout'"
            raise InputError(
                f"{path}: key '{key}' has no meaning for a scan read as {raw.layout}; "
                f"remove it (did you mean {hint}?)"
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


def _require_units(raw: RawScan, options: ScanOptions, unit_xy, unit_z, path: Path) -> None:
    """Ask for everything the file lacks in one message, ready to be copied."""
    stated_spacing = options.spacing if options.spacing is not None else raw.spacing
    lacks_spacing = raw.layout == "matrix" and stated_spacing is None
    needs_unit_xy = raw.layout != "matrix" or (
        not lacks_spacing and not _has_units_of_its_own(options.spacing)
    )
    lacks_unit = unit_z is None or (needs_unit_xy and unit_xy is None)
    if not (lacks_unit or lacks_spacing):
        return
    what = " and ".join(
        word for word, lacks in (("unit", lacks_unit), ("spacing", lacks_spacing)) if lacks
    )
    lines = []
    if lacks_unit:
        lines.append("    unit: mm          # of its lengths; unit_xy and unit_z where they differ")
    if lacks_spacing:
        lines.append("    spacing: 0.1 mm   # between neighbouring cells")
    name, _ = split_file_name(path.name)
    raise InputError(
        f"{path}: the file states no {what}. Write into {path.with_name(name + '.yaml')}, "
        "with your own values:\n" + "\n".join(lines)
    )


def _has_units_of_its_own(spacing) -> bool:
    """Whether a spacing, or each of a pair, is a text such as "0.1 mm"."""
    pair = spacing if isinstance(spacing, tuple) else (spacing,)
    return all(isinstance(step, str) for step in pair)


def _choose_spacing(raw, options, unit_xy, path: Path, overrides: list) -> tuple[float, float]:
    """The sidecar's spacing, else the file's, in mm; recorded where they differ."""
    stated = None
    if raw.spacing is not None and unit_xy is not None:
        factor = length_factor(unit_xy, f"{path}: unit_xy")
        stated = factor * raw.spacing[0], factor * raw.spacing[1]
    if options.spacing is not None:
        spacing = spacing_mm(options.spacing, unit_xy, f"{path}: key 'spacing'")
        check_spacing(spacing, path)
        if stated and not np.allclose(spacing, stated, rtol=1e-6, atol=0):
            overrides.append(
                f"spacing {spacing[0]:.6g} x {spacing[1]:.6g} mm from the sidecar, the file says "
                f"{stated[0]:.6g} x {stated[1]:.6g} mm"
            )
        return spacing
    assert stated is not None  # it was required, with its unit
    check_spacing(stated, path)
    return stated


def _without_missing(values: np.ndarray, missing: float | None) -> np.ndarray:
    """A copy, in file units, with the missing number and infinities as NaN."""
    absent = ~np.isfinite(values)
    if missing is not None:
        # Markers such as 3.4e38 come back from text and float32 not quite the same.
        absent |= np.isclose(values, missing, rtol=1e-6, atol=0)
    return np.where(absent, np.nan, values)
