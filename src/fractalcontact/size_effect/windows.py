"""Smaller windows of the same joint: how roughness, closure and strength go with size (sect. 3, 5).

The window of the specimen is cut into parts x parts equal sub-windows that do not overlap, and each
is pressed on its own, at the same nominal pressures.
"""

import numpy as np
import xarray as xr

from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.mean_plane import without_mean_planes
from ..elastic.halfspace import HalfSpace
from ..mechanics.closure import bulk_settlement
from ..mechanics.joint import composite_topography, direction_spacing
from ..mechanics.state_scalars import state_errors
from ..mechanics.states import forces_of, hardness_of
from ..mechanics.sweep import load_steps
from ..surface.specimen import cell_side, faces, nominal_area, window_slices

#: Sub-windows along each side of the window, by default: octaves and halves.
PARTS = (1, 2, 3, 4, 6, 8)
#: Sub-windows solved of each size.
MOST = 16
#: A sub-window that is pressed has at least this many cells a side, one whose sigma_z is measured
#: at least so many.
FEWEST_CELLS = 16
FEWEST_CELLS_ROUGHNESS = 4

#: Eq. 2 is fitted from so many cells to this part of the window's side unless a range is given: the
#: range of the roughness-length estimator of :mod:`roughness.dimension`.
FIRST_CELLS, LAST_PART = 8, 1 / 4


