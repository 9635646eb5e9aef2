"""Parts of a joint, all of them pressed at one offset: what the test of eq. 6 is made from."""

import numpy as np
import xarray as xr

from .closure import bulk_settlement
from .halfspace import HalfSpace
from .joint import composite_topography, direction_spacing, prefractal
from .labels import about
from .scaling import FEWEST_NODES
from .specimen import nominal_area
from .states import forces_of, hardness_of
from .sweep import load_steps
from .windows import FEWEST_CELLS, PARTS, split

#: A resolution is used if the smallest sub-windows keep so many nodes a side at it.
FEWEST_ACROSS = 12
#: The whole window is tested at the study's loads and at so many doublings of the largest: loads no
#: rock would stand as an elastic body, but where small windows hold nodes enough.
BEYOND = 3
#: So many more doublings may be needed for small windows to have the sigma* of the whole; see
#: :func:`press_parts` for when they are pressed.
DOUBLINGS = 3
#: Loads stay below this part of what the hardness lets a window carry.
LARGEST_PART = 0.98


def press_parts(specimen, direction, cells, settings, solver, parts=PARTS):
    """Press all sub-windows of several sizes under the study's loads and some beyond.

    Parameters
    ----------
    specimen, direction, settings, solver, parts
        As for :func:`size_test`.
    cells : int
        Offset in cells.

    Returns
    -------
    pressed : xr.Dataset
        ``nodes`` (part, window, resolution, step) in contact, ``interface_closure`` (part, window,
        step) at the finest resolution, ``side`` b and ``windows`` (part), ``ladder_pressure``
        (step) whose first steps are those of the loads. Steps that no window of a size needs are
        NaN.
    domains : (load, ny, nx) bool ndarray
        Contact domain of the whole window at the finest resolution.

    Notes
    -----
    Sub-windows are cut to whole cells of the coarsest resolution, so that all of them cover the
    same area at each.

    Doublings beyond the loads cost most, and are pressed where they can be asked for: n x n parts
    up to n times the largest load, as eq. 6 has it where Delta_sigma is 1 or more, and on until
    each of them has a larger real mean pressure than the whole has under any load. One doubling is
    always pressed, for the slope of the curve at the largest load.
    """
    composite = composite_topography(specimen, direction, cells)
    spacing = np.array([specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]])
    parts = [n for n in parts if n == 1 or min(composite.shape) // n >= FEWEST_CELLS]
    smallest = min(composite.shape) // max(parts)
    factors = [k for k in settings["resolutions"] if k == 1 or smallest // k >= FEWEST_ACROSS]
    hardness = hardness_of(settings, specimen)
    area = nominal_area(specimen)
    of_study = forces_of(settings["loads"], area) / area
    pressures = _ladder(of_study, hardness)
    tested = pressures[: len(of_study) + BEYOND]
    shape = (len(parts), max(parts) ** 2, len(factors), len(pressures))
    nodes, closure = np.full(shape, np.nan), np.full((*shape[:2], shape[3]), np.nan)
    sides = np.empty((len(parts), 2))
    solving = {"rtol": solver["rtol"], "hardness": hardness}
    s = np.sqrt(spacing.prod()) * np.array(factors)
    # Tested loads and the next doubling window by window, further doublings one by one.
    more = range(len(tested) + 1, len(pressures))
    rounds = [range(more.start), *(range(step, step + 1) for step in more)]
    domains, largest = [], np.inf
    for i, n in enumerate(parts):
        windows = _cut(composite, n, max(factors))
        sub = np.array(windows.shape[1:])
        sides[i] = sub * spacing
        loads = pressures * sides[i].prod()
        modulus = settings["material"]["e_star"]
        settlement = bulk_settlement(loads, modulus, *sides[i])
        states = {}
        for k, factor in enumerate(factors):
            space = HalfSpace(
                tuple(sub // factor), tuple(spacing * factor), modulus, kernel=solver["kernel"]
            )
            for j, window in enumerate(windows):
                where = f"{n} x {n} parts, sub-window {j}, resolution {factor}"
                h = prefractal(window, factor)
                states[j, k] = load_steps(h, space, loads, solving, where)

        for steps in rounds:
            if steps.start > len(tested):
                real = real_pressure(loads, nodes[i, : n**2].swapaxes(1, 2), s)
                if n == 1:
                    largest = np.nanmax(real[0, : len(tested)], initial=0.0)
                asked = pressures[steps.start - 1] < n * tested[-1] * (1 - 1e-9)
                if not asked and (real[:, steps.start - 1] >= largest).all():
                    break
            for (j, k), rising in states.items():
                for step, state in zip(steps, rising, strict=False):
                    nodes[i, j, k, step] = np.count_nonzero(state.in_contact)
                    if k == 0:
                        # Faces that match everywhere have nothing to close.
                        settled = np.ptp(windows[j]) > 0
                        closure[i, j, step] = settled * (state.closure - settlement[step])
                        if n == 1 and step < len(tested):
                            domains.append(state.in_contact)
    pressed = xr.Dataset(
        {
            "nodes": (
                ("part", "window", "resolution", "step"),
                nodes,
                about("1", "nodes in contact"),
            ),
            "interface_closure": (
                ("part", "window", "step"),
                closure,
                about("mm", "interface closure w_int = w - w_b of a sub-window"),
            ),
            "side": ("part", np.sqrt(sides.prod(axis=1)), about("mm", "side b of the sub-windows")),
            "windows": ("part", np.square(parts), about("1", "sub-windows pressed of each size")),
            "nominal_pressure": (
                "load",
                tested,
                about("MPa", "nominal pressure sigma_0 of the whole window"),
            ),
            "beyond_study": (
                "load",
                tested > of_study[-1],
                about("1", "whether the load is larger than those of the study"),
            ),
            "ladder_pressure": (
                "step",
                pressures,
                about("MPa", "nominal pressures that every window was pressed with"),
            ),
            "spacing": (
                "resolution",
                s,
                about("mm", "spacing s"),
            ),
        },
        coords={
            "part": ("part", parts, about("1", "sub-windows along a side of the window")),
            "resolution": ("resolution", factors, about("1", "multiple k of the scan's spacing")),
            "load": ("load", tested * area, about("N", "force on the whole window")),
            "direction": direction,
            "offset": (
                (),
                cells * direction_spacing(specimen, direction),
                about("mm", "shear offset v"),
            ),
        },
    )
    return pressed, np.array(domains)


def real_pressure(force, nodes, spacing):
    """Geometric mean of sigma_n over the resolutions, MPa.

    Parameters
    ----------
    force : (..., step) ndarray
        N.
    nodes : (..., step, resolution) ndarray
        In contact; the mean number for several windows together.
    spacing : (resolution,) ndarray
        mm.

    Returns
    -------
    (..., step) ndarray
        NaN where there are fewer than `FEWEST_NODES` nodes at a resolution.
    """
    nodes = np.where(nodes >= FEWEST_NODES - 1e-9, nodes, np.nan)
    return np.exp(np.log(force[..., np.newaxis] / (nodes * spacing**2)).mean(axis=-1))


def whole_areas(specimen, direction, cells, settings, solver, pressed):
    """Real area of the whole window at all resolutions of the study.

    Parameters
    ----------
    specimen, direction, cells, settings, solver
        As for :func:`press_parts`.
    pressed : xr.Dataset
        From :func:`press_parts`, which has solved some of the resolutions.

    Returns
    -------
    xr.DataArray (resolution, load)
        mm2.
    """
    composite = composite_topography(specimen, direction, cells)
    spacing = np.array([specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]])
    factors = settings["resolutions"]
    solving = {"rtol": solver["rtol"], "hardness": hardness_of(settings, specimen)}
    loads = pressed["load"]
    known = pressed["nodes"].sel(part=1).isel(window=0, step=slice(len(loads)))
    # That of press_parts is cut to whole cells of its coarsest resolution.
    uncut = not any(n % known["resolution"].max() for n in composite.shape)
    areas = []
    for factor in factors:
        if uncut and factor in known["resolution"]:
            areas.append(known.sel(resolution=factor).values * np.prod(spacing * factor))
            continue
        h = prefractal(composite, factor)
        space = HalfSpace(
            h.shape,
            tuple(spacing * factor),
            settings["material"]["e_star"],
            kernel=solver["kernel"],
        )
        states = load_steps(h, space, loads.values, solving, f"resolution {factor}")
        areas.append([state.area for state in states])
    coords = {"resolution": factors, "load": loads}
    return xr.DataArray(areas, dims=("resolution", "load"), coords=coords)


def _ladder(pressures, hardness):
    """The study's pressures and doublings of the largest, as far as the hardness lets them."""
    beyond = pressures[-1] * 2.0 ** np.arange(1, BEYOND + DOUBLINGS + 1)
    return np.r_[pressures, beyond[beyond < LARGEST_PART * hardness]]


def _cut(composite, parts, multiple):
    """All sub-windows (n, ny, nx), cut to a multiple of cells."""
    windows = split(composite, parts)
    ny, nx = (n // multiple * multiple for n in windows.shape[1:])
    return windows[:, :ny, :nx]
