"""Ensembles: their first realisation is the named specimen, and a realisation knows no other."""

from dataclasses import asdict, replace

import numpy as np
import pytest
import xarray as xr
from made_stages import scan, stages_of
from materials import ROCK

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.settings import EnsembleSettings, read
from fractalcontact.ensemble.realisations import EXPONENTS, STATES, _add_eq6, ensemble
from fractalcontact.ensemble.statistics import TRENDS, add_statistics, add_trends
from fractalcontact.study.configuration import (
    resolve_embedded,
    resolve_settings,
    solver_settings,
)
from fractalcontact.surface.embedded import embedded_surface

SOLVER = solver_settings({}, "tiny")
RECIPE = {"label": "tiny", "size": "12.8 mm", "spacing": "0.1 mm", "dimension": 2.2}
RECIPE |= {"rms": "0.2 mm", "roll_off": "2 mm", "seed": 5, "realisations": 4}
#: Where each of the states stands among the stages of a specimen.
STAGE_OF = dict.fromkeys(STATES, "closure")
STAGE_OF |= {"delta_sigma": "domains", "delta_sigma_area": "scaling", "difference": "scaling"}
#: States that the stages of a specimen do not have.
OWN = ("mean_gap", "delta_sigma_random", "area_bend")


def _stated(opposite):
    study = {
        "materials": {"rock": ROCK},
        "defaults": {
            "material": "rock",
            "opposite": opposite,
            "window": "6.4 mm",
            "contact_directions": ["W"],
            "offsets": ["0.2 mm", "0.5 mm"],
            "map_offset": "0.5 mm",
            "loads": ["0.25 MPa", "2 MPa", "10 MPa", "60 MPa"],
            "dilatancy_loads": ["2 MPa", "10 MPa"],
            "map_load": "10 MPa",
            "resolutions": [1, 2, 4],
        },
        "embedded": {"tiny": RECIPE},
    }
    return resolve_settings(study, "tiny", {}, "study")


@pytest.fixture(scope="module", params=["match", "flat"])
def made(request):
    """Stages of a specimen, its recipe and settings, and its ensemble."""
    settings, recipe = _stated(request.param), resolve_embedded(RECIPE, "embedded.tiny")
    faces = (scan(embedded_surface(recipe), recipe["spacing"]), None)
    known = stages_of("tiny", faces, settings, SOLVER, later=("closure",))
    light = read(EnsembleSettings, asdict(settings))

    def of(realisations, recipe=recipe, settings=light):
        return ensemble(known["specimens"], known["joints"], recipe, realisations, settings, SOLVER)

    return known, of, light, of(4)


def test_the_first_realisation_is_the_named_specimen(made):
    known, _, light, found = made
    np.testing.assert_array_equal(found["normal_force"], known["closure"]["normal_force"])
    for name in STATES:
        if name not in OWN:
            stage = known[STAGE_OF[name]]
            at = {"direction": light.contact_directions[0], "resolution": 1}
            state = stage[name].sel({dim: at[dim] for dim in at if dim in stage[name].dims})
            state = state.sel(offset=found.attrs["offset"])
            np.testing.assert_array_equal(found[name][0], state, err_msg=name)
    contact = known["contact"].sel(normal_force=found.attrs["map_load"])
    mean_gap = found["mean_gap"][0].sel(normal_force=found.attrs["map_load"])
    assert float(contact["map_gap"].mean()) == pytest.approx(float(mean_gap), rel=1e-5)


def test_a_realisation_does_not_depend_on_how_many_there_are_nor_on_which_is_first(made):
    _, of, _, four = made
    three = of(3)
    np.testing.assert_array_equal(four["seed"], [5, 6, 7, 8])
    for name in (*STATES, *EXPONENTS):
        np.testing.assert_array_equal(three[name], four[name][:3], err_msg=name)
    later = of(3, recipe=resolve_embedded(RECIPE | {"seed": 6}, "embedded.tiny"))
    for name in (*STATES, *EXPONENTS):
        np.testing.assert_array_equal(later[name], four[name][1:], err_msg=name)


def test_realisations_under_more_loads_are_solved_under_those_that_are_drawn(made):
    _, of, light, found = made
    more = [(0.1, "pressure"), (0.25, "pressure"), (1.0, "pressure"), *light.loads[1:]]
    again = of(3, settings=replace(light, loads=more))
    np.testing.assert_array_equal(again["normal_force"], found["normal_force"])


def test_one_resolution_is_enough_but_for_what_compares_several(made):
    _, of, light, found = made
    alone = of(3, settings=replace(light, resolutions=[1]))
    np.testing.assert_array_equal(alone["nodes"], found["nodes"][:3])
    for name in ("delta_sigma_area", "area_bend", "difference", "delta_sigma_area_trend"):
        assert alone[name].isnull().all()


def test_closures_count_from_one_load_at_which_every_realisation_is_resolved(made):
    found = made[-1]
    closing = found["closure_from_common_seat"].transpose("realisation", ...).values
    resolved = (found["nodes"] >= 10).all("realisation").values
    assert resolved.any()
    first = int(np.argmax(resolved))
    assert (closing[:, first] == 0).all()
    assert np.isnan(closing[:, :first]).all()
    assert (np.diff(closing[:, first:], axis=1) > 0).all()


