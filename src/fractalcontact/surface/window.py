"""Where the window of a specimen lies: hole-free, central, with room to slide."""

import json
import math

import numpy as np

from ..core.directions import DIRECTIONS, axis_and_sign
from ..core.errors import InputError

#: A side given in mm holds a whole number of cells within this fraction of one.
_ROUNDING = 1e-6


def place_window(specimen, window, centre, multiple, reach) -> dict:
    """Choose size and place of the window of :func:`surface.specimen.make_specimen`.

    Parameters
    ----------
    specimen : xr.Dataset
        Without a window.
    window, centre, multiple, reach
        As there.

    Returns
    -------
    dict
        Attributes ``window_y0``, ``window_x0``, ``window_ny``, ``window_nx``, ``window_mm`` and
        ``window_note``.

    Raises
    ------
    InputError
        If there is no place for it.
    """
    name = specimen.attrs["name"]
    if not (isinstance(multiple, int) and multiple >= 1):
        raise InputError(f"{name}: 'multiple' is {multiple!r}; expected a whole number from 1")
    spacing = (specimen.attrs["spacing_y"], specimen.attrs["spacing_x"])
    valid = specimen["valid"].values
    automatic = window is None
    middle = tuple((n - 1) / 2 for n in valid.shape)  # in cells, as all places below
    if automatic:
        square = _largest_square(valid, spacing)
        corner = _nearest(_free_places(valid, square), square, middle)
        middle = tuple(c + (n - 1) / 2 for c, n in zip(corner, square, strict=True))
        part = 1 if specimen.attrs["opposite"] == "flat" else 2
        asked = tuple(n // part for n in square)
        sides = tuple(n * s for n, s in zip(asked, spacing, strict=True))
        reach = 0.0  # the half square has its quarter all around
    else:
        sides = _pair(window, name, "window")
        if not all(math.isfinite(side) and side > 0 for side in sides):
            raise InputError(f"{name}: key 'window' is {window!r}; expected a length above zero")
        asked = tuple(
            math.floor(side / s + _ROUNDING) for side, s in zip(sides, spacing, strict=True)
        )
    if centre is not None:
        starts = (float(specimen.y[0]), float(specimen.x[0]))
        middle = tuple(
            (c - start) / s
            for c, start, s in zip(
                _pair(centre, name, "window_centre"), starts, spacing, strict=True
            )
        )
    shape = tuple(n // multiple * multiple for n in asked)
    extent = [n * s for n, s in zip(valid.shape, spacing, strict=True)]
    if any(n > total for n, total in zip(shape, valid.shape, strict=True)):
        raise InputError(
            f"{name}: key 'window' asks for {sides[0]:.4g} x {sides[1]:.4g} mm (y, x), the scan "
            f"covers {extent[0]:.4g} x {extent[1]:.4g} mm; write at most "
            f"'window: {_rounded_down(min(extent)):.6g} mm'"
        )
    if min(shape) < 1:
        raise InputError(
            f"{name}: a window of {sides[0]:.4g} x {sides[1]:.4g} mm holds {asked[0]} x {asked[1]} "
            f"cells, fewer than the multiple of {multiple} that the resolutions need; write "
            "a larger 'window' or fewer resolutions"
        )
    corner, place_note = _find_place(specimen, shape, middle, reach, centre is not None, spacing)
    notes = [place_note] if place_note else []
    if shape != asked:
        notes.append(
            f"{asked[0]} x {asked[1]} cells rounded down to {shape[0]} x {shape[1]}, multiples of "
            f"{multiple}"
        )
    if automatic:
        notes.append("size chosen from the largest hole-free square")
    return {
        "window_y0": corner[0],
        "window_x0": corner[1],
        "window_ny": shape[0],
        "window_nx": shape[1],
        "window_mm": [n * s for n, s in zip(shape, spacing, strict=True)],
        "window_note": "; ".join(notes),
    }


def _find_place(specimen, shape, middle, reach, centre_given: bool, spacing):
    """First cell of the window, and a note if it is not where it was wanted."""
    valid = specimen["valid"].values
    free = _free_places(valid, shape)
    if not free.any():
        raise _no_place(specimen, shape, spacing)
    wanted = tuple(
        min(max(math.floor(m - (n - 1) / 2 + 0.5), 0), total - n)
        for m, n, total in zip(middle, shape, valid.shape, strict=True)
    )
    sliding = free & _reachable_places(specimen, shape, reach, spacing)
    if free[wanted] and (centre_given or sliding[wanted] or not sliding.any()):
        return wanted, ""
    corner = _nearest(sliding if sliding.any() else free, shape, middle)
    moved = [(c - w) * s for c, w, s in zip(corner, wanted, spacing, strict=True)]
    why = "a hole" if not free[wanted] else "the offsets asked for"
    return (
        corner,
        f"window moved by {moved[0]:.4g} mm in y, {moved[1]:.4g} mm in x because of {why}",
    )


def _reachable_places(specimen, shape, reach, spacing) -> np.ndarray:
    """Places from which the lower window can slide by ``reach`` without meeting a hole."""
    present = np.isfinite(specimen["lower"].values)
    places = np.ones([total - n + 1 for total, n in zip(present.shape, shape, strict=True)], bool)
    if specimen.attrs["opposite"] == "flat":
        return places
    reaches = reach if isinstance(reach, dict) else dict.fromkeys(DIRECTIONS, reach)
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
    holes = np.zeros([n + 1 for n in valid.shape], dtype=np.int64)
    np.cumsum(np.cumsum(~valid, axis=0), axis=1, out=holes[1:, 1:])
    return (holes[ny:, nx:] - holes[:-ny, nx:] - holes[ny:, :-nx] + holes[:-ny, :-nx]) == 0


def _nearest(places: np.ndarray, shape, middle) -> tuple[int, int]:
    """The place whose rectangle has its centre nearest to ``middle`` (all in cells)."""
    y, x = np.nonzero(places)
    distance = (y + (shape[0] - 1) / 2 - middle[0]) ** 2 + (x + (shape[1] - 1) / 2 - middle[1]) ** 2
    nearest = np.argmin(distance)
    return int(y[nearest]), int(x[nearest])


def _largest_square(valid: np.ndarray, spacing) -> tuple[int, int]:
    """Cells (ny, nx) of the largest hole-free square in mm, found by bisection."""
    pixel = max(spacing)

    def cells(n: int) -> tuple[int, int]:
        return tuple(math.floor(n * pixel / s + _ROUNDING) for s in spacing)

    fits = 1  # one cell is free, or there would be no plane
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


def hole_free_square(valid: np.ndarray, spacing) -> tuple[slice, slice]:
    """Rows and columns of the largest square without holes, the one nearest to the middle.

    Parameters
    ----------
    valid : (ny, nx) bool ndarray
    spacing : (float, float)
        (dy, dx), mm: it is square in mm.
    """
    shape = _largest_square(valid, spacing)
    corner = _nearest(_free_places(valid, shape), shape, tuple((n - 1) / 2 for n in valid.shape))
    return tuple(slice(start, start + n) for start, n in zip(corner, shape, strict=True))


def _no_place(specimen, shape, spacing) -> InputError:
    valid = specimen["valid"].values
    rows, columns = np.nonzero(~valid)
    y, x = specimen.y.values, specimen.x.values
    square = _largest_square(valid, spacing)
    corner = _nearest(_free_places(valid, square), square, tuple((n - 1) / 2 for n in valid.shape))
    centre = [
        c + (n - 1) / 2 * s
        for c, n, s in zip((y[corner[0]], x[corner[1]]), square, spacing, strict=True)
    ]
    side = _rounded_down(min(n * s for n, s in zip(square, spacing, strict=True)))
    scan = json.loads(specimen.attrs["lower_scan"]).get("source", "")
    return InputError(
        f"{specimen.attrs['name']} ({scan}): no hole-free place for a window of "
        f"{shape[0] * spacing[0]:.4g} x {shape[1] * spacing[1]:.4g} mm: {np.mean(~valid):.1%} of "
        f"the cells are missing, between x = {x[columns.min()]:.4g} and {x[columns.max()]:.4g} mm "
        f"and y = {y[rows.min()]:.4g} and {y[rows.max()]:.4g} mm. The largest hole-free square has "
        f"a side of {side:.6g} mm, centred on y = {centre[0]:.4g}, x = {centre[1]:.4g} mm; write "
        f"'window: {side:.6g} mm' or less"
    )


def _rounded_down(length: float) -> float:
    """A length as a user may copy it: to 4 digits, and not above what is there."""
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
