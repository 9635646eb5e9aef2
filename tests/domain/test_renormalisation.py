import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.intervals import LEFT_OUT, t_quantile
from fractalcontact.domain.renormalisation import (
    area_bend,
    compare_dimensions,
    fractal_pressure,
    hausdorff_measure,
    nominal_pressure,
    renormalisation,
)
from fractalcontact.states.left_out import PARTS_LEFT_OUT

S = xr.DataArray(0.08 * 2.0 ** np.arange(4), dims="resolution")
DELTA = xr.DataArray([1.2, 1.5, 1.8], dims="normal_force")
FORCE = xr.DataArray([100.0, 1000.0, 10000.0], dims="normal_force")
MEASURE = xr.DataArray([3.0, 40.0, 200.0], dims="normal_force")
AREA = MEASURE * S ** (2 - DELTA)


def left_of(nodes):
    """Fractions left of nodes (..., resolution, part) without each part."""
    left = 1 - nodes / nodes.sum(axis=-1, keepdims=True)
    return xr.DataArray(left, dims=("sample", "resolution", LEFT_OUT)[-np.ndim(nodes) :])


LEFT = left_of(np.random.default_rng(1).poisson(30, (4, PARTS_LEFT_OUT)))


def test_exact_fractal_gives_back_its_dimension_and_measure():
    result = renormalisation(S, AREA, FORCE)
    assert result.delta_sigma.dims == ("normal_force",)
    np.testing.assert_allclose(result.delta_sigma, DELTA)
    np.testing.assert_allclose(result.hausdorff_measure, MEASURE)
    np.testing.assert_allclose(result.sigma_star, FORCE / MEASURE)
    assert (result.n == 4).all()


def test_one_power_law_does_not_bend():
    nodes = AREA / S**2
    np.testing.assert_allclose(area_bend(S, AREA, nodes, fewest=0).value, 0, atol=1e-12)
    # Delta_sigma 1 between the two finest spacings, 1.5 then, 1.7 between the two coarsest.
    bent = np.exp(np.cumsum(np.log(2) * np.array([0, 1, 0.5, 0.3]))) * xr.ones_like(S)
    many = xr.full_like(S, 100.0)
    assert float(area_bend(S, bent, many).value) == pytest.approx(-0.7)
    many[-1] = 3.0
    assert float(area_bend(S, bent, many).value) == pytest.approx(-0.5)
    many[-2] = 3.0
    assert np.isnan(area_bend(S, bent, many).value)


def test_interval_is_of_slopes_without_one_part_after_another():
    result = renormalisation(S, AREA, FORCE, left=LEFT)
    for load in range(3):
        without = np.log(AREA[load] * LEFT).transpose("resolution", LEFT_OUT)
        slopes = np.polyfit(np.log(S), without, 1)[0]
        half = t_quantile(slopes.size - 1) * np.sqrt((slopes.size - 1) * slopes.var())
        for end, sign in (("low", -1), ("high", 1)):
            expected = np.clip(DELTA[load] + sign * half, 0, 2)
            np.testing.assert_allclose(result[f"delta_sigma_{end}"][load], expected)


def test_no_parts_leave_no_interval_and_one_that_holds_all_leaves_all_open():
    assert np.isnan(renormalisation(S, AREA, FORCE).delta_sigma_low).all()
    alone = LEFT.copy()
    alone[-1] = np.arange(PARTS_LEFT_OUT) > 0
    result = renormalisation(S, AREA, FORCE, left=alone)
    np.testing.assert_allclose(result.delta_sigma, DELTA)
    assert (result.delta_sigma_low == 0).all()
    assert (result.delta_sigma_high == 2).all()


def test_what_all_resolutions_share_is_no_error_of_the_slope():
    shared = LEFT[0] * xr.ones_like(S)
    result = renormalisation(S, AREA, FORCE, left=shared)
    np.testing.assert_allclose(result.delta_sigma_high, DELTA)


def test_no_dimension_and_no_interval_goes_beyond_a_plane():
    # An area that grows with refinement has an exponent beyond 2, one that falls by s^2 or more 0.
    for delta, stated in ((-0.1, 0), (0.0, 0), (1.95, 1.95), (2.0, 2), (2.1, 2)):
        found = renormalisation(S, 40.0 * S ** (2 - delta) + 0 * FORCE, FORCE, left=LEFT)
        np.testing.assert_allclose(found.delta_sigma, stated, atol=1e-9)
        assert (found.delta_sigma_low >= 0).all()
        assert (found.delta_sigma_high <= 2).all()
        assert (found.delta_sigma_low <= found.delta_sigma).all()
        assert (found.delta_sigma <= found.delta_sigma_high).all()


