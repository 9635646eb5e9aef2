import numpy as np
import pytest
import xarray as xr
from ensembles import ensemble

from contactlab.experiments.delta_g import estimator_bias
from contactlab.figures.experiments import estimator_bias as figure
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.roughness.dimension import surface_dimension
from fractalcontact.roughness.recommended import RECOMMENDED
from fractalcontact.roughness.registry import ESTIMATORS
from fractalcontact.surface.synthesis import self_affine

#: Their slope is H itself within 0.03 for H from 0.5 to 0.9, even without correction.
LITTLE_BIASED = ["second_differences", "roughness_length", "power_spectrum"]
RECIPE = {
    "hurst": [0.3, 0.5, 0.8],
    "sizes": [256, 128],
    "seeds": list(range(ensemble("surfaces of every exponent"))),
}


@pytest.fixture(scope="module")
def bias():
    return estimator_bias(RECIPE)


def test_estimators_keep_their_promises(bias):
    natural = bias.sel(size=256, hurst=[0.5, 0.8])
    # Of 10 or 20 surfaces; the mean of 50 is held to 0.03.
    unbiased = (np.abs(natural["bias"]) <= 0.03).all("hurst")
    assert unbiased.sum() >= 3
    assert (np.abs(natural["bias"].sel(estimator=LITTLE_BIASED)) <= 0.04).all()
    # Rougher surfaces than natural ones too, whose missing short waves raise H.
    assert (bias["coverage"] >= 0.9).all()
    # No interval is wide enough to hold anything.
    assert (natural["half_width"].sel(estimator=LITTLE_BIASED) < 0.13).all()


def test_known_bias_is_taken_off(bias):
    smooth = bias.sel(hurst=0.8, size=256)
    for name in ("variogram", "triangular_prism"):
        assert smooth["slope_bias"].sel(estimator=name) < -0.05
        assert np.abs(smooth["bias"].sel(estimator=name)) < 0.04
    for name in LITTLE_BIASED:
        # Of points nothing is to be taken off but the aliasing of the spectrum, and what a roll-off
        # does that one surface of twenty is taken to have.
        seen = float(smooth["roll_off_seen"].item())
        atol = 0.005 if name == "power_spectrum" else 1e-9 + 0.05 * seen
        without = smooth.sel(estimator=name)
        np.testing.assert_allclose(without["slope_bias"], without["bias"], rtol=1e-7, atol=atol)


def test_table_is_that_of_the_single_surfaces(bias):
    found = bias["found"].sel(hurst=0.5, size=128)
    surface = self_affine((128, 128), 1.0, 0.5, rms=1.0, seed=7)
    np.testing.assert_allclose(
        found.sel(seed=7).squeeze("roll_off"), surface_dimension(surface, 1.0)["hurst"], rtol=1e-12
    )
    chosen = bias.sel(hurst=0.5, size=128)
    np.testing.assert_allclose(chosen["rms_error"] ** 2, ((found - 0.5) ** 2).mean("seed"))
    np.testing.assert_allclose(chosen["bias"], found.mean("seed") - 0.5)
    np.testing.assert_allclose(chosen["scatter"], found.std("seed", ddof=1))
    assert ((chosen["bias_low"] < chosen["bias"]) & (chosen["bias"] < chosen["bias_high"])).all()
    held = (chosen["found_low"] <= 0.5) & (chosen["found_high"] >= 0.5)
    np.testing.assert_allclose(chosen["coverage"], held.mean("seed"))


def test_verdicts_are_about_natural_surfaces_alone(bias):
    assert bias["estimator"].values.tolist() == list(ESTIMATORS)
    natural = bias.sel(hurst=[0.5, 0.8])
    every = ["hurst", "size", "roll_off"]
    np.testing.assert_allclose(bias["worst_bias"], np.abs(natural["bias"]).max(every))
    np.testing.assert_allclose(bias["min_coverage"], natural["coverage"].min(every))
    mean_square = (natural["rms_error"] ** 2).mean(every)
    np.testing.assert_allclose(bias["overall_error"] ** 2, mean_square)
    rough = estimator_bias({"hurst": [0.3], "sizes": [64], "seeds": [1, 2]})
    assert rough["worst_bias"].isnull().all()


