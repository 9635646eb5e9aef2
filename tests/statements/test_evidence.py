"""Verdicts on realisations of a kind, of ensembles in which a statement is true, false or open."""

import numpy as np
import pytest
import xarray as xr
from judged_joints import SETTINGS, stages

from fractalcontact.core.claims import all_claims
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.labels import TWINS
from fractalcontact.core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from fractalcontact.ensemble.statistics import add_statistics, add_trends
from fractalcontact.statements.evidence import Evidence, OfRealisations, evidence_of
from fractalcontact.statements.findings import Joint
from fractalcontact.statements.judge import judge, rule_of
from fractalcontact.statements.study import judge_study

FORCES = np.array([10.0, 100.0, 1000.0, 10000.0])
REALISATIONS = 12
#: Values over realisations scatter about their mean by so much, over loads independently.
SCATTER = 0.02
#: Statements on joints of a kind.
NAMES = [
    "compliance_rises_at_first",
    "curves_overlap",
    "compliance_rises_again",
    "composite_dimension_rises",
    "compliance_goes_with_dimension",
    "larger_samples_close_more",
    "closure_grows_as_roughness",
    "voids_grow_with_size",
    "area_falls",
    "dilatancy_flattens",
    "area_is_lacunar",
    "estimates_agree",
    "dimension_rises_by_area",
    "dimension_rises_by_boxes",
    "dimension_spans_all",
    "size_effect_follows",
    "larger_domains_are_less_dense",
    "domains_are_fractal",
    "domains_differ_from_cuts",
    "domains_are_isotropic",
]
#: Box sides of local slopes, mm.
SIDES = 0.1 * 2.0 ** np.arange(6)
OCTAVES = ("normal_force", "null_octave")
#: Offsets, mm: the faces correlate up to 0.5 mm by 1/e, not at all from 2 mm on.
V = np.array([0.1, 0.2, 0.4, 0.6, 1.2, 1.9, 10.0])
DIRECTIONS = ["W", "E", "N", "S"]
#: What may be changed of the sliding.
SLIDING_KEYS = {"compliance", "area", "lag", "plateau_trend", "plateau_change", "undecided"}


def made(seed=0, **changes):
    """An ensemble of which everything the paper says holds, but for what is changed."""
    means = {
        "delta_sigma": [0.2, 0.8, 1.4, 1.9],
        "delta_sigma_random": [0.1, 0.5, 0.9, 1.2],
        "delta_sigma_area": [0.2, 0.8, 1.4, 1.9],
        "difference": np.zeros(4),
        "area_bend": np.zeros(4),
        "eq6_area": np.zeros(4),
        "eq6_box": np.zeros(4),
        "area_exponent": -0.6,
        "compliance_exponent": 0.6,
        "closure_exponent": 0.6,
        "roughness_exponent": 0.6,
        "void_exponent": 0.6,
        "random_void_exponent": 0.0,
        "gap_exponent": 0.6,
        "interval_difference": 0.02,
        "nodes": np.full(4, 1000.0),
        "local_slope": [1.06, 1.1, 1.0, 1.08, 1.15],
        "local_slope_random": np.linspace(0, 2, 5),
        "local_slope_cut_difference": np.full(5, 0.2),
        "delta_sigma_cut_difference": 0.15 * (np.arange(4) - 1.5),
    }
    of_sliding = {name: changes.pop(name) for name in SLIDING_KEYS & changes.keys()}
    means |= changes
    for name in ("local_slope", "local_slope_random", "local_slope_cut_difference"):
        means[name] = np.broadcast_to(means[name], (len(FORCES), 5))
    means["local_slope_random_difference"] = means["local_slope"] - means["local_slope_random"]
    means["local_slope_cut"] = means["local_slope"] - means["local_slope_cut_difference"]
    rng = np.random.default_rng(seed)
    result = xr.Dataset(coords={"normal_force": FORCES})
    for name, mean in means.items():
        mean = np.asarray(mean, float)
        dims = ("realisation", *OCTAVES)[: 1 + mean.ndim]
        values = mean + SCATTER * rng.standard_normal((REALISATIONS, *mean.shape))
        result[name] = (dims, values, {"units": "1", "long_name": name})
    for name, values in add_sliding(rng, of_sliding).items():
        result[name] = values
    for ending, sides in (("", SIDES[1:]), ("_min", SIDES[:-1]), ("_max", SIDES[1:])):
        result[f"local_slope_side{ending}"] = "null_octave", sides
    add_trends(result)
    add_statistics(result, [*means, "lag_dimension"])
    pressure = FORCES / 100.0
    return result.assign_coords(nominal_pressure=("normal_force", pressure))


