"""Exponents over the side b with intervals over disjoint sub-windows."""

import numpy as np
import pytest
import xarray as xr
from ensembles import ensemble

from fractalcontact.size_effect.division import split, spread_windows
from fractalcontact.size_effect.size_exponents import (
    add_size_exponents,
    kept_fractions,
    size_exponent,
    usable_sizes,
)

PARTS = (1, 2, 3, 4, 6, 8)
SIDES = 24.0 / np.array(PARTS)
PLACES = [np.arange(n * n) for n in PARTS]


def windows_of(field, parts=PARTS):
    """Means of a field of 24 x 24 over its sub-windows, (part, window)."""
    values = np.full((len(parts), 64), np.nan)
    for k, n in enumerate(parts):
        values[k, : n * n] = split(field, n).mean(axis=(1, 2))
    return values


def joint(rng, exponent, scatter=0.2, waves=0.1):
    """Sub-windows of one joint: a patchy field, each window with a chance of its own."""
    coarse = np.kron(rng.normal(size=(6, 6)), np.ones((4, 4)))
    field = np.exp(scatter * rng.normal(size=(24, 24)) + waves * coarse)
    values = windows_of(field) * SIDES[:, np.newaxis] ** exponent
    own = np.sqrt(np.array(PARTS)[:, np.newaxis] / 8) * 0.05
    return values * np.exp(own * rng.normal(size=values.shape))


# -- exact -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("exponent", [-0.7, 0.0, 0.4])
def test_exact_power_is_recovered_without_width(exponent):
    values = windows_of(np.ones((24, 24))) * 3 * SIDES[:, np.newaxis] ** exponent
    found = size_exponent(PARTS, SIDES, values, PLACES)
    np.testing.assert_allclose(found.ends, exponent, atol=1e-9)
    assert (found.n, *np.exp(found.over)) == (6, pytest.approx(3.0), pytest.approx(24.0))


def test_windows_that_do_not_count_leave_the_exponent_to_the_others():
    values = windows_of(np.ones((24, 24))) * 3 * SIDES[:, np.newaxis] ** 0.4
    for k, places in enumerate(PLACES):
        if len(places) > 1:
            values[k, 0] = np.nan
    found = size_exponent(PARTS, SIDES, values, PLACES)
    np.testing.assert_allclose(found.ends, 0.4, atol=1e-9)
    values[1:, 1:] = np.nan
    assert np.isnan(size_exponent(PARTS, SIDES, values, PLACES).value)


def test_quarters_left_out():
    np.testing.assert_allclose(kept_fractions(1, np.arange(1)), 0.75)
    np.testing.assert_allclose(kept_fractions(2, np.arange(4)), 1 - np.eye(4))
    thirds = kept_fractions(3, np.arange(9))
    # Of the ninths of the first quarter one lies in it, two half and the middle one by a quarter.
    np.testing.assert_allclose(thirds[0], [0, 0.5, 1, 0.5, 0.75, 1, 1, 1, 1])
    for n in PARTS:
        kept = kept_fractions(n, np.arange(n * n))
        np.testing.assert_allclose(kept.sum(axis=0), 3)  # every cell lies in one quarter
        np.testing.assert_allclose(kept.sum(axis=1), 0.75 * n * n)


def test_two_sizes_have_the_interval_of_their_windows():
    # Whole 1, quarters of mean 2: no line is needed to know how far that may be chance.
    quarters = np.array([1.5, 2.5, 1.8, 2.2])
    values = np.array([[1.0, np.nan, np.nan, np.nan], quarters])
    found = size_exponent((1, 2), np.array([2.0, 1.0]), values, PLACES[:2])
    means = np.log([np.delete(quarters, i).mean() for i in range(4)])
    error = np.sqrt(3 * np.var(means) + np.var(np.log(quarters), ddof=1)) / np.log(2)
    assert found.value == pytest.approx(-1)
    assert found.high - found.value == pytest.approx(3.182446 * error, rel=1e-6)


def test_too_few_sizes_have_none():
    values = windows_of(np.ones((24, 24)))
    values[1:] = np.nan
    assert np.isnan(size_exponent(PARTS, SIDES, values, PLACES).ends).all()


def test_a_state_of_few_nodes_leaves_out_its_size():
    nodes = np.array([[100.0, np.nan], [40, 30], [40, 29], [np.nan, np.nan]])
    np.testing.assert_array_equal(usable_sizes(nodes, 30), [True, True, False, False])


# -- coverage --------------------------------------------------------------------------------------


@pytest.mark.parametrize("exponent", [0.0, -0.5])
def test_interval_covers_the_exponent(exponent):
    n = ensemble("joints whose size exponent is known")
    rng = np.random.default_rng(1)
    found = [size_exponent(PARTS, SIDES, joint(rng, exponent), PLACES) for _ in range(n)]
    covered = np.mean([one.low <= exponent <= one.high for one in found])
    assert covered >= 0.93
    assert np.mean([one.value for one in found]) == pytest.approx(exponent, abs=0.01)
    # It does not say nothing: no effect and -0.5 are distinguished.
    assert np.mean([one.high - one.low for one in found]) < 0.5


# -- properties ------------------------------------------------------------------------------------


def test_units_change_nothing():
    values = joint(np.random.default_rng(2), -0.3)
    one = size_exponent(PARTS, SIDES, values, PLACES)
    other = size_exponent(PARTS, 1e3 * SIDES, 1e-6 * values, PLACES)
    np.testing.assert_allclose(other.ends, one.ends, rtol=1e-9)
    assert other.n == one.n


def test_it_does_not_matter_which_way_the_joint_lies():
    rng = np.random.default_rng(3)
    field = np.exp(0.3 * rng.normal(size=(24, 24)))
    one = size_exponent(PARTS, SIDES, windows_of(field), PLACES)
    for turned in (field.T, field[::-1], field[:, ::-1]):
        found = size_exponent(PARTS, SIDES, windows_of(turned), PLACES)
        np.testing.assert_allclose(found.ends, one.ends, rtol=1e-9, atol=1e-12)


def test_more_scatter_is_a_wider_interval():
    widths = []
    for scatter in (0.05, 0.2, 0.8):
        found = size_exponent(
            PARTS, SIDES, joint(np.random.default_rng(4), 0.0, scatter, 0.0), PLACES
        )
        widths.append(found.high - found.low)
    assert widths[0] < widths[1] < widths[2]


def test_windows_that_were_chosen_keep_their_places():
    places = [spread_windows(n, 4) for n in PARTS]
    values = np.full((6, 4), np.nan)
    for k, where in enumerate(places):
        values[k, : len(where)] = SIDES[k] ** 0.25
    result = xr.Dataset({"side": ("part", SIDES)}, {"part": list(PARTS), "load": [1.0]})
    data = xr.DataArray(values[..., np.newaxis], dims=("part", "window", "load"))
    add_size_exponents(result, "exponent", data, places, "exponent of it")
    for end in ("", "_low", "_high"):
        np.testing.assert_allclose(result[f"exponent{end}"], [0.25], atol=1e-9)
    assert result["exponent_n"].item() == 6
    assert result["exponent_b_max"].attrs["units"] == "mm"
