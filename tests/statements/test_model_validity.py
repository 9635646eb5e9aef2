"""The verdict on the elastic model: limits stated, limits assumed, and the worse of two counts."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from made_settings import made_settings

from fractalcontact.core.verdicts import GOOD, IN_PART, NOT_JUDGED, POOR
from fractalcontact.statements.model_validity import (
    Validity,
    elastic_model_validity,
    model_validity,
)

NOTHING = replace(made_settings().material, modulus=20e3)
STRENGTH = replace(NOTHING, joint_wall_strength=80.0)
HARDNESS = replace(STRENGTH, hardness=1000.0)


@pytest.mark.parametrize(
    ("material", "pressure", "slope", "verdict"),
    [
        (STRENGTH, 80.0, 0.3, GOOD),
        (STRENGTH, 81.0, 0.3, IN_PART),
        (STRENGTH, 241.0, 0.1, POOR),
        (STRENGTH, 10.0, 0.31, IN_PART),
        (STRENGTH, 10.0, 0.76, POOR),
        (STRENGTH, 10.0, np.nan, GOOD),
        # Yielded all over, its mean pressure is the hardness, but for rounding.
        (HARDNESS, 1000.0 * (1 + 1e-12), 0.1, GOOD),
        (HARDNESS, 1001.0, 0.1, POOR),
        # E/1000 and three times E/200 where nothing is stated.
        (NOTHING, 20.0, 0.1, GOOD),
        (NOTHING, 21.0, 0.1, IN_PART),
        (NOTHING, 301.0, 0.1, POOR),
        (STRENGTH, np.nan, 0.1, NOT_JUDGED),
    ],
)
def test_the_worse_of_pressure_and_slope_counts(material, pressure, slope, verdict):
    assert elastic_model_validity(pressure, slope, material).verdict == verdict


@pytest.mark.parametrize(
    ("nominal", "verdict"), [(1.0, GOOD), (500.0, GOOD), (501.0, IN_PART), (871.0, POOR)]
)
def test_contacts_that_crush_are_judged_by_what_the_window_can_carry(nominal, verdict):
    found = elastic_model_validity(1000.0, 0.1, HARDNESS, nominal)
    assert found.verdict == verdict
    assert "elastic" not in found.reason
    # Slopes count as of elastic contact, and a load nothing there.
    assert elastic_model_validity(1000.0, 0.8, HARDNESS, nominal).verdict == POOR
    assert elastic_model_validity(80.0, 0.1, STRENGTH, nominal).verdict == GOOD


def test_no_larger_pressure_or_slope_makes_it_better():
    order = (GOOD, IN_PART, POOR).index
    for material in (NOTHING, STRENGTH, HARDNESS):
        pressures, slopes = np.geomspace(1, 1e5, 30), np.linspace(0, 2, 30)
        by_pressure = [elastic_model_validity(p, 0.1, material).verdict for p in pressures]
        by_slope = [elastic_model_validity(1.0, slope, material).verdict for slope in slopes]
        for verdicts in (by_pressure, by_slope):
            ranks = [order(verdict) for verdict in verdicts]
            assert ranks == sorted(ranks)
            assert ranks[0] == 0
            assert ranks[-1] == 2


def test_a_stated_strength_within_the_assumed_range_is_judged_no_better_at_its_ends():
    """An assumed verdict of good, or of poor, holds for every usual strength."""
    order = (GOOD, IN_PART, POOR).index
    for strength in np.geomspace(20e3 / 1000, 20e3 / 200, 9):
        stated = replace(NOTHING, joint_wall_strength=strength)
        for pressure in np.geomspace(1, 1e4, 50):
            assumed = elastic_model_validity(pressure, 0.1, NOTHING).verdict
            if assumed != IN_PART:
                found = elastic_model_validity(pressure, 0.1, stated).verdict
                assert order(found) == order(assumed)


def test_the_reason_names_the_limit_and_both_numbers():
    found = elastic_model_validity(4880.0, 1.11, STRENGTH)
    assert found.reason == (
        "contacts bear 4880 MPa on average, beyond the joint wall strength (80 MPa); rms "
        "slope 1.11, too steep"
    )
    assumed = elastic_model_validity(5.0, 0.1, NOTHING)
    assert "none being stated (E/1000 to E/200: 20 to 100 MPa)" in assumed.reason


@pytest.mark.parametrize("material", [NOTHING, STRENGTH, HARDNESS])
def test_the_stage_holds_the_verdict_of_every_state_at_the_finest_resolution(material):
    rng = np.random.default_rng(1)
    dims, shape = ("offset", "direction", "resolution", "normal_force"), (3, 2, 2, 4)
    forces = np.geomspace(1, 1e4, 4)
    sigma_n = rng.uniform(10, 500, shape)
    sigma_n[0, 0, :, 0] = np.nan  # too few nodes touch
    coords = {"offset": [0.1, 0.2, 0.4], "direction": ["N", "W"], "normal_force": forces}
    coords["nominal_pressure"] = ("normal_force", forces / 100)
    scaling = xr.Dataset({"sigma_n": (dims, sigma_n)}, coords | {"resolution": [2, 1]})
    slopes = rng.uniform(0, 1, (2, 3))
    area = xr.Dataset({"rms_slope": (("direction", "offset"), slopes)}, coords)
    found = model_validity(area, scaling, material)
    assert found["verdict"].dims == ("direction", "offset", "normal_force")
    for i, j, k in np.ndindex(found["verdict"].shape):
        wanted = elastic_model_validity(
            sigma_n[j, i, 1, k], slopes[i, j], material, forces[k] / 100
        )
        state = found.isel(direction=i, offset=j, normal_force=k)
        np.testing.assert_equal(Validity.of(state), wanted)
    assert found["verdict"].values[0, 0, 0] == NOT_JUDGED
    assert all({"units", "long_name"} <= one.attrs.keys() for one in found.data_vars.values())
