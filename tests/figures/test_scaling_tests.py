"""Figures of the direct test of eq. 6, of the two estimators of Delta_sigma, and Fig. 11."""

import numpy as np
import pytest
import xarray as xr
from cases import representative
from drawings import changed, draw

from fractalcontact.figures.joint import size_prediction, size_test
from fractalcontact.figures.paper import fig11_slope_angle
from fractalcontact.size_effect.eq6 import add_decisions
from fractalcontact.size_effect.strength_laws import slope_angle

SPECIMENS = ("sliding", "flat", "pair")


def drawn(module, atlas, name):
    return draw(atlas, module.__name__.rpartition(".")[2], name)


# -- the direct test -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", representative(SPECIMENS))
def test_ratio_of_prediction_and_solution_is_one_and_the_error_of_the_atlas(atlas, name):
    test = atlas[f"size_test/{name}"].to_dataset()
    table = drawn(size_prediction, atlas, name).data
    assert set(table["predictor"]) == set(size_prediction.PREDICTORS)
    for panel, quantity, column in (("a", "closure", "ratio_mm"), ("b", "area", "ratio")):
        for row in table[table["panel"] == panel].to_dict("records"):
            stored = test.sel(predictor=row["predictor"], normal_force=row["normal_force_N"])
            np.testing.assert_allclose(row[column], 1 + stored[f"{quantity}_error"])


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


# -- Fig. 11 ---------------------------------------------------------------------------------------


def test_slope_angle_is_where_a_block_slides():
    assert slope_angle(5.0, 5.0) == pytest.approx(45)
    assert slope_angle(0.0, 5.0) == 0


def test_slope_angle_is_that_of_the_strength_over_the_pressure(atlas):
    laws = atlas["windows/sliding"].to_dataset()
    expected = np.arctan(laws["strength_at_equal_v_over_b"] / laws["nominal_pressure"])
    angles = laws["limit_slope_angle"].transpose(*expected.dims)
    np.testing.assert_allclose(angles, np.degrees(expected))


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