def add_sliding(rng, changes):
    """Sliding of realisations, with the scatter of the other quantities relative to the mean."""
    values = {
        "compliance": [1, 1.8, 3.2, 4, 4.1, 4.1, 5],
        "area": [40, 25, 15, 5, 5.1, 5.2, 4.95],
        "lag": np.linspace(2.0, 2.35, 7),
        "plateau_trend": [["level"] * 4] * REALISATIONS,
        "plateau_change": np.zeros((REALISATIONS, 4)),
        "undecided": "",
    } | changes

    def scattered(name):
        noise = 1 + SCATTER * rng.standard_normal((REALISATIONS, V.size))
        return ("realisation", "offset"), np.asarray(values[name]) * noise

    of_lags = np.repeat(np.asarray(values["lag"])[:, np.newaxis], 3, axis=1)
    scatter = SCATTER * rng.standard_normal((REALISATIONS, V.size, 3))
    lags = ("realisation", "offset", "lag_range")
    each = ("realisation", "direction")
    return {
        "offset": V,
        "direction": DIRECTIONS,
        "axis": ["E-W", "N-S"],
        "compliance_slid": scattered("compliance"),
        "area_slid": scattered("area"),
        "lag_dimension": (lags, of_lags + scatter, {"units": "1", "long_name": "dimension"}),
        "plateau_slope": (each, np.zeros((REALISATIONS, 4))),
        "plateau_change": (each, values["plateau_change"]),
        "plateau_trend": (each, np.asarray(values["plateau_trend"])),
        "plateau_undecided": (each, np.full((REALISATIONS, 4), "", object) + values["undecided"]),
        "odd_slope": (("realisation", "axis"), np.zeros((REALISATIONS, 2))),
    }


#: Two realisations of twelve are level in every direction; none is level.
SOME_LEVEL = [["level"] * 4] * 2 + [["level", "rising", "level", "rising"]] * 10
NONE_LEVEL = [["level", "rising", "level", "rising"]] * 12
CONCRETE = {**SETTINGS, "material": {**SETTINGS["material"], "name": "concrete"}}


def verdict(name, **changes):
    return found(name, **changes).verdict


def found(name, **changes):
    joint = Joint({**stages(), "ensemble": made(**changes)}, SETTINGS)
    return rule_of(name)(joint)


def test_a_minority_of_realisations_decides_nothing():
    correlated = np.array([["the faces still correlate"] * 4] * REALISATIONS, object)
    for decided, expected in ((5, UNDETERMINED), (6, FAILS)):
        correlated[:decided] = ""
        result = found("dilatancy_flattens", plateau_trend=NONE_LEVEL, undecided=correlated)
        assert result.verdict == expected
        assert f"none of {decided} realisations that slide far enough, of 12" in result.numbers


def test_twins_of_a_scan_judge_nothing():
    twins = made().assign_attrs(members=TWINS)
    assert type(evidence_of(Joint({"ensemble": twins}, SETTINGS))) is Evidence
    assert isinstance(evidence_of(Joint({"ensemble": made()}, SETTINGS)), OfRealisations)


@pytest.mark.parametrize("name", NAMES)
def test_an_ensemble_as_the_paper_has_it(name):
    held = found(name)
    assert held.verdict == HOLDS
    assert held.judged_on == "12 realisations"
    assert "12 realisations" in held.numbers


