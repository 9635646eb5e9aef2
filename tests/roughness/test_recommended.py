"""The recommended dimension, and when there is none."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.laws.theory import no_majumdar_bhushan
from fractalcontact.roughness.dimension import surface_dimension
from fractalcontact.roughness.recommended import (
    RECOMMENDED,
    best_dimension,
    beyond_roll_off,
    dimension_words,
)
from fractalcontact.surface.synthesis import self_affine


@pytest.fixture(scope="module")
def measured():
    surface = self_affine((128, 128), 0.1, 0.7, rms=0.3, seed=3)
    return surface_dimension(surface, 0.1, known_dimension=2.3)


def estimates(value, low, high):
    values = {"dimension": value, "dimension_low": low, "dimension_high": high}
    return xr.Dataset(
        {name: ("estimator", [2.5, number]) for name, number in values.items()},
        coords={"estimator": ["variogram", RECOMMENDED]},
    )


def test_one_value_is_recommended_and_used(measured):
    chosen = measured.sel(estimator=RECOMMENDED)
    expected = [chosen[f"dimension{end}"].item() for end in ("", "_low", "_high")]
    assert list(best_dimension(measured).ends) == expected
    stored = [measured[f"recommended_dimension{end}"].item() for end in ("", "_low", "_high")]
    assert stored == expected
    assert measured["recommended"].item() == RECOMMENDED
    assert "rms error" in measured["reason"].item()
    assert measured["no_dimension"].item() == ""
    assert measured["known_dimension"].item() == 2.3
    assert expected[1] < 2.3 < expected[2]
    assert f"Delta_g {expected[0]:.2f}" in dimension_words(measured)


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        ((1.8, 1.7, 1.9), "1.80 [1.70, 1.90] does not lie between 2 and 3: not self-affine"),
        ((3.3, 3.1, 3.4), "3.30 [3.10, 3.40] does not lie between 2 and 3: not self-affine"),
        ((1.98, 1.9, 2.1), "its interval reaches above 2"),
        ((3.01, 2.9, 3.1), "its interval reaches below 3"),
        ((np.nan,) * 3, "no fit"),
    ],
)
def test_what_no_surface_can_have_is_refused(ends, words):
    found = best_dimension(estimates(*ends))
    assert np.isnan(found.ends).all()
    assert words in found.reason


def test_a_possible_value_passes_whatever_its_interval():
    assert best_dimension(estimates(2.1, 1.9, 2.3)).ends == (2.1, 1.9, 2.3)


def test_a_smooth_hill_has_no_dimension():
    y, x = np.mgrid[-1:1:128j, -1:1:128j]
    found = surface_dimension(np.exp(-(x**2) - y**2), 0.1)
    assert found["dimension"].sel(estimator=RECOMMENDED) < 2
    assert np.isnan(best_dimension(found).ends).all()
    assert "does not lie between 2 and 3" in found["no_dimension"].item()
    assert dimension_words(found).startswith("no surface dimension: Delta_g")


def test_theories_without_a_dimension_say_why():
    assert no_majumdar_bhushan(1.2) == ""
    assert "between 1 and 1.5" in no_majumdar_bhushan(1.6)
    assert "no_dimension" in no_majumdar_bhushan(np.nan)


def test_a_stated_range_beyond_the_roll_off_is_told():
    surface = self_affine((256, 256), 0.1, 0.8, rms=0.3, seed=3, roll_off=3.2)
    automatic = surface_dimension(surface, 0.1, estimators=[RECOMMENDED])
    stated = surface_dimension(surface, 0.1, estimators=[RECOMMENDED], fit_range=(0.4, 3.2))
    assert not beyond_roll_off(automatic)
    assert beyond_roll_off(stated)
    assert "beyond a quarter of the roll-off" in dimension_words(stated)
