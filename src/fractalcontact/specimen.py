"""A specimen: one or two levelled faces on one grid, and the window the study looks through."""

import json
import math

import numpy as np
import xarray as xr

from .cleaning import clean_faces
from .errors import InputError

DIRECTIONS = {"E": ("x", 1), "N": ("y", 1), "W": ("x", -1), "S": ("y", -1)}
OPPOSITES = ("match", "flat")
#: Above this, subtracting the mean plane (a shear) departs from turning the specimen by 0.4 %.
STEEP_TILT = 5.0  # degrees
#: A side given in mm holds a whole number of cells within this fraction of one.
_ROUNDING = 1e-6


def make_specimen(
    lower,
    upper=None,
    *,
    opposite="match",
    outliers="keep",
    fill_holes=0,
    window=None,
    window_centre=None,
    multiple=1,
    reach=0.0,
    name="specimen",
) -> xr.Dataset:
    """Clean and level the faces, mark the cells present in all of them and place the window.

    Parameters
    ----------
    lower, upper : DataArray (y, x)
        Heights in mm on one grid, as `scan.read_faces` gives them; ``upper`` is None if one face
        was scanned.
    opposite : {"match", "flat"}
        What faces a single scanned face: its perfect match, or a rigid plane.
    outliers : {"keep", "mask"}
        Whether outlying cells stay as they are or become missing, see `cleaning.find_outliers`.
    fill_holes : int
        Rows and columns of the largest hole that is filled, see `cleaning.fill_holes`; 0 for none.
    window : float, (float, float) or None
        Side in mm, or sides (y, x). None: half the largest hole-free square, in its middle, so
        that it can slide by a quarter of that square; the whole square against a plane.
    window_centre : (float, float), optional
        (y, x) in mm; default the middle of the scan. A window that meets a hole there moves to the
        nearest hole-free place; without a given centre also where it could not slide by ``reach``.
    multiple : int
        Cells along each side are rounded down to a multiple of it, so that keeping every k-th node
        covers the same area for every k that divides it.
    reach : float or dict
        Offset in mm the lower window should be able to slide, in all directions or by direction.
    name : str
        For errors and attributes.

    Returns
    -------
    Dataset
        ``lower``, ``upper`` (if scanned), ``valid``, ``outlier`` and ``filled`` (y, x); the window
        in cells as the attributes ``window_y0, window_x0, window_ny, window_nx``; what was done to
        the faces as ``cleaning``, ``levelling`` and, for two, ``registration`` (JSON).

    Raises
    ------
    InputError
        If the faces have different grids, or the window is too large or finds no hole-free place.
    """
    if opposite not in OPPOSITES:
        raise InputError(f"{name}: key 'opposite' is {opposite!r}; expected 'match' or 'flat'")
    scans = [lower] if upper is None else [lower, upper]
    if upper is not None and not (lower.x.equals(upper.x) and lower.y.equals(upper.y)):
        raise InputError(f"{name}: the two faces are not on one grid; read them together")
    attributes = [dict(scan.attrs) for scan in scans]
    scans, cells, cleaning = clean_faces(
        scans, outliers=outliers, largest_hole=fill_holes, name=name
    )
    valid = np.logical_and.reduce([np.isfinite(scan.values) for scan in scans])
    if valid.sum() < 3:
        raise InputError(f"{name}: the faces have no cells in common; they must share one frame")
    plane, levelling = _mean_plane(scans, valid)

    specimen = xr.Dataset(coords={"y": lower.y, "x": lower.x})
    for face, scan in zip(("lower", "upper"), scans, strict=False):
        attrs = {"units": "mm", "long_name": f"height of the {face} face, mean plane removed"}
        specimen[face] = (("y", "x"), scan.values - plane, attrs)
    specimen["valid"] = (
        ("y", "x"),
        valid,
        {"units": "1", "long_name": "cell present in every scanned face"},
    )
    for key, words in (("outlier", "outlying cell"), ("filled", "harmonically filled cell")):
        in_any = {"units": "1", "long_name": f"{words} of any scanned face"}
        specimen[key] = (("y", "x"), cells[key], in_any)
    specimen.attrs = {
        "name": name,
        "faces": len(scans),
        "opposite": opposite if upper is None else "scanned",
        "spacing_x": float(lower.attrs["spacing_x"]),
        "spacing_y": float(lower.attrs["spacing_y"]),
        **cleaning,
        **levelling,
    }
    for face, attrs in zip(("lower", "upper"), attributes, strict=False):
        if "registration" in attrs:
            specimen.attrs["registration"] = attrs.pop("registration")
        specimen.attrs[f"{face}_scan"] = json.dumps(attrs, sort_keys=True)
    specimen.attrs |= _place_window(specimen, window, window_centre, multiple, reach)
    return specimen


