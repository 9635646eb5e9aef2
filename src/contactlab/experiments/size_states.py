"""Contact of synthetic surfaces whose prefactor, cut-offs and size are set one by one.

Eq. 6 has one exponent for three causes, which are separated here: the short cut-off of the surface
(resolution), its side (size) and the set that touches (geometry). The spectrum has one prefactor
throughout, so that a larger surface continues a smaller one, and a longer cut-off only leaves waves
out.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled_dataset
from fractalcontact.core.labels import cf_attrs
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.domain.correlation import correlation_dimension
from fractalcontact.domain.null_models import bearing_area_cut
from fractalcontact.domain.random_nodes import expected_dimension
from fractalcontact.states.settlement import bulk_settlement
from fractalcontact.states.states import SCALARS
from fractalcontact.states.sweep import load_steps
from fractalcontact.surface.embedded import embedded_surface
from fractalcontact.surface.synthesis import band_limited, band_slope
from roughcontact.contact.corrected_area import corrected_area
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace

from .size_tasks import SizeTask
from .units import E_STAR, SPACING

#: Prefactor C_0 of the spectrum, mm^(2 - 2H): nothing depends on it, as pressures are in units of
#: E* h'_rms.
PREFACTOR = 1e-6
#: Standard deviation of the heights of other constructions, mm: nothing depends on it either.
RMS = 1e-2

_STATE = ("surface", "reduced_pressure")
#: Stored variables of every state: dimensions, unit and long name.
STATES: dict[str, tuple] = {
    "area_share": (_STATE, "1", "real contact area A_r / A_0"),
    "corrected_share": (_STATE, "1", "real contact area A_r / A_0, corrected for the perimeter"),
    "nodes": (_STATE, "1", "nodes in contact"),
    "separation": (_STATE, "1", "mean gap over h_rms"),
    "compliance": (_STATE, "1", "compliance of the interface dw_int/dp times E* / h_rms"),
    "central_share": (_STATE, "1", "corrected A_r / A_0 of the central half"),
    "central_pressure": (_STATE, "1", "p / (E* h'_rms) of the central half"),
    "box_dimension": (_STATE, "1", "Delta_sigma of the contact domain by box counting"),
    "random_dimension": (_STATE, "1", "the same expected of as many random nodes"),
    "cut_box_dimension": (_STATE, "1", "the same of the bearing-area cut of as many nodes"),
    "band_dimension": (_STATE, "1", "correlation dimension between cut-off and roll-off"),
    "cut_dimension": (_STATE, "1", "the same of the bearing-area cut of as many nodes"),
    **{name: (_STATE, *SCALARS[name]) for name in ("residual", "energy_error")},
}
#: Stored variables of every surface.
SURFACES: dict[str, tuple] = {
    "of_arm": ("surface", "1", "arm of the experiment"),
    "of_hurst": ("surface", "1", "Hurst exponent H"),
    "of_size": ("surface", "1", "nodes per side"),
    "of_cut_off": ("surface", "1", "shortest wavelength, nodes"),
    "of_roll_off": (
        "surface",
        "1",
        "longest self-affine wavelength, nodes; missing without a roll-off",
    ),
    "of_construction": ("surface", "1", "construction of the surface; empty for a spectrum"),
    "number": ("surface", "1", "number of the surface in its class"),
    "rms_slope": (
        "surface",
        "1",
        "h'_rms of its class in the mean, from the spectrum; of arm G of its nodes",
    ),
    "rms_height": ("surface", "mm", "h_rms of the surface about its mean plane"),
}


def solve_tasks(tasks: Sequence[Sequence[Any]], loads: Sequence[float], rtol: float) -> xr.Dataset:
    """:func:`solve_task` of each task of a job, as the workflow states it, along ``surface``."""
    return xr.concat([solve_task(SizeTask(*task), loads, rtol) for task in tasks], "surface")


def solve_task(task: SizeTask, loads: Sequence[float], rtol: float) -> xr.Dataset:
    """States of the surfaces of one job under rising loads.

    Parameters
    ----------
    task : SizeTask
    loads : sequence of float
        Values of p / (E* h'_rms), h'_rms being the mean of surfaces of the arm and size
        with the shortest cut-off, so that the pressure is one for all cut-offs.
    rtol : float
        Tolerance of the solves.

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
    numbers = range(task.first, task.first + task.surfaces)
    surfaces = [_one_surface(task, number, pressures, rtol) for number in numbers]
    values: dict[str, Any] = {
        name: np.array([surface[name] for surface in surfaces]) for name in surfaces[0]
    }
    of_class = {
        "of_arm": np.array([task.arm] * task.surfaces),
        "of_hurst": np.full(task.surfaces, task.hurst),
        "of_size": np.full(task.surfaces, task.size),
        "of_cut_off": np.full(task.surfaces, task.cut_off),
        "of_roll_off": np.full(task.surfaces, np.nan if task.roll_off is None else task.roll_off),
        "of_construction": np.array([task.construction] * task.surfaces),
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
    """h'_rms of a class. Without a roll-off long waves make it grow a little with the size."""
    return band_slope((task.size, task.size), SPACING, task.hurst, **_class_of(task))


#: Stream of seeds of each arm. W shares that of S3: its windows are cut from the same surfaces.
_STREAMS = {"R": 0, "S1": 1, "S2": 2, "S3": 3, "W": 3, "G": 4}


def seed_of(task: SizeTask, number: int) -> int:
    """Seed of a surface: one for all cut-offs, so that each is the same surface, filtered."""
    entropy = (_STREAMS[task.arm], round(1000 * task.hurst), task.whole or task.size, number)
    return int(np.random.SeedSequence(entropy).generate_state(1)[0])


def _surface(task: SizeTask, number: int) -> np.ndarray:
    """Heights of a surface, mm; of arm W the whole from which windows are cut."""
    seed, side = seed_of(task, number), task.whole or task.size
    if not task.construction:
        return band_limited((side, side), SPACING, task.hurst, seed=seed, **_class_of(task))
    return embedded_surface(
        {
            "size": side * SPACING,
            "spacing": SPACING,
            "outline": "square",
            "construction": task.construction,
            "dimension": 3 - task.hurst,
            "rms": RMS,
            "roll_off": None,
            "seed": seed,
        }
    )


def _windows(heights: np.ndarray, size: int) -> list[np.ndarray]:
    """Windows that a surface falls into, each about its own mean plane."""
    return [
        without_mean_plane(heights[y : y + size, x : x + size])
        for y in range(0, len(heights) - size + 1, size)
        for x in range(0, len(heights) - size + 1, size)
    ]


def _one_surface(task: SizeTask, number: int, pressures: np.ndarray, rtol: float) -> dict[str, Any]:
    """Numbers of one surface, and of its states over the loads as means over its windows."""
    whole = _surface(task, number)
    windows = [whole] if task.whole is None else _windows(whole, task.size)
    if task.construction:
        slope = own = float(np.sqrt(sum(np.mean(d**2) for d in np.gradient(whole, SPACING))))
    else:
        slope = _mean_slope(task._replace(cut_off=task.finest))
        # The slope is that of the waves: node differences are too small for waves of a few nodes.
        own = _mean_slope(task)
    space = HalfSpace(windows[0].shape, (SPACING, SPACING), E_STAR)
    forces = pressures * slope * E_STAR * windows[0].size * SPACING**2
    band = task.cut_off * SPACING, (task.roll_off or len(windows[0]) / 8) * SPACING
    where = f"{task.name}, surface {number}"
    # One rms height for all windows, so that mean ratios to it are ratios of mean quantities.
    rms = float(np.mean([np.sqrt(np.mean(heights**2)) for heights in windows]))
    rows_of_windows = [
        [
            _numbers_of(state, heights, rms, slope, band)
            for state in load_steps(heights, space, forces, {"rtol": rtol}, where)
        ]
        for heights in windows
    ]
    means = {
        name: _known_mean(
            np.array([[row[name] for row in rows] for rows in rows_of_windows], float)
        )
        for name in STATES
    }
    return {"rms_slope": own, "rms_height": rms} | means


def _known_mean(values: np.ndarray) -> np.ndarray:
    """Mean of the values over the first axis that are not NaN; NaN without any."""
    finite = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return np.where(finite, values, 0.0).sum(axis=0) / finite.sum(axis=0)


def _numbers_of(
    state: ContactState, heights: np.ndarray, rms: float, slope: float, band: tuple[float, float]
) -> dict[str, float]:
    """:data:`STATES` of one state."""
    domain, space = state.in_contact, state.space
    side = len(heights) * SPACING
    cut = bearing_area_cut(heights, int(np.count_nonzero(domain)))
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
        "random_dimension": expected_dimension(domain, SPACING),
        "cut_box_dimension": dimension_of_domain(cut, SPACING).dimension,
        "band_dimension": correlation_dimension(domain, SPACING, band).value,
        "cut_dimension": correlation_dimension(cut, SPACING, band).value,
        "residual": state.residual,
        "energy_error": state.energy_error,
    }
