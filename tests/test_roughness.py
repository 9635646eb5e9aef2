from pathlib import Path

import numpy as np
import pytest

from fractalcontact.roughness import ESTIMATORS, slope_statistics, surface_dimension
from fractalcontact.synthesis import disc_outline, self_affine

SCANS = Path(__file__).parents[2] / "shared" / "scans"
UNBIASED = ["second_differences", "roughness_length", "power_spectrum"]


@pytest.fixture(scope="module")
def surface():
    return self_affine((256, 256), 0.1, 0.7, rms=0.3, seed=3)


def hurst(heights, spacing=0.1, **keywords):
    return surface_dimension(heights, spacing, **keywords).hurst.to_series()


# -- exact -----------------------------------------------------------------------------------------


def test_variogram_and_second_differences_of_a_corrugation():
    period, lag = 16, 4
    x = np.arange(256)
    z = np.tile(np.sin(2 * np.pi * x / period), (256, 1))
    curves = {
        name: dict(zip(*ESTIMATORS[name].curve(z, 1.0), strict=True))
        for name in ("variogram", "second_differences")
    }
    # <(z(x+h) - z(x))^2> = 2 sin^2(pi h / l) for a unit sine, on x; nothing on y: half of it.
    assert curves["variogram"][lag] == pytest.approx(np.sin(np.pi * lag / period) ** 2, rel=1e-2)
    expected = 4 * np.sin(np.pi * lag / period) ** 4
    assert curves["second_differences"][lag] == pytest.approx(expected, rel=1e-2)


def test_profile_spectrum_holds_the_variance_and_peaks_at_the_wave():
    wave = np.tile(np.sin(2 * np.pi * np.arange(256) / 16), (256, 1))
    wavelength, density = ESTIMATORS["power_spectrum"].curve(wave, 0.5)
    assert wavelength[np.argmax(density)] == pytest.approx(8.0, rel=0.1)


def test_white_noise_is_flat_in_the_spectrum_and_level_in_windows():
    noise = np.random.default_rng(0).standard_normal((256, 256))
    _, density = ESTIMATORS["power_spectrum"].curve(noise, 0.5)
    np.testing.assert_allclose(density, 0.5, rtol=0.15)  # <z^2> times the spacing
    _, rms = ESTIMATORS["roughness_length"].curve(noise, 0.5)
    np.testing.assert_allclose(rms, 1, rtol=0.02)  # at short windows too: degrees of freedom


def test_prism_facets_of_a_plane_have_its_slope():
    y, x = np.indices((64, 64), dtype=float)
    _, slope = ESTIMATORS["triangular_prism"].curve(0.3 * x + 0.4 * y, 1.0)
    np.testing.assert_allclose(slope, 0.5)


def test_statistics_of_a_corrugation():
    n, period = 400, 100
    z = np.tile(np.sin(2 * np.pi * np.arange(n) / period), (n, 1))
    z -= np.polynomial.Polynomial.fit(np.arange(n), z[0], 1)(np.arange(n))
    q = 2 * np.pi / period
    s = slope_statistics(z, 1.0)
    assert s.z2_y.item() == pytest.approx(0, abs=1e-12)
    assert s.z2_x.item() == pytest.approx(q / np.sqrt(2), rel=0.01)
    assert s.rms_slope.item() == pytest.approx(q / np.sqrt(2), rel=0.01)
    assert s.m0.item() == pytest.approx(0.5, rel=0.04)
    assert s.m4.item() == pytest.approx(q**4 / 4, rel=0.01)  # mean of x and y


# -- independent -----------------------------------------------------------------------------------


@pytest.mark.parametrize("target", [0.5, 0.8])
def test_three_estimators_find_the_hurst_exponent(target):
    found = [hurst(self_affine((256, 256), 0.1, target, rms=0.3, seed=s)) for s in range(8)]
    mean = sum(found) / len(found)
    assert mean[UNBIASED].to_numpy() == pytest.approx(target, abs=0.05)
    # The other two are low, by what the docstring states.
    assert (mean[["variogram", "triangular_prism"]] < target + 0.03).all()
    assert (mean > target - 0.15).all()


# -- properties ------------------------------------------------------------------------------------