@pytest.mark.parametrize(
    ("name", "changes", "expected"),
    [
        ("compliance_rises_at_first", {"compliance": [4, 3, 2, 1, 1, 1, 1]}, FAILS),
        # Neighbours agree, offsets a factor of three apart do not.
        ("curves_overlap", {"compliance": [1, 1.8, 3.2, 4, 5, 6, 9]}, FAILS),
        ("curves_overlap", {"compliance": [1, 1.8, 3.2, 4, 4.35, 4.4, 9]}, UNDETERMINED),
        ("compliance_rises_again", {"compliance": [1, 1.8, 3.2, 4, 4.1, 4.1, 4.1]}, FAILS),
        # A rise without a plateau before is no second one.
        ("compliance_rises_again", {"compliance": [1, 1.8, 3.2, 4, 4.6, 5.2, 8]}, FAILS),
        ("compliance_rises_again", {"compliance": [1, 1.8, 3.2, 4, 4.1, 4.1, 4.475]}, PARTLY),
        ("composite_dimension_rises", {"lag": np.linspace(2.9, 2.35, 7)}, FAILS),
        ("compliance_goes_with_dimension", {"lag": np.linspace(2.9, 2.35, 7)}, FAILS),
        ("compliance_goes_with_dimension", {"lag": np.full(7, 2.35)}, UNDETERMINED),
        ("area_falls", {"area": np.full(7, 5.0)}, FAILS),
        ("area_falls", {"area": 5 * V**-0.1}, PARTLY),
        ("area_falls", {"area": 5 * V**-0.12}, HOLDS),
        ("dilatancy_flattens", {"plateau_trend": SOME_LEVEL}, PARTLY),
        ("dilatancy_flattens", {"plateau_trend": NONE_LEVEL}, FAILS),
        ("dilatancy_flattens", {"undecided": "the faces still correlate"}, UNDETERMINED),
        ("dilatancy_flattens_in_two", {}, FAILS),
        ("dilatancy_flattens_in_two", {"plateau_trend": SOME_LEVEL}, PARTLY),
        ("dilatancy_flattens_in_two", {"plateau_trend": NONE_LEVEL}, HOLDS),
        ("dilatancy_is_anisotropic", {}, FAILS),
        ("dilatancy_is_anisotropic", {"plateau_change": [[0, 0.4, 0, 0.1]] * 12}, HOLDS),
        (
            "dilatancy_is_anisotropic",
            {"plateau_change": [[0, 0.4, 0, 0.1]] * 3 + [[0, 0.2, 0, 0]] * 9},
            PARTLY,
        ),
        ("domains_are_isotropic", {"interval_difference": 0.2}, FAILS),
        ("domains_are_isotropic", {"interval_difference": 0.1}, UNDETERMINED),
        ("area_settles", {}, HOLDS),
        ("area_settles", {"area": [40, 25, 15, 9, 8, 7, 5]}, FAILS),
        # The compliance does not grow with size, closure from first touch does.
        ("larger_samples_close_more", {"compliance_exponent": 0.05}, PARTLY),
        ("larger_samples_close_more", {"compliance_exponent": 0.0, "closure_exponent": 0.0}, FAILS),
        ("larger_samples_close_more", {"closure_exponent": -0.4}, PARTLY),
        (
            "larger_samples_close_more",
            {"compliance_exponent": np.nan, "closure_exponent": np.nan},
            UNDETERMINED,
        ),
        (
            "closure_grows_as_roughness",
            {"roughness_exponent": 1.0, "compliance_exponent": 1.0, "gap_exponent": 1.0},
            HOLDS,
        ),
        ("closure_grows_as_roughness", {"roughness_exponent": 1.0}, FAILS),
        ("closure_grows_as_roughness", {"gap_exponent": 1.0}, PARTLY),
        ("closure_grows_as_roughness", {"roughness_exponent": 0.9}, UNDETERMINED),
        ("voids_grow_with_size", {"void_exponent": 0.0}, FAILS),
        ("voids_grow_with_size", {"void_exponent": np.nan}, UNDETERMINED),
        ("larger_domains_are_less_dense", {"area_exponent": -0.02}, FAILS),
        ("larger_domains_are_less_dense", {"area_exponent": 0.3}, FAILS),
        ("larger_domains_are_less_dense", {"area_exponent": np.nan}, UNDETERMINED),
        ("size_effect_follows", {"eq6_area": np.full(4, 0.5), "eq6_box": np.full(4, 0.7)}, FAILS),
        ("size_effect_follows", {"eq6_area": np.full(4, 0.5)}, PARTLY),
        (
            "size_effect_follows",
            {"eq6_area": np.full(4, np.nan), "eq6_box": np.full(4, np.nan)},
            UNDETERMINED,
        ),
        ("estimates_agree", {"difference": [0.6, 0.5, 0.4, 0.2]}, FAILS),
        ("estimates_agree", {"difference": [0.6, 0.5, 0.0, 0.0]}, PARTLY),
        ("estimates_agree", {"difference": np.full(4, np.nan)}, UNDETERMINED),
        ("area_is_lacunar", {"delta_sigma_area": np.full(4, 2.3)}, FAILS),
        ("area_is_lacunar", {"area_bend": np.full(4, 0.3)}, PARTLY),
        ("area_is_lacunar", {"delta_sigma_area": np.full(4, np.nan)}, UNDETERMINED),
        ("dimension_rises_by_area", {"delta_sigma_area": np.full(4, 1.4)}, FAILS),
        ("dimension_rises_by_area", {"delta_sigma_area": [1.9, 1.4, 0.8, 0.2]}, FAILS),
        ("dimension_rises_by_area", {"delta_sigma_area": [1.2, 1.3, 1.4, 1.5]}, PARTLY),
        ("domains_are_fractal", {"local_slope": [1.0, 1.1, 1.2, 1.3, 1.3]}, PARTLY),
        ("domains_are_fractal", {"local_slope": [1.6, 1.8, 1.9, 2.0, 2.0]}, FAILS),
        ("domains_are_fractal", {"nodes": np.full(4, 20.0)}, UNDETERMINED),
        ("domains_are_fractal", {"local_slope": [0.1, 0.5, 1.0, 1.5, 1.9]}, FAILS),
        # Random nodes have the same counts: they could have shown no structure.
        ("domains_are_fractal", {"local_slope_random": [1.06, 1.1, 1.0, 1.08, 1.15]}, UNDETERMINED),
        # As a cut at one height: that explains it, and changes no verdict.
        ("domains_are_fractal", {"local_slope_cut_difference": np.full(5, 0.05)}, HOLDS),
        ("domains_differ_from_cuts", {"local_slope_cut_difference": np.zeros(5)}, FAILS),
        ("domains_differ_from_cuts", {"local_slope_cut_difference": np.full(5, 0.05)}, FAILS),
        ("domains_differ_from_cuts", {"delta_sigma_cut_difference": np.full(4, 0.4)}, FAILS),
        ("domains_differ_from_cuts", {"nodes": np.full(4, 20.0)}, UNDETERMINED),
        ("dimension_rises_by_boxes", {"delta_sigma": np.full(4, 1.4)}, FAILS),
        ("dimension_spans_all", {"delta_sigma": [0.2, 0.5, 0.8, 0.9]}, FAILS),
        ("dimension_spans_all", {"delta_sigma": [0.8, 0.9, 1.1, 1.9]}, PARTLY),
        ("dimension_spans_all", {"delta_sigma": np.full(4, np.nan)}, UNDETERMINED),
    ],
    ids=str,
)
def test_what_does_not_hold_of_a_kind_is_said(name, changes, expected):
    assert verdict(name, **changes) == expected


