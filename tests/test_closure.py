"""Bulk settlement, hyperbola and dilatancy."""

import numpy as np
import pytest

from fractalcontact.closure import bulk_settlement, fit_hyperbola


def test_bulk_settlement_of_a_square():
    exact = (4 * np.log(1 + np.sqrt(2)) - 4 / 3 * (np.sqrt(2) - 1)) / np.pi
    assert bulk_settlement(100.0, 1e4, 20, 20) == pytest.approx(exact * 100 / (1e4 * 20), rel=1e-12)


def test_a_hyperbola_is_found_again_exactly():
    w = np.linspace(0.01, 0.35, 8)
    sigma = 30 * w / (1 - w / 0.4)
    fit = fit_hyperbola(sigma, w)
    assert (fit.k_ni, fit.w_m) == pytest.approx((30, 0.4), rel=1e-6)
    assert fit.misfit < 1e-6
    assert fit.reason == ""


def test_the_interval_holds_the_truth_under_noise():
    rng = np.random.default_rng(1)
    w = np.linspace(0.02, 0.35, 12)
    sigma = 30 * w / (1 - w / 0.4)
    inside = 0
    for _ in range(100):
        fit = fit_hyperbola(sigma, w + rng.normal(0, 0.004, w.size))
        inside += fit.w_m_low <= 0.4 <= fit.w_m_high
    assert inside >= 88  # 95 expected, with a standard deviation of 2.2


def test_a_straight_line_has_no_asymptote():
    sigma = np.linspace(1, 10, 8)
    fit = fit_hyperbola(sigma, sigma / 50 * (1 + 1e-3 * np.sin(sigma)))
    assert np.isnan(fit.w_m) or fit.w_m_high > 2 * sigma.max() / 50


def test_too_few_points_give_a_reason():
    fit = fit_hyperbola([1, 2, 3], [0.1, 0.15, -1])
    assert np.isnan(fit.k_ni)
    assert "needed" in fit.reason
