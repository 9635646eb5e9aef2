"""Dilatancy of a joint in other windows and by other readings of its scans, under one load.

A strength by dilatancy comes from the slope of one curve over the offsets. The curves of other
windows and readings show how far it hangs on the window and on the scans.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..core.labels import cf_attrs
from ..core.window import window_slices
from ..joint.joint import prefractal
from ..scan.other_readings import other_readings
from ..states.loading import JointLoading
from ..states.other_windows import MIN_EFFECTIVE, whole_composite, window_places
from ..states.settlement import window_settlement
from ..states.sweep import load_steps
from .strength import OWN, QUARTER, READ, WINDOW

#: Most nodes along a side of the grids that variants are solved on: their differences count.
MAX_SIDE = 96
_DIMS = ("variant", "offset")


def slid_variants(loading: JointLoading, force: float) -> dict[str, tuple]:
    """Dilatancies of variants of a joint, as ``xr.Dataset`` takes them.

    ``variant_dilatancy`` (variant, offset), mm, is delta = delta_r - w_int under the force on the
    window (N), the same pressure on quarters; ``variant_kind`` (variant) one of :data:`OWN`,
    :data:`WINDOW`, :data:`QUARTER` and :data:`READ`; ``windows_independent`` the number of
    independent windows, 4 for quarters. Quarters stand in where the scan is too small for other
    windows. Every second node, or fewer, is taken of windows beyond :data:`MAX_SIDE`. Raises
    `NotConverged`.
    """
    kinds, composites, effective = _variants(loading)
    factor = -(-max(loading.shape) // MAX_SIDE)
    pressure = force / loading.area
    curves = [
        [
            _dilatancy(loading, prefractal(h, factor), float(mated.max()), factor, pressure)
            for h in slid
        ]
        for mated, *slid in composites
    ]
    words = cf_attrs("mm", "elastic dilatancy of other windows and readings, reference load")
    words |= {"direction": loading.direction}
    of_kind = cf_attrs("1", "kind of the variant")
    return {
        "variant_dilatancy": (_DIMS, np.reshape(curves, (len(kinds), len(loading.cells))), words),
        "variant_kind": ("variant", kinds, of_kind),
        "windows_independent": ((), effective, cf_attrs("1", "number of independent windows")),
    }


def _variants(loading: JointLoading) -> tuple[list[str], list[list[np.ndarray]], float]:
    """Kinds, composites at no offset and at each one (mm), and independent windows."""
    window = window_slices(loading.specimen)
    slid = _whole(loading)
    present = np.logical_and.reduce([np.isfinite(h) for h in slid])
    places, effective = window_places(present, window)
    kinds, parts = [OWN], [window]
    if effective >= MIN_EFFECTIVE:
        kinds += [WINDOW] * (len(places) - 1)
        parts += places[1:]
    else:
        quarters = list(_quarters(window))
        kinds, parts, effective = kinds + [QUARTER] * len(quarters), parts + quarters, 4.0
    composites = [[h[part] for h in slid] for part in parts]
    for specimen in other_readings(loading.specimen).values():
        read = [h[window] for h in _whole(replace(loading, specimen=specimen))]
        if all(np.isfinite(h).all() for h in read):
            kinds.append(READ)
            composites.append(read)
    return kinds, composites, effective


def _whole(loading: JointLoading) -> list[np.ndarray]:
    """Composite topographies of the whole scan at no offset and at each one, mm."""
    cells = [0, *loading.cells.tolist()]
    return [whole_composite(loading.specimen, loading.direction, n) for n in cells]


def _quarters(window: tuple[slice, slice]) -> Iterator[tuple[slice, slice]]:
    """Quarters of a window, rows and columns."""
    halves = []
    for part in window:
        half = (part.stop - part.start) // 2
        halves.append([slice(part.start, part.start + half), slice(part.stop - half, part.stop)])
    for rows in halves[0]:
        for columns in halves[1]:
            yield rows, columns


def _dilatancy(
    loading: JointLoading, composite: np.ndarray, mated: float, factor: int, pressure: float
) -> float:
    """delta = max h(v) - max h(0) - w + w_b under a nominal pressure, mm; ``mated`` is max h(0)."""
    space = loading.half_space(composite.shape, factor)
    sides = np.multiply(space.shape, space.spacing)
    force = pressure * float(np.prod(sides))
    if np.ptp(composite) == 0:
        return 0.0
    where = f"specimen {loading.specimen.attrs['name']}, variants"
    (state,) = load_steps(composite, space, [force], loading.solving, where)
    settlement = float(window_settlement(space, force))
    return float(composite.max()) - mated - state.closure + settlement
