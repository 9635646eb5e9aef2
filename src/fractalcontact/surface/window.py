"""Placement of the window of a specimen: hole-free, central, with room to slide."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import ndimage

from ..core.directions import DIRECTIONS, axis_and_sign, slides
from ..core.errors import InputError
from ..core.limits import SMALLEST_SIDE
from ..core.text import percent
from ..core.window import spacing_of, window_fraction

#: Fraction of a cell within which a side given in mm holds a whole number of cells.
_ROUNDING = 1e-6
#: Percent of the holes that the proposed key fills.
_MOST_HOLES = 99.9

#: One number for both axes, or a pair (y, x); mm.
Length = float | tuple[float, float]


@dataclass(frozen=True)
class WindowRequest:
    """Size and place that a study asks for its window."""

    window: Length | None = None
    """Side in mm, or sides (y, x). None: half the largest hole-free square, in its middle, so that
    it can slide by a quarter of that square; the whole square against a plane."""
    window_centre: tuple[float, float] | None = None
    """(y, x) in mm; by default the middle of the scan. A window that meets a hole there moves to
    the nearest hole-free place; without a given centre also where it could not slide by `reach`."""
    multiple: int = 1
    """Cells along each side are rounded down to a multiple of it, so that keeping every k-th node
    covers the same area for every k that divides it."""
    reach: float | Mapping[str, float] = 0.0
    """Offset in mm the lower window should be able to slide, in all directions or by direction."""


class _Wanted(NamedTuple):
    """Requested window before rounding and placement; lengths in cells, (y, x)."""

    cells: tuple[int, ...]
    sides: tuple[float, ...]
    """Sides of the window, mm."""
    middle: tuple[float, ...]
    reach: float | Mapping[str, float]


def place_window(specimen: xr.Dataset, request: WindowRequest) -> dict:
    """Size and place of a window in whole cells, hole-free, where it can slide.

    Returned are the attributes ``window_y0``, ``window_x0``, ``window_ny``, ``window_nx``,
    ``window_mm`` and ``window_note``. A window without a place is refused.
    """
    name, multiple = specimen.attrs["name"], request.multiple
    if not (isinstance(multiple, int) and multiple >= 1):
        raise InputError(f"{name}: 'multiple' is {multiple!r}; expected a whole number from 1")
    spacing = spacing_of(specimen)
    automatic = request.window is None
    wanted = _half_of_largest_square(specimen) if automatic else _stated(specimen, request)
    if request.window_centre is not None:
        middle = _in_cells(specimen, _pair(request.window_centre, name, "window_centre"))
        wanted = wanted._replace(middle=middle)
        _require_inside(specimen, request.window_centre, middle)
    shape = tuple(n // multiple * multiple for n in wanted.cells)
    _require_room(specimen, wanted, shape, multiple)
    if automatic and min(shape) < SMALLEST_SIDE and (holes := _hole_words(specimen)):
        raise InputError(
            f"{name}: holes leave a window of {shape[1]} x {shape[0]} cells (x, y), where at least "
            f"{SMALLEST_SIDE} x {SMALLEST_SIDE} hold any roughness{holes}"
        )
    corner, place_note = _find_place(specimen, shape, wanted, request.window_centre is not None)
    notes = [place_note] if place_note else []
    if automatic and slides(specimen.attrs["opposite"]):
        share = _share(specimen, shape)
        notes.append(f"{share} of the face, so that it can slide{_larger(specimen, shape)}")
    elif automatic:
        notes.append(f"the largest square without holes, {_share(specimen, shape)} of the face")
    if shape != wanted.cells:
        notes.append(
            f"cut from {wanted.cells[1]} x {wanted.cells[0]} to {shape[1]} x {shape[0]} cells, so "
            f"that the largest of 'resolutions' ({multiple}) divides them"
        )
    return {
        "window_y0": corner[0],
        "window_x0": corner[1],
        "window_ny": shape[0],
        "window_nx": shape[1],
        "window_mm": [n * s for n, s in zip(shape, spacing, strict=True)],
        "window_note": "; ".join(notes),
    }


def _half_of_largest_square(specimen) -> _Wanted:
    """Half the largest hole-free square, about its middle; all of it against a plane."""
    valid, spacing = specimen["valid"].values, spacing_of(specimen)
    square = _largest_square(valid, spacing)
    corner = _nearest(_free_places(valid, square), square, _middle(valid.shape), spacing)
    middle = tuple(c + (n - 1) / 2 for c, n in zip(corner, square, strict=True))
    part = 2 if slides(specimen.attrs["opposite"]) else 1
    cells = tuple(n // part for n in square)
    sides = tuple(n * s for n, s in zip(cells, spacing, strict=True))
    return _Wanted(cells, sides, middle, 0.0)  # the outer quarter of the square lies all around


def _larger(specimen: xr.Dataset, shape: tuple[int, ...]) -> str:
    """Clause with the key of a window that uses more of the face and slides less.

    Half of the largest square without holes is the window: of one half as large again an eighth of
    that square is left to slide by.
    """
    half = min(n * s for n, s in zip(shape, spacing_of(specimen), strict=True))
    side = float(f"{1.5 * half:.2g}")
    cells = [int(side / s) for s in spacing_of(specimen)]
    return (
        f"; 'window: {side:.6g} mm' uses {_share(specimen, tuple(cells))} and slides by up to "
        f"{half - side / 2:.2g} mm"
    )


def _share(specimen: xr.Dataset, shape: tuple[int, ...]) -> str:
    """Fraction of the measured cells of the face that a window takes, in words."""
    return percent(window_fraction(specimen, shape))


def _stated(specimen, request) -> _Wanted:
    """The window of the sides that the study states, about the middle of the scan."""
    sides = _pair(request.window, specimen.attrs["name"], "window")
    if not all(math.isfinite(side) and side > 0 for side in sides):
        raise InputError(
            f"{specimen.attrs['name']}: key 'window' is {request.window!r}; expected a length "
            "above zero"
        )
    cells = tuple(
        math.floor(side / s + _ROUNDING)
        for side, s in zip(sides, spacing_of(specimen), strict=True)
    )
    return _Wanted(cells, sides, _middle(specimen["valid"].shape), request.reach)


def _middle(shape) -> tuple[float, ...]:
    """Middle of a grid, in cells."""
    return tuple((n - 1) / 2 for n in shape)


def _in_cells(specimen, place) -> tuple[float, ...]:
    """A place (y, x) in mm, in cells from the first one."""
    starts = (float(specimen.y[0]), float(specimen.x[0]))
    spacing = spacing_of(specimen)
    return tuple((c - start) / s for c, start, s in zip(place, starts, spacing, strict=True))


def _require_inside(specimen, centre, middle) -> None:
    """Refuse a middle of the window that lies beside the scan."""
    shape = specimen["valid"].shape
    if all(-0.5 <= m <= n - 0.5 for m, n in zip(middle, shape, strict=True)):
        return
    y, x = specimen.y.values, specimen.x.values
    y_0, x_0 = _pair(centre, specimen.attrs["name"], "window_centre")
    raise InputError(
        f"{specimen.attrs['name']}: key 'window_centre' is x = {x_0:g}, y = {y_0:g} mm, outside "
        f"the scan, which covers x = {x[0]:.4g} to {x[-1]:.4g} and y = {y[0]:.4g} to {y[-1]:.4g} "
        "mm; write a point inside it"
    )


def _require_room(specimen, wanted: _Wanted, shape, multiple) -> None:
    """Refuse a window that is larger than the scan, or smaller than the resolutions need."""
    name, total = specimen.attrs["name"], specimen["valid"].shape
    sides, cells = wanted.sides, wanted.cells
    if any(n > limit for n, limit in zip(shape, total, strict=True)):
        extent = [n * s for n, s in zip(total, spacing_of(specimen), strict=True)]
        raise InputError(
            f"{name}: key 'window' asks for {sides[1]:.4g} x {sides[0]:.4g} mm (x, y), the scan "
            f"covers {extent[1]:.4g} x {extent[0]:.4g} mm; write at most "
            f"'window: {_rounded_down(min(extent)):.6g} mm'"
        )
    if min(shape) < 1:
        raise InputError(
            f"{name}: a window of {sides[1]:.4g} x {sides[0]:.4g} mm holds {cells[1]} x {cells[0]} "
            f"cells (x, y), fewer than the multiple of {multiple} that the resolutions need; write "
            f"a larger 'window' or fewer resolutions{_hole_words(specimen)}"
        )


def _find_place(specimen, shape, wanted: _Wanted, centre_given: bool):
    """First cell of the window, and a note if it is not where it was wanted."""
    valid, spacing = specimen["valid"].values, spacing_of(specimen)
    free = _free_places(valid, shape)
    if not free.any():
        raise _no_place(specimen, shape)
    asked = tuple(
        math.floor(m - (n - 1) / 2 + 0.5) for m, n in zip(wanted.middle, shape, strict=True)
    )
    first = tuple(
        min(max(start, 0), total - n)
        for start, n, total in zip(asked, shape, valid.shape, strict=True)
    )
    sliding = free & _reachable_places(specimen, shape, wanted.reach)
    if free[first] and (centre_given or sliding[first] or not sliding.any()):
        corner, why = first, "the edge of the scan"
    else:
        corner = _nearest(sliding if sliding.any() else free, shape, wanted.middle, spacing)
        why = "a hole" if not free[first] else "the offsets asked for"
    if not centre_given:
        asked = first  # half a cell of rounding is no move
    if corner == asked:
        return corner, ""
    moved = [(c - w) * s for c, w, s in zip(corner, asked, spacing, strict=True)]
    return (
        corner,
        f"window moved by {moved[1]:.4g} mm in x, {moved[0]:.4g} mm in y because of {why}",
    )


def _reachable_places(specimen, shape, reach) -> np.ndarray:
    """Places from which the lower window can slide by ``reach`` without meeting a hole."""
    spacing = spacing_of(specimen)
    present = np.isfinite(specimen["lower"].values)
    places = np.ones([total - n + 1 for total, n in zip(present.shape, shape, strict=True)], bool)
    if not slides(specimen.attrs["opposite"]):
        return places
    reaches = reach if isinstance(reach, Mapping) else dict.fromkeys(DIRECTIONS, reach)
    for direction, distance in reaches.items():
        axis_name, sign = axis_and_sign(direction)
        axis = "yx".index(axis_name)
        cells = math.ceil(distance / spacing[axis] - _ROUNDING)
        if cells >= places.shape[axis]:
            return np.zeros_like(places)
        swept = list(shape)
        swept[axis] += cells
        free = _free_places(present, swept)
        # The swept rectangle starts at the window, or ends with it.
        padding = [(0, 0), (0, 0)]
        padding[axis] = (0, cells) if sign > 0 else (cells, 0)
        places &= np.pad(free, padding)
    return places


def _free_places(valid: np.ndarray, shape) -> np.ndarray:
    """True at [y, x] where the rectangle of ``shape`` that starts there has no hole."""
    ny, nx = shape
    if valid.all():  # sums over a large scan are asked for a dozen times
        return np.ones((valid.shape[0] - ny + 1, valid.shape[1] - nx + 1), dtype=bool)
    holes = np.zeros([n + 1 for n in valid.shape], dtype=np.int64)
    np.cumsum(np.cumsum(~valid, axis=0), axis=1, out=holes[1:, 1:])
    return (holes[ny:, nx:] - holes[:-ny, nx:] - holes[ny:, :-nx] + holes[:-ny, :-nx]) == 0


def _nearest(places: np.ndarray, shape, middle, spacing) -> tuple[int, int]:
    """The place whose rectangle has its centre nearest to ``middle``, in mm; both are in cells."""
    y, x = np.nonzero(places)
    away = (
        (first + (n - 1) / 2 - m) * s
        for first, n, m, s in zip((y, x), shape, middle, spacing, strict=True)
    )
    nearest = np.argmin(sum(distance**2 for distance in away))
    return int(y[nearest]), int(x[nearest])


def _largest_square(valid: np.ndarray, spacing) -> tuple[int, int]:
    """Cells (ny, nx) of the largest hole-free square in mm, found by bisection."""
    pixel = max(spacing)

    def cells(n: int) -> tuple[int, int]:
        return tuple(math.floor(n * pixel / s + _ROUNDING) for s in spacing)

    fits = 1  # at least one cell is free, as the face has a plane
    too_large = 1 + min(
        math.floor(n * s / pixel + _ROUNDING) for n, s in zip(valid.shape, spacing, strict=True)
    )
    while too_large - fits > 1:
        n = (fits + too_large) // 2
        if _free_places(valid, cells(n)).any():
            fits = n
        else:
            too_large = n
    return cells(fits)


def hole_free_square(valid: np.ndarray, spacing: tuple[float, float]) -> tuple[slice, slice]:
    """Rows and columns of the largest square without holes, the one nearest to the middle.

    It is square in mm by the spacing (dy, dx).
    """
    shape = _largest_square(valid, spacing)
    corner = _nearest(_free_places(valid, shape), shape, _middle(valid.shape), spacing)
    rows, columns = (slice(start, start + n) for start, n in zip(corner, shape, strict=True))
    return rows, columns


def _no_place(specimen, shape) -> InputError:
    """Error of a window without a place: the obstacle, and the window that would fit."""
    valid, spacing = specimen["valid"].values, spacing_of(specimen)
    rows, columns = np.nonzero(~valid)
    y, x = specimen.y.values, specimen.x.values
    square = _largest_square(valid, spacing)
    corner = _nearest(_free_places(valid, square), square, _middle(valid.shape), spacing)
    centre = [
        c + (n - 1) / 2 * s
        for c, n, s in zip((y[corner[0]], x[corner[1]]), square, spacing, strict=True)
    ]
    side = _rounded_down(min(n * s for n, s in zip(square, spacing, strict=True)))
    scan = json.loads(specimen.attrs["lower_scan"]).get("source", "")
    return InputError(
        f"{specimen.attrs['name']} ({scan}): no hole-free place for a window of "
        f"{shape[1] * spacing[1]:.4g} x {shape[0] * spacing[0]:.4g} mm (x, y): "
        f"{percent(float(np.mean(~valid)))} of the cells are missing, between "
        f"x = {x[columns.min()]:.4g} and {x[columns.max()]:.4g} mm and "
        f"y = {y[rows.min()]:.4g} and {y[rows.max()]:.4g} mm. The largest hole-free square has "
        f"a side of {side:.6g} mm, centred on x = {centre[1]:.4g}, y = {centre[0]:.4g} mm; write "
        f"'window: {side:.6g} mm' or less{_hole_words(specimen)}"
    )


def _hole_words(specimen) -> str:
    """Clause that names the key which fills the holes inside a scan; "" without any."""
    missing = ~specimen["valid"].values
    labels, _ = ndimage.label(missing)
    boxes = ndimage.find_objects(labels)
    inner = [
        max(part.stop - part.start for part in box)
        for box in boxes
        if all(part.start > 0 and part.stop < n for part, n in zip(box, missing.shape, strict=True))
    ]
    if not inner:
        return ""
    largest = int(np.ceil(np.percentile(inner, _MOST_HOLES)))
    return (
        f"; {percent(float(missing.mean()))} of the cells are missing, and {len(inner)} holes lie "
        f"inside the scan: 'fill_holes: {largest}' fills those of up to {largest} rows and columns"
    )


def _rounded_down(length: float) -> float:
    """Length for the user to copy: 4 digits, rounded down."""
    unit = 10.0 ** (math.floor(math.log10(length)) - 3)
    return math.floor(length / unit + _ROUNDING) * unit


def _pair(value, name: str, key: str) -> tuple[float, float]:
    """One number for both axes, or a pair (y, x)."""
    pair = tuple(value) if isinstance(value, list | tuple) else (value, value)
    if len(pair) != 2 or not all(isinstance(v, int | float | np.number) for v in pair):
        raise InputError(
            f"{name}: key '{key}' is {value!r}; expected a number or a pair (y, x) in mm"
        )
    return float(pair[0]), float(pair[1])
