"""What a roll-off takes from each measure, whether one is seen, and the range that follows."""

from itertools import pairwise

import numpy as np
import pytest
from brownian import brownian_surface
from ensembles import ensemble
from scipy.integrate import quad
from scipy.special import j0

from fractalcontact.roughness.dimension import surface_dimension
from fractalcontact.roughness.estimators.variogram import variogram_curves
from fractalcontact.roughness.fit_range import choose_fit_range
from fractalcontact.roughness.roll_off import (
    HURST_GRID,
    SHAPES,
    SMOOTH,
    about_line_fraction,
    about_plane_fraction,
    difference_fraction,
    levelled_slope_fraction,
    rise_fraction,
    second_difference_fraction,
)
from fractalcontact.surface.synthesis import self_affine

EVERY = [
    difference_fraction,
    second_difference_fraction,
    rise_fraction,
    levelled_slope_fraction,
    about_plane_fraction,
    about_line_fraction,
]


def at(hurst):
    return np.abs(HURST_GRID - hurst).argmin()


def surface(n, hurst, seed, share=None):
    roll_off = None if share is None else share * n
    return self_affine((n, n), 1.0, hurst, rms=1.0, seed=seed, roll_off=roll_off)


def mean_square_difference(hurst, share):
    """Of the model, by direct integration over wave numbers, in units of q_r^(-2H)."""
    z, power = 2 * np.pi * share, lambda q: max(q, 1.0) ** (-2 - 2 * hurst)
    edges = np.r_[0, 1, np.geomspace(1, 2000 / z, 400)[1:]]
    parts = [quad(lambda q: q * power(q) * (1 - j0(z * q)), a, b)[0] for a, b in pairwise(edges)]
    return sum(parts) + edges[-1] ** (-2 * hurst) / (2 * hurst)  # of J0 nothing is left there


# -- exact -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("hurst", [0.3, 0.5, 0.8])
def test_difference_is_that_of_the_spectrum(hurst):
    # The ratio of two lags knows no unit: the power law's own constant drops out.
    short, long = (mean_square_difference(hurst, share) for share in (0.05, 0.5))
    left = difference_fraction(np.array([0.05, 0.5]))[at(hurst)]
    expected = 10 ** (2 * hurst) * left[1] / left[0]
    assert long / short == pytest.approx(expected, rel=2e-3)


def test_long_lags_see_twice_the_variance():
    # Far above the roll-off the difference is flat: h^(2H) times its fraction does not grow.
    share = np.array([6.0, 12.0])
    level = share ** (2 * HURST_GRID[:, np.newaxis]) * difference_fraction(share)
    rough = HURST_GRID > 0.3
    np.testing.assert_allclose(level[rough, 1] / level[rough, 0], 1, atol=0.02)


def test_half_exponent_has_its_own_series():
    # H = 1/2: the missing part of short lags is z^2 (1/(2 - 2H) - 1/4)/4 of q_r^-1, z = 2 pi share.
    share = np.array([1e-3])
    whole = np.sqrt(np.pi) / (0.5 * 4 * np.sqrt(np.pi) / 2)  # Gamma(1/2) / (H 4 Gamma(3/2))
    missing = (2 * np.pi * share) ** 2 / 4 * 0.75 / (2 * np.pi * share * whole)
    assert 1 - difference_fraction(share)[at(0.5), 0] == pytest.approx(missing[0], rel=0.02)


# -- properties ------------------------------------------------------------------------------------


@pytest.mark.parametrize("fraction", EVERY)
@pytest.mark.parametrize("shape", SHAPES)
def test_fractions_fall_from_one_as_the_roll_off_nears(fraction, shape):
    share = np.r_[0, np.geomspace(1e-3, 4, 30)]
    left = fraction(share, shape)
    assert (left[:, 0] == 1).all()
    assert ((left > 0) & (left <= 1 + 1e-6)).all()
    assert (np.diff(left, axis=1) <= 1e-6).all()


def test_what_has_no_plane_feels_a_roll_off_least():
    share = np.array([0.25])
    plane, second, plain = (
        f(share)[at(0.8), 0]
        for f in (about_plane_fraction, second_difference_fraction, difference_fraction)
    )
    assert plane > second > plain
    assert plain < 0.4
    assert plane > 0.95


# -- independent: synthetic surfaces ---------------------------------------------------------------


