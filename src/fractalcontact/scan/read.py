"""Scan files of any kind as heights (y, x) in mm, with missing cells and provenance."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from ..core.directions import APERTURE
from ..core.errors import InputError
from ..core.file_names import split_file_name
from ..gridding.faces import grid_one, grid_pair
from ..gridding.outline import within_outline
from ..gridding.ungridded import UngriddedScan
from .confined import read_confined
from .draft import OPENING, draft_line
from .files import is_unchanged, regular_file, sha256
from .in_mm import ScanFile, in_mm
from .options import (
    FACES,
    PAIR_KEYS,
    ScanOptions,
    of_face,
    parse_options,
)
from .raw import IncompleteSidecar, RawScan

__all__ = ["faces_in_mm", "read_faces", "read_matrix", "read_scan", "scan_in_mm"]


def read_scan(path: Path | str, options: Mapping | None = None) -> xr.DataArray:
    """Read one scan file.

    Parameters
    ----------
    path : path-like
        A matrix, a point cloud, a mesh or an instrument's file; its extension says which.
    options : mapping, optional
        Keys of the sidecar, see :class:`scan.options.ScanOptions`. A file that does not describe
        itself is read only as they say; of any other they win over the file.

    Returns
    -------
    DataArray
        ``height`` (y, x) in mm, NaN where missing; x and y in mm, ascending, cell centres. A tilt
        is left in, but scattered points and meshes steeper than 5 degrees are turned level first.
        Of an aperture map its negative, not turned, without the cells outside its outline.

    Raises
    ------
    InputError
        If the file is damaged, does not describe itself and the options do not say all
        (:class:`scan.raw.IncompleteSidecar`), or cannot be the scan of a rough surface.
    """
    given = parse_options(options, str(path))
    scan = grid_one(in_mm(_read(Path(path), given), given))
    if given.kind != APERTURE:
        return scan
    # Cells outside an outline that is stated by their number are missing already.
    is_masked = isinstance(given.outline, dict) and "mask" in given.outline
    return within_outline(scan, None if is_masked else given.outline, f"sidecar of {path}")


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
        As for `read_scan`, for both faces, and under ``lower`` and ``upper`` for one of them; and
        ``registration`` (rigid, translation or none) and ``mirror_upper`` (x or y).

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
    if upper_path is None:
        given = parse_options(options, str(lower_path))
        for key in PAIR_KEYS:
            if getattr(given, key) is not None:
                raise InputError(
                    f"{lower_path}: key '{key}' is for two faces, and this scan has one; remove it"
                )
        return read_scan(lower_path, options), None
    lower, upper, given = faces_in_mm(lower_path, upper_path, options)
    return grid_pair(lower, upper, given.registration, given.mirror_upper)


def faces_in_mm(
    lower_path: Path | str, upper_path: Path | str, options: Mapping | None = None
) -> tuple[UngriddedScan, UngriddedScan, ScanOptions]:
    """Numbers of both files of a joint in mm, before they are on a grid, and the keys of the pair.

    Options and errors are those of `read_faces`, but for what :func:`gridding.faces.grid_pair`
    refuses.
    """
    paths = dict(zip(FACES, (Path(lower_path), Path(upper_path)), strict=True))
    stated = {f: parse_options(of_face(options, f), str(path)) for f, path in paths.items()}
    files = {face: _read(path, stated[face]) for face, path in paths.items()}
    _require_one_layout(files["lower"], files["upper"])
    lower, upper = (in_mm(files[face], stated[face]) for face in FACES)
    return lower, upper, stated["lower"]


def read_matrix(
    path: Path | str, options: Mapping | None = None
) -> tuple[np.ndarray, tuple[float, float], dict]:
    """Matrix of any quantity in a file, its spacing (dx, dy) in mm, and its provenance.

    Values (ny, nx) are multiplied by the length of ``unit_z`` in mm; NaN where missing, y
    ascending. Points are refused, and otherwise what `read_scan` refuses, but for numbers that
    cannot be heights.
    """
    scan = scan_in_mm(Path(path), options, are_heights=False)
    if scan.layout != "matrix":
        raise InputError(f"{path}: holds points, a matrix is needed; 'layout: matrix' if it is one")
    assert scan.spacing is not None  # a matrix has one
    return scan.values, scan.spacing, scan.provenance


def scan_in_mm(path: Path, options: Mapping | None, *, are_heights: bool = True) -> UngriddedScan:
    """Numbers of a file in mm, before they are on a grid, as its sidecar states.

    ``are_heights`` is False of a contact map, whose numbers may be anything. Errors are those of
    `read_scan`, but for a surface that is none.
    """
    given = parse_options(options, str(path))
    return in_mm(_read(path, given), given, are_heights=are_heights)


def _read(path: Path, options: ScanOptions) -> ScanFile:
    before = regular_file(path)
    raw = read_confined(path, options)
    checksum = sha256(path)
    if not is_unchanged(before, regular_file(path)):
        raise InputError(
            f"{path}: the file changed while it was read; wait until the copy or export has "
            "finished, then run again"
        )
    _refuse_unsaid_aperture(path, raw, options)
    return ScanFile(path, raw, checksum)


def _refuse_unsaid_aperture(path: Path, raw: RawScan, options: ScanOptions) -> None:
    """Refuse a file that describes itself, and by its name or variable not as a face."""
    if options.kind is None and (word := OPENING.search(" ".join((path.stem, *raw.notes)))):
        name, _ = split_file_name(path.name)
        raise IncompleteSidecar(
            f"{path}: its name or a variable contains {word[0]!r}, but no sidecar states its kind; "
            f"write into {path.with_name(f'{name}.yaml')} 'kind: face' or",
            draft_line("kind", APERTURE, "the opening between both faces"),
        )


def _require_one_layout(lower: ScanFile, upper: ScanFile) -> None:
    """Refuse a matrix and points as two faces, before their keys are checked."""
    if (lower.raw.layout == "matrix") != (upper.raw.layout == "matrix"):
        matrix, cloud = (lower, upper) if lower.raw.layout == "matrix" else (upper, lower)
        what = "a mesh" if cloud.raw.layout == "mesh" else "points x, y, z"
        raise InputError(
            f"{matrix.path} is a matrix of heights and {cloud.path} holds {what}; both faces need "
            f"one kind of file, so export {matrix.path.name} as points x, y, z too (or both as "
            "matrices of one spacing)"
        )
