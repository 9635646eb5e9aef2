import numpy as np
import pytest
from brownian import brownian_surface
from ensembles import ensemble

from fractalcontact.roughness.dimension import measured_exponents
from fractalcontact.roughness.known_bias import (
    HURST_GRID,
    POINTS,
    Fit,
    extended,
    levelled_slope,
    slopes,
    square_about_line,
    square_about_plane,
    unresolved,
)
from fractalcontact.roughness.registry import ESTIMATORS
from fractalcontact.roughness.spectrum_model import BAND_LIMITED
from fractalcontact.surface.synthesis import self_affine

MADE = {
    BAND_LIMITED: lambda n, hurst, seed: self_affine((n, n), 1.0, hurst, rms=1.0, seed=seed),
    POINTS: brownian_surface,
}
FULL = pytest.mark.full


def at(hurst, values):
    return np.interp(hurst, HURST_GRID, values)


def found_over_default_range(name, sampling, axis="both"):
    lengths = ESTIMATORS[name].factor * np.geomspace(4, 32, 12)
    return ESTIMATORS[name].expected_hurst(Fit(lengths, 256, axis), sampling)


def limit_at_one(values):
    """Values at H = 1, the surfaces of which are planes of mean square slope 1 along each axis."""
    return np.polynomial.Polynomial.fit(HURST_GRID[-5:], values[-5:], 2)(1.0)


# -- exact -----------------------------------------------------------------------------------------


def test_levelling_takes_a_plane_off_whole():
    assert limit_at_one(levelled_slope()) == pytest.approx(1.0, abs=1e-4)
    assert limit_at_one(square_about_plane()) == pytest.approx(0.0, abs=1e-4)
    assert limit_at_one(square_about_line()) == pytest.approx(0.0, abs=1e-4)


def test_random_walk_about_its_line():
    assert at(0.5, square_about_line()) == pytest.approx(1 / 15)


def test_planes_have_no_short_waves():
    assert limit_at_one(unresolved()) == pytest.approx(0.0, abs=1e-3)


def test_lines_with_gaps():
    x = np.arange(5.0)
    y = np.array([2 * x, [0, 1, np.nan, 3, 4], [np.nan] * 4 + [1]])
    np.testing.assert_allclose(slopes(x, y), [2, 1, np.nan])


def test_interpolation_goes_straight_on():
    known, values = np.array([0.0, 1.0, 3.0]), np.array([0.0, 2.0, 3.0])
    np.testing.assert_allclose(
        extended(np.array([-1.0, 0.5, 2.0, 5.0]), known, values), [-2, 1, 2.5, 4]
    )


# -- independent -----------------------------------------------------------------------------------


@pytest.mark.parametrize("target", [0.3, 0.5, 0.8])
def test_levelling_takes_the_slope_that_a_sum_over_all_pairs_says(target):
    n = 30
    y, x = (a.ravel() for a in (np.mgrid[:n, :n] + 0.5) / n)
    pull = (x - 0.5) / np.sum((x - 0.5) ** 2)  # the plane's slope along x is pull @ z
    squares = np.hypot(x - x[:, np.newaxis], y - y[:, np.newaxis]) ** (2 * target)
    expected = -pull @ squares @ pull / 2
    assert np.interp(target, HURST_GRID, levelled_slope()) == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("target", [0.3, 0.5, 0.8])
def test_squares_about_planes_and_lines_are_those_of_small_grids(target):
    # The projector that takes off the mean plane, on the covariance that differences alone say.
    n = 40
    place = (np.arange(n) + 0.5) / n
    y, x = np.meshgrid(place[::2], place[::2], indexing="ij")
    for points, found in (
        (np.stack([y.ravel(), x.ravel()], axis=1), square_about_plane()),
        (place[:, np.newaxis], square_about_line()),
    ):
        terms = np.linalg.qr(np.column_stack([np.ones(len(points)), points]))[0]
        distance = np.linalg.norm(points[:, np.newaxis] - points, axis=2) ** (2 * target)
        left = np.eye(len(points)) - terms @ terms.T
        assert at(target, found) == pytest.approx(
            -np.sum(left * distance) / 2 / len(points), rel=0.03
        )


@pytest.mark.parametrize(
    "target", [pytest.param(0.3, marks=FULL), 0.5, pytest.param(0.8, marks=FULL)]
)
def test_missing_waves_take_the_same_off_every_lag(target):
    # All waves of the grid, summed: finer towards long ones, which hold most.
    t, weight = np.polynomial.legendre.leggauss(600)
    t, weight = (t + 1) / 2, weight / 2
    wave, weight = np.pi * t**4, 4 * np.pi * t**3 * weight
    density = np.hypot(wave[:, np.newaxis], wave) ** (-2 - 2 * target)
    of_wave = 4 * weight * (density @ weight)
    lag = np.array([4, 8, 16])
    found = np.array([np.sum(of_wave * (1 - np.cos(wave * h))) for h in lag])
    # In units of the h^(2H) that all waves together give at long lags.
    unit = (found[2] - found[1]) / (16 ** (2 * target) - 8 ** (2 * target))
    missing = lag ** (2 * target) - found / unit
    np.testing.assert_allclose(missing, at(target, unresolved()), atol=0.02)


@pytest.mark.parametrize("sampling", MADE)
@pytest.mark.parametrize("target", [0.3, 0.7])
def test_slopes_are_those_of_made_surfaces(sampling, target):
    n, names = 256, [name for name in ESTIMATORS if name not in ("cube_counting", "slit_islands")]
    slopes_found = {name: [] for name in names}
    for seed in range(ensemble("slopes of surfaces")):
        made, _ = measured_exponents(MADE[sampling](n, target, seed), 1.0, estimators=names)
        for name, estimate in made.items():
            slopes_found[name].append(estimate.slope_hurst)
    for name, found in slopes_found.items():
        fit = Fit(made[name].length[made[name].used], n, "both")
        expected = at(target, ESTIMATORS[name].expected_hurst(fit, sampling))
        error = np.std(found, ddof=1) / np.sqrt(len(found))
        assert abs(np.mean(found) - expected) < 0.008 + 3 * error, name


# -- properties ------------------------------------------------------------------------------------


@pytest.mark.parametrize("sampling", MADE)
@pytest.mark.parametrize("name", ESTIMATORS)
def test_what_a_slope_says_rises_with_the_exponent(name, sampling):
    for axis in ("both", "x"):
        assert (np.diff(found_over_default_range(name, sampling, axis)) > 0).all()


@pytest.mark.parametrize("name", ESTIMATORS)
def test_missing_waves_make_rough_surfaces_seem_smoother(name):
    limited, points = (found_over_default_range(name, sampling) for sampling in MADE)
    assert at(0.3, limited - points) > 0.03
    assert abs(at(0.9, limited - points)) < 0.012


@pytest.mark.parametrize("name", ESTIMATORS)
def test_interval_holds_for_either_kind_of_surface(name):
    target = 0.3
    for made in MADE.values():
        held = 0
        seeds = ensemble("intervals of surfaces")
        for seed in range(100, 100 + seeds):
            surface = made(256, target, seed)
            measured, _ = measured_exponents(surface, 1.0, estimators=[name])
            found = measured[name].hurst["both"]
            held += found.low <= target <= found.high
        assert held >= np.floor(0.9 * seeds)
