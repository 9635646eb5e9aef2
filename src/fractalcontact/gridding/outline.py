"""Outline of a measured map of contact or aperture: which of its cells belong to the nominal area.

A film, cast or core is seldom a rectangle, its file always is: cells outside that hold zeros would
count as nominal area without contact, or as contact. The sidecar says where the outline runs.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from scipy.ndimage import binary_erosion, label
from scipy.spatial import ConvexHull, QhullError

from ..core.errors import InputError
from ..core.text import percent
from ..core.units import quantity

#: A map whose rim is empty is suspicious where the convex hull of its contact takes less of the
#: rectangle: the largest disc in a square takes 0.785.
HULL_SHARE = 0.8
#: Fewer cells in contact leave so much of a rectangle empty by chance: their hull takes
#: 1 - (8/3) ln N / N of a square on the average (Renyi and Sulanke, 1963), 0.88 for 100 cells.
MIN_CELLS = 100


#: Largest patch of zeros, a fraction of the map, at the corners of an aperture map without an
#: outline; a larger patch most likely lies outside the specimen.
MAX_CORNER_ZEROS = 0.005
#: Largest fraction of an outline along which zeros may lie; with more, the zeros most likely lie
#: outside the specimen.
MAX_RIM_ZEROS = 0.5
#: Largest fraction of the contact outside a disc without a stated centre.
MAX_OUTSIDE = 0.01


def outline_mask(
    outline: str | Mapping[str, Any] | None,
    values: np.ndarray,
    y: np.ndarray,
    x: np.ndarray,
    where: str,
) -> np.ndarray:
    """Cells (ny, nx) of a map whose centres lie within its outline.

    An outline is "rectangle", the whole map, as without an outline; "disc", the largest disc in it;
    ``{"disc": {"centre": [x, y], "diameter": d}}``; ``{"polygon": [[x, y], ...]}``; or ``{"mask":
    value}``: cells of this value lie outside. Numbers are mm in the coordinates of the map, texts
    have a unit.

    ``values`` (ny, nx) are those of the file, ``y`` and ``x`` the centres of the cells in mm,
    ascending. An outline that is no area, or that holds no cell, is refused.
    """
    if outline is None or outline == "rectangle":
        return np.ones(values.shape, bool)
    whole: tuple[str, Any] = ("disc", {})
    kind, stated = whole if isinstance(outline, str) else next(iter(outline.items()))
    if kind == "mask":
        inside = ~np.isclose(values, stated, rtol=1e-6, atol=0)
    elif kind == "disc":
        inside = _disc(stated, y, x, where)
    else:
        inside = _polygon(stated, y, x, where)
    if not inside.any():
        raise InputError(
            f"{where}: no cell lies within; the map goes from {_ends(x)} mm in x and from "
            f"{_ends(y)} mm in y"
        )
    return inside


def within_outline(
    apertures: xr.DataArray, outline: str | Mapping[str, Any] | None, where: str
) -> xr.DataArray:
    """Aperture map (y, x) in mm, or its negative, without the cells outside its outline.

    Zeros that would count as contact are refused: those that reach in from the corners without a
    stated outline, and those that the outline runs through.
    """
    values = apertures.values
    inside = outline_mask(outline, values, apertures.y.values, apertures.x.values, where)
    if outline not in (None, "rectangle"):
        rim = inside & ~binary_erosion(inside)
        if (share := float((values[rim] == 0).mean())) > MAX_RIM_ZEROS:
            raise InputError(
                f"{where}: 'outline' runs through zeros over {percent(share)} of its length, so it "
                "is wider than the specimen; write where that lies, 'outline: {disc: {centre: "
                "[x, y], diameter: d}}' or a polygon, or 'mask: 0'"
            )
    patches, _ = label(values == 0)
    corners = patches[[0, 0, -1, -1], [0, -1, 0, -1]]
    share = np.isin(patches, corners[corners > 0]).mean()
    # Contact may lie in one corner by chance.
    if outline is None and share > MAX_CORNER_ZEROS and np.count_nonzero(corners) > 1:
        raise InputError(
            f"{where}: {percent(share)} of the aperture map are zeros that reach in from its "
            "corners: if they lie outside the specimen, write 'outline: disc' (or a polygon, or "
            "'mask: 0'), if the faces touch there, 'outline: rectangle'"
        )
    attrs = {"missing_share": float(np.isnan(values)[inside].mean())}
    return apertures.where(inside).assign_attrs(apertures.attrs | attrs)


def outline_words(outline: str | Mapping[str, Any]) -> str:
    """Outline of a map in words, as :func:`outline_mask` takes it."""
    if isinstance(outline, str):
        return outline
    kind, stated = next(iter(outline.items()))
    if kind == "mask":
        return f"all but cells of {stated:g}"
    if kind == "polygon":
        return f"polygon of {len(stated)} corners"
    words = []
    if "diameter" in stated:
        words.append(f"of diameter {_as_stated(stated['diameter'])}")
    if "centre" in stated:
        x, y = map(_as_stated, stated["centre"])
        words.append(f"about x = {x}, y = {y}")
    return " ".join(["disc", *words])


def _as_stated(stated: float | str) -> str:
    """A length as a sidecar states it: in mm unless it has a unit."""
    return stated if isinstance(stated, str) else f"{stated:g} mm"


def _ends(centres: np.ndarray) -> str:
    half = (centres[1] - centres[0]) / 2
    return f"{centres[0] - half:.4g} to {centres[-1] + half:.4g}"


def _disc(stated: Mapping[str, Any], y: np.ndarray, x: np.ndarray, where: str) -> np.ndarray:
    """Cells in a disc; without a centre or a diameter the largest in the middle."""
    sides = [centres[-1] - centres[0] + centres[1] - centres[0] for centres in (y, x)]
    centre = [_length(c, where) for c in stated.get("centre", [x.mean(), y.mean()])]
    diameter = _length(stated.get("diameter", min(sides)), where)
    if diameter <= 0:
        raise InputError(f"{where}: a diameter of {diameter:g} mm; it must be positive")
    return np.hypot(x - centre[0], (y - centre[1])[:, np.newaxis]) <= diameter / 2


def _polygon(
    corners: Sequence[Sequence[Any]], y: np.ndarray, x: np.ndarray, where: str
) -> np.ndarray:
    """Cells in a polygon, by the number of its sides that a ray to the East crosses."""
    points = np.array([[_length(c, where) for c in corner] for corner in corners])
    after = np.roll(points, -1, axis=0)
    twice = np.sum(points[:, 0] * after[:, 1] - after[:, 0] * points[:, 1])
    if twice == 0:
        raise InputError(f"{where}: these corners enclose no area")
    inside = np.zeros((len(y), len(x)), bool)
    for (x0, y0), (x1, y1) in zip(points, after, strict=True):
        rows = np.flatnonzero((y0 > y) != (y1 > y))
        crossing = x0 + (y[rows] - y0) * (x1 - x0) / (y1 - y0) if len(rows) else np.empty(0)
        inside[rows] ^= x < crossing[:, np.newaxis]
    return inside


def _length(value: Any, where: str) -> float:
    return quantity(value, "length", where) if isinstance(value, str) else float(value)


def outline_warning(
    values: np.ndarray, touching: np.ndarray, outline: object, threshold: float = np.inf
) -> str:
    """Warning of contact cut off by a disc, or of zeros taken for nominal area; "" if neither.

    ``values`` (ny, nx) are those of the file, NaN where nothing was measured; cells outside the
    outline touch above ``threshold``. The warning of contact is for a disc without a stated centre
    alone. Any stated ``outline`` silences the warning of zeros.
    """
    absent = np.isnan(values)
    empty = ~(touching | absent)
    if outside := _outside_words(values, touching, outline, threshold):
        return outside
    rim = np.concatenate([empty[0], empty[-1], empty[:, 0], empty[:, -1]])
    if outline is not None or not rim.all() or touching.sum() < MIN_CELLS:
        return ""
    share = _hull_share(touching)
    if share >= HULL_SHARE:
        return ""
    return (
        f"no contact all round, which spans {100 * share:.0f} % of the rectangle: if the film "
        "is smaller than its file, A_0 is too large; write 'outline: disc' (or a polygon, or a "
        "mask) in the sidecar, or 'outline: rectangle' if it is not"
    )


def _outside_words(
    values: np.ndarray, touching: np.ndarray, outline: object, threshold: float
) -> str:
    """Warning where a disc cuts off contact: without a centre it sits in the middle of the map."""
    with np.errstate(invalid="ignore"):
        every = int((values > threshold).sum())
    lost = every - int(touching.sum())
    disc = outline.get("disc") if isinstance(outline, Mapping) else None
    is_placed = disc is None or "centre" in disc
    if (outline != "disc" and is_placed) or lost <= MAX_OUTSIDE * every:
        return ""
    return (
        f"{percent(lost / every)} of the contact lies outside the outline, {outline_words(outline)}"  # type: ignore[arg-type]
        ": write where it lies in the sidecar, 'outline: {disc: {centre: [x, y], diameter: d}}', "
        "or 'outline: rectangle'"
    )


def _hull_share(touching: np.ndarray) -> float:
    """Fraction of the rectangle in the convex hull of the cells in contact, whole cells."""
    row, column = np.nonzero(touching)
    corners = np.concatenate([np.c_[row + dy, column + dx] for dy in (0, 1) for dx in (0, 1)])
    try:
        return float(ConvexHull(corners).volume / touching.size)
    except QhullError:  # one row of cells, which has an area: not reached with whole cells
        return 0.0
