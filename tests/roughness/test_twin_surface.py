"""Twin surfaces: Gaussian where chance explains the heights, else with the measured ones."""

import numpy as np
import pytest
from scipy.stats import kurtosis, skew

from fractalcontact.roughness.plane_spectrum import plane_spectrum
from fractalcontact.roughness.twin_surface import twin_doubt, twin_surface
from fractalcontact.surface.synthesis import self_affine

SPACING = (0.1, 0.1)


def _rough(seed, n=128, roll_off=1.0):
    return self_affine((n, n), 0.1, 0.8, rms=0.3, seed=seed, roll_off=roll_off)


@pytest.mark.parametrize("roll_off", [1.0, None])
def test_gaussian_surfaces_have_gaussian_twins(roll_off):
    found = [
        twin_surface(_rough(seed, roll_off=roll_off), SPACING, (64, 64)).gaussian
        for seed in range(12)
    ]
    assert sum(found) >= 10


@pytest.mark.parametrize("sign", [1, -1])
def test_skewed_heights_and_their_spectrum_are_those_of_the_twins(sign):
    heights = sign * 0.1 * np.exp(2.5 * _rough(1, n=192))
    surface = twin_surface(heights, SPACING, (192, 192))
    assert not surface.gaussian
    twins = [surface.drawn(seed) for seed in range(6)]
    of_twins = [[of(z.ravel()) for of in (np.std, skew, kurtosis)] for z in twins]
    own = [of(heights.ravel()) for of in (np.std, skew, kurtosis)]
    np.testing.assert_allclose(np.mean(of_twins, axis=0), own, rtol=0.25)
    spectra = [plane_spectrum(z, SPACING).density.mean(axis=1) for z in twins]
    own = plane_spectrum(heights, SPACING).density.mean(axis=1)
    ratio = np.log(np.mean(spectra, axis=0) / own)
    assert np.abs(ratio.mean()) < 0.15
    assert np.sqrt(np.mean(ratio**2)) < 0.4


def test_a_seed_is_one_twin():
    surface = twin_surface(_rough(2), SPACING, (64, 48))
    assert surface.drawn(4).shape == (64, 48)
    np.testing.assert_array_equal(surface.drawn(4), surface.drawn(4))
    assert np.abs(surface.drawn(4) - surface.drawn(5)).max() > 0.1


def test_twins_are_doubted_where_the_surface_has_steps_or_longer_waves_than_they_have():
    doubted = [bool(twin_doubt(_rough(seed), SPACING)) for seed in range(12)]
    assert sum(doubted) <= 1
    rough = _rough(1)
    x = np.arange(128) / 128
    steps = rough + 2.0 * np.floor(8 * x)
    assert "kurtosis" in twin_doubt(steps, SPACING)
    swell = rough + 3.0 * np.sin(2 * np.pi * 2.5 * x)
    assert "longest waves" in twin_doubt(swell, SPACING)
    # Neither a tilt nor the unit changes what is said.
    assert twin_doubt(1e3 * (swell + 5 * x), (100.0, 100.0)) == twin_doubt(swell, SPACING)
