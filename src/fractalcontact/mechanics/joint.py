"""The joint: one face slid over the other, its composite topography, dilatancy and pre-fractals.

Signs are those of PHYSICS.md: the window stays with the upper block, which slides by v towards a
direction d; h(xi; v, d) = z_l(xi + v d) - z_u(xi), and the largest h touches first.
"""

import numpy as np
import xarray as xr

from ..core.directions import AUTOMATIC_OFFSETS
from ..core.errors import InputError
from ..core.labels import cf_attrs
from ..core.mean_plane import without_mean_plane
from ..surface.specimen import faces, largest_offset, nominal_area, window_slices

#: Steps (y, x) of one cell towards East, North, West and South; "none" for a joint that cannot
#: slide, a surface against a rigid plane.
STEPS = {"E": (0, 1), "N": (1, 0), "W": (0, -1), "S": (-1, 0), "none": (0, 0)}

#: How Delta_g of the composite topographies is measured: of the estimators with little bias the
#: one that a tilt of the composite, which is part of the joint, does not touch.
COMPOSITE_ESTIMATOR = "second_differences"


def composite_topography(specimen, direction, cells):
    """Composite topography h of the window at an offset.

    Parameters
    ----------
    specimen : xr.Dataset
        From :func:`surface.specimen.make_specimen`.
    direction : {"E", "N", "W", "S", "none"}
        Where the upper block slides.
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
    window_y, window_x = window_slices(specimen)
    step_y, step_x = (step * int(cells) for step in STEPS[direction])
    slid_y = slice(window_y.start + step_y, window_y.stop + step_y)
    slid_x = slice(window_x.start + step_x, window_x.stop + step_x)
    return z_l[slid_y, slid_x] - z_u[window_y, window_x]


def prefractal(composite, factor):
    """Every ``factor``-th node of a composite topography, as if scanned more coarsely."""
    return composite[::factor, ::factor]


def direction_spacing(specimen, direction):
    """Cell side along a direction, mm."""
    return float(specimen.attrs["spacing_x" if direction in ("E", "W") else "spacing_y"])


def choose_offsets(specimen, offsets, directions):
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
        cells = np.array([round(offset / spacing) for offset in offsets])
        for offset, n in zip(offsets, cells, strict=True):
            if n == 0 and offset > 0:
                raise InputError(
                    f"specimen {specimen.attrs['name']}: offset {offset:g} mm is less than half "
                    f"its spacing of {spacing:g} mm; write at least {spacing:g} mm"
                )
            if direction != "none" and n > largest_offset(specimen, direction):
                raise InputError(_too_far(specimen, direction, n))
        chosen[direction] = cells
    return chosen


def rigid_dilatancy(specimen, direction, cells):
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
    mated = composite_topography(specimen, direction, 0).max()
    opened, spread = [], []
    for n in cells:
        composite = composite_topography(specimen, direction, n)
        opened.append(composite.max() - mated)
        spread.append(composite.std())
    return np.array(opened), np.array(spread)


def face_correlation(specimen, direction, cells):
    """Correlation of the two faces under the window, each less its own mean plane.

    Parameters
    ----------
    specimen, direction
        As for :func:`composite_topography`.
    cells : (n,) int array_like
        Offsets in cells.

    Returns
    -------
    (n,) ndarray
        Pearson's coefficient; NaN where a face is a plane.
    """
    _, z_u = faces(specimen)
    upper = z_u[window_slices(specimen)]
    under = without_mean_plane(upper)
    found = []
    for n in cells:
        above = without_mean_plane(composite_topography(specimen, direction, n) + upper)
        norm = np.sqrt(np.mean(above**2) * np.mean(under**2))
        found.append(np.mean(above * under) / norm if norm > 0 else np.nan)
    return np.array(found)


def correlation_ranges(offset, correlation, area):
    """Offsets at which the faces stop to resemble each other.

    Parameters
    ----------
    offset : (n,) array_like
        v, mm, ascending.
    correlation : (directions, n) array_like
        From :func:`face_correlation`.
    area : float
        Of the window, mm2.

    Returns
    -------
    length : (directions,) ndarray
        Correlation length l, mm: the first v where the correlation is at most 1/e.
    uncorrelated : (directions,) ndarray
        The first v, mm, where it no longer differs from zero.
    limit : float
        Up to here it does not: 1.96 sqrt(pi l^2 / (2 A_0)).

    Notes
    -----
    Chance alone correlates two unrelated faces with a variance of (integral of rho^2)/A_0
    (Bartlett 1935, here in the plane); the integral is pi l^2 / 2 for a Gaussian and for an
    exponential rho. l is the geometric mean over the directions that reach it; without one, or with
    a window that holds so few lengths l that chance explains more than 1/e, nothing can be said
    and the last two results are NaN.
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


