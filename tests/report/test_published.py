"""The register of published numbers: each stands once, and one reader reads it."""

import re
from pathlib import Path

import numpy as np
import xarray as xr

import fractalcontact
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.subject import Subject
from fractalcontact.core.verdicts import NO_PRESSURE, TOO_WIDE
from fractalcontact.report.columns import columns_of, old_columns_of
from fractalcontact.report.published import (
    BY_SCAN,
    BY_TOUCH,
    PLACES,
    TOO_UNCERTAIN,
    Number,
    Row,
    published,
    read,
    read_at,
    row_of,
    shown_in,
    stages_of,
    under_load,
)

DIMS = ("direction", "offset", "resolution", "normal_force")
FORCES = [1.0, 2.0, 3.0]


def over_loads(values, units="mm"):
    return DIMS, np.reshape(values, (1, 1, 1, 3)), {"units": units}


def subject(budget=None, **closure):
    """A specimen with one direction, offset and resolution, and three loads."""
    stage = xr.Dataset(
        {
            "solved": over_loads([True, True, "solved" not in closure], "1"),
            "suspect_load_share": over_loads([0.0, 0.0, 0.9], "1"),
            **{name: over_loads(values) for name, values in closure.items()},
            "reported_direction": "W",
            "reported_offset": 0.1,
            "reported_resolution": 1,
            "reported_load": ("normal_force", [True, True, True]),
            "reference_load": ("normal_force", [False, True, False]),
        },
        coords={
            "direction": ["W"],
            "offset": [0.1],
            "resolution": [1],
            "normal_force": FORCES,
            "nominal_pressure": ("normal_force", [10.0, 20.0, 30.0]),
        },
    )
    stages = {"closure": stage}
    if budget is not None:
        stages["error_budget"] = budget
    return Subject(stages, {"material": {"modulus": 5.0, "hardness": np.inf}})


def row(**keys):
    return Row("width", "width", "closure/width", "mm", **keys)


def test_a_row_is_all_that_a_quantity_needs():
    numbers = read(row(), subject(width=[1, 2, 3]))
    assert [(one.at, one.value, one.missing) for one in numbers] == [
        ({"pressure": 10.0 * value}, value, "") for value in (1, 2, 3)
    ]
    assert columns_of(row(summary="breadth"), numbers[1]) == {"breadth_mm": 2}


def test_columns_are_of_one_rule_whether_a_value_is_known_or_not():
    of = row(summary="breadth", interval="fit", range=("a/b", "a/c"), why=True)
    found = columns_of(of, read(of, subject(width=[1, np.nan, 3]))[1])
    assert list(found) == [
        *("breadth_mm", "breadth_low_mm", "breadth_high_mm"),
        *("breadth_determined", "breadth_reason"),
    ]
    assert not found["breadth_determined"]
    one = Number({}, Estimate(2.0, 1.0, 4.0), error=0.5, population=0.7, hardest=3.0)
    found = columns_of(row(summary="breadth", budget="width"), one)
    assert found == {
        **{"breadth_mm": 2.0, "breadth_low_mm": 1.0, "breadth_high_mm": 4.0},
        **{"breadth_error_surface_mm": 0.5, "breadth_error_population_mm": 0.7},
        "breadth_hardest_mm": 3.0,
    }
    found = old_columns_of(row(summary="breadth", range=("a/b", "a/c")), one)
    assert found == {"breadth_mm_low": 1.0, "breadth_mm_high": 4.0, "breadth_mm_determined": True}


def test_an_interval_is_its_own_or_from_the_error_of_the_budget_within_its_bounds():
    ends = {"width": [1, 2, 3], "width_low": [0.5, 1, 2], "width_high": [2, np.nan, 4]}
    assert read(row(), subject(**ends))[0].estimate.ends == (1, 0.5, 2)
    one_end = read(row(), subject(width=[1, 2, 3], width_low=[0.5, 1, 2]))[0]
    assert np.isnan(one_end.estimate.low)
    errors = xr.Dataset(
        {
            "width_total": ("normal_force", [4.0, 0.5, np.nan]),
            "width_total_of_population": ("normal_force", [5.0, 6.0, 7.0]),
        },
        coords={"normal_force": FORCES, "quantity": ["other"]},
    )
    first, second, third = read(row(budget="width"), subject(errors, width=[1, 2, 3]))
    assert first.estimate.ends == (1, 0, 5)
    assert (second.estimate.low, second.error, second.population) == (1.5, 0.5, 6.0)
    assert np.isnan([third.estimate.low, third.error, third.hardest]).all()


