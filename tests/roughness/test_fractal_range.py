"""Noise floor, filter and roll-off of synthetic surfaces: what was put in is found, no more."""

import numpy as np
import pytest
from ensembles import ensemble
from scipy.ndimage import gaussian_filter

from fractalcontact.roughness.fractal_range import find_fractal_range
from fractalcontact.roughness.spectra import profile_spectra
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1
HURST = ensemble("exponents of spectra")


def surface(n, hurst, seed=1, **options):
    return self_affine((n, n), SPACING, hurst, rms=0.3, seed=seed, **options)


def white(shape, seed=7):
    return np.random.default_rng(seed).normal(size=shape)


def along(axes, heights, spacing=SPACING):
    curves = profile_spectra(heights, (spacing, spacing))
    return [find_fractal_range(curves[axis], spacing) for axis in axes]


def each_axis(heights, spacing=SPACING):
    """Of surfaces that are alike along both: one of them in the quick suite."""
    return along(ensemble("axes of spectra"), heights, spacing)


def unseen(interval):
    return not interval.known


# --- nothing is seen where nothing is ------------------------------------------------------------


@pytest.mark.parametrize("hurst", HURST)
@pytest.mark.parametrize(
    ("n", "dtype"),
    [(64, float), pytest.param(128, float, marks=pytest.mark.full), (256, np.float32)],
)
def test_a_self_affine_surface_has_no_noise_floor_and_no_filter(n, hurst, dtype):
    for found in each_axis(surface(n, hurst).astype(dtype).astype(float)):
        assert unseen(found.noise_rms)
        assert unseen(found.filter_wavelength)
        assert unseen(found.end)
        assert found.line[1] == pytest.approx(1 + 2 * hurst, abs=0.25)


@pytest.mark.parametrize("hurst", HURST)
def test_aliasing_of_points_of_a_finer_surface_is_no_noise(hurst):
    finer = self_affine((512, 512), SPACING / 2, hurst, rms=0.3, seed=2)
    for found in each_axis(finer[::2, ::2]):
        assert unseen(found.noise_rms)
        assert unseen(found.filter_wavelength)


def test_too_few_cells_say_nothing():
    for found in each_axis(surface(16, 0.8)):
        assert found.form is None
        assert unseen(found.noise_rms)


def test_a_grating_is_no_power_law_and_nothing_is_said_of_its_noise():
    x = np.arange(200) * SPACING
    grating = np.sign(np.sin(2 * np.pi * x / 1.7)) + 1e-4 * white((200, 200))
    (along_x,) = along("x", grating)
    assert along_x.misfit > np.log(2)
    assert unseen(along_x.noise_rms)
    assert unseen(along_x.end)


# --- what was put in is found --------------------------------------------------------------------


@pytest.mark.parametrize("hurst", HURST)
def test_white_noise_is_found_at_its_level_and_crossing(hurst):
    within = []
    for seed in range(ensemble("noisy surfaces")):
        clean = surface(256, hurst, seed)
        # As large as the surface at a wavelength of 8 cells.
        line = along("x", clean)[0].line
        rms = np.sqrt(line[0] * (8 * SPACING) ** line[1] / SPACING)
        for found in each_axis(clean + rms * white(clean.shape, seed)):
            assert found.noise_rms.value == pytest.approx(rms, rel=0.25)
            assert found.end == found.noise_wavelength
            assert found.end.value == pytest.approx(8 * SPACING, rel=0.35)
            low, high = found.noise_rms.low, found.noise_rms.high
            within.append(low <= rms <= high)
    assert np.mean(within) >= 0.75


def test_noise_of_a_small_scan_is_found():
    for found in each_axis(surface(64, 0.8) + 0.1 * white((64, 64))):
        low, high = found.noise_rms.low, found.noise_rms.high
        assert low <= 0.1 <= high


def test_noise_alone_leaves_no_fractal_range():
    for found in each_axis(0.02 * white((128, 128))):
        assert found.noise_rms.value == pytest.approx(0.02, rel=0.05)
        assert found.end.value > 20 * SPACING


