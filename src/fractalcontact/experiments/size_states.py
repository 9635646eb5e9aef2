"""Contact of synthetic surfaces whose prefactor, cut-offs and size are set one by one.

What eq. 6 gives one exponent for is separated: the short cut-off of the surface (resolution), its
side (size) and the set that touches (geometry). The spectrum has one prefactor throughout, so that
a larger surface continues a smaller one, and a longer cut-off leaves waves away and changes none.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..contact.state import ContactState
from ..core.datasets import labelled_dataset
from ..core.labels import cf_attrs
from ..domain.box_dimension import dimension_of_domain
from ..domain.correlation import correlation_dimension
from ..elastic.halfspace import HalfSpace
from ..mechanics.area import corrected_area
from ..mechanics.closure import bulk_settlement
from ..mechanics.sweep import load_steps
from ..study.size_tasks import ARMS, SizeTask
from ..surface.synthesis import band_limited, band_slope
from .units import E_STAR, SPACING

#: Prefactor C_0 of the spectrum, mm^(2 - 2H): nothing depends on it, for pressures are in units of
#: E* h'_rms.
PREFACTOR = 1e-6

_STATE = ("surface", "reduced_pressure")
#: What is kept of every state: dimensions, unit and long name.
STATES: dict[str, tuple] = {
    "area_share": (_STATE, "1", "real contact area A_r / A_0"),
    "corrected_share": (_STATE, "1", "real contact area A_r / A_0, corrected for the perimeter"),
    "nodes": (_STATE, "1", "nodes in contact"),
    "separation": (_STATE, "1", "mean gap over h_rms"),
    "compliance": (_STATE, "1", "compliance of the interface dw_int/dp times E* / h_rms"),
    "central_share": (_STATE, "1", "corrected A_r / A_0 of the central half"),
    "central_pressure": (_STATE, "1", "p / (E* h'_rms) of the central half"),
    "box_dimension": (_STATE, "1", "Delta_sigma of the contact domain by box counting"),
    "correlation_dimension": (_STATE, "1", "correlation dimension D_2 of the contact domain"),
    "band_dimension": (_STATE, "1", "D_2 between the cut-off and the roll-off"),
    "cut_dimension": (_STATE, "1", "the same of the bearing-area cut of as many nodes"),
    "residual": (_STATE, "1", "largest KKT residual, fraction of the closure"),
}
#: What is kept of every surface.
SURFACES: dict[str, tuple] = {
    "of_arm": ("surface", "1", "arm of the experiment"),
    "of_hurst": ("surface", "1", "Hurst exponent H"),
    "of_size": ("surface", "1", "nodes per side"),
    "of_cut_off": ("surface", "1", "shortest wavelength, nodes"),
    "of_roll_off": (
        "surface",
        "1",
        "longest self-affine wavelength, nodes; none without a roll-off",
    ),
    "number": ("surface", "1", "number of the surface in its class"),
    "rms_slope": ("surface", "1", "h'_rms of the surface, from its waves"),
    "rms_height": ("surface", "mm", "h_rms of the surface about its mean plane"),
}


def solve_task(task: SizeTask, loads: Sequence[float], rtol: float) -> xr.Dataset:
    """States of the surfaces of one job under rising loads.

    Parameters
    ----------
    task : SizeTask
    loads : sequence of float
        Values of p / (E* h'_rms), h'_rms being that which surfaces of the arm and size have in the
        mean with the shortest cut-off, so that the pressure is one for all cut-offs.
    rtol : float
        Of the solves.

    Returns
    -------
    xr.Dataset
        :data:`STATES` over (surface, reduced_pressure) and :data:`SURFACES`.

    Raises
    ------
    NotConverged
        If a state could not be verified; the message names it.
    """
    pressures = np.unique(loads)
    slope = _mean_slope(task._replace(cut_off=task.finest))
    numbers = range(task.first, task.first + task.surfaces)
    each = [_one_surface(task, number, pressures * slope, slope, rtol) for number in numbers]
    values = {name: np.array([one[name] for one in each]) for name in each[0]}
    of_class = {
        "of_arm": np.array([task.arm] * task.surfaces),
        "of_hurst": np.full(task.surfaces, task.hurst),
        "of_size": np.full(task.surfaces, task.size),
        "of_cut_off": np.full(task.surfaces, task.cut_off),
        "of_roll_off": np.full(task.surfaces, np.nan if task.roll_off is None else task.roll_off),
        "number": np.array(numbers),
    }
    return labelled_dataset(
        STATES | SURFACES,
        values | of_class,
        {"reduced_pressure": ("reduced_pressure", pressures, cf_attrs("1", "p / (E* h'_rms)"))},
    )


def _class_of(task: SizeTask) -> dict[str, Any]:
    return {
        "prefactor": PREFACTOR,
        "cut_off": task.cut_off * SPACING,
        "roll_off": None if task.roll_off is None else task.roll_off * SPACING,
    }


def _mean_slope(task: SizeTask) -> float:
    """h'_rms of a class. Without a roll-off long waves add a little with the size."""
    return band_slope((task.size, task.size), SPACING, task.hurst, **_class_of(task))


def seed_of(task: SizeTask, number: int) -> int:
    """Seed of a surface: one for all cut-offs, so that each is the same surface, filtered."""
    arm = sorted(ARMS).index(task.arm)
    entropy = (arm, round(1000 * task.hurst), task.size, number)
    return int(np.random.SeedSequence(entropy).generate_state(1)[0])


def _one_surface(
    task: SizeTask, number: int, pressures: np.ndarray, slope: float, rtol: float
) -> dict[str, Any]:
    """Numbers of one surface, those of its states over the loads."""
    shape = (task.size, task.size)
    heights = band_limited(
        shape, SPACING, task.hurst, seed=seed_of(task, number), **_class_of(task)
    )
    space = HalfSpace(shape, (SPACING, SPACING), E_STAR)
    forces = pressures * E_STAR * task.size**2 * SPACING**2
    where = f"{task.name}, surface {number}"
    states = load_steps(heights, space, forces, {"rtol": rtol}, where)
    band = task.cut_off * SPACING, (task.roll_off or task.size / 8) * SPACING
    rows = [_numbers_of(state, heights, slope, band) for state in states]
    own = {
        # Not differences of nodes: those of waves of a few nodes are too small.
        "rms_slope": _mean_slope(task),
        "rms_height": float(np.sqrt(np.mean(heights**2))),
    }
    return own | {name: [row[name] for row in rows] for name in rows[0]}


def _numbers_of(
    state: ContactState, heights: np.ndarray, slope: float, band: tuple[float, float]
) -> dict[str, float]:
    """:data:`STATES` of one state."""
    domain, space = state.in_contact, state.space
    side = len(heights) * SPACING
    rms = float(np.sqrt(np.mean(heights**2)))
    centre = slice(len(heights) // 4, len(heights) - len(heights) // 4)
    central = domain[centre, centre]
    bulk = bulk_settlement(state.force, E_STAR, side, side) / state.force
    return {
        "area_share": state.area / side**2,
        "corrected_share": corrected_area(domain, space.spacing) / side**2,
        "nodes": np.count_nonzero(domain),
        "separation": float(state.gap.mean()) / rms,
        "compliance": (1 / state.stiffness - bulk) * side**2 * E_STAR / rms,
        "central_share": corrected_area(central, space.spacing) / (central.size * SPACING**2),
        "central_pressure": float(state.pressure[centre, centre].mean()) / (E_STAR * slope),
        "box_dimension": dimension_of_domain(domain, SPACING).dimension,
        "correlation_dimension": correlation_dimension(domain, SPACING).value,
        "band_dimension": correlation_dimension(domain, SPACING, band).value,
        "cut_dimension": correlation_dimension(_bearing_cut(heights, domain), SPACING, band).value,
        "residual": state.residual,
    }


def _bearing_cut(heights: np.ndarray, domain: np.ndarray) -> np.ndarray:
    """The highest nodes of a surface, as many as are in contact."""
    count = np.count_nonzero(domain)
    order = np.argpartition(heights.ravel(), heights.size - count)[heights.size - count :]
    cut = np.zeros(heights.size, bool)
    cut[order] = True
    return cut.reshape(heights.shape)