def test_a_quantity_of_the_budget_by_source_has_its_error_too():
    budget = xr.Dataset(
        {
            kind: (("quantity", "normal_force"), [[0.1, 0.2, 0.3], [1.0, 2.0, 3.0]])
            for kind in ("total", "total_of_population", "hardest")
        },
        coords={"quantity": ["other", "width"], "normal_force": FORCES},
    )
    found = read(row(budget="width"), subject(budget, width=[1, 2, 3]))
    assert [(one.error, one.population, one.hardest) for one in found] == [
        (error, error, error) for error in (1.0, 2.0, 3.0)
    ]


def test_of_several_reasons_for_no_number_the_nearest_is_given():
    lacks = row(missing="none of this kind")
    assert read(lacks, subject())[0].missing == "none of this kind"
    assert [one.missing for one in read(lacks, subject(width=[1, np.nan, 3]))] == [
        "",
        "none of this kind",
        "",
    ]
    unsolved = subject(width=[1, 2, np.nan], solved=[1, 1, 0])
    assert read(lacks, unsolved)[2].missing == "not solved under this load"


def test_what_is_no_result_is_missing_and_a_fit_that_is_none_is_undetermined():
    flagged = {"width": [1, 2, 3], "says": [1, 0, np.nan]}
    found = read(row(flag="closure/says", note="too few"), subject(**flagged))
    assert [one.missing for one in found] == ["", "too few", "too few"]
    ends = flagged | {"width_low": [0.9, 1.9, 2.9], "width_high": [1.1, 2.1, 3.1]}
    fits = read(row(flag="closure/says", range=("a/b", "a/c")), subject(**ends))
    assert [(one.missing, one.determined) for one in fits] == [("", True), ("", False), ("", False)]


def test_a_number_that_its_error_outweighs_is_undetermined_and_says_so():
    of = row(error="closure/off", most=0.5, by_scan=True)
    found = read(of, subject(width=[1, 2, 3], off=[0.4, 1.2, 0.1]))
    assert [one.determined for one in found] == [True, False, False]
    assert [one.remark for one in found] == ["", TOO_UNCERTAIN, BY_SCAN]
    assert not any(one.missing for one in found)
    without = read(row(error="closure/off"), subject(width=[1, 2, 3], off=[0.4, 1.2, 0.1]))
    assert all(one.determined for one in without)


def test_a_number_that_is_no_result_is_empty_in_a_table():
    flagged = subject(width=[1, 2, 3], says=[1, 0, 1], width_low=[0, 1, 2], width_high=[2, 3, 4])
    of = row(flag="closure/says", note="a bound", summary="breadth", interval="fit", why=True)
    found = columns_of(of, read(of, flagged)[1])
    assert found.pop("breadth_reason") == "a bound"
    assert np.isnan(list(found.values())).all()
    assert columns_of(of, read(of, flagged)[0])["breadth_mm"] == 1


def test_the_scan_and_a_wide_interval_leave_a_number_undetermined():
    found = read(row(by_scan=True), subject(width=[1, 2, 3]))
    assert [one.determined for one in found] == [True, True, False]
    ends = {"width": [1, 2, 1], "width_low": [0.9, 0.1, 0.5], "width_high": [1.1, 9, 1.5]}
    found = read(row(range=("a/b", "a/c")), subject(**ends))
    assert [one.determined for one in found] == [True, False, True]
    assert found[1].remark == TOO_WIDE
    # What counts from first touch is undetermined under every load where that is a scan error.
    ends = {"width": [1, 2, 3], "width_low": [0.9, 1.9, 2.9], "width_high": [1.1, 2.1, 3.1]}
    touched = subject(suspect_load_share=[0.9, 0.2, 0.2], **ends)
    found = read(row(by_scan=True, from_touch=True), touched)
    assert [one.remark for one in found] == [BY_SCAN, BY_TOUCH, BY_TOUCH]
    assert not any(one.determined for one in found)
    # A dimension that is 2 needs no interval, and one over all dimensions says nothing.
    ends = {"width": [2, 1, 1], "width_low": [2, -1, 0.9], "width_high": [2, 2.5, 1.1]}
    found = read(row(dimension=True), subject(**ends))
    assert [one.determined for one in found] == [True, False, True]