@pytest.mark.parametrize("hurst", HURST)
@pytest.mark.parametrize("width", [pytest.param(1.5, marks=pytest.mark.full), 2.5])
def test_a_gaussian_low_pass_is_found_where_it_halves_the_spectrum(hurst, width):
    z = gaussian_filter(surface(256 + 40, hurst), width, truncate=8)[20:-20, 20:-20]
    half = 2 * np.pi * width * SPACING / np.sqrt(np.log(2))
    for found in each_axis(z):
        assert found.form.filtering == "Gaussian"
        assert unseen(found.noise_rms)
        assert found.end == found.filter_wavelength
        assert found.end.value == pytest.approx(half, rel=0.06)


def test_a_filter_and_the_noise_behind_it_are_separated():
    z = gaussian_filter(surface(296, 0.7), 2, truncate=8)[20:-20, 20:-20] + 3e-4 * white((256, 256))
    for found in each_axis(z):
        assert found.noise_rms.value == pytest.approx(3e-4, rel=0.1)
        assert found.filter_wavelength.value == pytest.approx(4 * np.pi * SPACING / 0.8326, rel=0.1)
        assert found.end == found.filter_wavelength


@pytest.mark.parametrize("hurst", HURST)
def test_a_roll_off_is_found_at_the_long_end_and_ends_no_range(hurst):
    for found in each_axis(surface(256, hurst, roll_off=1.6)):
        assert found.roll_off_wavelength.value == pytest.approx(1.6, rel=0.1)
        assert unseen(found.end)


def test_shifted_scan_lines_are_noise_along_the_other_axis_alone():
    z = surface(256, 0.8) + 0.03 * white((256, 1))
    along_x, along_y = along("xy", z)
    assert unseen(along_x.noise_rms)
    assert along_y.noise_rms.value == pytest.approx(0.03, rel=0.15)


@pytest.mark.parametrize("step", [0.02, pytest.param(0.05, marks=pytest.mark.full)])
def test_quantised_heights_have_the_noise_of_their_step(step):
    z = step * np.round(surface(256, 0.9) / step)
    for found in each_axis(z):
        assert found.noise_rms.value == pytest.approx(step / np.sqrt(12), rel=0.15)


def test_a_few_spikes_are_not_the_noise_of_the_instrument():
    clean = surface(256, 0.8)
    spiky = clean.copy()
    spiky[40, 50], spiky[41, 90] = 30, -30  # of an rms of 0.3
    for found in each_axis(spiky):
        assert unseen(found.noise_rms)
        assert 0.5 < found.left_out <= 2


# --- properties ----------------------------------------------------------------------------------


def test_units_and_a_plane_change_nothing():
    z = surface(128, 0.7) + 0.05 * white((128, 128))
    for found, same in zip(each_axis(z), each_axis(1e3 * z, 1e3 * SPACING), strict=True):
        np.testing.assert_allclose(
            same.noise_rms.ends, 1e3 * np.array(found.noise_rms.ends), rtol=1e-3
        )
        np.testing.assert_allclose(same.end.ends, 1e3 * np.array(found.end.ends), rtol=1e-3)
    tilted = z + 0.2 * np.arange(128) + 5
    for found, same in zip(each_axis(z), each_axis(tilted), strict=True):
        np.testing.assert_allclose(same.noise_rms.ends, found.noise_rms.ends, rtol=1e-3)


def test_each_axis_has_its_own_spacing():
    z = surface(128, 0.7) + 0.1 * white((128, 128))
    curves = profile_spectra(z, (0.4, 0.1))
    square = profile_spectra(z, (0.1, 0.1))
    np.testing.assert_allclose(curves["y"].length, 4 * square["y"].length)
    along_y = find_fractal_range(curves["y"], 0.4)
    assert along_y.noise_rms.value == pytest.approx(0.1, rel=0.1)
    np.testing.assert_array_equal(curves["x"].total, square["x"].total)
