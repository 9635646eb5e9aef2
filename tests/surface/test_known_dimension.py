import numpy as np
import pytest
from ensembles import ensemble
from known_sets import punch_dimensions

from fractalcontact.core.fitting import fit_line
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.roughness.dimension import measured_exponents
from fractalcontact.surface.known_dimension import (
    cantor_punch,
    extruded,
    random_midpoint,
    weierstrass_mandelbrot,
)

MAKERS = [weierstrass_mandelbrot, random_midpoint]


# Exact


def test_steps_of_the_first_generations():
    np.testing.assert_allclose(cantor_punch(1, lowering=2.0), [1, 0, 1])
    np.testing.assert_allclose(cantor_punch(2, lowering=2.0), [1.5, 1, 1.5, 0, 0, 0, 1.5, 1, 1.5])
    # Three parts of a fifth each, one empty fifth between neighbours.
    np.testing.assert_allclose(cantor_punch(1, parts=3, narrowing=5 / 3), [1, 0, 1, 0, 1])


def test_dimensions_of_the_triadic_punch():
    profile, contact = punch_dimensions(2, 1.5, 4 / 3)
    assert profile == pytest.approx(1 + np.log(1.5) / np.log(3))
    assert contact == pytest.approx(np.log(2) / np.log(3))
    assert punch_dimensions(2, 1.5, 2.5)[0] == 1  # flanks of finite length


@pytest.mark.parametrize(("parts", "narrowing"), [(2, 1.5), (2, 2.0), (3, 5 / 3)])
def test_the_punch_touches_a_plane_at_a_cantor_set(parts, narrowing):
    ratio, generations = round(parts * narrowing), 5
    profile = cantor_punch(generations, parts=parts, narrowing=narrowing)
    highest = profile >= profile.max() - 1e-12
    _, contact = punch_dimensions(parts, narrowing)
    for generation in range(generations + 1):
        boxes = highest.reshape(ratio**generation, -1).any(axis=1).sum()
        assert boxes == pytest.approx(ratio ** (generation * contact))


# Independent


@pytest.mark.parametrize(("narrowing", "lowering"), [(1.5, 1.1), (1.5, 1.3), (2.0, 1.2)])
def test_boxes_find_the_dimension_of_the_profile(narrowing, lowering):
    # Boxes as wide as the last steps, of a profile exaggerated without end: as many as they are
    # high. All their heights together are the profile's total variation.
    ratio, generations = round(2 * narrowing), np.array([8, 9, 10])
    variation = [
        np.abs(np.diff(cantor_punch(n, narrowing=narrowing, lowering=lowering), prepend=0)).sum()
        for n in generations
    ]
    side = float(ratio) ** -generations
    found = -fit_line(np.log(side), np.log(variation / side)).slope.value
    expected, _ = punch_dimensions(2, narrowing, lowering)
    assert found == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("target", [0.5, 0.8])
def test_estimators_find_the_dimension_again(make, target):
    names = ["second_differences", "roughness_length", "variogram"]
    found = np.mean(
        [
            [
                estimate.hurst["both"].value
                for estimate in measured_exponents(
                    make((256, 256), 0.1, target, rms=0.3, seed=seed), 0.1, estimators=names
                )[0].values()
            ]
            for seed in range(ensemble("surfaces of other makers"))
        ],
        axis=0,
    )
    np.testing.assert_allclose(found, target, atol=0.06)


def test_an_extruded_profile_has_one_dimension_more_than_the_profile():
    target = 0.7
    found = []
    n, seeds = ensemble("extruded profiles")
    for seed in range(seeds):
        profile = weierstrass_mandelbrot((2, n), 0.1, target, rms=0.3, seed=seed)[0]
        surface = extruded(profile, n)
        estimate, _ = measured_exponents(surface, 0.1, estimators=["second_differences"])
        found.append(estimate["second_differences"].hurst["x"].value)
        assert np.isnan(estimate["second_differences"].hurst["y"].value)  # no roughness at all
    assert 3 - np.mean(found) == pytest.approx((2 - target) + 1, abs=0.05)


# Properties


@pytest.mark.parametrize("make", MAKERS)
def test_surfaces_are_level_scaled_and_the_same_again(make):
    surface = make((60, 90), 0.1, 0.7, rms=0.3, seed=5)
    assert surface.shape == (60, 90)
    assert np.sqrt(np.mean(surface**2)) == pytest.approx(0.3)
    np.testing.assert_allclose(without_mean_plane(surface), surface, atol=1e-12)
    np.testing.assert_array_equal(surface, make((60, 90), 0.1, 0.7, rms=0.3, seed=5))
    assert not np.allclose(surface, make((60, 90), 0.1, 0.7, rms=0.3, seed=6))


def test_rows_of_an_extruded_profile_are_the_profile():
    profile = cantor_punch(2)
    np.testing.assert_array_equal(extruded(profile, 3), [profile] * 3)


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize(
    "wrong", [{"hurst": 1.0}, {"hurst": 0.0}, {"rms": 0.0}, {"spacing": -1.0}, {"shape": (1, 9)}]
)
def test_what_cannot_be_made_is_refused(make, wrong):
    arguments = {"shape": (8, 8), "spacing": 0.1, "hurst": 0.7, "rms": 1.0} | wrong
    with pytest.raises(ValueError, match=r"must|needs"):
        make(**arguments, seed=0)


@pytest.mark.parametrize(
    "wrong", [{"generations": 0}, {"narrowing": 1.4}, {"narrowing": 1.0}, {"parts": 4}]
)
def test_a_punch_that_does_not_end_at_nodes_is_refused(wrong):
    with pytest.raises(ValueError, match="does not end at nodes"):
        cantor_punch(**({"generations": 3} | wrong))