def test_variogram_of_synthetic_surfaces_loses_what_is_said():
    n, share, hurst = 256, 0.125, 0.8
    measures = [
        variogram_curves(surface(n, hurst, seed, share), 1.0)["both"].measure()
        for seed in range(ensemble("surfaces with a roll-off"))
    ]
    lag = variogram_curves(np.zeros((n, n)), 1.0)["both"].length
    chosen = (lag >= 4) & (lag <= 32)
    power = lag[chosen] ** (2 * hurst) * difference_fraction(lag[chosen] / (share * n))[at(hurst)]
    ratio = np.mean(measures, axis=0)[chosen] / power
    np.testing.assert_allclose(ratio / ratio.mean(), 1, atol=0.05)
    plain = np.mean(measures, axis=0)[chosen] / lag[chosen] ** (2 * hurst)
    assert plain[-1] / plain[0] < 0.3


@pytest.mark.parametrize(("hurst", "share"), [(0.5, 0.25), (0.8, 0.125)])
def test_every_estimator_holds_the_known_dimension_below_a_roll_off(hurst, share):
    for seed in range(ensemble("surfaces with a roll-off")):
        found = surface_dimension(surface(256, hurst, seed, share), 1.0)
        held = (found.dimension_low <= 3 - hurst) & (3 - hurst <= found.dimension_high)
        assert held.all(), (seed, found.dimension.values)
        assert np.abs(found.hurst - hurst).max() < 0.17
        # Four waves in the side place it no better than this; the interval ends on a lag.
        assert found.roll_off == pytest.approx(share * 256, rel=0.55)
        assert found.roll_off_low < 1.05 * share * 256
        assert found.roll_off_high > 0.95 * share * 256
        assert found.range_max == pytest.approx(found.roll_off.item() / 4)
        assert "roll-off" in found.range_reason.item()


def von_karman(n, hurst, seed, roll_off):
    """Patch of a surface with the spectrum (q^2 + q_r^2)^(-1 - H)."""
    waves = np.fft.fftfreq(2 * n)[:, np.newaxis], np.fft.rfftfreq(2 * n)
    density = (1 + roll_off**2 * (waves[0] ** 2 + waves[1] ** 2)) ** (-1 - hurst)
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal((2 * n, 2 * n)))
    return np.fft.irfft2(noise * np.sqrt(density), s=(2 * n, 2 * n))[:n, :n]


def test_smooth_roll_off_of_half_an_exponent_is_an_exponential_correlation():
    # H = 1/2: the correlation is exp(-q_r h), and h^(2H) belongs to its first term.
    share = np.geomspace(1e-3, 5, 20)
    z = 2 * np.pi * share
    expected = (1 - np.exp(-z)) / z
    np.testing.assert_allclose(difference_fraction(share, SMOOTH)[at(0.5)], expected, rtol=2e-3)


def test_a_roll_off_of_another_shape_is_held():
    for seed in range(ensemble("surfaces with a roll-off")):
        found = surface_dimension(von_karman(256, 0.8, seed, 40.0), 1.0)
        assert found.roll_off == pytest.approx(40, rel=0.5)
        held = (found.dimension_low <= 2.2) & (found.dimension_high >= 2.2)
        assert held.all(), (seed, found.dimension.values)
        plain = found.sel(estimator=["second_differences", "roughness_length", "variogram"])
        np.testing.assert_allclose(plain.dimension, 2.2, atol=0.15)


@pytest.mark.parametrize("hurst", [0.3, 0.7])
def test_no_roll_off_is_seen_where_there_is_none(hurst):
    for seed in range(ensemble("surfaces with a roll-off")):
        heights = brownian_surface(128, hurst, seed)
        found = choose_fit_range(heights - heights.mean(), 1.0)
        assert found.roll_off.value == np.inf
        assert found[:2] == (4, 16)
        # What cannot be excluded is longer than what is fitted.
        assert found.roll_off.low > 2 * found.longest


# -- the range -------------------------------------------------------------------------------------


def test_range_goes_with_the_unit():
    heights = surface(256, 0.8, 1, 0.125)
    in_mm = choose_fit_range(heights, 0.1)
    in_cells = choose_fit_range(heights, 1.0)
    np.testing.assert_allclose(in_mm[:2], 0.1 * np.array(in_cells[:2]))
    np.testing.assert_allclose(in_mm.roll_off.ends, 0.1 * np.array(in_cells.roll_off.ends))


def test_stated_range_is_kept_and_the_roll_off_inside_is_said():
    heights = surface(256, 0.8, 1, 0.125)
    inside = choose_fit_range(heights, 1.0, (2.0, 24.0))
    assert inside[:2] == (2.0, 24.0)
    assert "beyond a quarter of the roll-off" in inside.reason
    assert choose_fit_range(heights, 1.0, (2.0, 6.0)).reason == "stated by the study"


def test_a_surface_too_small_or_flat_has_no_roll_off():
    for heights in (np.zeros((64, 64)), np.full((64, 64), np.nan), surface(8, 0.5, 0)):
        assert choose_fit_range(heights, 1.0).roll_off.value == np.inf
