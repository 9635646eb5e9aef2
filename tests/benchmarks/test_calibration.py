"""Calibration of Delta_sigma on intervals that are right, and on random fractals."""

import importlib.util

import numpy as np
import pytest
from places import BENCHMARKS


@pytest.fixture(scope="module")
def measured():
    spec = importlib.util.spec_from_file_location("calibration", BENCHMARKS / "calibration.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_right_intervals_are_calibrated_and_missing_ones_left_out(measured):
    value = np.random.default_rng(0).normal(1.5, 0.1, 2000)
    rows = np.stack([value, value - 0.196, value + 0.196], axis=1)
    rows[:100, 1:] = np.nan
    n, mean, sd, ratio, coverage = measured.calibration(rows, truth=1.5)
    assert n == 1900
    assert (mean, sd) == (pytest.approx(1.5, abs=0.01), pytest.approx(0.1, rel=0.05))
    assert ratio == pytest.approx(1, rel=0.05)
    assert coverage == pytest.approx(0.95, abs=0.02)


@pytest.mark.parametrize("name", ["percolation 1.5", "random carpet", "random dust"])
def test_random_fractals_have_their_dimension(measured, name):
    parts, _, kept = measured.FRACTALS[name]
    nodes = []
    for seed in range(40):
        cells, dimension = measured.random_fractal(parts, 4, kept, seed)
        assert cells.shape == (parts**4,) * 2
        nodes.append(cells.sum())
    assert np.mean(nodes) == pytest.approx(parts ** (4 * dimension), rel=0.2)


def test_states_of_a_window_have_the_quantities_that_are_calibrated(monkeypatch):
    monkeypatch.syspath_prepend(BENCHMARKS)
    sampling = importlib.import_module("calibration_sampling")
    joint = sampling.TWINS["sandstone, capped"]._replace(face=96, window=48)
    face = sampling.face_of(joint, 1)
    assert face.shape == (48, 48 + joint.slid)
    values, counted = sampling.states_of(joint, face)
    names = list(sampling.QUANTITIES)
    assert values.shape == counted.shape == (len(names), len(sampling.PRESSURES))
    area = (48 * joint.spacing) ** 2 * np.array(sampling.PRESSURES) / joint.hardness
    np.testing.assert_allclose(values[names.index("corrected area")], area, rtol=1e-3)
    assert (np.diff(values[names.index("closure from the seat")]) > 0).all()
    assert (np.diff(values[names.index("mean gap")]) < 0).all()
    assert np.isnan(counted[names.index("closure from the seat")]).all()
    assert (counted[names.index("mean gap")] > 0).all()
    half = sampling.twin_half_widths(joint, face, range(1, 4))
    assert (half[names.index("mean gap")] > 0).all()


def test_transmissivities_of_a_window_have_what_their_interval_is_made_of(monkeypatch):
    monkeypatch.syspath_prepend(BENCHMARKS)
    flows = importlib.import_module("calibration_flow")
    joint = flows.TWINS["sandstone"]._replace(face=96, window=48)
    log_t, quarters, gap, counted = flows.states_of(joint, 1)
    assert log_t.shape == (len(flows.PRESSURES),)
    assert (np.diff(log_t) < 0).all()
    assert (np.diff(gap) < 0).all()
    assert (quarters[np.isfinite(log_t)] > 0).all()
    assert (counted > 0).all()