def test_a_wide_interval_under_the_heaviest_load_leaves_the_upper_end_open():
    wide = made(delta_sigma=[0.6, 0.7, 0.9, 0.8])
    wide["delta_sigma_mean_high"][-1] = 1.9
    joint = Joint({**stages(), "ensemble": wide}, SETTINGS)
    assert rule_of("dimension_spans_all")(joint).verdict == UNDETERMINED


def test_random_nodes_explain_voids_and_change_no_verdict():
    for of_random in (0.0, 0.6):
        held = found("voids_grow_with_size", random_void_exponent=of_random)
        assert held.verdict == HOLDS
        assert held.explanation.startswith(f"among as many random nodes x = {of_random:.1f}")


def test_the_specimen_is_judged_where_its_realisations_span_no_decade():
    name = "dimension_rises_by_area"
    short = found(name, delta_sigma_area=[np.nan, np.nan, np.nan, 1.9])
    assert (short.verdict, short.judged_on) == (HOLDS, "")
    assert found(name).judged_on == "12 realisations"


def test_what_the_interval_leaves_open_is_undetermined_with_what_would_decide_it():
    wide = made()
    for end, value in (("", 0.1), ("_low", -0.1), ("_high", 0.3)):
        wide[f"compliance_exponent_mean{end}"] = value
        wide[f"closure_exponent_mean{end}"] = value
    judged = judge({**stages(), "ensemble": wide}, SETTINGS).sel(
        statement="larger_samples_close_more"
    )
    assert judged["verdict"] == UNDETERMINED
    claim = all_claims()["larger_samples_close_more"]
    assert str(judged["note"].item()).endswith(claim.decides)


