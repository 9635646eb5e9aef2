"""Joints with and without a roll-off: what is kept of them, and what makes the plateau."""

import numpy as np
import pytest
import xarray as xr
from ensembles import ensemble

from contactlab.experiments.roll_off import add_trend, roll_off_effect
from fractalcontact.core.directions import DIRECTIONS

RECIPE = {
    "label": "made",
    "size": 25.6,
    "outline": "square",
    "spacing": 0.1,
    "dimension": 2.2,
    "rms": 0.2,
    "roll_off": 2.5,
}


@pytest.fixture(scope="module")
def effect():
    return roll_off_effect(RECIPE, 12.8, range(ensemble("joints with a roll-off")))


def test_dilatancy_levels_off_with_a_roll_off_and_rises_on_without(effect):
    with_it, without = (effect.sel(surface=f"{kind}_roll_off") for kind in ("with", "without"))
    half = float(effect["rigid_offset"][-1]) / 2
    second = effect["rigid_offset"] >= half
    change = [
        float(s["slope"] * half / s["rigid_dilatancy"][..., second].mean())
        for s in (with_it, without)
    ]
    assert abs(change[0]) < 0.1
    assert change[1] > 0.15
    assert without["slope_low"] > 0
    np.testing.assert_allclose([with_it["change"], without["change"]], change, rtol=0.02)
    assert (with_it["trend"].item(), without["trend"].item()) == ("level", "rising")


@pytest.mark.parametrize(
    ("shape", "trend"),
    [
        (lambda v: 1 - np.exp(-10 * v), "level"),
        (lambda v: v, "rising"),
        (lambda v: 2 - 0.2 * v, "falling"),
    ],
)
def test_a_plateau_is_separated_from_a_rise(effect, shape, trend):
    made, v = effect.copy(), effect["rigid_offset"]
    noise = 1 + 0.01 * effect["seed"]
    made["rigid_dilatancy"] = noise * shape(v) + 0 * effect["rigid_dilatancy"]
    add_trend(made)
    assert (made["trend"] == trend).all()
    second = v[v >= v[-1] / 2]
    change = (shape(second)[-1] - shape(second)[0]) / shape(second).mean()
    np.testing.assert_allclose(made["change"], change, rtol=0.05, atol=1e-6)


def test_seeds_that_disagree_show_no_trend(effect):
    made, v = effect.copy(), effect["rigid_offset"]
    slopes = xr.where(effect["seed"] % 2 == 0, 1.0, -0.2)
    made["rigid_dilatancy"] = 2 + slopes * v + 0 * effect["rigid_dilatancy"]
    add_trend(made)
    assert (made["trend"] == "").all()
    assert (made["slope_low"] < 0).all()


def test_slopes_are_those_of_the_second_half_of_the_offsets(effect):
    v = effect["rigid_offset"].values
    second = v >= v[-1] / 2
    opened = effect["rigid_dilatancy"].mean("direction").transpose("rigid_offset", ...).values
    for i in range(effect.sizes["surface"]):
        slopes = np.polyfit(v[second], opened[second][:, i], 1)[0]
        assert effect["slope"][i].item() == pytest.approx(slopes.mean(), rel=1e-9)


def test_the_spread_is_what_heights_and_correlation_make_it(effect):
    joints = effect.sel(surface="with_roll_off")
    expected = joints["face_rms"] * np.sqrt(2 - 2 * joints["face_correlation"].clip(max=1))
    mean = [values.mean(("seed", "direction")) for values in (expected, joints["composite_rms"])]
    np.testing.assert_allclose(mean[0], mean[1], rtol=0.05, atol=1e-6)


def test_short_waves_are_as_steep_in_both(effect):
    slope = effect["rms_slope"].transpose("surface", "seed")
    np.testing.assert_allclose(slope[0], slope[1], rtol=1e-12)


def test_all_slide_as_far_in_every_direction(effect):
    assert effect["direction"].values.tolist() == list(DIRECTIONS)
    assert float(effect["rigid_offset"][-1]) == pytest.approx(6.4, abs=0.11)
    assert np.isfinite(effect["rigid_dilatancy"]).all()
    assert (effect["rigid_dilatancy"].isel(rigid_offset=0) == 0).all()


def test_everything_is_labelled(effect):
    for name, variable in effect.data_vars.items():
        assert {"units", "long_name"} <= variable.attrs.keys(), name
