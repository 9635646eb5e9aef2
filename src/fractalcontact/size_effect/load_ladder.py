"""The load ladder: all sub-windows of a joint at one offset, loaded step by step, for eq. 6."""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

from roughcontact.contact.state import ContactState

from ..core.datasets import labelled_dataset
from ..core.intervals import LEFT_OUT
from ..core.labels import cf_attrs
from ..core.limits import CORRECTED_NODES, RESOLVED_NODES
from ..core.per_curve import stacked
from ..core.ranges import within
from ..core.settings import JointSettings
from ..domain.renormalisation import MIN_NODES_PER_RESOLUTION
from ..joint.joint import prefractal
from ..states.area_sampling import state_area_sampling
from ..states.left_out import PARTS_LEFT_OUT, fractions_left, part_ends
from ..states.loading import JointLoading
from ..states.settlement import interface_closure
from ..states.state_scalars import state_area
from ..states.states import SCALARS, SOLVER_ERROR
from ..states.sweep import load_steps
from .division import PARTS, solvable_parts, split
from .sub_windows import SubWindows

#: Fewest nodes per side of the smallest sub-windows at a resolution that is used.
MIN_NODES_PER_SIDE = 12
#: Most doublings of the study's largest load at which the whole window is tested while sub-windows
#: hold too few nodes: loads that no rock would stand as an elastic body.
TESTED_DOUBLINGS = 3
#: Most further doublings, which small windows may need to have the sigma* of the whole; see
#: :func:`solve_sub_windows` for when they are solved.
SPARE_DOUBLINGS = 3
#: Largest load, as a fraction of the load that a window carries at the hardness.
LARGEST_FRACTION = 0.98

#: Estimator of Delta_sigma: takes the dataset of :func:`solve_sub_windows` of the whole window
#: alone, its domains and the parts; returns a dataset with ``delta_sigma`` (estimator,
#: normal_force).
Dimensions = Callable[[xr.Dataset, np.ndarray, Sequence[int]], xr.Dataset]


def solve_sub_windows(
    loading: JointLoading[JointSettings],
    parts: Sequence[int] = PARTS,
    estimate: Dimensions | None = None,
) -> tuple[xr.Dataset, np.ndarray]:
    """States of all sub-windows of several sizes under the study's loads and some beyond.

    At the one offset of ``loading``, of the divisions among ``parts`` that
    :func:`size_effect.division.solvable_parts` gives. The dataset has what ``estimate`` returned,
    :data:`_OF_SIZES` by ``part``, NaN for steps that no window of a size needs, ``whole_area``,
    ``whole_area_sampling`` and ``whole_left`` of :mod:`states.left_out`, and ``ladder_pressure``
    (step), whose first steps are those of the loads. Second come the contact domains (load, ny, nx)
    of the whole window at the finest resolution. Raises `NotConverged`.

    Sub-windows are cut to whole cells of the coarsest resolution, so that all of them cover the
    same area at each.

    Doublings beyond the loads cost most, and the ladder is extended by them where they are needed:
    the whole is tested beyond the study until sub-windows of all sizes hold nodes enough, and
    windows of side b' up to sigma_0 (b/b')^(2 - Delta), where eq. 6 has the sigma* of the whole,
    for all loads and estimates of Delta_sigma; and on until each of them has a larger real mean
    pressure than the whole has under any load. Without an estimate, or where the study requests all
    states, Delta = 1 is taken. One doubling is always solved, for the slope of the curve at the
    largest load.
    """
    settings, area = loading.settings, loading.area
    composite = loading.composite(loading.cells.item())
    parts = solvable_parts(parts, loading.shape)
    smallest = min(loading.shape) // max(parts)
    finest = min(settings.resolutions)
    factors = [
        k for k in settings.resolutions if k == finest or smallest // k >= MIN_NODES_PER_SIDE
    ]
    of_study = loading.forces(settings.loads) / area
    pressures = _ladder(of_study, loading.solving["hardness"])
    # A stiffness costs a further solve; it is computed at the dilatancy loads alone.
    looked_at = loading.forces(settings.dilatancy_loads) / area
    compliant = np.isclose(pressures[:, np.newaxis], looked_at, rtol=1e-9).any(axis=1)
    sizes = []
    for n in parts:
        windows = _cut(composite, n, max(factors))
        where = f"{n} x {n} parts"
        size = _LoadedSize(loading, windows, pressures, where, factors, compliant)
        size.extend(len(of_study))
        sizes.append(size)
    n_tested, most = len(of_study), min(len(of_study) + TESTED_DOUBLINGS, len(pressures))
    while n_tested < most and not all(size.resolved() for size in sizes):
        n_tested += 1
        for size in sizes:
            size.extend(1)
    for size in sizes:
        size.extend(1)

    whole, estimated, powers = sizes[0], xr.Dataset(), np.ones(1)
    domains = np.array(whole.domains[:n_tested])
    if estimate is not None:
        estimated = estimate(_labelled([whole], [1], of_study[-1], n_tested, area), domains, parts)
        if loading.solver.accuracy is not None:
            powers = 2 - estimated["delta_sigma"].values
    largest = np.nanmax(whole.real_pressure()[0, :n_tested], initial=0.0)
    for size in sizes:
        ratio = np.sqrt(whole.sides.prod() / size.sides.prod())
        size.extend_to(np.nanmax(pressures[:n_tested] * ratio**powers, initial=0.0), largest)
    states = _labelled(sizes, parts, of_study[-1], n_tested, area).merge(estimated)
    offset = ((), loading.offsets.item(), cf_attrs("mm", "shear offset v"))
    return states.assign_coords(direction=loading.direction, offset=offset), domains