def test_the_first_need_that_a_specimen_lacks_is_the_reason():
    of = row(needs=("basic_friction_angle", "joint_wall_strength"))
    known, material = subject(width=[1, 2, 3]), {"modulus": 5.0, "hardness": np.inf}
    for stated, missing in (
        ({}, "no basic friction angle is stated"),
        ({"basic_friction_angle": 30.0}, "no joint wall strength is stated"),
        ({"basic_friction_angle": 30.0, "joint_wall_strength": 80.0}, ""),
    ):
        one = Subject(known.stages, {"material": material | stated})
        assert read(of, one)[0].missing == missing


def test_a_number_under_a_load_is_the_only_one_where_others_are_not_over_the_loads():
    loads = read(row(), subject(width=[1, 2, 3]))
    assert [under_load(loads, load, 3).value for load in range(3)] == [1, 2, 3]
    assert under_load(loads, 1, 4).value == 1  # at reference pressures
    alone = [Number({"direction": "W"}, Estimate(5.0))]
    assert under_load(alone, 0, 1).value == 5
    assert read_at(row(), subject(width=[1, 2, 3])).value == 2  # the reference load


def test_stages_of_a_place_are_those_of_its_rows_and_of_the_reported_state():
    assert {"specimens", "closure", "error_budget", "flow", "domains"} < stages_of("explorer")
    assert "measured" in stages_of("section")
    assert "settings" not in stages_of("section")
    assert stages_of() == {"specimens", "closure", "error_budget"}


def test_no_bound_on_the_pressure_is_no_number():
    (hardness,) = read(row_of("hardness"), subject())
    assert hardness.missing == row_of("hardness").missing
    assert np.isnan(hardness.value)
    (modulus,) = read(row_of("modulus"), subject())
    assert (modulus.value, modulus.missing) == (5, "")


def test_what_is_missing_says_why_before_what_is_to_know_of_it():
    known = Estimate(1.0, 0.9, 1.1, reason="to know")
    assert Number({}, known, "missing").remark == "missing"
    assert Number({}, known).remark == "to know"
    assert Number({}, Estimate(1.0, 0.9, 1.1)).remark == ""
    assert Number({}, Estimate(1.0, 0.9, 1.1), determined=False).remark == BY_SCAN
    assert Number({}, Estimate(1.0), determined=False).remark == "its error is not known"


def test_a_dimension_lies_in_the_plane_and_an_error_may_be_one_of_the_stage():
    errors = xr.Dataset(
        {f"width_{kind}": ("normal_force", [4.0, 0.5, 0.5]) for kind in ("total", "hardest")},
        coords={"normal_force": FORCES, "quantity": ["other"]},
    )
    errors["total_of_population"] = (("quantity", "normal_force"), [[1.0, 1.0, 1.0]])
    of = row(dimension=True, budget="width")
    assert read(of, subject(errors, width=[1, 1, 1]))[0].estimate.ends == (1, 0, 2)
    of = row(error="closure/spread", within=(-np.inf, np.inf))
    found = read(of, subject(width=[1, 2, 3], spread=[2, 1, 0.5]))
    assert [one.estimate.low for one in found] == [-1, 1, 2.5]
    assert [one.error for one in found] == [2, 1, 0.5]


def test_a_lacking_stage_and_a_flag_without_a_value_have_reasons_of_their_own():
    lacks = Row("gap", "gap", "flow/gap", "mm", absent="no flow", missing="no load")
    assert read(lacks, subject())[0].missing == "no flow"
    of = row(flag="closure/says", note="too few", missing="none")
    found = read(of, subject(width=[1, np.nan, 3], says=[0, 0, 1]))
    assert [one.missing for one in found] == ["too few", "none", ""]


def test_a_stage_that_leaves_loads_out_has_no_value_there():
    """Branches end far above the seating pressure; tables go through all loads."""
    known = subject()
    words = {"units": "1"}
    data = {
        "width": ("normal_force", [2.0, 3.0], {"units": "mm"}),
        "why": ("normal_force", ["", "too full"], words),
        "nominal_pressure": ("normal_force", [20.0, 30.0], {"units": "MPa"}),
    }
    branches = xr.Dataset(data, coords={"normal_force": FORCES[1:]})
    both = Subject({**known.stages, "branches": branches}, known.settings)
    of = Row("width", "width", "branches/width", "mm", reason="branches/why", missing="no branch")
    found = read(of, both)
    assert [one.missing for one in found] == ["no branch", "", ""]
    assert [one.value for one in found[1:]] == [2.0, 3.0]
    assert [str(one.estimate.reason) for one in found] == ["", "", "too full"]