@pytest.fixture(scope="module")
def rolled():
    seeds = list(range(ensemble("surfaces with a roll-off") + 1))
    recipe = {"hurst": [0.5, 0.8], "sizes": [256], "roll_offs": [0.125, 0.25], "seeds": seeds}
    return estimator_bias(recipe)


def test_intervals_hold_below_a_roll_off(rolled):
    assert rolled["roll_off"].values.tolist() == [0.25, 0.125]
    assert (rolled["roll_off_seen"] == 1).all()
    assert (rolled["coverage"] >= 0.9).all()
    # Before the correction variogram and prisms would have missed all of them.
    for name in ("variogram", "triangular_prism"):
        missed = np.abs(rolled["slope_bias"].sel(estimator=name, hurst=0.8))
        assert (missed > 0.15).all()
        assert (np.abs(rolled["bias"].sel(estimator=name, hurst=0.8)) < 0.06).all()
    assert rolled.attrs["recommended"] == RECOMMENDED
    assert rolled["overall_error"].sel(estimator=RECOMMENDED) < 0.08


def test_a_surface_without_a_fit_is_counted_as_that():
    # A roll-off of 16 cells leaves the variogram too few lags, and the wider windows enough.
    few = estimator_bias({"hurst": [0.8], "sizes": [64], "roll_offs": [0.25], "seeds": [1, 2]})
    few = few.squeeze(["hurst", "size", "roll_off"])
    found = np.isfinite(few["found"])
    np.testing.assert_allclose(few["fitted"], found.mean("seed"))
    assert (few["coverage"].notnull() == found.any("seed")).all()
    assert few["fitted"].sel(estimator=RECOMMENDED) > 0


def test_every_variable_says_what_it_is(bias):
    for name, values in bias.data_vars.items():
        assert {"units", "long_name"} <= set(values.attrs), name


# The figure


def drawn(bias):
    with print_style():
        drawing = figure.draw(xr.DataTree.from_dict({"/estimator_bias/surfaces": bias}), [])
        drawing.figure.draw_without_rendering()
    return drawing


def test_figure_shows_the_table_and_says_what_holds(bias):
    drawing = drawn(bias)
    shown = drawing.data.set_index(["estimator", "hurst", "size"])["bias"]
    for (name, hurst, size), value in shown.items():
        assert value == bias["bias"].sel(estimator=name, hurst=hurst, size=size).item()
    assert drawing.caption.startswith("Supplementary figure.")


def test_verdict_follows_the_numbers(bias):
    errors = bias["overall_error"]
    least = errors.where(errors["estimator"] != RECOMMENDED, 0.01)
    good = bias.assign(overall_error=least, min_coverage=xr.full_like(least, 0.95))
    words = drawn(good).caption
    assert "has an rms error of 0.010, the least" in words
    assert "contain H in 95 % or more, those of the worst estimator in 95 %" in words
    bad = bias.assign(overall_error=xr.where(errors["estimator"] == "variogram", 0.01, 0.2))
    bad["min_coverage"] = xr.full_like(least, 0.5)
    words = drawn(bad).caption
    assert "has an rms error of 0.200, variogram one of 0.010" in words
    assert "contain H in 50 % or more" in words


def test_each_roll_off_has_its_panels(rolled):
    drawing = drawn(rolled)
    assert len(drawing.figure.axes) == 4
    assert len(drawing.caption.split()) < 70
    assert set(drawing.data["roll_off"]) == {0.125, 0.25}


def test_rough_surfaces_alone_allow_no_verdict():
    rough = estimator_bias({"hurst": [0.3], "sizes": [64], "seeds": [1, 2]})
    assert "No H of 0.5 or more" in drawn(rough).caption
