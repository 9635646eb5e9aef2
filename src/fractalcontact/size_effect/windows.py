"""Smaller windows of the same joint: how roughness, closure and strength go with size (sect. 3, 5).

The window of the specimen is cut into parts x parts equal sub-windows that do not overlap, and each
is solved on its own, at the same nominal pressures.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from roughcontact.contact.state import ContactState

from ..core.datasets import labelled_dataset
from ..core.labels import cf_attrs
from ..core.settings import JointSettings
from ..domain.clusters import largest_void
from ..domain.random_nodes import random_nodes
from ..joint.joint import sliding_axis
from ..states.loading import JointLoading
from ..states.settlement import interface_closure
from ..states.state_scalars import state_area, state_errors
from ..states.states import SOLVER_ERROR
from .division import PARTS, occupied_windows, solvable_parts, split, spread_windows
from .local_roughness import local_roughness, roughness_by_size
from .sub_windows import SubWindows

#: Largest number of sub-windows solved of each size.
MAX_WINDOWS = 16

#: Scalars of every state of a sub-window: unit, long name.
STATES = {
    "closure": ("mm", "closure w from first touch of the sub-window"),
    "interface_closure": ("mm", "interface closure w_int = w - w_b of the sub-window"),
    "area": ("mm2", "real contact area A_r"),
    "area_share": ("1", "real contact area A_r / A_0 of the sub-window"),
    "stiffness": ("N/mm", "normal stiffness dF/dw"),
    "corrected_area_share": ("1", "corrected real contact area A_r / A_0 of the sub-window"),
    "interface_compliance": ("mm/MPa", "compliance of the interface d w_int / d sigma"),
    "mean_gap": ("mm", "mean gap of the sub-window"),
    "nodes": ("1", "nodes in contact"),
    "largest_void": ("mm", "diameter of the largest disc in the window that holds no contact"),
    "random_void": ("mm", "diameter of the largest such disc among as many random nodes"),
    "occupied": ("1", "1 where the contact of the whole window has a node in the sub-window"),
    "interface_closure_error": ("mm", f"interface closure w_int, {SOLVER_ERROR}"),
    "area_share_error": ("1", f"real contact area A_r / A_0, {SOLVER_ERROR}"),
    "corrected_area_share_error": (
        "1",
        f"corrected real contact area A_r / A_0, {SOLVER_ERROR}",
    ),
    "interface_compliance_error": ("mm/MPa", f"compliance of the interface, {SOLVER_ERROR}"),
}

#: Scalars of every sub-window at an offset: unit, long name.
SHAPES = {
    "sigma_z": ("mm", "rms of the composite topography about its own mean plane"),
    "rigid_opening": ("mm", "rigid dilatancy delta_r of the sub-window"),
}

_TABLE = {
    **{
        name: (("part", "window", "offset", "normal_force"), *words)
        for name, words in STATES.items()
    },
    **{name: (("part", "window", "offset"), *words) for name, words in SHAPES.items()},
    "side": ("part", "mm", "side b of the sub-windows"),
    "side_along": ("part", "mm", "length of the sub-windows along the sliding"),
    "bulk_settlement": (("part", "normal_force"), "mm", "bulk settlement w_b of a sub-window"),
    "nominal_pressure": ("normal_force", "MPa", "nominal pressure sigma_0"),
}


def window_states(
    loading: JointLoading[JointSettings],
    parts: Sequence[int] = PARTS,
    most: int = MAX_WINDOWS,
) -> xr.Dataset:
    """Contact states of sub-windows of several sizes, and sigma_z of sub-windows of many more
    sizes.

    Variables are those of :func:`solved_windows` and
    :func:`size_effect.local_roughness.roughness_by_size`.
    """
    solved = solved_windows(loading, parts, most)
    return solved.merge(roughness_by_size(loading))


def solved_windows(
    loading: JointLoading[JointSettings],
    parts: Sequence[int] = PARTS,
    most: int = MAX_WINDOWS,
) -> xr.Dataset:
    """Contact states of sub-windows of several sizes, under the study's dilatancy loads.

    The loads are taken as nominal pressures: forces there act on the whole window. Of ``parts``
    those of :func:`size_effect.division.solvable_parts` are taken, at most ``most`` sub-windows of
    each size. :data:`STATES` over (part, window, offset, normal_force) and :data:`SHAPES` over
    (part, window, offset) are NaN where there are fewer sub-windows; ``side`` b (part), mm, is the
    square root of their area. Raises `NotConverged`, whose note names the state.

    The composite topography of a sub-window is loaded as it lies in the whole one. The blocks of
    the model do not turn (sect. 4), and only so the states of the parts can be compared with those
    of the whole, of which they are pieces. A laboratory would seat a specimen of that size; the
    part of its closure that comes from tilt alone then vanishes.
    """
    area, cells = loading.area, loading.cells
    pressures = loading.forces(loading.settings.dilatancy_loads) / area
    parts = solvable_parts(parts, loading.shape)
    chosen = [spread_windows(n, most) for n in parts]
    dims = (len(parts), max(map(len, chosen), default=0), len(cells), len(pressures))
    values: dict[str, np.ndarray] = {name: np.full(dims, np.nan) for name in STATES}
    values |= {name: np.full(dims[:3], np.nan) for name in SHAPES}
    settlement = np.full((len(parts), len(pressures)), np.nan)
    sides = np.full((len(parts), 2), np.nan)
    whole_domains: dict[int, list[np.ndarray]] = {}
    for k, n in enumerate(parts):
        mated = split(loading.composite(0), n)[chosen[k]]
        for i, offset in enumerate(cells):
            composites = split(loading.composite(offset), n)[chosen[k]]
            where = f"{n} x {n} parts, offset {offset} cells"
            size = _Solved(loading, composites, pressures, where, places=chosen[k])
            size.extend(len(pressures))
            if n == 1:
                whole_domains[i] = size.domains
            size.values["occupied"][:] = 1.0
            for load, domain in enumerate(whole_domains.get(i, [])):
                size.values["occupied"][:, load] = occupied_windows(domain, n)[chosen[k]]
            opened = composites.max(axis=(1, 2)) - mated.max(axis=(1, 2))
            shapes = {"rigid_opening": opened, "sigma_z": local_roughness(composites)}
            for name, of_windows in (size.values | shapes).items():
                values[name][k, : len(composites), i] = of_windows
            sides[k], settlement[k] = size.sides, size.settlement
    values |= {
        "side": np.sqrt(sides.prod(axis=1)),
        "side_along": sides[:, sliding_axis(loading.direction)],
        "bulk_settlement": settlement,
        "nominal_pressure": pressures,
    }
    return labelled_dataset(
        _TABLE,
        values,
        coords={
            "part": ("part", parts, cf_attrs("1", "sub-windows along a side of the window")),
            "offset": ("offset", loading.offsets, cf_attrs("mm", "shear offset v")),
            "normal_force": (
                "normal_force",
                pressures * area,
                cf_attrs("N", "force on the whole window"),
            ),
            "direction": loading.direction,
        },
        attrs={"opposite": loading.specimen.attrs["opposite"]},
    )


class _Solved(SubWindows):
    """Sub-windows all of whose states are kept, as ``values`` of :data:`STATES` (window, load).

    ``domains`` (load,) are the contact domains of a window alone.
    """

    def __init__(self, loading: JointLoading[JointSettings], windows: np.ndarray, *more, **options):
        super().__init__(loading, windows, *more, **options)
        shape = len(windows), len(self.forces)
        self.values = {name: np.full(shape, np.nan) for name in STATES}
        self.domains: list[np.ndarray] = []

    def keep(self, state: ContactState, window: int, resolution: int, step: int) -> None:
        """Store :data:`STATES` of a state."""
        rows, columns = state.space.shape
        area = state.space.cell_area * rows * columns
        flush, settlement = self.flush[window], self.settlement[step]
        errors, stiffness = state_errors(state, state.slope), state.stiffness
        nodes = int(np.count_nonzero(state.in_contact))
        numbers = {
            "closure": state.closure,
            "interface_closure": interface_closure(state.closure, settlement, flush),
            "area": state.area,
            "area_share": state.area / area,
            "stiffness": stiffness,
            "corrected_area_share": state_area(state) / area,
            "mean_gap": 0.0 if flush else state.gap.mean(),
            "nodes": nodes,
            "largest_void": largest_void(state.in_contact, state.space.spacing),
            "random_void": _random_void(state.space.shape, state.space.spacing, nodes),
            "interface_closure_error": 0.0 if flush else errors["closure_error"],
            "area_share_error": errors["area_error"] / area,
            "corrected_area_share_error": errors["area_corrected_error"] / area,
        }
        if not flush:
            bulk = settlement * area / self.forces[step]
            numbers["interface_compliance"] = area / stiffness - bulk
            # In full contact no force brings mirrored faces nearer: the compliance is exactly 0.
            is_rigid = np.isinf(stiffness)
            error = 0.0 if is_rigid else errors["stiffness_error"] * area / stiffness**2
            numbers["interface_compliance_error"] = error
        if len(self.flush) == 1:
            self.domains.append(state.in_contact)
        for name, value in numbers.items():
            self.values[name][window, step] = value


def _random_void(shape: tuple[int, int], spacing: tuple[float, float], nodes: int) -> float:
    """Largest void among as many random nodes, mm, whichever axis is called x."""
    first, last = sorted(zip(shape, spacing, strict=True))
    turned = first[0], last[0]
    domain = random_nodes(turned, nodes, np.arange(np.prod(turned)), 0)
    return largest_void(domain, (first[1], last[1]))
