"""Figures of the direct test of eq. 6, of the two estimators of Delta_sigma, and Fig. 11."""

import re

import numpy as np
import pytest
import xarray as xr
from cases import representative

from fractalcontact.core.subject import Subject
from fractalcontact.figures.joint import size_prediction, size_test
from fractalcontact.figures.kit.drawing import print_style, save
from fractalcontact.figures.paper import fig11_slope_angle
from fractalcontact.size_effect.eq6 import add_decisions
from fractalcontact.size_effect.strength_laws import slope_angle

SPECIMENS = ("sliding", "flat", "pair")


def drawn(module, atlas, name):
    with print_style():
        return module.draw(atlas, name)


def changed(atlas, group, change):
    """The atlas with one group put through a function of its dataset."""
    other = atlas.copy()
    other[group] = xr.DataTree(change(other[group].to_dataset()))
    return other


def axes_labels_have_units(figure):
    axes = [a for part in (figure, *figure.subfigs) for a in part.axes]
    assert axes
    for one in axes:
        labels = [label for label in (one.get_xlabel(), one.get_ylabel()) if label]
        assert labels
        assert all(re.search(r"\(.+\)$", label) for label in labels)


def written_twice_alike(module, atlas, name, folder):
    for run in ("first", "second"):
        with print_style():
            save(module.draw(atlas, name), folder / run, "figure")
    for ending in ("png", "svg", "csv", "txt"):
        first, second = (
            (folder / run / f"figure.{ending}").read_bytes() for run in ("first", "second")
        )
        assert first == second
        assert len(first) > 100


# -- the direct test -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", representative(SPECIMENS))
def test_direct_test_labels_and_caption(atlas, name):
    for module in (size_test, size_prediction):
        drawing = drawn(module, atlas, name)
        drawing.figure.draw_without_rendering()
        axes_labels_have_units(drawing.figure)
        assert Subject.of(atlas, name).settings["label"] in drawing.figure.get_suptitle()
        assert "nan" not in drawing.caption


@pytest.mark.parametrize("name", representative(SPECIMENS))
def test_direct_test_points_are_those_of_the_atlas(atlas, name):
    test = atlas[f"size_test/{name}"].to_dataset()
    data = drawn(size_test, atlas, name).data
    for panel, column, variable in (
        ("a", "area_fraction", "area_fraction"),
        ("b", "area_exponent", "area_exponent"),
        ("c", "slope", "slope"),
        ("b", "predicted_slope", "predicted_slope"),
    ):
        points = data[(data["panel"] == panel)]
        if panel == "b":
            points = points[points["estimator"].isna() == (column == "area_exponent")]
        expected = test[variable].transpose("normal_force", ...).values.ravel()
        np.testing.assert_array_equal(points[column], expected)
    said = data[data["estimator"].notna()]
    assert list(said["verdict"]) == list(test["verdict"].T.values.ravel())
    predicted = drawn(size_prediction, atlas, name).data
    area = predicted[predicted["panel"] == "b"].set_index(["predictor", "normal_force_N"])
    for (predictor, force), row in area.iterrows():
        stored = test.sel(predictor=predictor, normal_force=force)
        np.testing.assert_array_equal(row["predicted_area"], stored["predicted_area"])
        np.testing.assert_allclose(row["ratio"], 1 + stored["area_error"])
    assert set(area.index.get_level_values(0)) == set(size_prediction.PREDICTORS)


@pytest.mark.parametrize("name", representative(SPECIMENS))
def test_every_table_of_the_size_test_names_a_load_alike(atlas, name):
    test = atlas[f"size_test/{name}"].to_dataset()
    known = {
        force: (pressure, beyond)
        for force, pressure, beyond in zip(
            *(test[v].values for v in ("normal_force", "nominal_pressure", "beyond_study")),
            strict=True,
        )
    }
    for module in (size_test, size_prediction):
        for row in drawn(module, atlas, name).data.itertuples():
            assert known[row.normal_force_N] == (row.nominal_pressure_MPa, row.beyond_study)


def test_prediction_is_headed_by_the_heaviest_load_of_the_study(atlas):
    def predicted(test, beyond):
        for quantity in ("closure", "area"):
            error = test[f"{quantity}_error"]
            test[f"{quantity}_error"] = xr.full_like(error, 0.25)
        test["beyond_study"] = test["beyond_study"].copy(data=beyond)
        add_decisions(test)
        return test

    pressure = atlas["size_test/sliding"]["nominal_pressure"].values
    for first, shown in ((3, 2), (0, -1)):
        beyond = np.arange(len(pressure)) >= first
        tree = changed(
            atlas, "size_test/sliding", lambda test, beyond=beyond: predicted(test, beyond)
        )
        caption = drawn(size_prediction, tree, "sliding").caption
        beyond = ", beyond the study's loads," if first == 0 else ""
        assert f"At {pressure[shown]:.3g} MPa{beyond} the predictions are" in caption
        for quantity in ("closure", "contact area"):
            assert f"1.2 to 1.2 times the solved {quantity}" in caption


