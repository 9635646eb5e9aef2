"""Specimen: one or two levelled faces on one grid, and the window of the study."""

import json
import math
from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset
from ..core.directions import APERTURE, axis_and_sign, slides
from ..core.errors import InputError
from ..core.limits import STEEP_TILT
from ..core.settings import SpecimenSettings
from ..core.window import spacing_of, window_slices
from .cleaning import clean_faces
from .window import WindowRequest, place_window

OPPOSITES = ("match", "flat", APERTURE)


#: Variables of a specimen: dimensions, unit, long name.
_VARIABLES = {
    "lower": (("y", "x"), "mm", "height of the lower face, mean plane removed"),
    "upper": (("y", "x"), "mm", "height of the upper face, mean plane removed"),
    "valid": (("y", "x"), "1", "cell present in every scanned face"),
    "outlier": (("y", "x"), "1", "outlying cell of any scanned face"),
    "spike": (("y", "x"), "1", "lone spike of any scanned face"),
    "filled": (("y", "x"), "1", "harmonically filled cell of any scanned face"),
    "sparse": (("y", "x"), "1", "cell far from any point measured, of any scanned face"),
    "overlap": (("y", "x"), "1", "upper face below the lower one as scanned and registered"),
    "suspect_lower": (("y", "x"), "1", "suspicious cell of the lower face"),
    "suspect_upper": (("y", "x"), "1", "suspicious cell of the upper face"),
}


def make_specimen(
    lower: xr.DataArray,
    upper: xr.DataArray | None = None,
    *,
    opposite: str = "match",
    outliers: str = "keep",
    fill_holes: int = 0,
    judged: bool = True,
    name: str = "specimen",
    **window: Any,
) -> xr.Dataset:
    """Specimen of one or two scanned faces: cleaned, levelled, with its window.

    Parameters
    ----------
    lower, upper : DataArray (y, x)
        Heights in mm on one grid, as `scan.read_faces` gives them; ``upper`` is None if one face
        was scanned.
    opposite : {"match", "flat", "aperture"}
        What faces a single scanned face: its perfect match, or a rigid plane; of an aperture map,
        whose negative ``lower`` is, the plane too, and no tilt is taken off.
    outliers : {"keep", "mask", "fill"}
        Whether outlying cells stay as they are, become missing, or are filled with lone spikes and
        deep overlaps, see `cleaning.clean_faces`.
    fill_holes : int
        Rows and columns of the largest hole that is filled, see `cleaning.fill_holes`; 0 for none.
    judged : bool
        False looks for no suspicious cells where they would be kept, see `cleaning.clean_faces`.
    name : str
        For errors and attributes.
    **window
        Size and place of the window: ``window``, ``window_centre``, ``multiple`` and ``reach`` as
        :class:`surface.window.WindowRequest` describes them.

    Returns
    -------
    Dataset
        ``lower``, ``upper`` (if scanned), ``valid`` and the cells that `cleaning.clean_faces`
        names (y, x); the window in cells as the attributes ``window_y0, window_x0, window_ny,
        window_nx``; what was done to the faces as ``cleaning``, ``levelling`` and, for two,
        ``registration`` (JSON).

    Raises
    ------
    InputError
        If the faces have different grids, or the window is too large or finds no hole-free place.
    """
    request = WindowRequest(**window)
    if opposite not in OPPOSITES:
        raise InputError(f"{name}: key 'opposite' is {opposite!r}; expected 'match' or 'flat'")
    if upper is not None and not (lower.x.equals(upper.x) and lower.y.equals(upper.y)):
        raise InputError(f"{name}: the two faces are not on one grid; read them together")
    scans = {"lower": lower} if upper is None else {"lower": lower, "upper": upper}
    cleaned, cells, cleaning = clean_faces(
        list(scans.values()),
        outliers=outliers,
        largest_hole=fill_holes,
        judged=judged,
        name=name,
    )
    valid = np.logical_and.reduce([np.isfinite(scan.values) for scan in cleaned])
    if valid.sum() < 3:
        raise InputError(f"{name}: the faces have no cells in common; they must share one frame")
    plane, levelling = _mean_plane(cleaned, valid, level=opposite != APERTURE)
    heights = {face: scan.values - plane for face, scan in zip(scans, cleaned, strict=True)}
    values = {**heights, "valid": valid, **cells}
    specimen = labelled_dataset(
        {key: _VARIABLES[key] for key in values}, values, coords={"y": lower.y, "x": lower.x}
    )
    spacing_y, spacing_x = spacing_of(lower)
    specimen.attrs = {
        "name": name,
        "faces": len(scans),
        "opposite": opposite if upper is None else "scanned",
        "spacing_x": spacing_x,
        "spacing_y": spacing_y,
        **cleaning,
        **levelling,
        **_provenance(scans),
    }
    specimen.attrs |= place_window(specimen, request)
    return specimen