class _LoadedSize(SubWindows):
    """All sub-windows of one size at all resolutions, and what eq. 6 takes of their states.

    Compliance is computed at the steps ``compliant`` (step,), where `RESOLVED_NODES` nodes touch.

    Attributes
    ----------
    nodes, ambiguous : (window, resolution, step) ndarray
        In contact, and those of which it is not certain; NaN for steps not solved yet.
    corrected : (window, resolution, step) ndarray
        Corrected real contact area, mm2; of several windows at the finest resolution alone.
    sampling : (resolution, step) ndarray
        Relative sampling error of that of a window alone.
    left : (resolution, step, left_out) ndarray
        Fractions of that area, see :mod:`states.left_out`.
    finest : dict of str to (window, step) ndarray
        ``interface_closure``, mm, and :data:`OF_WINDOWS`.
    domains : list of (ny, nx) bool ndarray
        Domains of a window alone at the finest resolution, one for each step.
    bulk_compliance : float
        Bulk settlement over sigma_0, mm/MPa.
    """

    def __init__(
        self,
        loading: JointLoading[JointSettings],
        windows: np.ndarray,
        pressures: np.ndarray,
        where: str,
        factors: Sequence[int],
        compliant: np.ndarray,
    ) -> None:
        super().__init__(loading, windows, pressures, where, factors)
        self.spacing = np.sqrt(loading.spacing.prod()) * np.array(factors)
        self.nodes = np.full((len(windows), len(factors), len(pressures)), np.nan)
        self.ambiguous, self.corrected = self.nodes.copy(), self.nodes.copy()
        names = ("interface_closure", *OF_WINDOWS)
        self.finest = {name: np.full((len(windows), len(pressures)), np.nan) for name in names}
        self.sampling = self.nodes[0].copy()
        self.left = np.full((*self.sampling.shape, PARTS_LEFT_OUT), np.nan)
        self._compliant = compliant
        self.domains: list[np.ndarray] = []
        self._ends: list[np.ndarray] = []
        self.bulk_compliance = self.settlement[0] / pressures[0]

    def keep(self, state: ContactState, window: int, resolution: int, step: int) -> None:
        """Store the numbers of a state and, where the window is loaded alone, its domain."""
        place, alone = (window, resolution, step), len(self.nodes) == 1
        self.nodes[place] = np.count_nonzero(state.in_contact)
        self.ambiguous[place] = state.ambiguous
        if resolution == 0 or alone:
            self.corrected[place] = state_area(state)
        if alone:
            domain, factor = state.in_contact, self.factors[resolution]
            if resolution == 0:
                self.domains.append(domain)
                self._ends.append(part_ends(domain, factor))
            self.sampling[resolution, step] = state_area_sampling(state)
            self.left[resolution, step] = fractions_left(domain, factor, self._ends[step])
        if resolution == 0:
            for name, value in self._of_state(state, window, step).items():
                self.finest[name][window, step] = value

    def _of_state(self, state: ContactState, window: int, step: int) -> dict[str, float]:
        """Fields of a state kept at the finest resolution."""
        flush, settlement = self.flush[window], self.settlement[step]
        area, domain = self.sides.prod(), state.in_contact
        ny, nx = domain.shape
        middle = np.s_[ny // 4 : ny - ny // 4, nx // 4 : nx - nx // 4]
        even = state.pressure[middle].size / state.pressure.size
        compliance = np.nan
        resolved = self._compliant[step] and np.count_nonzero(domain) >= RESOLVED_NODES
        if resolved and not flush and state.stiffness > 0:
            compliance = area / state.stiffness - self.bulk_compliance
        return {
            "interface_closure": interface_closure(state.closure, settlement, flush),
            "area_fraction": self.corrected[window, 0, step] / area,
            "interface_compliance": compliance,
            "mean_gap": 0.0 if flush else float(state.gap.mean()),
            "central_load": float(state.pressure[middle].sum() / state.pressure.sum() / even),
        }

    def extend_to(self, pressure: float, real_pressure: float) -> None:
        """Extend to a nominal pressure, and until every sub-window has a real mean pressure."""
        while self.solved < len(self.pressures):
            last = self.solved - 1
            reached = (self.real_pressure()[:, last] >= real_pressure).all()
            if reached and within(self.pressures[last], pressure, np.inf):
                return
            self.extend(1)

    def resolved(self) -> bool:
        """True if the sub-windows hold enough nodes under the last load for every test.

        Every sub-window needs enough for its corrected area; sigma* needs enough on the average at
        every resolution.
        """
        nodes = self.nodes[:, :, self.solved - 1]
        fewest, mean = nodes[:, 0].min(), nodes.mean(axis=0).min()
        return bool(fewest >= CORRECTED_NODES and mean >= MIN_NODES_PER_RESOLUTION)

    def real_pressure(self) -> np.ndarray:
        """:func:`real_pressure` of each sub-window, (window, step)."""
        return real_pressure(self.forces, self.nodes.swapaxes(1, 2), self.spacing)


#: Quantities of every sub-window at the finest resolution, for
#: :mod:`size_effect.size_law`: unit, long name.
OF_WINDOWS = {
    "area_fraction": ("1", "corrected real contact area A_r/A_0 of a sub-window"),
    "interface_compliance": ("mm/MPa", "compliance d w_int / d sigma_0 of a sub-window"),
    "mean_gap": ("mm", "mean gap of a sub-window"),
    "central_load": ("1", "load on the central half of a sub-window over that of an even spread"),
}

_WINDOW, _NODES = ("window", "step"), ("window", "resolution", "step")
#: Quantities of every size: unit, long name, dimensions.
_OF_SIZES = {
    "nodes": ("1", "nodes in contact", *_NODES),
    "nodes_error": ("1", f"nodes in contact, {SOLVER_ERROR}", *_NODES),
    "interface_closure": ("mm", "interface closure w_int = w - w_b of a sub-window", *_WINDOW),
    **{name: (*words, *_WINDOW) for name, words in OF_WINDOWS.items()},
    "bulk_compliance": ("mm/MPa", "bulk settlement of a sub-window over sigma_0"),
    "side": ("mm", "side b of the sub-windows"),
    "windows": ("1", "sub-windows solved of each size"),
}
_TABLE = {
    "whole_area": (
        ("resolution", "step"),
        "mm2",
        "corrected real contact area of the whole window",
    ),
    "whole_area_sampling": (("resolution", "step"), *SCALARS["area_sampling"]),
    "whole_left": (("resolution", "step", LEFT_OUT), "1", "fraction of it without a part"),
    "nominal_pressure": ("normal_force", "MPa", "nominal pressure sigma_0 of the whole window"),
    "beyond_study": ("normal_force", "1", "whether the load is larger than those of the study"),
    "ladder_pressure": ("step", "MPa", "nominal pressures that every window was loaded with"),
    "spacing": ("resolution", "mm", "spacing s"),
}


def _labelled(
    sizes: Sequence[_LoadedSize],
    parts: Sequence[int],
    largest_of_study: float,
    n_tested: int,
    area: float,
) -> xr.Dataset:
    """The dataset of :func:`solve_sub_windows`; windows that a size does not have are NaN."""
    whole = sizes[0]
    tested = whole.pressures[:n_tested]
    values = {
        "whole_area": whole.corrected[0],
        "whole_area_sampling": whole.sampling,
        "whole_left": whole.left,
        "nominal_pressure": tested,
        "beyond_study": tested > largest_of_study,
        "ladder_pressure": whole.pressures,
        "spacing": whole.spacing,
    }
    of_sizes = [
        {
            "nodes": size.nodes,
            "nodes_error": size.ambiguous,
            "bulk_compliance": size.bulk_compliance,
            "side": np.sqrt(size.sides.prod()),
            "windows": len(size.nodes),
            **size.finest,
        }
        for size in sizes
    ]
    coords = {
        "part": ("part", parts, cf_attrs("1", "sub-windows along a side of the window")),
        "resolution": (
            "resolution",
            whole.factors,
            cf_attrs("1", "multiple k of the scan's spacing"),
        ),
        "normal_force": ("normal_force", tested * area, cf_attrs("N", "force on the whole window")),
    }
    states = labelled_dataset(_TABLE, values, coords=coords)
    return states.assign(stacked(of_sizes, _OF_SIZES, ["part"]))


def real_pressure(force: np.ndarray, nodes: np.ndarray, spacing: np.ndarray) -> np.ndarray:
    """Geometric mean of sigma_n over the resolutions (..., step), MPa.

    Forces (..., step) are in N, nodes (..., step, resolution) those in contact, the mean number for
    several windows together, spacings (resolution,) in mm. NaN where there are fewer than
    `MIN_NODES_PER_RESOLUTION` nodes at a resolution.
    """
    nodes = np.where(within(nodes, MIN_NODES_PER_RESOLUTION, np.inf), nodes, np.nan)
    return np.exp(np.log(force[..., np.newaxis] / (nodes * spacing**2)).mean(axis=-1))


def whole_areas(
    loading: JointLoading[JointSettings], states: xr.Dataset, domains: np.ndarray
) -> xr.Dataset:
    """Corrected real area of the whole window at all resolutions of the study.

    ``states`` and ``domains`` are those of :func:`solve_sub_windows`, which has solved some of the
    resolutions. ``area_corrected``, mm2, ``area_sampling`` and ``nodes`` (resolution,
    normal_force), and ``left`` (resolution, normal_force, left_out) of :mod:`states.left_out`.
    """
    composite = loading.composite(loading.cells.item())
    factors, loads = loading.settings.resolutions, states["normal_force"]
    solved = states.sel(part=1).isel(window=0, step=slice(len(loads)))
    # solve_sub_windows cuts the window to whole cells of its coarsest resolution.
    uncut = not any(n % solved["resolution"].max() for n in composite.shape)
    ends = [part_ends(domain, min(factors)) for domain in domains]
    rows, left = [], []
    for factor in factors:
        if uncut and factor in solved["resolution"]:
            of_factor = solved.sel(resolution=factor)
            names = ("whole_area", "whole_area_sampling", "nodes")
            rows.append(np.array([of_factor[name].values for name in names]))
            left.append(of_factor["whole_left"].values)
            continue
        h = prefractal(composite, factor)
        space = loading.half_space(h.shape, factor)
        steps = load_steps(h, space, loads.values, loading.solving, f"resolution {factor}")
        numbers, without = [], []
        for state, of_load in zip(steps, ends, strict=True):
            domain = state.in_contact
            numbers.append((state_area(state), state_area_sampling(state), domain.sum()))
            without.append(fractions_left(domain, factor, of_load))
        rows.append(np.transpose(numbers))
        left.append(np.array(without))
    dims = ("resolution", "normal_force")
    columns = np.swapaxes(np.array(rows), 0, 1)
    table = zip(("area_corrected", "area_sampling", "nodes"), columns, strict=True)
    areas = {name: (dims, values) for name, values in table}
    coords = {"resolution": factors, "normal_force": loads}
    return xr.Dataset(areas, coords).assign(left=((*dims, LEFT_OUT), np.array(left)))


def _ladder(pressures: np.ndarray, hardness: float) -> np.ndarray:
    """The study's pressures and doublings of the largest, as far as the hardness lets them."""
    beyond = pressures[-1] * 2.0 ** np.arange(1, TESTED_DOUBLINGS + SPARE_DOUBLINGS + 1)
    return np.r_[pressures, beyond[beyond < LARGEST_FRACTION * hardness]]


def _cut(composite: np.ndarray, parts: int, multiple: int) -> np.ndarray:
    """All sub-windows (n, ny, nx), cut to a multiple of cells."""
    windows = split(composite, parts)
    ny, nx = (n // multiple * multiple for n in windows.shape[1:])
    return windows[:, :ny, :nx]
