"""A specimen: one or two levelled faces on one grid, and the window the study looks through."""

import json
import math

import numpy as np
import xarray as xr

from ..core.directions import axis_and_sign
from ..core.errors import InputError
from .cleaning import clean_faces
from .window import place_window

OPPOSITES = ("match", "flat")
#: Above this, subtracting the mean plane (a shear) departs from turning the specimen by 0.4 %.
STEEP_TILT = 5.0  # degrees


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
    specimen.attrs |= place_window(specimen, window, window_centre, multiple, reach)
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
    axis, sign = axis_and_sign(direction)
    if specimen.attrs["opposite"] == "flat":
        return 0
    rows, columns = window_slices(specimen)
    lower = specimen["lower"].values
    if axis == "x":
        lines, window = np.isfinite(lower[rows]).all(axis=0), columns
    else:
        lines, window = np.isfinite(lower[:, columns]).all(axis=1), rows
    ahead = lines[window.stop :] if sign > 0 else lines[: window.start][::-1]
    return int(np.argmin(np.r_[ahead, False]))  # the first line with a hole, or the edge


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
