"""Laboratory tests beside computed curves: made by another solver, with noise, seat and rock."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from dense_programmes import dense_operator, dense_pressure
from made_settings import made_settings
from made_stages import scan, stages_of

from fractalcontact.core.errors import InputError
from fractalcontact.core.estimate import Estimate
from fractalcontact.measured.computed import Joint
from fractalcontact.measured.curve import Curve, ratio, scatter
from fractalcontact.measured.stage import measured_stage
from fractalcontact.mechanics.closure import bulk_settlement
from fractalcontact.mechanics.loading import JointLoading
from fractalcontact.study.configuration import solver_settings
from fractalcontact.study.measured import resolve_tests
from fractalcontact.surface.synthesis import self_affine

SOLVER = solver_settings({}, "made")
SEAT, TOP, ROCK, NOISE = 0.25, 20.0, 4e-3, 0.3e-3  # MPa, MPa, mm/MPa, mm
LOADS = [(float(one), "pressure") for one in np.geomspace(0.1, 40, 14)]
BESIDE = {"gauge": "4 um/MPa", "seat": "0.25 MPa"}


def made_joint(seed, hardness):
    """Settings and stages of a small joint, one face scanned."""
    face = self_affine((64, 64), 0.1, 0.8, rms=0.06, seed=seed, roll_off=1.2)
    settings = made_settings(
        loads=LOADS, dilatancy_loads=LOADS[-1:], map_load=LOADS[-1], window=3.2, offsets=[0.3],
        map_offset=0.3, directions=["E"], contact_directions=["E"], resolutions=[1, 2],
    )
    material = replace(
        settings.material, hardness=hardness, e_star=1000.0, basic_friction_angle=30.0
    )
    settings = replace(settings, material=material)
    return settings, stages_of("made", [scan(face, 0.1)], settings, SOLVER)


def laboratory(settings, stages, seed, factor=1.0):
    """Pressure and displacement, mm, of loading and reloading, by a dense boxed programme.

    The joint of the laboratory has ``factor`` times the modulus and hardness of the study's.
    """
    loading = JointLoading.of_joint(
        stages["specimens"], stages["joints"], "E", settings, SOLVER
    ).at_map_offset()
    height = loading.composite(int(loading.cells[0]))
    space = loading.half_space(height.shape)
    matrix = dense_operator(space) / factor
    cap, area = factor * settings.material.hardness, loading.area
    sides = np.multiply(space.shape, space.spacing)

    def branch(height, top, closures, cap):
        clearance = (top - height).ravel()
        rows = []
        for closure in closures:
            pressure = dense_pressure(matrix, clearance, closure, cap)
            force = pressure.sum() * space.cell_area
            closing = closure - bulk_settlement(force, factor * space.modulus, *sides)
            rows.append((force / area, closing))
            if force / area > TOP:
                break
        gap = clearance - closure + matrix @ pressure
        return np.array(rows), pressure, gap

    finite = cap if np.isfinite(cap) else 1e9
    steps = np.geomspace(0.02, 1, 70) * np.ptp(height)
    load, pressure, gap = branch(height, height.max(), steps, finite)
    crushed = np.where(pressure >= finite * (1 - 1e-12), np.minimum(gap, 0), 0)
    # Again, elastically, on what was pressed in; from first touch before any load.
    top = steps[len(load) - 1]
    again, *_ = branch(
        height + crushed.reshape(height.shape), height.max(), np.linspace(0.02, 1, 60) * top, 1e12
    )
    rng = np.random.default_rng(seed)
    tests = {}
    for name, curve in (("load", load), ("reload", again)):
        x, closing = curve[(curve[:, 0] >= SEAT)].T
        x, first = np.unique(x, return_index=True)
        seated = closing[first] - np.interp(np.log(SEAT), np.log(curve[:, 0] + 1e-12), curve[:, 1])
        tests[name] = x, seated + ROCK * x + NOISE * rng.standard_normal(x.size)
    return tests


def written(folder, tests, **more):
    """Tests of the laboratory as files, and as a sidecar states them."""
    stated = []
    for name, (x, y) in tests.items():
        text = "pressure [MPa], displacement [um]\n"
        text += "".join(f"{a:.5f}, {1000 * b:.4f}\n" for a, b in zip(x, y, strict=True))
        Path(folder, f"{name}.csv").write_text(text)
        cycle = 1 if name == "load" else 2
        stated.append(BESIDE | {"file": f"{name}.csv", "branch": name, "cycle": cycle})
    stated[0] |= more
    return stated


def compared(settings, stages, stated, folder):
    tests = resolve_tests(stated, "made.yaml: measured", Path(folder))
    needed = ("specimens", "joints", "closure", "dilatancy", "error_budget", "flow", "strength")
    return measured_stage(
        **{name: stages[name] for name in needed},
        settings=replace(settings, measured=tests),
        solver=SOLVER,
    )["measured"]


@pytest.fixture(scope="module", params=[np.inf, 100.0], ids=["elastic", "crushing"])
def made(request):
    settings, stages = made_joint(3, request.param)
    return settings, stages, laboratory(settings, stages, 3)


def test_another_solver_s_test_agrees_within_its_errors(made, tmp_path):
    """Noise of 0.3 um, a seat of 0.25 MPa and 4 um/MPa of rock are taken for what they are."""
    settings, stages, tests = made
    found = compared(settings, stages, {"closure": written(tmp_path, tests)}, tmp_path)
    print(found.closure_ratio.values, found.closure_ratio_low.values, found.closure_ratio_high.values)
    print({k: (found[k].values) for k in found if "k_ni" in k or "chi" in k or "v_m" in k})