def judged_as(atlas, verdict, reason):
    """The size test of the sliding joint with one verdict and reason at all loads of the study."""

    def set_all(test):
        test["beyond_study"] = xr.zeros_like(test["beyond_study"], dtype=bool)
        for name, value in (("verdict", verdict), ("reason", reason)):
            test[name] = test[name].copy(data=np.full(test[name].shape, value, object))
        add_decisions(test)
        return test

    return changed(atlas, "size_test/sliding", set_all)


@pytest.mark.parametrize(
    ("verdict", "reason", "said"),
    [
        (
            "agrees",
            "",
            "by A_r(s) eq. 6 agrees at {n} of {n} conclusive loads, by box counting",
        ),
        (
            "measured flatter",
            "",
            "by A_r(s) eq. 6 agrees at none of {n} conclusive loads, by box counting eq. 6 agrees",
        ),
        ("undecided", "the cat ate it", "inconclusive: the cat ate it"),
    ],
)
def test_a_verdict_on_eq_6_carries_its_reason(atlas, verdict, reason, said):
    tree = judged_as(atlas, verdict, reason)
    drawing = drawn(size_test, tree, "sliding")
    test = tree["size_test/sliding"].to_dataset()
    n = test["normal_force"].size
    assert said.format(n=n) in drawing.caption
    decides = test["decides"].sel(estimator=list(size_test.ESTIMATORS))
    assert decides.sum() == (0 if verdict == "undecided" else decides.size)


def test_measured_and_predicted_have_colours_of_their_own(atlas):
    for axes in drawn(size_test, atlas, "sliding").figure.axes:
        laws = {line.get_color() for line in axes.lines if line.get_linestyle() in ("-", "--")}
        points = {line.get_color() for line in axes.lines if line.get_marker() in "os^"}
        assert not laws & points


def test_direct_test_without_a_slope(atlas):
    def nothing_found(test):
        for name in ("slope", "area_exponent"):
            for end in ("", "_low", "_high"):
                test[f"{name}{end}"] = test[f"{name}{end}"] * np.nan
        return test

    drawing = drawn(size_test, changed(atlas, "size_test/flat", nothing_found), "flat")
    drawing.figure.draw_without_rendering()
    assert "Parts hold too few nodes in contact" in drawing.caption
    assert "nan" not in drawing.caption


@pytest.mark.full
def test_direct_test_is_the_same_twice(atlas, tmp_path):
    written_twice_alike(size_test, atlas, "sliding", tmp_path)


# -- Fig. 11 ---------------------------------------------------------------------------------------


def test_slope_angle_is_where_a_block_slides():
    assert slope_angle(5.0, 5.0) == pytest.approx(45)
    assert slope_angle(0.0, 5.0) == 0


@pytest.mark.parametrize("name", representative(["sliding", "pair"]))
def test_slope_angle_labels_table_and_caption(atlas, name):
    drawing = drawn(fig11_slope_angle, atlas, name)
    drawing.figure.draw_without_rendering()
    axes_labels_have_units(drawing.figure)
    assert "Fig. 11" in drawing.caption
    assert "nan" not in drawing.caption
    laws = atlas[f"windows/{name}"].to_dataset()
    shares = laws.sizes["share"] * laws.sizes["normal_force"] * laws.sizes["part"]
    assert len(drawing.data) == shares
    expected = np.degrees(np.arctan(laws["strength_at_equal_v_over_b"] / laws["nominal_pressure"]))
    expected = expected.transpose("share", "normal_force", "part").values.ravel()
    np.testing.assert_allclose(drawing.data["limit_slope_angle_degree"], expected)


def test_slope_angle_names_what_is_quoted(atlas):
    figure = drawn(fig11_slope_angle, atlas, "sliding").figure
    quoted = [line.get_label() for line in figure.axes[0].lines]
    assert any("1.66 - 2, by later work of the same school" in label for label in quoted)


def test_slope_angle_without_a_friction_angle(atlas):
    def unknown(laws):
        for name in [n for n in laws.data_vars if "strength" in n and n != "strength_share"]:
            laws[name] = laws[name] * np.nan
        return laws

    drawing = drawn(fig11_slope_angle, changed(atlas, "windows/sliding", unknown), "sliding")
    drawing.figure.draw_without_rendering()
    assert "No angle can be given" in drawing.caption


@pytest.mark.full
def test_slope_angle_is_the_same_twice(atlas, tmp_path):
    written_twice_alike(fig11_slope_angle, atlas, "sliding", tmp_path)