def test_sigma_star_does_not_depend_on_resolution_though_sigma_n_does():
    whole, finer = (renormalisation(S[i], AREA[:, i], FORCE) for i in (slice(4), slice(3)))
    np.testing.assert_allclose(whole.sigma_star, finer.sigma_star)
    # Real pressures rise towards finer resolution, as in Fig. 8.
    assert (whole.sigma_n.transpose("resolution", "normal_force").diff("resolution") < 0).all()


def test_euclidean_contact_keeps_the_usual_pressure():
    area = xr.full_like(S, 7.0)
    result = renormalisation(S, area, xr.DataArray(70.0))
    assert result.delta_sigma.item() == pytest.approx(2)
    assert result.sigma_star.item() == pytest.approx(10)


def test_fit_agrees_with_numpy():
    rng = np.random.default_rng(0)
    area = AREA * np.exp(0.1 * xr.DataArray(rng.standard_normal(4), dims="resolution"))
    result = renormalisation(S, area, FORCE)
    for load in range(3):
        slope = np.polyfit(np.log(S), np.log(area[load]), 1)[0]
        assert result.delta_sigma[load].item() == pytest.approx(2 - slope)


def test_resolutions_without_contact_are_left_out():
    area = AREA.copy()
    area[0, :2] = 0.0
    area[1, 0] = np.nan
    result = renormalisation(S, area, FORCE)
    assert result.n.values.tolist() == [2, 3, 4]
    assert np.isnan(result.delta_sigma[0]).all()
    assert np.isnan(result.sigma_star[0]).all()
    np.testing.assert_allclose(result.delta_sigma[1:], DELTA[1:])
    assert np.isnan(result.sigma_n.sel(normal_force=0)[:2]).all()


@pytest.mark.parametrize(("nodes", "fitted"), [(1, 0), (3, 0), (4, 4)])
def test_few_nodes_have_no_dimension(nodes, fitted):
    result = renormalisation(S, nodes * S**2, xr.DataArray(10.0))
    assert result.n.item() == fitted
    if fitted:
        assert result.delta_sigma.item() == pytest.approx(0, abs=1e-9)
    else:
        assert np.isnan(result.delta_sigma)
        assert np.isnan(result.sigma_n).all()


def test_resolutions_of_few_nodes_are_left_out():
    nodes = xr.DataArray([200, 66, 22, 3], dims="resolution")
    result = renormalisation(S, nodes * S**2, xr.DataArray(10.0))
    assert result.n.item() == 3
    slope = np.polyfit(np.log(S[:3]), np.log(nodes[:3]), 1)[0]
    assert result.delta_sigma.item() == pytest.approx(-slope)
    assert np.isfinite(result.sigma_n).values.tolist() == [True, True, True, False]


def test_interval_holds_the_dimension_of_counts_that_scatter():
    rng = np.random.default_rng(0)
    expected = 400 * 2.0 ** (-1.2 * np.arange(4)) / PARTS_LEFT_OUT
    parts = rng.poisson(expected[:, np.newaxis], (500, 4, PARTS_LEFT_OUT))
    nodes = xr.DataArray(parts.sum(axis=-1), dims=("sample", "resolution"))
    result = renormalisation(S, nodes * S**2, xr.DataArray(10.0), left=left_of(parts))
    inside = (result.delta_sigma_low <= 1.2) & (result.delta_sigma_high >= 1.2)
    assert 0.93 <= inside.mean() <= 0.97


def test_more_dimensions_than_load():
    area = AREA.expand_dims(offset=2).transpose("offset", "resolution", "normal_force")
    result = renormalisation(S, area, FORCE)
    assert set(result.delta_sigma.dims) == {"offset", "normal_force"}
    assert result.sigma_star.transpose("offset", "normal_force").shape == (2, 3)
    np.testing.assert_allclose(result.delta_sigma.sel(offset=1), DELTA)


def test_negative_areas_and_spacings_are_refused():
    with pytest.raises(ValueError, match="negative"):
        renormalisation(S, -AREA, FORCE)
    with pytest.raises(ValueError, match="positive"):
        renormalisation(0 * S, AREA, FORCE)


def test_hausdorff_measure_counts_nodes_in_their_own_dimension():
    assert hausdorff_measure(0.5, 12 * 0.25, 1.5) == pytest.approx(12 * 0.5**1.5)
    assert hausdorff_measure(0.5, 12 * 0.25, 0.0) == pytest.approx(12)


