"""The directional spectrum: of noise, of known surfaces, of one that is periodic."""

import numpy as np
import pytest

from fractalcontact.roughness.plane_spectrum import SECTORS, amplitude_error, plane_spectrum
from fractalcontact.roughness.twin_surface import twin_surface
from fractalcontact.surface.synthesis import band_limited, self_affine


def test_independent_heights_have_their_variance_times_a_cell_everywhere():
    heights = 0.2 * np.random.default_rng(1).standard_normal((150, 128))
    spectrum = plane_spectrum(heights, (0.1, 0.2))
    many = (spectrum.number > 1) & (spectrum.number < 5)
    np.testing.assert_allclose(spectrum.density[many].mean(axis=1), 0.04 * 0.02, rtol=0.15)


@pytest.mark.parametrize("roll_off", [None, 2.0])
def test_a_part_of_a_self_affine_surface_has_the_spectrum_of_the_whole_down_to_long_waves(roll_off):
    hurst, n = 0.8, 96
    means = []
    for seed in range(12):
        whole = self_affine((3 * n, 3 * n), 0.1, hurst, rms=0.3, seed=seed, roll_off=roll_off)
        spectrum = plane_spectrum(whole[n : 2 * n, n : 2 * n], (0.1, 0.1))
        means.append(spectrum.density.mean(axis=1))
    q = spectrum.number
    theory = np.maximum(q, 0 if roll_off is None else 1 / roll_off) ** (-2 * (1 + hurst))
    ratio = np.mean(means, axis=0) / theory
    ratio /= np.exp(np.mean(np.log(ratio)))
    assert np.abs(np.log(ratio)).max() < np.log(1.7)  # two waves at the long end
    assert np.abs(np.log(ratio[q > 1])).max() < np.log(1.25)


def test_a_periodic_surface_has_twins_of_its_wave_and_direction():
    n, wave, height = 128, 1.6, 0.3  # mm
    x = 0.1 * np.arange(n)
    rough = self_affine((n, n), 0.1, 0.8, rms=0.02, seed=3, roll_off=2.0)
    heights = rough + height * np.sin(2 * np.pi * x / wave)
    surface = twin_surface(heights, (0.1, 0.1), (n, n))
    powers = []
    for seed in range(12):
        spectrum = plane_spectrum(surface.drawn(seed), (0.1, 0.1))
        powers.append(spectrum.density)
    power = np.mean(powers, axis=0)
    ring, sector = np.unravel_index(power.argmax(), power.shape)
    assert 1 / spectrum.number[ring] == pytest.approx(wave, rel=0.1)
    assert sector in (0, SECTORS - 1)
    variance = np.mean([surface.drawn(seed).var() for seed in range(12)])
    assert variance == pytest.approx(height**2 / 2, rel=0.3)


def test_directions_are_told_apart_where_the_surface_has_them_and_not_where_it_has_none():
    rough = self_affine((160, 160), 0.1, 0.8, rms=0.3, seed=5, roll_off=2.0)
    same = plane_spectrum(rough, (0.1, 0.1))
    stretched = plane_spectrum(np.repeat(rough, 3, axis=0)[:160], (0.1, 0.1))
    middle = (same.number > 0.5) & (same.number < 2)
    along_x, along_y = 0, SECTORS // 2

    def apart(spectrum):
        return np.mean(
            np.log(spectrum.density[middle, along_x] / spectrum.density[middle, along_y])
        )

    assert abs(apart(same)) < 0.3
    assert apart(stretched) > 1.5


@pytest.mark.parametrize(("hurst", "roll_off"), [(0.8, 2.0), (0.5, None)])
def test_the_amplitude_error_is_the_scatter_of_the_rms_over_windows(hurst, roll_off):
    band = {"prefactor": 0.01, "cut_off": 0.2, "roll_off": roll_off}
    surfaces = [band_limited((96, 96), 0.1, hurst, seed=seed, **band) for seed in range(40)]
    rms = np.array([z.std() for z in surfaces])
    stated = np.median([amplitude_error(z, (0.1, 0.1)) for z in surfaces[:12]])
    assert 0.6 < stated / (rms.std(ddof=1) / rms.mean()) < 1.7


@pytest.mark.parametrize("roll_off", [None, 4.0])
def test_longer_waves_than_the_window_holds_are_continued_by_its_power_law(roll_off):
    band = {"prefactor": 0.01, "cut_off": 0.2, "roll_off": roll_off}
    slopes, logs = [], []
    for seed in range(16):
        whole = band_limited((256, 256), 0.1, 0.8, seed=seed, **band)
        spectrum = plane_spectrum(whole[64:192, 64:192], (0.1, 0.1))
        slopes.append(spectrum.slope)
        number = np.array([1 / 12.8])  # one wave in the window
        theory = 0.01 * (2 * np.pi * max(number[0], 1 / (roll_off or np.inf))) ** -3.6
        logs.append(np.log(spectrum.at(0 * number, number)[0] / theory))
    assert abs(np.median(logs)) < 0.4
    expected = -3.6 if roll_off is None else 0.0
    assert np.median(slopes) == pytest.approx(expected, abs=0.5)


def test_a_plane_has_no_spectrum():
    plane = np.add.outer(np.arange(40.0), np.arange(40.0))
    with pytest.raises(ValueError, match="heights that vary"):
        plane_spectrum(plane, (0.1, 0.1))