def faces(specimen: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Heights of the lower and upper face (ny, nx) in mm, NaN where missing.

    A face that was not scanned is the lower face itself ("match") or the plane z = 0 ("flat").
    """
    z_l = specimen["lower"].values.astype(np.float64)
    if specimen.attrs["opposite"] == "scanned":
        return z_l, specimen["upper"].values.astype(np.float64)
    if specimen.attrs["opposite"] == "flat":
        return z_l, np.zeros_like(z_l)
    return z_l, z_l


def window_slices(specimen: xr.Dataset) -> tuple[slice, slice]:
    """Rows and columns of the window at zero offset."""
    y0, x0, ny, nx = (int(specimen.attrs[f"window_{key}"]) for key in ("y0", "x0", "ny", "nx"))
    return slice(y0, y0 + ny), slice(x0, x0 + nx)


def window_sides(specimen):
    """Sides (y, x) of the window, mm."""
    return tuple(specimen.attrs[f"window_n{a}"] * specimen.attrs[f"spacing_{a}"] for a in "yx")


def cell_side(specimen):
    """s, mm: side of the square as large as a cell, so that N nodes cover N s^2."""
    return float(np.sqrt(specimen.attrs["spacing_y"] * specimen.attrs["spacing_x"]))


def nominal_area(specimen):
    """A_0 of the window, mm2."""
    side_y, side_x = window_sides(specimen)
    return side_y * side_x


def largest_offset(specimen: xr.Dataset, direction: str) -> int:
    """Cells the lower window can slide before it leaves the scan or meets a hole.

    Parameters
    ----------
    specimen : Dataset
    direction : {"E", "N", "W", "S"}
        E: the lower window moves to larger x, h = z_l(xi + v d) - z_u(xi).

    Returns
    -------
    int
        0 against a flat face, on which sliding changes nothing.
    """
    axis, sign = _axis_and_sign(direction)
    if specimen.attrs["opposite"] == "flat":
        return 0
    rows, columns = window_slices(specimen)
    present = np.isfinite(specimen["lower"].values)
    if axis == "x":
        lines, window = present[rows].all(axis=0), columns
    else:
        lines, window = present[:, columns].all(axis=1), rows
    ahead = lines[window.stop :] if sign > 0 else lines[: window.start][::-1]
    return int(np.argmin(np.r_[ahead, False]))  # the first line with a hole, or the edge


def _axis_and_sign(direction: str) -> tuple[str, int]:
    if direction not in DIRECTIONS:
        raise InputError(f"direction {direction!r}; expected one of {', '.join(DIRECTIONS)}")
    return DIRECTIONS[direction]


def _mean_plane(scans, valid: np.ndarray) -> tuple[np.ndarray, dict]:
    """Least-squares plane of the (mean) face, and what was done, as attributes.

    One plane for both faces: the gap between them is a measurement and stays.
    """
    x, y = np.meshgrid(scans[0].x.values, scans[0].y.values)
    mean_face = np.mean([scan.values[valid] for scan in scans], axis=0)
    x_mean, y_mean = x[valid].mean(), y[valid].mean()  # centred: coordinates may be far from 0
    terms = np.column_stack([x[valid] - x_mean, y[valid] - y_mean, np.ones(len(mean_face))])
    (slope_x, slope_y, height), *_ = np.linalg.lstsq(terms, mean_face, rcond=None)
    offset = height - slope_x * x_mean - slope_y * y_mean
    tilt = math.degrees(math.atan(math.hypot(slope_x, slope_y)))
    of = "the scanned face" if len(scans) == 1 else "the mean of both faces, subtracted from both"
    sentence = (
        f"least-squares plane of {of}, over the cells present in all; tilt {tilt:.3g} degrees"
    )
    if tilt > STEEP_TILT:
        sentence += (
            f". NOTE: above {STEEP_TILT:g} degrees; heights stay vertical, not normal to the plane"
        )
    attrs = {
        "levelling": sentence,
        "plane_slope_x": float(slope_x),
        "plane_slope_y": float(slope_y),
        "plane_offset_mm": float(offset),
        "tilt_degrees": tilt,
    }
    return slope_x * (x - x_mean) + slope_y * (y - y_mean) + height, attrs


def _place_window(specimen, window, centre, multiple, reach) -> dict:
    """Choose size and place of the window; its attributes."""
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
        axis_name, sign = _axis_and_sign(direction)
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