def test_eq_6_of_a_full_square_is_the_pressure_applied_whatever_the_size():
    assert fractal_pressure(640.0, 8.0, 2.0) == pytest.approx(10.0)  # MPa, 640 N on 64 mm2


@pytest.mark.parametrize("delta", [0.4, 1.5, 2.0])
def test_eq_6_meets_the_specimen(delta):
    # Eq. 5 as written: sigma_0 A_0 = sigma* H_D of the whole joint.
    b, force = 16.0, 100.0
    assert fractal_pressure(force, b, delta) * b ** (delta - 2) == pytest.approx(force / b**2)


def test_sigma_star_does_not_depend_on_the_unit_of_length():
    # N mm^-delta in N m^-delta: a joint of 16 mm is one of 0.016 m.
    delta = 1.3
    in_mm, in_m = (fractal_pressure(100.0, b, delta) for b in (16.0, 0.016))
    assert in_m == pytest.approx(in_mm * 1000**delta)


def test_size_effect_has_the_slope_of_equation_six():
    b = np.array([20.0, 40.0, 200.0])
    sigma = nominal_pressure(5.0, 1.6, b)
    np.testing.assert_allclose(np.diff(np.log(sigma)) / np.diff(np.log(b)), -0.4)
    np.testing.assert_allclose(nominal_pressure(5.0, 2.0, b), 5.0)  # no size effect
    assert nominal_pressure(5.0, 1.3, 1.0) == 5.0


def test_size_effect_and_renormalisation_are_the_same_statement():
    # A fractal that fills the joint: N = (b/s)^Delta nodes, so H_D = b^Delta, sigma_0 = F/b^2.
    b, delta, force = 20.0, 1.6, 1000.0
    area = (b / S) ** delta * S**2
    result = renormalisation(S, area, xr.DataArray(force))
    sigma_0 = nominal_pressure(result.sigma_star, result.delta_sigma, b)
    assert sigma_0.item() == pytest.approx(force / b**2)


def known(values, half):
    """Delta_sigma over the load with even intervals."""
    values = np.array(values)
    found = Estimate(values, values - half, values + half)
    return xr.Dataset(found.variables("delta_sigma", "normal_force", "1", "dimension"))


def test_dimensions_are_compared_with_their_intervals():
    result = compare_dimensions(known([1.7, 1.5], 0.03), known([1.4, 1.45], 0.04))
    np.testing.assert_allclose(result.difference, [0.3, 0.05])
    np.testing.assert_allclose(result.difference_low, [0.25, 0.0], atol=1e-12)
    np.testing.assert_allclose(result.difference_high, [0.35, 0.1])
    assert result.disagree[0].item()


def test_missing_dimension_never_disagrees():
    result = compare_dimensions(known([1.5], 0.1), known([np.nan], 0.1))
    assert np.isnan(result.difference)
    assert not result.disagree


def test_no_bend_widens_the_interval_and_areas_that_no_sample_changes_have_none():
    nodes = xr.full_like(AREA, 1e4)
    weight = np.log(S) - np.log(S).mean()
    straight, bent = (
        renormalisation(S, area, FORCE, nodes, left=LEFT)
        for area in (AREA, AREA * np.exp(0.02 * weight**2))
    )
    for end in ("low", "high"):
        off = straight[f"delta_sigma_{end}"] - straight.delta_sigma
        np.testing.assert_allclose(bent[f"delta_sigma_{end}"] - bent.delta_sigma, off)
    # The bend is of four areas, of which each octave takes two.
    slopes = np.array([1, -1, -1, 1]) @ np.log(LEFT.values) / np.log(2)
    half = t_quantile(slopes.size - 1) * np.sqrt((slopes.size - 1) * slopes.var())
    bend = area_bend(S, AREA, nodes, left=LEFT)
    np.testing.assert_allclose(bend.high - bend.value, half)
    exact = xr.zeros_like(AREA)
    known = renormalisation(S, AREA, FORCE, nodes, left=LEFT, sampling=exact)
    np.testing.assert_allclose(known.delta_sigma_low, known.delta_sigma)
    np.testing.assert_allclose(known.delta_sigma_high, known.delta_sigma)
    some = renormalisation(S, AREA, FORCE, nodes, left=LEFT, sampling=exact.where(S[0] < S, 0.1))
    np.testing.assert_allclose(some.delta_sigma_high, straight.delta_sigma_high)
