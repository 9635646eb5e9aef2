"""Parts of a joint, all of them pressed at one offset: what the test of eq. 6 is made from."""

import numpy as np
import xarray as xr

from ..core.labels import cf_attrs
from ..domain.renormalisation import FEWEST_NODES
from ..elastic.halfspace import HalfSpace
from ..mechanics.closure import bulk_settlement
from ..mechanics.joint import composite_topography, direction_spacing, prefractal
from ..mechanics.states import forces_of, hardness_of
from ..mechanics.sweep import load_steps
from ..surface.specimen import nominal_area
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


def press_parts(specimen, direction, cells, settings, solver, parts=PARTS, estimate=None):
    """Press all sub-windows of several sizes under the study's loads and some beyond.

    Parameters
    ----------
    specimen, direction, settings, solver, parts
        As for :func:`size_test`.
    cells : int
        Offset in cells.
    estimate : callable, optional
        Takes this dataset of the whole window alone, its domains and the parts, and returns one
        with ``delta_sigma`` (estimator, load).

    Returns
    -------
    pressed : xr.Dataset
        What was estimated, and
        ``nodes`` (part, window, resolution, step) in contact and ``nodes_error``, those that the
        solver leaves undecided; ``interface_closure`` (part, window, step) at the finest
        resolution, ``side`` b and ``windows`` (part), ``ladder_pressure`` (step) whose first steps
        are those of the loads. Steps that no window of a size needs are NaN.
    domains : (load, ny, nx) bool ndarray
        Contact domain of the whole window at the finest resolution.

    Notes
    -----
    Sub-windows are cut to whole cells of the coarsest resolution, so that all of them cover the
    same area at each.

    Doublings beyond the loads cost most, and are pressed where they are asked for: windows of side
    b' up to sigma_0 (b/b')^(2 - Delta), where eq. 6 has the sigma* of the whole, for all loads and
    estimates of Delta_sigma; and on until each of them has a larger real mean pressure than the
    whole has under any load. Without an estimate, or where the study asks for everything, Delta = 1
    is taken. One doubling is always pressed, for the slope of the curve at the largest load.
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
    n_tested = min(len(of_study) + BEYOND, len(pressures))
    solving = {"rtol": solver["rtol"], "hardness": hardness}
    spaces = {"modulus": settings["material"]["e_star"], "kernel": solver["kernel"]}
    sizes = []
    for n in parts:
        windows = _cut(composite, n, max(factors))
        size = _Size(windows, spacing, factors, pressures, spaces, solving, f"{n} x {n} parts")
        size.press(n_tested + 1)
        sizes.append(size)

    whole, found, powers = sizes[0], xr.Dataset(), np.ones(1)
    domains = np.array(whole.domains[:n_tested])
    if estimate is not None:
        found = estimate(_labelled([whole], [1], of_study[-1], n_tested, area), domains, parts)
        if solver.get("accuracy") is not None:
            powers = 2 - found["delta_sigma"].values
    largest = np.nanmax(whole.real_pressure()[0, :n_tested], initial=0.0)
    for size in sizes:
        ratio = np.sqrt(whole.sides.prod() / size.sides.prod())
        size.press_on(np.nanmax(pressures[:n_tested] * ratio**powers, initial=0.0), largest)
    pressed = _labelled(sizes, parts, of_study[-1], n_tested, area).merge(found)
    place = cells * direction_spacing(specimen, direction)
    pressed = pressed.assign_coords(
        direction=direction, offset=((), place, cf_attrs("mm", "shear offset v"))
    )
    return pressed, domains


class _Size:
    """All sub-windows of one size at all resolutions, pressed step by step.

    Parameters
    ----------
    windows : (window, ny, nx) ndarray
        Composite topographies, mm.
    spacing : (2,) ndarray
        mm.
    factors : sequence of int
        Resolutions k, the finest first.
    pressures : (step,) ndarray
        Nominal, MPa.
    spaces, solving : dict
        Options of :class:`elastic.halfspace.HalfSpace` and of
        :func:`contact.solve.solve_contact`.
    what : str
        For errors.

    Attributes
    ----------
    nodes, undecided : (window, resolution, step) ndarray
        In contact, and those of which it is not certain; NaN for steps not pressed yet.
    closure : (window, step) ndarray
        Of the interface, mm.
    domains : list of (ny, nx) bool ndarray
        Of the first window at the finest resolution, a step each.
    """

    def __init__(self, windows, spacing, factors, pressures, spaces, solving, what):
        cells = np.array(windows.shape[1:])
        self.sides, self.pressures, self.factors = cells * spacing, pressures, factors
        self.spacing = np.sqrt(spacing.prod()) * np.array(factors)
        self.loads = pressures * self.sides.prod()
        self.nodes = np.full((len(windows), len(factors), len(pressures)), np.nan)
        self.undecided = self.nodes.copy()
        self.closure = np.full((len(windows), len(pressures)), np.nan)
        self.domains, self.pressed = [], 0
        self._settlement = bulk_settlement(self.loads, spaces["modulus"], *self.sides)
        # Faces that match everywhere have nothing to close.
        self._open = [np.ptp(window) > 0 for window in windows]
        self._states = {}
        for k, factor in enumerate(factors):
            space = HalfSpace(tuple(cells // factor), tuple(spacing * factor), **spaces)
            for j, window in enumerate(windows):
                where = f"{what}, sub-window {j}, resolution {factor}"
                h = prefractal(window, factor)
                self._states[j, k] = load_steps(h, space, self.loads, solving, where)

    def press(self, steps):
        """Press every sub-window by so many steps more, as far as there are any."""
        following = range(self.pressed, min(self.pressed + steps, len(self.loads)))
        for (j, k), rising in self._states.items():
            for step, state in zip(following, rising, strict=False):
                self.nodes[j, k, step] = np.count_nonzero(state.in_contact)
                self.undecided[j, k, step] = state.ambiguous
                if k == 0:
                    interface = state.closure - self._settlement[step]
                    self.closure[j, step] = self._open[j] * interface
                    if j == 0:
                        self.domains.append(state.in_contact)
        self.pressed = following.stop

    def press_on(self, pressure, real_pressure):
        """Press on to a nominal pressure, and until every sub-window has a real mean pressure."""
        while self.pressed < len(self.pressures):
            last = self.pressed - 1
            reached = (self.real_pressure()[:, last] >= real_pressure).all()
            if reached and self.pressures[last] >= pressure * (1 - 1e-9):
                return
            self.press(1)

    def real_pressure(self):
        """:func:`real_pressure` of each sub-window, (window, step)."""
        return real_pressure(self.loads, self.nodes.swapaxes(1, 2), self.spacing)


def _labelled(sizes, parts, largest_of_study, n_tested, area):
    """The dataset of :func:`press_parts`; windows that a size does not have are NaN."""
    pressures = sizes[0].pressures
    n_windows, n_factors = max(parts) ** 2, len(sizes[0].spacing)
    nodes = np.full((len(parts), n_windows, n_factors, len(pressures)), np.nan)
    undecided = nodes.copy()
    closure = np.full((len(parts), n_windows, len(pressures)), np.nan)
    for i, size in enumerate(sizes):
        taken = slice(len(size.nodes))
        nodes[i, taken], undecided[i, taken] = size.nodes, size.undecided
        closure[i, taken] = size.closure
    s = sizes[0].spacing
    sides = [np.sqrt(size.sides.prod()) for size in sizes]
    tested = pressures[:n_tested]
    of_nodes = ("part", "window", "resolution", "step")
    closing = cf_attrs("mm", "interface closure w_int = w - w_b of a sub-window")
    beyond = cf_attrs("1", "whether the load is larger than those of the study")
    ladder = cf_attrs("MPa", "nominal pressures that every window was pressed with")
    return xr.Dataset(
        {
            "nodes": (of_nodes, nodes, cf_attrs("1", "nodes in contact")),
            "nodes_error": (
                of_nodes,
                undecided,
                cf_attrs("1", "nodes in contact, error by the solver"),
            ),
            "interface_closure": (("part", "window", "step"), closure, closing),
            "side": ("part", sides, cf_attrs("mm", "side b of the sub-windows")),
            "windows": (
                "part",
                np.square(parts),
                cf_attrs("1", "sub-windows pressed of each size"),
            ),
            "nominal_pressure": (
                "load",
                tested,
                cf_attrs("MPa", "nominal pressure sigma_0 of the whole window"),
            ),
            "beyond_study": ("load", tested > largest_of_study, beyond),
            "ladder_pressure": ("step", pressures, ladder),
            "spacing": ("resolution", s, cf_attrs("mm", "spacing s")),
        },
        coords={
            "part": ("part", parts, cf_attrs("1", "sub-windows along a side of the window")),
            "resolution": (
                "resolution",
                sizes[0].factors,
                cf_attrs("1", "multiple k of the scan's spacing"),
            ),
            "load": ("load", tested * area, cf_attrs("N", "force on the whole window")),
        },
    )


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