def split(heights, parts):
    """Cut a grid into parts x parts equal sub-windows without overlap.

    Parameters
    ----------
    heights : (ny, nx) array_like
    parts : int

    Returns
    -------
    (parts**2, ny // parts, nx // parts) ndarray
        Row by row. Cells that do not divide are left at the edges, as evenly as can be.
    """
    heights = np.asarray(heights)
    ny, nx = (n // parts for n in heights.shape)
    first_y, first_x = _first_cells(heights.shape, parts)
    middle = heights[first_y : first_y + parts * ny, first_x : first_x + parts * nx]
    return middle.reshape(parts, ny, parts, nx).swapaxes(1, 2).reshape(parts**2, ny, nx)


def _first_cells(shape, parts):
    return [(n - parts * (n // parts)) // 2 for n in shape]


def spread_windows(parts, most):
    """Which of parts x parts sub-windows to take: at most ``most``, on an even lattice.

    Returns
    -------
    (n,) int ndarray
        Places in what :func:`split` returns.
    """
    along = min(parts, max(1, int(np.sqrt(most))))
    place = ((np.arange(along) + 0.5) * parts / along).astype(int)
    return (place[:, np.newaxis] * parts + place).ravel()


def window_states(
    specimen,
    direction,
    cells,
    settings,
    solver,
    parts=PARTS,
    most=MOST,
    *,
    seated=False,
):
    """Press sub-windows of several sizes at some offsets, under the study's dilatancy loads.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : str
    cells : (n,) int array_like
        Offsets in cells, ascending.
    settings : dict
        From :func:`study.configuration.resolve_settings`. Its ``dilatancy_loads`` are taken as
        nominal pressures: forces there act on the whole window.
    solver : dict
        ``rtol`` and ``kernel``.
    parts : sequence of int
        Sub-windows along each side. Sizes below `FEWEST_CELLS` a side are left out, but for the
        whole window.
    most : int
        Sub-windows solved of each size.
    seated : bool
        Remove the mean plane of each sub-window before pressing it, as if its blocks could turn.

    Returns
    -------
    xr.Dataset
        :data:`STATES` over (part, window, offset, load) and :data:`SHAPES` over (part, window,
        offset), NaN where there are fewer sub-windows; ``side`` b (part), the square root of their
        area. And ``face_sigma_z`` (scale) and ``sigma_z_all`` (offset, scale) with the interval of
        their mean over all sub-windows of many more sizes (``scale_side``), see
        :func:`roughness_by_size`.

    Raises
    ------
    NotConverged
        If a state could not be verified; the message names it.

    Notes
    -----
    By default the composite topography of a sub-window is pressed as it lies in the whole one. The
    blocks of the model do not turn (sect. 4), and only so the states of the parts can be held
    against those of the whole, of which they are pieces. A laboratory would seat a specimen of that
    size; the part of its closure that comes from tilt alone then vanishes.
    """
    cells = np.asarray(cells, int)
    area = nominal_area(specimen)
    pressures = forces_of(settings["dilatancy_loads"], area) / area
    shape = composite_topography(specimen, direction, 0).shape
    parts = [n for n in parts if n == 1 or min(shape) // n >= FEWEST_CELLS]
    chosen = [spread_windows(n, most) for n in parts]
    dims = (len(parts), max(map(len, chosen), default=0), len(cells), len(pressures))
    states = {name: np.full(dims, np.nan) for name in STATES}
    shapes = {name: np.full(dims[:3], np.nan) for name in SHAPES}
    settlement = np.full((len(parts), len(pressures)), np.nan)
    sides = np.full((len(parts), 2), np.nan)
    spacing = np.array([specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]])
    solving = {"rtol": solver["rtol"], "hardness": hardness_of(settings, specimen)}
    for k, n in enumerate(parts):
        sub = tuple(side // n for side in shape)
        sides[k] = sub * spacing
        space = HalfSpace(sub, spacing, settings["material"]["e_star"], kernel=solver["kernel"])
        forces = pressures * sides[k].prod()
        settlement[k] = bulk_settlement(forces, space.modulus, *sides[k])
        mated = _sub_windows(specimen, direction, 0, n, chosen[k], seated)
        for i, offset in enumerate(cells):
            composites = _sub_windows(specimen, direction, offset, n, chosen[k], seated)
            opened = composites.max(axis=(1, 2)) - mated.max(axis=(1, 2))
            taken = slice(0, len(composites))
            shapes["rigid_opening"][k, taken, i] = opened
            shapes["sigma_z"][k, taken, i] = local_roughness(composites)
            shapes["tilt_share"][k, taken, i] = tilt_share(composites)
            for j, composite in enumerate(composites):
                where = f"{n} x {n} parts, sub-window {chosen[k][j]}, offset {offset} cells"
                found = _pressed(composite, space, forces, settlement[k], solving, where)
                for name, values in found.items():
                    states[name][k, j, i] = values
    made = cells * direction_spacing(specimen, direction)
    result = xr.Dataset(
        {
            **{
                name: (("part", "window", "offset", "load"), values, cf_attrs(*STATES[name]))
                for name, values in states.items()
            },
            **{
                name: (("part", "window", "offset"), values, cf_attrs(*SHAPES[name]))
                for name, values in shapes.items()
            },
            "side": (
                "part",
                np.sqrt(sides.prod(axis=1)),
                cf_attrs("mm", "side b of the sub-windows"),
            ),
            "side_along": (
                "part",
                sides[:, 1 if direction in ("E", "W") else 0],
                cf_attrs("mm", "length of the sub-windows along the sliding"),
            ),
            "bulk_settlement": (
                ("part", "load"),
                settlement,
                cf_attrs("mm", "bulk settlement w_b of a sub-window"),
            ),
            "nominal_pressure": ("load", pressures, cf_attrs("MPa", "nominal pressure sigma_n")),
        },
        coords={
            "part": ("part", parts, cf_attrs("1", "sub-windows along a side of the window")),
            "offset": ("offset", made, cf_attrs("mm", "shear offset v")),
            "load": ("load", pressures * area, cf_attrs("N", "force on the whole window")),
            "direction": direction,
        },
        attrs={"opposite": specimen.attrs["opposite"], "seated": int(seated)},
    )
    return result.merge(roughness_by_size(specimen, direction, cells))


#: What is kept of every state of a sub-window: name, unit, long name.
STATES = {
    "closure": ("mm", "closure w from first touch of the sub-window"),
    "interface_closure": ("mm", "interface closure w_int = w - w_b of the sub-window"),
    "area": ("mm2", "real contact area A_r"),
    "area_share": ("1", "real contact area A_r / A_0 of the sub-window"),
    "stiffness": ("N/mm", "normal stiffness dF/dw"),
    "interface_compliance": ("mm/MPa", "compliance of the interface d w_int / d sigma"),
    "interface_closure_error": ("mm", "interface closure w_int, error by the solver"),
    "area_share_error": ("1", "real contact area A_r / A_0, error by the solver"),
    "interface_compliance_error": ("mm/MPa", "compliance of the interface, error by the solver"),
}

#: What is kept of every sub-window at an offset.
SHAPES = {
    "sigma_z": ("mm", "rms of the composite topography about its own mean plane"),
    "tilt_share": ("1", "part of the variance of the composite topography that is tilt"),
    "rigid_opening": ("mm", "rigid dilatancy delta_r of the sub-window"),
}


def _sub_windows(specimen, direction, cells, parts, chosen, seated):
    """Composite topographies (n, ny, nx) of the sub-windows chosen."""
    windows = split(composite_topography(specimen, direction, cells), parts)[chosen]
    return without_mean_planes(windows) if seated else windows


def _pressed(composite, space, forces, settlement, solving, where):
    """States of one sub-window under rising loads; name to (n_load,) values."""
    ny, nx = space.shape
    area = space.cell_area * ny * nx
    found = {name: np.full(len(forces), np.nan) for name in STATES}
    for j, state in enumerate(load_steps(composite, space, forces, solving, where)):
        for name in ("closure", "area", "stiffness"):
            found[name][j] = getattr(state, name)
        off = state_errors(state)
        found["interface_closure_error"][j] = off["closure_error"]
        found["area_share_error"][j] = off["area_error"] / area
        stiffness_error = off["stiffness_error"]
        found["interface_compliance_error"][j] = stiffness_error * area / state.stiffness**2
    found["area_share"] = found["area"] / area
    # Faces that match everywhere have nothing to close, as in `closure.closure_curves`.
    if np.ptp(composite) == 0:
        found["interface_closure"][:] = found["interface_closure_error"][:] = 0.0
        found["interface_compliance_error"][:] = np.nan
        return found
    found["interface_closure"] = found["closure"] - settlement
    found["interface_compliance"] = area / found["stiffness"] - settlement * area / forces
    return found


# -- roughness against size (eq. 2) ----------------------------------------------------------------


def local_roughness(windows):
    """sigma_z, mm: rms height of each window about its own mean plane.

    Parameters
    ----------
    windows : (n, ny, nx) array_like
        Complete, mm.

    Returns
    -------
    (n,) ndarray
        With the three degrees of freedom of the plane taken off, as the roughness-length estimator
        of :mod:`roughness.dimension` has it.
    """
    residuals = without_mean_planes(windows)
    ny, nx = residuals.shape[1:]
    return np.sqrt(np.sum(residuals**2, axis=(1, 2)) / (ny * nx - 3))


def tilt_share(windows):
    """Part of the variance of each window that its mean plane explains; NaN where it is flat."""
    windows = np.asarray(windows, float)
    total = windows.var(axis=(1, 2))
    left = np.mean(without_mean_planes(windows) ** 2, axis=(1, 2))
    return np.where(total > 0, 1 - left / np.where(total > 0, total, 1), np.nan)


def roughness_by_size(specimen, direction, cells):
    """sigma_z of the face and of the composite topography in sub-windows of many sizes.

    Returns
    -------
    xr.Dataset
        Means over all sub-windows of a size with ``_low`` and ``_high`` (95 %): ``face_sigma_z``
        (scale) of the lower face under the window, ``sigma_z_all`` (offset, scale) of the composite
        topography. ``scale_side`` b in mm and ``scale_n``, sub-windows of that size.
    """
    lower = faces(specimen)[0][window_slices(specimen)]
    parts = _octaves_and_halves(min(lower.shape) // FEWEST_CELLS_ROUGHNESS)
    composites = [composite_topography(specimen, direction, n) for n in cells]
    nodes = np.array([np.prod([n // p for n in lower.shape]) for p in parts])
    side = cell_side(specimen) * np.sqrt(nodes)
    face = _mean_roughness([lower], parts)
    composite = _mean_roughness(composites, parts)
    result = xr.Dataset(
        {
            "scale_side": ("scale", side, cf_attrs("mm", "side b of the sub-windows")),
            "scale_n": ("scale", parts**2, cf_attrs("1", "sub-windows of that size")),
            "scale_cells": ("scale", nodes, cf_attrs("1", "cells of each")),
        }
    )
    for ending, of_face, of_composite in zip(ENDINGS, face, composite, strict=True):
        words = f"about the plane of a sub-window, mean{ENDINGS[ending]}"
        result[f"face_sigma_z{ending}"] = (
            "scale",
            of_face[0],
            cf_attrs("mm", f"rms of the lower face {words}"),
        )
        result[f"sigma_z_all{ending}"] = (
            ("offset", "scale"),
            of_composite,
            cf_attrs("mm", f"rms of the composite topography {words}"),
        )
    return result


#: A mean and the ends of its interval.
ENDINGS = {"": "", "_low": ", lower end of its 95 % interval", "_high": ", upper end"}


def _octaves_and_halves(most):
    """1, 2, 3, 4, 6, 8, 12, 16 ... up to ``most``."""
    octaves = 2 ** np.arange(int(np.log2(max(most, 1))) + 1)
    parts = np.union1d(octaves, octaves[1:] * 3 // 2)
    return parts[parts <= max(most, 1)]


def _mean_roughness(topographies, parts):
    """Mean, low and high, each (topographies, parts)."""
    table = [[mean_interval(local_roughness(split(z, n)))[:3] for n in parts] for z in topographies]
    return np.moveaxis(np.reshape(table, (len(topographies), len(parts), 3)), 2, 0)