def test_every_number_has_its_mean_and_interval(made):
    found = made[-1]
    for name in (*STATES, *EXPONENTS, *TRENDS):
        mean = Estimate.read(found, f"{name}_mean")
        known = found[f"{name}_n"].values == 4
        half = (
            found[name].std("realisation", ddof=1).values * 3.182446 / 2
        )  # t of three degrees of freedom
        np.testing.assert_allclose(
            (mean.high - mean.low)[known] / 2, half[known], rtol=1e-5, atol=1e-12
        )
        np.testing.assert_allclose(
            np.asarray(mean.value)[known],
            found[name].mean("realisation").values[known],
            atol=1e-12,
        )


def _made_up(delta, cut):
    force = 10.0 ** np.arange(delta.shape[1])
    dims = ("realisation", "normal_force")
    attrs = {"units": "1", "long_name": "Delta_sigma"}
    return xr.Dataset(
        {
            "delta_sigma": (dims, delta, attrs),
            "delta_sigma_cut_difference": (dims, delta - cut, attrs),
            "delta_sigma_area": (dims, np.full(delta.shape, np.nan), attrs),
        },
        coords={"normal_force": force},
    )


def test_eq_6_is_missed_by_the_exponent_of_the_area_less_the_dimension_less_two():
    """The difference is 0 where A_r/A_0 ~ b^(Delta_sigma - 2), and has the sign of what is more."""
    attrs = {"units": "1", "long_name": "a number"}
    made = xr.Dataset(
        {
            "area_exponent": ("realisation", [-0.5, -0.4, -0.7], attrs),
            "delta_sigma_area": ("realisation", [1.5, 1.5, 1.5], attrs),
            "delta_sigma": ("realisation", [1.6, 1.6, 1.6], attrs),
        }
    )
    _add_eq6(made)
    np.testing.assert_allclose(made["eq6_area"], [0.0, 0.1, -0.2], atol=1e-12)
    np.testing.assert_allclose(made["eq6_box"], [-0.1, 0.0, -0.3], atol=1e-12)


def test_trends_are_slopes_per_decade_over_the_loads_that_all_realisations_have():
    slopes = np.array([0.2, 0.4, 0.6])
    delta = 0.5 + slopes[:, np.newaxis] * np.arange(4)
    delta[1, 0] = np.nan
    delta[:2, 0] += 10  # where one realisation has none the others do not count
    result = _made_up(delta, np.broadcast_to(0.3 * np.arange(4), (3, 4)))
    add_trends(result)
    np.testing.assert_array_equal(result["delta_sigma_trend_used"], [False, True, True, True])
    np.testing.assert_allclose(result["delta_sigma_trend"], slopes)
    np.testing.assert_allclose(result["departure_trend"], slopes - 0.3)
    assert result["delta_sigma_area_trend"].isnull().all()
    assert float(result["delta_sigma_trend_mean"]) == pytest.approx(0.4)


def test_departures_from_a_cut_that_fills_the_window_are_left_out():
    cut = np.broadcast_to([1.2, 1.4, 1.6, 1.99], (3, 4))
    away = np.array([0.1, 0.2, 0.3, 0.0])
    result = _made_up(cut + away, cut)
    add_trends(result)
    np.testing.assert_array_equal(result["departure_trend_used"], [True, True, True, False])
    np.testing.assert_allclose(result["departure_trend"], 0.1)
    assert result["delta_sigma_trend_used"].all()


def test_the_interval_of_the_mean_holds_it_in_95_of_100_ensembles():
    draws = np.random.default_rng(1).normal(3.0, 0.5, (12, 2000))
    result = xr.Dataset(
        {"x": (("realisation", "of"), draws, {"units": "mm", "long_name": "a length"})}
    )
    add_statistics(result, ["x"])
    mean = Estimate.read(result, "x_mean")
    assert np.mean((mean.low <= 3) & (mean.high >= 3)) == pytest.approx(0.95, abs=0.015)
    assert result["x_mean"].attrs["units"] == "mm"


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        ("mean_gap", 0, np.inf),
        ("nodes", 0, np.inf),
        ("closure_from_common_seat", 0, np.inf),
        ("local_slope", 0, 2),
        ("area_bend", -np.inf, np.inf),
    ],
)
def test_intervals_end_at_the_bounds_of_the_quantity(name, least, most):
    rows = ("realisation", [0.01, 0.02, 1.9], {"units": "1", "long_name": "a quantity"})
    result = xr.Dataset({name: rows})
    add_statistics(result, [name])
    kinds = [of for of in ("mean", "band") if f"{name}_{of}_low" in result]
    assert (kinds == ["mean", "band"]) == (name in ("mean_gap", "local_slope"))
    ends = [float(result[f"{name}_{of}_{end}"]) for of in kinds for end in ("low", "high")]
    assert [end < 0 for end in ends] == [least < 0, False] * len(kinds)
    assert min(ends) >= least
    assert max(ends) <= most
