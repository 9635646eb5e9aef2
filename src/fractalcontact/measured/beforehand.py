"""Conditions of laboratory tests that are known before anything is solved."""

from collections.abc import Collection

import numpy as np
import xarray as xr

from roughcontact.contact.path import LOAD

from ..core.errors import InputError
from ..core.settings import MeasuredTest, Settings, Solver
from ..joint.joint import choose_offsets, prefractal
from ..states.loading import JointLoading
from .curve import Curve
from .readings import TestReadings, read_test

#: Relative difference up to which two pressures count as equal.
NEAR = 0.01


def check_tests(
    specimen: xr.Dataset, settings: Settings, solver: Solver
) -> list[tuple[MeasuredTest, TestReadings]]:
    """Tests of a specimen with their readings, refused as the stage ``measured`` refuses them.

    Raises `InputError` for the first file, or the first thing said of it, that stops the stage
    before a solve.
    """
    if not settings.measured:
        return []
    direction = settings.contact_directions[0]
    cells = choose_offsets(specimen, settings.offsets, [direction])[direction]
    loading = JointLoading(specimen, direction, cells, settings, solver).at_map_offset()
    hardness = float(loading.solving["hardness"])
    loads = [*settings.dilatancy_loads, settings.map_load]
    checked = []
    for test in settings.measured:
        readings = read_test(test)
        if test.kind == "closure":
            (offset,) = loading.cells
            composite = prefractal(loading.composite(int(offset)), min(settings.resolutions))
            require_relief(test, readings.curve, float(np.ptp(composite)))
            require_calibration(test, hardness)
        elif test.kind != "flow":
            require_direction(test, settings.contact_directions if loading.slides else ())
        if np.isfinite(test.pressure):
            require_pressure(test, loading.forces(loads) / loading.area)
        checked.append((test, readings))
    return checked


def require_relief(test: MeasuredTest, readings: Curve, relief: float) -> None:
    """Refuse a closure that exceeds the relief of the faces, mm."""
    if (closed := float(np.ptp(readings.y))) > relief:
        raise InputError(
            f"{test.file}: the joint closes by {closed:.3g} mm, more than the relief of its "
            f"faces, {relief:.3g} mm; check the unit of the displacement"
        )


def require_calibration(test: MeasuredTest, hardness: float) -> None:
    """Refuse a constant that a test cannot fit to a joint of this hardness, MPa, or infinity."""
    crushes = np.isfinite(hardness)
    if test.calibrate == "hardness" and not crushes:
        raise InputError(
            f"{test.file}: 'calibrate: hardness', but the joint is elastic; state a "
            "hardness in the material, or calibrate the modulus"
        )
    if test.calibrate == "modulus" and crushes and test.branch != LOAD:
        raise InputError(
            f"{test.file}: 'calibrate: modulus' on the branch '{test.branch}' of a "
            "joint that crushes; calibrate it on loading, or calibrate the hardness"
        )


def require_direction(test: MeasuredTest, computed: Collection[str]) -> None:
    """Refuse a direction of sliding that is none of those computed; none are of a plane."""
    if not computed:
        raise InputError(f"{test.file}: a surface against a plane does not slide; remove the test")
    if test.direction not in computed:
        raise InputError(
            f"{test.file}: sliding towards {test.direction} was not computed, only towards "
            f"{', '.join(computed)}; add it to 'contact_directions'"
        )


def require_pressure(test: MeasuredTest, pressure: np.ndarray) -> None:
    """Refuse a held pressure outside of those at which a test is computed, MPa, ascending."""
    if not pressure.size or not (
        pressure[0] * (1 - NEAR) <= test.pressure <= pressure[-1] * (1 + NEAR)
    ):
        ends = ", ".join(f"{value:.3g}" for value in pressure) or "none"
        raise InputError(
            f"{test.file}: {test.pressure:g} MPa lies outside of the pressures at which "
            f"{test.kind} was computed ({ends} MPa); add it to 'loads' and 'dilatancy_loads'"
        )