def test_without_an_ensemble_the_specimen_is_judged():
    plain = judge(stages(), SETTINGS)
    assert set(plain["judged_on"].values) == {"this specimen"}
    both = judge({**stages(), "ensemble": made()}, SETTINGS)
    on = dict(zip(both["statement"].values, both["judged_on"].values, strict=True))
    for name, subject in on.items():
        assert (subject == "12 realisations") == (name in NAMES)


def test_every_statement_says_what_would_decide_it():
    assert all(claim.decides for claim in all_claims().values())


@pytest.mark.parametrize(
    ("less", "words"),
    [
        (np.zeros(4), "no faster than the bearing-area cut"),
        (0.3 * np.arange(4), "faster than the bearing-area cut"),
        (0.1 * np.arange(4), "not surely faster"),
        # A cut near 2 cannot rise, so that the two are not compared.
        ([-1.8, -1.2, -0.6, 0.0], "not compared with the bearing-area cut"),
    ],
    ids=str,
)
def test_the_cut_explains_a_rise_and_changes_no_verdict(less, words):
    finding = found(
        "dimension_rises_by_boxes",
        delta_sigma=[0.2, 0.8, 1.4, 1.9],
        delta_sigma_cut_difference=less,
    )
    assert finding.verdict == HOLDS
    assert words in finding.explanation


@pytest.mark.parametrize(
    ("values", "expected"),
    [((1.7, 1.7, 1.5), HOLDS), ((1.4, 1.6, 1.6), FAILS), ((1.6, 1.6, 1.6), UNDETERMINED)],
)
def test_kinds_are_compared_by_the_errors_of_their_means(values, expected, monkeypatch):
    monkeypatch.setattr("fractalcontact.statements.study.best_dimension", Estimate)
    flat = {**SETTINGS, "opposite": "flat"}
    surfaces = {
        str(dimension): {
            **stages(),
            "surface_dimension": dimension,
            "ensemble": made(seed=seed, delta_sigma_area=np.full(4, value)),
        }
        for seed, (dimension, value) in enumerate(zip((2.1, 2.3, 2.5), values, strict=True))
    }
    judged = judge_study(surfaces, dict.fromkeys(surfaces, flat))
    row = judged.sel(statement="size_exponent_grows_with_dimension")
    assert row["verdict"] == expected
    assert row["judged_on"] == "realisations of each"