def test_all_states_of_a_quantity_are_read_where_its_row_says_so():
    known = subject()
    coords = {"contact_direction": ["W", "E"], "offset": [0.1]}
    width = (("contact_direction", "offset"), [[1.0], [2.0]], {"units": "mm"})
    strength = xr.Dataset({"width": width}, coords=coords)
    both = Subject({**known.stages, "strength": strength}, known.settings)
    of = Row("width", "width", "strength/width", "mm", all=True)
    assert [one.at["direction"] for one in read(of, both)] == ["W", "E"]


def test_what_is_known_where_the_reported_state_was_not_solved_is_no_gap():
    unsolved = [1.0, 1.0, 1.0]  # the third load, whatever the values
    numbers = read(row(), subject(width=[1, 2, 3], solved=unsolved))
    assert [one.missing for one in numbers] == ["", "", ""]
    # Of numbers over more than the loads the state says nothing.
    dims = ("contact_direction", "normal_force")
    coords = {"contact_direction": ["W", "E"], "normal_force": FORCES}
    coords["nominal_pressure"] = ("normal_force", [10.0, 20.0, 30.0])
    width = (dims, [[1.0, 2.0, np.nan], [1.0, 2.0, 3.0]], {"units": "mm"})
    known = subject(solved=unsolved)
    stages = {**known.stages, "strength": xr.Dataset({"width": width}, coords=coords)}
    of = Row("width", "width", "strength/width", "mm", all=True, missing="no angle")
    assert read(of, Subject(stages, known.settings))[2].missing == "no angle"


def test_a_dimension_has_signed_errors_and_says_whether_it_is_determined():
    of = Row("width", "width", "closure/width", "1", dimension=True, summary="width")
    assert of.signed
    assert not row().signed
    one = Number({}, Estimate(1.5, 1.4, 1.6))
    assert columns_of(of, one)["width_determined"]
    # What has no unit was never named with the unit first.
    fitted = Row("width", "width", "closure/width", "1", summary="width", range=("a/b", "a/c"))
    assert old_columns_of(fitted, one) == {}


def test_each_quantity_stands_once_and_is_shown_somewhere():
    names = [row.name for row in published()]
    assert len(names) == len(set(names)) > 60
    kept = shown_in("shown")
    # A row of the atlas alone says what it tells.
    assert all(len(row.shown.split()) > 3 for row in kept)
    assert not any(row in kept for row in shown_in(*(PLACES.keys() - {"shown"})))
    assert shown_in(*PLACES) == published()
    for place in ("summary", "curves", "page", "index"):
        shown = [getattr(row, place) for row in shown_in(place)]
        assert len(shown) == len(set(shown)) > 3
    # A table by source has rows of the budget, which the page names.
    assert all(row.budget and row.page for row in shown_in("errors"))


def test_the_reason_for_no_pressure_is_that_of_the_elastic_model():
    assert row_of("sigma_n").missing == NO_PRESSURE


def test_one_reader_gives_numbers_to_pages_and_cards():
    """No module of theirs reads an estimate, or a total of the error budget, by itself."""
    own = re.compile(r"""Estimate\.read\(|\["total(_of_population)?"\]""")
    source = Path(fractalcontact.__file__).parent
    found = [
        path.relative_to(source).as_posix()
        for room in ("pages", "cards")
        for path in (source / room).rglob("*.py")
        if own.search(path.read_text(encoding="utf-8"))
    ]
    assert found == []


def test_a_unit_is_the_last_word_of_a_column():
    """But for the names of release 1.0, which stand beside the new ones once more."""
    at = {"pressure": 5.0, "test": "a b", "sampling": "1.27 mm", "direction": "W"}
    for one in shown_in("summary"):
        for column in columns_of(one, Number(at, Estimate(1.0))):
            unit = one.unit.replace("/", "_per_")
            words = ("determined", "reason")
            assert one.unit == "1" or column.endswith((f"_{unit}", *words)), column
            assert " " not in column