def test_tilt_height_and_unit_change_nothing(surface):
    y, x = np.indices(surface.shape)
    expected = hurst(surface)
    np.testing.assert_allclose(hurst(surface + 3 + 0.02 * x - 0.05 * y), expected, rtol=1e-6)
    np.testing.assert_allclose(hurst(1e3 * surface, 100.0), expected, rtol=1e-9)
    np.testing.assert_allclose(hurst(0.01 * surface), expected, rtol=1e-9)


def test_turning_the_surface_changes_nothing(surface):
    np.testing.assert_allclose(hurst(surface.T), hurst(surface), rtol=1e-9)
    np.testing.assert_allclose(hurst(surface[:, ::-1]), hurst(surface), rtol=0.02)


def test_interval_and_dimension_belong_to_the_exponent(surface):
    result = surface_dimension(surface, 0.1, fit_range=(0.5, 3.0))
    assert (result.dimension == 3 - result.hurst).all()
    assert (result.hurst_low < result.hurst).all()
    assert (result.hurst < result.hurst_high).all()
    assert (result.dimension_low == 3 - result.hurst_high).all()
    assert (result.used.sum("scale") == result.n).all()
    inside = result.length.where(result.used)
    lag = result.sel(estimator="variogram")
    assert lag.fit_min >= 0.5 - 1e-9
    assert lag.fit_max <= 3.0 + 1e-9
    np.testing.assert_allclose(inside.min("scale"), result.fit_min)


def test_missing_cells_and_an_outline_shift_the_exponent_little(surface):
    whole = hurst(surface)
    rng = np.random.default_rng(0)
    disc = np.where(disc_outline(surface.shape, 0.1, 25.0), surface, np.nan)
    np.testing.assert_allclose(hurst(disc), whole, atol=0.12)
    holes = np.where(rng.random(surface.shape) < 2e-3, np.nan, surface)
    np.testing.assert_allclose(hurst(holes), whole, atol=0.12)


def test_oblong_cells_are_made_square(surface):
    oblong = surface_dimension(surface[::2], (0.2, 0.1), fit_range=(0.8, 3.2))
    square = surface_dimension(surface[::2, ::2], 0.2, fit_range=(0.8, 3.2))
    np.testing.assert_allclose(oblong.hurst, square.hurst, atol=1e-9)


def test_anisotropic_slopes_are_told_apart(surface):
    stretched = slope_statistics(surface, (0.2, 0.1))
    plain = slope_statistics(surface, 0.1)
    assert stretched.z2_y.item() == pytest.approx(plain.z2_y.item() / 2)
    assert stretched.z2_x.item() == pytest.approx(plain.z2_x.item())
    assert plain.rms_slope.item() ** 2 == pytest.approx(2 * plain.m2.item())


@pytest.mark.parametrize(
    "heights",
    [
        np.full((64, 64), 0.3),
        0.1 * np.indices((64, 64), dtype=float).sum(axis=0),
        np.full((64, 64), np.nan),
        np.random.default_rng(0).random((5, 4)),
    ],
    ids=["flat", "plane", "missing", "tiny"],
)
def test_no_dimension_where_there_is_none(heights):
    result = surface_dimension(heights, 1.0)
    assert result.hurst.isnull().all()
    assert result.dimension_low.isnull().all()
    assert not result.used.any()


def test_wrong_range_or_shape_is_refused(surface):
    with pytest.raises(ValueError, match="rise"):
        surface_dimension(surface, 0.1, fit_range=(3.0, 0.5))
    with pytest.raises(ValueError, match="grid"):
        surface_dimension(surface[0], 0.1)


# -- real scans ------------------------------------------------------------------------------------


@pytest.mark.scans
def test_natural_fault_has_the_exponents_its_authors_found():
    path = SCANS / "corona_fault" / "coronaA_grids.npz"
    if not path.exists():
        pytest.skip("the real scans are not beside the project")
    heights = 1e3 * np.load(path, allow_pickle=False)["Z_grid"]
    found = hurst(heights, 5.6858)
    # Along the striae 0.59, across 0.72, by its authors; the estimators pool both.
    assert ((found > 0.55) & (found < 0.80)).all()