def _provenance(scans) -> dict:
    """Source and registration of the faces, as attributes of the specimen."""
    provenance = {}
    for face, scan in scans.items():
        attrs = dict(scan.attrs)
        if "registration" in attrs:
            provenance["registration"] = attrs.pop("registration")
        provenance[f"{face}_scan"] = json.dumps(attrs, sort_keys=True)
    return provenance


def window_arguments(settings: SpecimenSettings) -> dict:
    """Settings of cleaning and window for :func:`make_specimen`.

    The window is cut to whole cells of the coarsest pre-fractal, so that all resolutions cover the
    same area, and placed where the offsets of the study can slide it.
    """
    centre = settings.window_centre
    reach = max(settings.offsets or [0.0])
    return {
        "opposite": settings.opposite,
        "outliers": settings.outliers,
        "fill_holes": settings.fill_holes,
        "window": settings.window,
        "window_centre": None if centre is None else (centre[1], centre[0]),
        "multiple": math.lcm(*settings.resolutions),
        "reach": dict.fromkeys(settings.directions, reach) if slides(settings.opposite) else 0.0,
    }


def largest_offset(specimen: xr.Dataset, direction: str) -> int:
    """Cells the lower window can slide within the scan and its holes; 0 against a flat face.

    Towards E the lower window moves to larger x, h = z_l(xi + v d) - z_u(xi).
    """
    axis, sign = axis_and_sign(direction)
    if not slides(specimen.attrs["opposite"]):
        return 0
    rows, columns = window_slices(specimen)
    lower = specimen["lower"].values
    if axis == "x":
        lines, window = np.isfinite(lower[rows]).all(axis=0), columns
    else:
        lines, window = np.isfinite(lower[:, columns]).all(axis=1), rows
    ahead = lines[window.stop :] if sign > 0 else lines[: window.start][::-1]
    return int(np.argmin(np.r_[ahead, False]))  # the first line with a hole, or the edge


def _mean_plane(scans, valid: np.ndarray, *, level: bool) -> tuple[np.ndarray, dict]:
    """Least-squares plane of the (mean) face, and its record as attributes.

    One plane for both faces: the gap between them is a measurement and stays. So does the wedge of
    an aperture map, of which the mean alone is taken off (not ``level``).
    """
    x, y = np.meshgrid(scans[0].x.values, scans[0].y.values)
    mean_face = np.mean([scan.values[valid] for scan in scans], axis=0)
    x_mean, y_mean = x[valid].mean(), y[valid].mean()  # centred: coordinates may be far from 0
    terms = np.column_stack([x[valid] - x_mean, y[valid] - y_mean, np.ones(len(mean_face))])
    (slope_x, slope_y, height), *_ = np.linalg.lstsq(terms, mean_face, rcond=None)
    if not level:
        slope_x = slope_y = 0.0
        height = mean_face.mean()
    offset = height - slope_x * x_mean - slope_y * y_mean
    tilt = math.degrees(math.atan(math.hypot(slope_x, slope_y)))
    of = "the scanned face" if len(scans) == 1 else "the mean of both faces, subtracted from both"
    # Smaller tilts are the rounding of faces that had none.
    tilted = f"{tilt:.3g}" if tilt > 1e-6 else "below 1e-6"
    sentence = f"least-squares plane of {of}, over the cells present in all; tilt {tilted} degrees"
    if tilt > STEEP_TILT:
        sentence += (
            f". NOTE: above {STEEP_TILT:g} degrees; heights stay vertical, not normal to the plane"
        )
    if not level:
        sentence = "the mean of the aperture map; its tilt is a wedge of the joint and stays"
    attrs = {
        "levelling": sentence,
        "plane_slope_x": float(slope_x),
        "plane_slope_y": float(slope_y),
        "plane_offset_mm": float(offset),
        "tilt_degrees": tilt,
    }
    return slope_x * (x - x_mean) + slope_y * (y - y_mean) + height, attrs
