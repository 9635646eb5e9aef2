"""Face values of the local cubic law: exact flows, brackets of finer grids, and the grid error."""

import numpy as np
import pytest
from ensembles import ensemble
from flow_bounds import transmissivity_bounds
from scipy import ndimage

from fractalcontact.flow.cubic_law import flow_of, grid_error, plane_flow
from fractalcontact.flow.network import MAX_FACE_DIFFERENCE
from fractalcontact.states.state_scalars import aperture
from fractalcontact.surface.synthesis import band_limited
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

STEP = (1.0, 1.0)


def by_each(gap, axis="x"):
    """T by harmonic means, by linear apertures and by the mean of both."""
    each = (plane_flow(gap, STEP, axis, faces) for faces in ("harmonic", "linear", "mean"))
    return [flow.transmissivity for flow in each]


# -- exact solutions -------------------------------------------------------------------------------


def test_plates_have_one_flow_by_every_face_value():
    flow = plane_flow(np.full((5, 7), 0.2), STEP)
    assert by_each(np.full((5, 7), 0.2)) == pytest.approx([0.2**3 / 12] * 3, rel=1e-12)
    assert flow.face_difference == pytest.approx(0, abs=1e-15)
    assert flow.resolved


def test_linear_face_values_are_exact_in_a_wedge():
    # Between the middles of its first and last cell; half a cell of even aperture is at each end.
    wedge = np.linspace(0.05, 1.0, 20)
    first, last, length = wedge[0], wedge[-1], 19
    inside = length * (first + last) / (2 * first**2 * last**2)
    exact = 20 / (inside + (first**-3 + last**-3) / 2) / 12
    low, high, mean = by_each(np.tile(wedge, (3, 1)))
    assert high == pytest.approx(exact, rel=1e-12)
    assert low < exact
    assert mean == pytest.approx((low + high) / 2, rel=1e-12)
    across = by_each(np.tile(wedge, (3, 1)), "y")
    assert across == pytest.approx([np.mean(wedge**3) / 12] * 3, rel=1e-12)


def waves(n, amplitude, length):
    """Aperture of n cells with waves of a length, over part of a wave too."""
    return 1 + amplitude * np.sin(2 * np.pi * (np.arange(n) + 0.5) / length)


@pytest.mark.parametrize("length", [16, 33, 64])
def test_the_grid_error_covers_that_of_a_sinusoid_along_the_flow(length):
    n, finer = 200, 100
    fine = waves(n * finer, 0.5, length * finer)
    exact = 1 / np.mean(fine**-3.0) / 12
    gap = np.tile(waves(n, 0.5, length), (4, 1))
    flow = plane_flow(gap, STEP)
    assert abs(flow.transmissivity - exact) <= grid_error(gap, STEP, "x", flow)
    assert flow.transmissivity == pytest.approx(exact, rel=0.03)


def test_a_corrugated_plate_is_series_along_and_parallel_across_at_once():
    # A product of an aperture along and one across the flow: the pressure stays even across.
    along, across = waves(120, 0.5, 40), waves(60, 0.3, 20)
    finer = 100
    exact = np.mean(waves(60 * finer, 0.3, 20 * finer) ** 3)
    exact /= 12 * np.mean(waves(120 * finer, 0.5, 40 * finer) ** -3.0)
    gap = np.outer(across, along)
    flow = plane_flow(gap, STEP)
    assert abs(flow.transmissivity - exact) <= flow.face_difference / 2
    assert flow.transmissivity == pytest.approx(exact, rel=5e-3)


def test_bounds_of_harmonic_means_do_not_hold_linear_apertures():
    # Corrugated across the flow alone, both bounds are the flow itself.
    gap = np.tile(waves(160, 0.7, 16), (3, 1))
    low, high, mean = by_each(gap)
    for faces, value in (("harmonic", low), ("linear", high), ("mean", mean)):
        assert transmissivity_bounds(gap, 1, faces) == pytest.approx((value, value), rel=1e-9)
    assert 1.05 < high / transmissivity_bounds(gap, 1, "harmonic")[1] < 1.1


# -- what the grid resolves ------------------------------------------------------------------------


def test_a_wave_too_short_for_the_grid_is_said_to_be_unresolved():
    flow = plane_flow(np.tile(waves(160, 0.95, 8), (3, 1)), STEP)
    assert flow.face_difference > MAX_FACE_DIFFERENCE * flow.transmissivity
    assert not flow.resolved
    assert flow.reason.startswith("the grid does not resolve the flow")
    assert plane_flow(np.tile(waves(160, 0.5, 16), (3, 1)), STEP).reason == ""


def test_a_single_face_value_makes_no_statement_about_the_grid():
    gap = np.tile(waves(160, 0.95, 8), (3, 1))
    for faces in ("harmonic", "linear"):
        flow = plane_flow(gap, STEP, faces=faces)
        assert np.isnan(flow.face_difference)
        assert flow.resolved


def log_normal(seed, n, smooth):
    """Log-normal apertures without contact."""
    noise = np.random.default_rng(seed).normal(size=(n, n))
    heights = ndimage.gaussian_filter(noise, smooth, mode="wrap")
    return np.exp(0.5 * heights / heights.std())


def cut(seed, n, smooth):
    """Apertures between two rough planes that have passed through each other."""
    return np.clip(np.log(log_normal(seed, n, smooth)) / 0.5 + 1.5, 0, None)


def loaded(seed, n, smooth):
    """Apertures of a contact state."""
    waves_of = {"cut_off": smooth, "roll_off": n / 4, "prefactor": 1.0}
    heights = band_limited((n, n), 1.0, 0.8, seed=seed, **waves_of)
    heights /= heights.std()
    space = HalfSpace((n, n), STEP, 1.0)
    return aperture(solve_contact(heights, space, force=1e-3 * n * n, rtol=1e-4))


@pytest.mark.parametrize("seed", range(3))
def test_linear_apertures_never_let_less_pass(seed):
    # Each face lets more pass: so does the whole (Rayleigh).
    low, high, mean = by_each(cut(seed, 48, 3))
    assert 0 < low < mean < high


def test_the_mean_and_its_grid_error_hold_the_flow_of_a_finer_grid():
    n, step, smooth = ensemble("finer grid of sampled fields"), 3, 15
    errors, covered, bracketed = [], [], []
    kinds = (log_normal, cut, log_normal, cut, loaded)
    for seed in range(20):
        fine = kinds[seed % len(kinds)](seed, n, smooth)
        truth = flow_of(fine, STEP, "x").transmissivity
        # Every third cell, the middle of three.
        gap = fine[1::step, 1::step]
        flow = flow_of(gap, STEP, "x")
        low, high = flow.transmissivity + np.array([-0.5, 0.5]) * flow.face_difference
        errors.append(abs(flow.transmissivity / truth - 1))
        covered.append(abs(flow.transmissivity - truth) <= grid_error(gap, STEP, "x", flow))
        bracketed.append(low <= truth <= high)
    assert np.median(errors) <= 0.005
    assert np.sum(covered) >= 18
    assert np.sum(bracketed) >= 16
