"""The joint: one face slid over the other, its composite topography, dilatancy and pre-fractals.

Signs are those of PHYSICS.md: the window stays with the upper block, which slides by v towards a
direction d; h(xi; v, d) = z_l(xi + v d) - z_u(xi), and the largest h touches first.
"""

import numpy as np
import xarray as xr

from .errors import InputError
from .specimen import faces, largest_offset, window_slices

#: Steps (y, x) of one cell towards East, North, West and South; "none" for a joint that cannot
#: slide, a surface against a rigid plane.
STEPS = {"E": (0, 1), "N": (1, 0), "W": (0, -1), "S": (-1, 0), "none": (0, 0)}

#: Offsets that "auto" places between one cell and the largest possible, in geometric steps.
AUTOMATIC_OFFSETS = 8


def composite_topography(specimen, direction, cells):
    """Composite topography h of the window at an offset.

    Parameters
    ----------
    specimen : xr.Dataset
        From :func:`fractalcontact.specimen.make_specimen`.
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


def describe_joint(specimen, settings):
    """Offsets, rigid dilatancy and composite topographies of a specimen.

    Parameters
    ----------
    specimen : xr.Dataset
    settings : dict
        From :func:`fractalcontact.study.resolve_settings`.

    Returns
    -------
    xr.Dataset
        ``rigid_dilatancy`` and ``composite_rms`` (direction, rigid_offset) at every cell up to the
        largest offset; ``offset_cells`` (direction, offset) of the contact solves; ``composite``
        (offset, window_y, window_x) for the first direction whose contact is solved.

    Raises
    ------
    InputError
        As :func:`choose_offsets`.
    """
    directions = settings["directions"]
    solved = settings["contact_directions"]
    every = list(dict.fromkeys([*directions, *solved]))
    chosen = choose_offsets(specimen, settings["offsets"], every)
    reference = solved[0]
    spacing = direction_spacing(specimen, reference)
    largest = int(max(chosen[reference]))
    dilatancy = np.full((len(directions), largest + 1), np.nan)
    spread = dilatancy.copy()
    for i, direction in enumerate(directions):
        ratio = spacing / direction_spacing(specimen, direction)
        cells = np.round(np.arange(largest + 1) * ratio).astype(int)
        dilatancy[i], spread[i] = rigid_dilatancy(specimen, direction, cells)
    composites = [composite_topography(specimen, reference, n) for n in chosen[reference]]
    window_y, window_x = window_slices(specimen)
    return xr.Dataset(
        {
            "rigid_dilatancy": (
                ("direction", "rigid_offset"),
                dilatancy,
                {"units": "mm", "long_name": "rigid dilatancy delta_r"},
            ),
            "composite_rms": (
                ("direction", "rigid_offset"),
                spread,
                {"units": "mm", "long_name": "standard deviation of the composite topography"},
            ),
            "offset_cells": (
                ("contact_direction", "offset"),
                np.array([chosen[direction] for direction in solved]),
                {"units": "1", "long_name": "offset in cells of the scan"},
            ),
            "composite": (
                ("offset", "window_y", "window_x"),
                np.array(composites),
                {"units": "mm", "long_name": f"composite topography h, direction {reference}"},
            ),
        },
        coords={
            "direction": directions,
            "contact_direction": solved,
            "rigid_offset": (
                "rigid_offset",
                np.arange(largest + 1) * spacing,
                {"units": "mm", "long_name": "shear offset v"},
            ),
            "offset": (
                "offset",
                chosen[reference] * spacing,
                {"units": "mm", "long_name": "shear offset v"},
            ),
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
