"""The joint: one face slid over the other, its composite topography, dilatancy and pre-fractals.

Signs are those of docs/conventions.md: the window stays with the upper block, which slides by v
towards a direction d; h(xi; v, d) = z_l(xi + v d) - z_u(xi), and the largest h touches first.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled, labelled_dataset
from ..core.directions import AUTOMATIC_OFFSETS
from ..core.errors import InputError
from ..core.labels import cf_attrs
from ..core.mean_plane import mean_slopes, without_mean_plane
from ..core.settings import SpecimenSettings
from ..core.window import faces, nominal_area, window_slices
from ..roughness.dimension import measured_exponents
from ..surface.specimen import largest_offset
from .lag_dimension import lag_dimensions
from .plateau import opposite_parts, rigid_plateaus, undecided_plateaus
from .rigid_slide import Slide, slide

#: Steps (y, x) of one cell towards East, North, West and South; "none" for a joint that cannot
#: slide, a surface against a rigid plane.
DIRECTION_STEPS = {"E": (0, 1), "N": (1, 0), "W": (0, -1), "S": (-1, 0), "none": (0, 0)}


def composite_topography(specimen: xr.Dataset, direction: str, cells: int) -> np.ndarray:
    """Composite topography h of the window at an offset.

    Parameters
    ----------
    specimen : xr.Dataset
        From :func:`surface.specimen.make_specimen`.
    direction : {"E", "N", "W", "S", "none"}
        Direction towards which the upper block slides.
    cells : int
        Offset in cells of the scan.

    Returns
    -------
    (ny, nx) float64 ndarray
        h in mm.

    Raises
    ------
    InputError
        If the window slides out of the scan or onto a missing cell; names the largest offset.
    """
    if direction != "none" and cells > largest_offset(specimen, direction):
        raise InputError(_too_far(specimen, direction, cells))
    z_l, z_u = faces(specimen)
    window = window_slices(specimen)
    return z_l[slid_window(window, direction, cells)] - z_u[window]


def slid_window(window: tuple[slice, slice], direction: str, cells: int) -> tuple[slice, slice]:
    """Rows and columns of the lower face below the window, rows and columns, at an offset."""
    rows, columns = (
        slice(part.start + step * int(cells), part.stop + step * int(cells))
        for part, step in zip(window, DIRECTION_STEPS[direction], strict=True)
    )
    return rows, columns


def prefractal(composite: np.ndarray, factor: int) -> np.ndarray:
    """Every ``factor``-th node of a composite topography, as if scanned more coarsely."""
    return composite[::factor, ::factor]


def sliding_axis(direction: str) -> int:
    """Axis of a grid (y, x) along which a direction goes: 0 or 1."""
    return int(DIRECTION_STEPS[direction][1] != 0)


def direction_spacing(specimen: xr.Dataset, direction: str) -> float:
    """Cell side along a direction, mm."""
    return float(specimen.attrs[f"spacing_{'yx'[sliding_axis(direction)]}"])


def offsets_of(cells: ArrayLike, spacing: float) -> np.ndarray:
    """Offsets (n,) of whole cells, mm, to twelve digits: 3 cells of 0.1 mm are 0.3 mm.

    Products have rounding in their last digit, and nobody finds 0.30000000000000004 by its value.
    """
    return np.array([float(f"{n * spacing:.12g}") for n in np.atleast_1d(cells)])


def choose_offsets(
    specimen: xr.Dataset, offsets: Sequence[float] | None, directions: Sequence[str]
) -> dict[str, np.ndarray]:
    """Offsets in whole cells, for each direction.

    Parameters
    ----------
    specimen : xr.Dataset
    offsets : sequence of float or None
        In mm, each rounded to whole cells; None places them from one cell to the largest offset
        that is possible in every direction (and at zero where two faces were scanned).
    directions : sequence of str

    Returns
    -------
    dict
        Direction to a (n,) int array; the n-th offsets of all directions belong together.

    Raises
    ------
    InputError
        If an offset leaves the scan, meets a hole, or is smaller than half a cell but not zero.
    """
    if offsets is None:
        return _automatic_offsets(specimen, directions)
    chosen = {}
    for direction in directions:
        spacing = direction_spacing(specimen, direction)
        cells = np.array([round(offset / spacing) for offset in sorted(offsets)])
        for offset, n in zip(sorted(offsets), cells, strict=True):
            if n == 0 and offset > 0:
                raise InputError(
                    f"specimen {specimen.attrs['name']}: offset {offset:g} mm is less than half "
                    f"its spacing of {spacing:g} mm; write at least {spacing:g} mm"
                )
            if direction != "none" and n > largest_offset(specimen, direction):
                raise InputError(_too_far(specimen, direction, n))
        chosen[direction] = cells
    return chosen


def rigid_dilatancy(
    specimen: xr.Dataset, direction: str, cells: ArrayLike
) -> tuple[np.ndarray, np.ndarray]:
    """Opening of the rigid joint, delta_r(v) = max h(v) - max h(0), and the spread of h.

    Parameters
    ----------
    specimen, direction
        As for :func:`composite_topography`.
    cells : (n,) int array_like
        Offsets in cells.

    Returns
    -------
    dilatancy : (n,) ndarray
        delta_r in mm.
    spread : (n,) ndarray
        Standard deviation sigma_z of h in mm.
    """
    slid = _slid(specimen, direction, np.r_[0, np.asarray(cells, int)])
    return slid.highest[1:] - slid.highest[0], slid.spread[1:]


def face_correlation(specimen: xr.Dataset, direction: str, cells: ArrayLike) -> np.ndarray:
    """Pearson's correlation (n,) of the faces under the window at offsets in cells.

    Each face is taken less its own mean plane; NaN where one is a plane.
    """
    return _slid(specimen, direction, np.asarray(cells, int)).correlation


def _slid(specimen: xr.Dataset, direction: str, cells: np.ndarray) -> Slide:
    """The joint at offsets (n,) in cells; they are checked as :func:`composite_topography` does."""
    farthest = int(max(cells))
    if direction != "none" and farthest > largest_offset(specimen, direction):
        raise InputError(_too_far(specimen, direction, farthest))
    z_l, z_u = faces(specimen)
    window = window_slices(specimen)
    corner = [along.start for along in window]
    corners = corner + np.outer(cells, DIRECTION_STEPS[direction])
    return slide(z_l, np.ascontiguousarray(z_u[window]), corners)


def correlation_ranges(
    offset: np.ndarray, correlation: np.ndarray, area: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """Correlation lengths of the faces, offsets from which they are uncorrelated, and the limit.

    The correlation length l, mm, is the first offset at which the correlation (directions, n) is at
    most 1/e; uncorrelated is the first offset, mm, at which it no longer differs from zero, as it
    is at most 1.96 sqrt(pi l^2 / (2 A_0)), the limit. The window's area A_0 is in mm2.

    Chance alone correlates two unrelated faces with a variance of (integral of rho^2)/A_0 (Bartlett
    1935, here in the plane); the integral is pi l^2 / 2 for a Gaussian and for an exponential rho.
    In the limit l is the geometric mean over the directions that reach it; without one, or with a
    window that holds so few lengths l that chance explains more than 1/e, nothing can be said and
    the last two results are NaN.
    """
    length = np.array([_first_below(offset, row, np.exp(-1)) for row in correlation])
    reached = length[np.isfinite(length) & (length > 0)]
    if not reached.size:
        return length, np.full(len(length), np.nan), np.nan
    mean_square = np.exp(2 * np.mean(np.log(reached)))
    limit = float(1.96 * np.sqrt(np.pi * mean_square / (2 * area)))
    if limit > np.exp(-1):
        return length, np.full(len(length), np.nan), np.nan
    return length, np.array([_first_below(offset, row, limit) for row in correlation]), limit


def _first_below(offset, values, limit):
    below = np.flatnonzero(np.asarray(values) <= limit)
    return offset[below[0]] if below.size else np.nan


#: Variables of a rigid slide: dimensions, unit, long name.
RIGID_SLIDE = {
    "rigid_dilatancy": (("direction", "rigid_offset"), "mm", "rigid dilatancy delta_r"),
    "composite_rms": (
        ("direction", "rigid_offset"),
        "mm",
        "standard deviation of the composite topography",
    ),
    "face_correlation": (
        ("direction", "rigid_offset"),
        "1",
        "correlation of the two faces under the window",
    ),
}

_CORRELATION = {
    "correlation_length": (
        "direction",
        "mm",
        "first offset where the correlation is at most 1/e",
    ),
    "uncorrelated_offset": (
        "direction",
        "mm",
        "first offset where the correlation does not differ from zero",
    ),
    "correlation_limit": ((), "1", "largest correlation that chance alone explains, 95 %"),
}


def describe_joint(specimen: xr.Dataset, settings: SpecimenSettings) -> xr.Dataset:
    """Offsets, rigid dilatancy and composite topographies of a specimen.

    Returns
    -------
    xr.Dataset
        ``rigid_dilatancy``, ``composite_rms`` and ``face_correlation`` (direction, rigid_offset)
        at every cell up to the largest offset; the plateaus of :func:`joint.plateau
        .rigid_plateaus` and the parts over opposite directions of :func:`joint.plateau
        .opposite_parts`, ``correlation_length`` and ``uncorrelated_offset`` (direction),
        ``correlation_limit``; ``offset_cells`` (direction, offset) of the contact solves; for the
        first direction whose contact is solved ``composite`` (offset, window_y, window_x), the node
        ``first_touch_y``, ``first_touch_x`` (offset) where it is highest, and those of
        :func:`joint.lag_dimension.lag_dimensions`.

    Raises
    ------
    InputError
        As :func:`choose_offsets`.
    """
    directions, solved = settings.directions, settings.contact_directions
    every = list(dict.fromkeys([*directions, *solved]))
    chosen = choose_offsets(specimen, settings.offsets, every)
    reference = solved[0]
    cells, spacing = chosen[reference], direction_spacing(specimen, reference)
    slide = describe_slide(specimen, directions, np.arange(int(max(cells)) + 1), spacing)
    composites = [composite_topography(specimen, reference, n) for n in cells]
    spacing_of = tuple(specimen.attrs[f"spacing_{axis}"] for axis in "yx")
    _, face = measured_exponents(
        specimen["lower"].values, spacing_of, fit_range=settings.surface_range, estimators=[]
    )
    window = window_slices(specimen)
    y, x = (specimen[axis].values[along] for axis, along in zip("yx", window, strict=True))
    touching = np.unravel_index([h.argmax() for h in composites], (y.size, x.size))
    slid_so = f"in the window before it slides, direction {reference}"
    table = {
        "offset_cells": (("contact_direction", "offset"), "1", "offset in cells of the scan"),
        "composite": (
            ("offset", "window_y", "window_x"),
            "mm",
            f"composite topography h, direction {reference}",
        ),
        "first_touch_y": ("offset", "mm", f"y of the node that touches first, {slid_so}"),
        "first_touch_x": ("offset", "mm", f"x of the node that touches first, {slid_so}"),
    }
    values = {
        "offset_cells": np.array([chosen[direction] for direction in solved]),
        "composite": np.array(composites),
        "first_touch_y": y[touching[0]],
        "first_touch_x": x[touching[1]],
    }
    return (
        slide.assign(window_tilts(specimen, slide["axis"].values.tolist()))
        .assign(lag_dimensions(composites, spacing_of, face.longest) | labelled(table, values))
        .assign_coords(
            contact_direction=solved,
            offset=("offset", offsets_of(cells, spacing), cf_attrs("mm", "shear offset v")),
            window_y=("window_y", y, specimen.y.attrs),
            window_x=("window_x", x, specimen.x.attrs),
        )
    )


def window_tilts(specimen: xr.Dataset, axes: Sequence[str]) -> dict[str, tuple]:
    """Tilt of the window's mean plane against that of the whole lower face, by axis, a slope.

    The tilt is positive where the face rises to East or North.
    """
    slopes = dict(
        zip(
            ("N-S", "E-W"),
            mean_slopes(faces(specimen)[0][window_slices(specimen)]),
            strict=True,
        )
    )
    spacing = {"N-S": specimen.attrs["spacing_y"], "E-W": specimen.attrs["spacing_x"]}
    table = {"window_tilt": ("axis", "1", "tilt of the mean plane of the window, a slope")}
    return labelled(table, {"window_tilt": np.array([slopes[a] / spacing[a] for a in axes])})


def describe_slide(
    specimen: xr.Dataset, directions: Sequence[str], cells: np.ndarray, spacing: float
) -> xr.Dataset:
    """Rigid dilatancy, its plateaus, and correlation of the faces at every cell.

    ``cells`` are offsets of the reference direction, from 0, and ``spacing`` is that of its cells,
    mm.
    """
    dilatancy = np.full((len(directions), len(cells)), np.nan)
    spread, correlation = dilatancy.copy(), dilatancy.copy()
    for i, direction in enumerate(directions):
        ratio = spacing / direction_spacing(specimen, direction)
        own = np.round(cells * ratio).astype(int)
        slid = _slid(specimen, direction, own)
        # The first cell is the zero offset.
        dilatancy[i], spread[i] = slid.highest - slid.highest[0], slid.spread
        correlation[i] = slid.correlation
    offsets = offsets_of(cells, spacing)
    length, uncorrelated, limit = correlation_ranges(offsets, correlation, nominal_area(specimen))
    table = RIGID_SLIDE | _CORRELATION
    values = (dilatancy, spread, correlation, length, uncorrelated, limit)
    result = labelled_dataset(
        table,
        dict(zip(table, values, strict=True)),
        coords={
            "direction": directions,
            "rigid_offset": ("rigid_offset", offsets, cf_attrs("mm", "shear offset v")),
        },
    )
    result = result.assign(rigid_plateaus(offsets, dilatancy, directions))
    result = result.assign(undecided_plateaus(offsets, correlation, uncorrelated))
    result = result.assign(opposite_parts(offsets, dilatancy, directions))
    return with_spreads(result, specimen)


def with_spreads(joint: xr.Dataset, specimen: xr.Dataset) -> xr.Dataset:
    """Rigid dilatancy over the spread of the composite topography, and the spread expected.

    ``dilatancy_over_rms`` is NaN where faces are flush; ``composite_rms_expected`` follows from the
    heights of both faces and their correlation; ``mean_uncorrelated_offset`` is that of all
    directions.
    """
    window = window_slices(specimen)
    lower, upper = (float(np.std(without_mean_plane(z[window]))) for z in faces(specimen))
    square = lower**2 + upper**2 - 2 * joint["face_correlation"].values * lower * upper
    lost = joint["uncorrelated_offset"].values
    lost = lost[np.isfinite(lost)]
    values = {
        "dilatancy_over_rms": over_spread(joint["rigid_dilatancy"], joint["composite_rms"]),
        "composite_rms_expected": np.sqrt(np.maximum(square, 0)),
        "mean_uncorrelated_offset": float(lost.mean()) if lost.size else np.nan,
    }
    return joint.assign(labelled(_SPREADS, values))


def over_spread(opened: ArrayLike, spread: ArrayLike) -> np.ndarray:
    """delta_r / sigma_z; NaN where faces are flush."""
    opened, spread = np.asarray(opened), np.asarray(spread)
    return np.divide(opened, spread, out=np.full(spread.shape, np.nan), where=spread > 0)


_SPREADS = {
    "dilatancy_over_rms": (
        ("direction", "rigid_offset"),
        "1",
        "rigid dilatancy over the standard deviation of the composite topography",
    ),
    "composite_rms_expected": (
        ("direction", "rigid_offset"),
        "mm",
        "standard deviation of the composite topography by heights and correlation of the faces",
    ),
    "mean_uncorrelated_offset": (
        (),
        "mm",
        "offset where the faces lose all correlation, mean of the directions that reach it",
    ),
}


def _automatic_offsets(specimen, directions):
    """Geometric offsets up to the largest possible, the same length in every direction."""
    spacings = {direction: direction_spacing(specimen, direction) for direction in directions}
    coarsest = max(spacings.values())
    reach = min(largest_offset(specimen, d) * spacings[d] for d in directions)
    most = int(reach / coarsest + 1e-9)
    if most < 1:
        raise InputError(
            f"specimen {specimen.attrs['name']}: its window cannot slide by even one cell; "
            "give a smaller 'window' in its sidecar, or 'opposite: flat'"
        )
    steps = np.unique(np.round(np.geomspace(1, most, AUTOMATIC_OFFSETS)).astype(int))
    if specimen.attrs["opposite"] == "scanned":
        steps = np.r_[0, steps]
    return {d: np.round(steps * coarsest / spacings[d]).astype(int) for d in directions}


def _too_far(specimen, direction, cells):
    spacing = direction_spacing(specimen, direction)
    largest = largest_offset(specimen, direction)
    return (
        f"specimen {specimen.attrs['name']}: an offset of {cells * spacing:g} mm towards "
        f"{direction} slides the window out of the scan or onto missing cells; the largest "
        f"possible is {largest * spacing:g} mm: change 'offsets' or 'window'"
    )