def describe_joint(specimen, settings):
    """Offsets, rigid dilatancy and composite topographies of a specimen.

    Parameters
    ----------
    specimen : xr.Dataset
    settings : dict
        From :func:`study.configuration.resolve_settings`.

    Returns
    -------
    xr.Dataset
        ``rigid_dilatancy``, ``composite_rms`` and ``face_correlation`` (direction, rigid_offset)
        at every cell up to the largest offset; ``correlation_length`` and ``uncorrelated_offset``
        (direction), ``correlation_limit``; ``offset_cells`` (direction, offset) of the contact
        solves; for the first direction whose contact is solved ``composite`` (offset, window_y,
        window_x) and its dimension Delta_g ``composite_dimension`` (offset), with its interval and
        the lengths fitted.

    Raises
    ------
    InputError
        As :func:`choose_offsets`.
    """
    from ..roughness.dimension import surface_dimension

    directions = settings["directions"]
    solved = settings["contact_directions"]
    every = list(dict.fromkeys([*directions, *solved]))
    chosen = choose_offsets(specimen, settings["offsets"], every)
    reference = solved[0]
    spacing = direction_spacing(specimen, reference)
    largest = int(max(chosen[reference]))
    dilatancy = np.full((len(directions), largest + 1), np.nan)
    spread, correlation = dilatancy.copy(), dilatancy.copy()
    for i, direction in enumerate(directions):
        ratio = spacing / direction_spacing(specimen, direction)
        cells = np.round(np.arange(largest + 1) * ratio).astype(int)
        dilatancy[i], spread[i] = rigid_dilatancy(specimen, direction, cells)
        correlation[i] = face_correlation(specimen, direction, cells)
    slid = np.arange(largest + 1) * spacing
    length, uncorrelated, limit = correlation_ranges(slid, correlation, nominal_area(specimen))
    composites = [composite_topography(specimen, reference, n) for n in chosen[reference]]
    dimensions = xr.concat(
        [
            surface_dimension(
                composite,
                tuple(specimen.attrs[f"spacing_{axis}"] for axis in "yx"),
                fit_range=settings["surface_range"],
                estimators=[COMPOSITE_ESTIMATOR],
            ).squeeze("estimator")
            for composite in composites
        ],
        "offset",
    )
    window_y, window_x = window_slices(specimen)
    of_slide = ("direction", "rigid_offset")
    return xr.Dataset(
        {
            "rigid_dilatancy": (of_slide, dilatancy, cf_attrs("mm", "rigid dilatancy delta_r")),
            "composite_rms": (
                of_slide,
                spread,
                cf_attrs("mm", "standard deviation of the composite topography"),
            ),
            "face_correlation": (
                of_slide,
                correlation,
                cf_attrs("1", "correlation of the two faces under the window"),
            ),
            "correlation_length": (
                "direction",
                length,
                cf_attrs("mm", "first offset where the correlation is at most 1/e"),
            ),
            "uncorrelated_offset": (
                "direction",
                uncorrelated,
                cf_attrs("mm", "first offset where the correlation does not differ from zero"),
            ),
            "correlation_limit": (
                (),
                limit,
                cf_attrs("1", "largest correlation that chance alone explains, 95 %"),
            ),
            **{
                f"composite_{name}": ("offset", dimensions[name].values, dimensions[name].attrs)
                for name in ("dimension", "dimension_low", "dimension_high", "fit_min", "fit_max")
            },
            "offset_cells": (
                ("contact_direction", "offset"),
                np.array([chosen[direction] for direction in solved]),
                cf_attrs("1", "offset in cells of the scan"),
            ),
            "composite": (
                ("offset", "window_y", "window_x"),
                np.array(composites),
                cf_attrs("mm", f"composite topography h, direction {reference}"),
            ),
        },
        coords={
            "direction": directions,
            "contact_direction": solved,
            "rigid_offset": ("rigid_offset", slid, cf_attrs("mm", "shear offset v")),
            "offset": ("offset", chosen[reference] * spacing, cf_attrs("mm", "shear offset v")),
            "window_y": ("window_y", specimen.y.values[window_y], specimen.y.attrs),
            "window_x": ("window_x", specimen.x.values[window_x], specimen.x.attrs),
        },
    )


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
