"""Figures of contact domains and their scaling: 8, 9, 10, 12 and 13."""

import json
import re
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from cases import representative
from drawings import breaches, draw, keep_drawings
from matplotlib.figure import Figure

from fractalcontact.core.fitting import fit_line
from fractalcontact.core.intervals import LEFT_OUT
from fractalcontact.core.limits import CORRECTED_NODES
from fractalcontact.core.settings import Material, read
from fractalcontact.core.subject import Subject
from fractalcontact.core.text import compact
from fractalcontact.domain.analysis import scaling_over_resolutions
from fractalcontact.domain.box_dimension import ESTIMATORS
from fractalcontact.domain.renormalisation import extrapolated_pressure
from fractalcontact.figures.kit import drawing as common
from fractalcontact.figures.kit.axes import label_short_span
from fractalcontact.figures.kit.domains import contact_domain, spread_loads
from fractalcontact.statements.model_validity import model_validity
from fractalcontact.states.states import with_pressure

NAMES = (
    "fig08_prefractals",
    "fig09_box_counting",
    "fig10_scaling",
    "fig12_evolution",
    "fig13_size_effect",
)
SPECIMENS = ("sliding", "flat", "pair")


@pytest.fixture(scope="module")
def atlas(atlas):
    """The atlas as if each node were 40: enough that their areas can be corrected."""
    changed = atlas.copy()
    for name in SPECIMENS:
        subject = Subject.of(atlas, name)
        curves = subject["closure"].load()
        areas = [f"area{of}{share}" for of in ("", "_corrected") for share in ("", "_share")]
        for quantity in ("nodes", *areas):
            curves[quantity] = (40 * curves[quantity]).assign_attrs(curves[quantity].attrs)
        curves["area_corrected_resolved"] = curves["nodes"] >= CORRECTED_NODES
        changed[f"closure/{name}"] = xr.DataTree(curves)
        left = np.random.default_rng(1).uniform(0.9, 1, (curves.sizes["resolution"], 9))
        left = xr.DataArray(left, dims=("resolution", LEFT_OUT))
        scaling = scaling_over_resolutions(curves, subject["domains"], 0.1, left=left)
        scaling = scaling.merge(extrapolated_pressure(scaling, np.sqrt(subject.area)))
        changed[f"scaling/{name}"] = xr.DataTree(with_pressure(scaling, subject.area))
    return keep_drawings(changed)


@pytest.mark.parametrize("specimen", representative(SPECIMENS, 1))
@pytest.mark.parametrize("figure", NAMES)
def test_figures_of_many_nodes_keep_the_contract(atlas, figure, specimen):
    """Both estimates of Delta_sigma are known there, which few nodes leave undetermined."""
    drawing = draw(atlas, figure, specimen)
    assert breaches(drawing, atlas, figure, specimen) == []
    assert drawing.caption.startswith(f"After Fig. {int(figure[3:5])} of ")
    assert len(re.findall(r"\.(?= [A-Z(]|$)", drawing.caption)) <= 7  # sentences


@pytest.mark.parametrize("figure", ["fig10_scaling", "fig13_size_effect"])
def test_eq_6_passes_through_the_specimen(atlas, figure):
    table = draw(atlas, figure, "sliding").data.dropna(subset="eq6_pressure_MPa")
    own = table[np.isclose(table["eq6_side_mm"], table["specimen_b_mm"])]
    assert len(own)
    for end in ("", "_low", "_high"):
        of = own.dropna(subset=f"eq6_pressure{end}_MPa")  # some have no interval
        assert len(of)
        np.testing.assert_allclose(of[f"eq6_pressure{end}_MPa"], of["nominal_pressure_MPa"])


def test_numbers_in_words():
    assert compact(2210.4) == "2210"
    assert compact(0.03906) == "0.0391"


def test_loads_spread_evenly_with_the_one_asked_for():
    assert list(spread_loads(6, 3)) == [0, 2, 5]
    assert list(spread_loads(6, 3, including=1)) in ([0, 1, 5], [1, 2, 5])
    assert list(spread_loads(6, 99)) == list(range(6))


def judged_anew(atlas, **material):
    """The atlas with the elastic model judged by its areas, of another material if one is given."""
    other = atlas.copy()
    configuration = json.loads(atlas.attrs["configuration"])
    settings = configuration["settings"]["sliding"]
    settings["material"] |= material
    other.attrs["configuration"] = json.dumps(configuration)
    area, scaling = (atlas[f"{stage}/sliding"].to_dataset() for stage in ("area", "scaling"))
    judged = model_validity(area, scaling, read(Material, settings["material"]))
    other["elastic_model/sliding"] = xr.DataTree(judged)
    return other, settings["material"]


# Against the atlas, by another way


def test_prefractals_balance_the_force(atlas):
    table = draw(atlas, "fig08_prefractals", "sliding").data
    settings = Subject.of(atlas, "sliding").settings
    force = 75 * 4.8**2  # N: the study names no load for the maps, so its largest
    assert table["resolution"].tolist() == settings["resolutions"]
    np.testing.assert_allclose(table["sigma_n_MPa"] * table["area_corrected_mm2"], force)
    np.testing.assert_allclose(table["sigma_n_raw_MPa"] * table["area_mm2"], force)
    subject = Subject.of(atlas, "sliding")
    load = subject.reported.reference
    nodes = [40 * contact_domain(subject, k, load).sum() for k in table["resolution"]]
    np.testing.assert_array_equal(table["nodes"], nodes)
    np.testing.assert_allclose(table["area_mm2"], nodes * table["spacing_mm"] ** 2)
    assert (table["area_corrected_mm2"] < table["area_mm2"]).all()


def test_areas_of_few_nodes_are_said_to_be_raw(atlas):
    few = atlas.copy()
    scaling, closure = (few[f"{stage}/sliding"].to_dataset() for stage in ("scaling", "closure"))
    closure["area_corrected_resolved"] = xr.zeros_like(closure["area_corrected_resolved"])
    scaling["sigma_n"] = scaling["sigma_n"] * np.nan
    few["scaling/sliding"] = xr.DataTree(scaling)
    few["closure/sliding"] = xr.DataTree(closure)
    drawing = draw(judged_anew(few)[0], "fig08_prefractals", "sliding")
    assert drawing.data["sigma_n_MPa"].isna().all()
    titles = [axes.get_title(loc="left") for axes in drawing.figure.axes if axes.images]
    assert all("(raw)" in title for title in titles)
    assert "fewer than 30 nodes in contact" in drawing.caption


@pytest.mark.parametrize(
    ("material", "words"),
    representative(
        [
            ({"hardness": 1e3}, "beyond the hardness (1000 MPa)"),
            ({"hardness": 1e9}, "within the hardness (1e+09 MPa)"),
            ({"hardness": np.inf, "joint_wall_strength": 80.0}, "beyond the joint wall strength"),
        ]
    ),
)
def test_pressures_are_compared_with_what_the_material_bears(atlas, material, words):
    other = atlas.copy()
    # As many nodes as the domain has: 5 GPa.
    scaling = other["scaling/sliding"].to_dataset()
    scaling["area_corrected"] = scaling["area_corrected"] / 40
    scaling["sigma_n"] = scaling["sigma_n"] * 40
    other["scaling/sliding"] = xr.DataTree(scaling)
    other, _ = judged_anew(other, **material)
    drawing = draw(other, "fig08_prefractals", "sliding")
    assert words in drawing.caption
    assert "rms slope" in drawing.caption
    (axes,) = (axes for axes in drawing.figure.axes if not axes.images)
    limit = material.get("joint_wall_strength", material["hardness"])
    (line,) = axes.patches
    assert (line.get_y(), line.get_height()) == (limit, 0)


@pytest.mark.parametrize("specimen", representative(SPECIMENS, 1))
def test_box_counts_give_the_dimension_of_the_atlas(atlas, specimen):
    drawing = draw(atlas, "fig09_box_counting", specimen)
    stored = Subject.of(atlas, specimen).states("domains").isel(normal_force=-1)
    used = drawing.data[drawing.data["ordinary_used"] == True]  # noqa: E712  # missing in rows of others
    line = fit_line(np.log(used["box_side_mm"]), np.log(used["box_count"]))
    np.testing.assert_allclose(-line.slope.value, stored["delta_sigma_ordinary"].item(), atol=1e-9)
    np.testing.assert_allclose(
        np.log(used["ordinary_count"]),
        line.intercept.value + line.slope.value * np.log(used["box_side_mm"]),
    )
    law = drawing.data[np.isfinite(drawing.data["law_count"])]
    if str(stored["estimator"].item()) == ESTIMATORS["mean"]:
        misfit = np.sqrt(np.mean((law["law_count"] / law["mean_count"] - 1) ** 2))
        np.testing.assert_allclose(misfit, stored["fit_misfit"].item(), rtol=0.05)
    null = drawing.data[np.isfinite(drawing.data["null_count_random"])]
    assert len(null)
    assert (null["null_count_random_low"] <= null["null_count_random_high"]).all()
    reason = str(stored["reason"].item())
    assert (f"no dimension: {reason}" in drawing.caption) == bool(reason)


@pytest.mark.parametrize("specimen", ["sliding", "flat"])
def test_area_law_is_that_of_the_atlas(atlas, specimen):
    table = draw(atlas, "fig10_scaling", specimen).data
    rows = table[table["panel"] == "a"]
    rows = rows[rows["normal_force_N"] == rows["normal_force_N"].max()]
    law = fit_line(np.log(rows["spacing_mm"]), np.log(rows["area_corrected_mm2"]))
    np.testing.assert_allclose(
        np.log(rows["fitted_area_mm2"]),
        law.intercept.value + law.slope.value * np.log(rows["spacing_mm"]),
    )


def test_interval_of_eq_6_brackets_its_line(atlas):
    table = draw(atlas, "fig13_size_effect", "sliding").data
    table = table[table["normal_force_N"] == table["normal_force_N"].max()]
    for key in ("area", "box"):
        rows = table[table["estimator"] == key]
        value = rows["eq6_pressure_MPa"].values
        slope = np.diff(np.log(value)) / np.diff(np.log(rows["eq6_side_mm"].values))
        np.testing.assert_allclose(slope, rows[f"delta_sigma_{key}"].values[0] - 2)
        rows = rows.dropna(subset="eq6_pressure_low_MPa")
        assert len(rows)
        value = rows["eq6_pressure_MPa"]
        assert (rows["eq6_pressure_low_MPa"] <= value * (1 + 1e-12)).all()
        assert (rows["eq6_pressure_high_MPa"] >= value * (1 - 1e-12)).all()


def test_size_effect_lists_slopes_and_the_specimen(atlas):
    table = draw(atlas, "fig13_size_effect", "flat").data
    known = table[np.isfinite(table["eq6_pressure_MPa"])]
    assert len(known)
    for (_, key), rows in known.groupby(["normal_force_N", "estimator"]):
        slope = np.diff(np.log(rows["eq6_pressure_MPa"])) / np.diff(np.log(rows["eq6_side_mm"]))
        np.testing.assert_allclose(slope, rows[f"delta_sigma_{key}"].iloc[0] - 2)
    np.testing.assert_allclose(
        table["nominal_pressure_MPa"] * table["specimen_b_mm"] ** 2, table["normal_force_N"]
    )


# Properties


@pytest.mark.parametrize("specimen", representative(["sliding", "pair"]))
@pytest.mark.parametrize(
    "figure",
    representative(
        ["fig10_scaling", "fig04_05_closure", "fig09_box_counting", "fig13_size_effect"]
    ),
)
def test_legends_hide_nothing(atlas, figure, specimen):
    drawn = draw(atlas, figure, specimen).figure
    drawn.draw_without_rendering()
    for legend in drawn.legends:
        frame = legend.get_window_extent()
        assert drawn.bbox.x0 <= frame.x0 < frame.x1 <= drawn.bbox.x1
        # A hair's breadth for the legend's padding, which is empty.
        assert all(axes.get_tightbbox().y0 >= frame.y1 - 1 for axes in drawn.get_axes())


@pytest.mark.parametrize("largest", representative([3.0, 6.0, 25.0, 45.0, 60.0, 400.0]))
def test_box_sides_have_labels_that_stand_apart(largest):
    """Over less than a decade matplotlib writes every minor tick, one over the other."""
    with common.print_style():
        shown = Figure(figsize=(7.2, 3.1))
        axes = shown.subplots(1, 3)[1]
        sides = pd.Series(np.geomspace(0.2, 0.2 * largest, 9))
        axes.loglog(sides, 1 / sides)
        label_short_span(axes.xaxis)
        shown.draw_without_rendering()
    low, high = axes.get_xlim()
    labels = [
        tick.label1.get_window_extent()
        for tick in [*axes.xaxis.get_major_ticks(), *axes.xaxis.get_minor_ticks()]
        if tick.label1.get_text() and low <= tick.get_loc() <= high
    ]
    labels.sort(key=lambda box: box.x0)
    assert len(labels) >= 2
    assert all(a.x1 < b.x0 for a, b in pairwise(labels))


@pytest.mark.parametrize("figure", ["fig10_scaling", "fig13_size_effect"])
def test_eq_6_is_called_an_extrapolation(atlas, figure):
    assert "extrapolated" in draw(atlas, figure, "sliding").caption


def test_the_estimates_are_compared_or_it_is_said_that_they_cannot_be(atlas):
    verdict = r"(The two disagree|Their intervals overlap)\.$"
    assert re.search(verdict, draw(atlas, "fig10_scaling", "flat").caption)
    # One resolution gives no A_r(s) to fit.
    assert np.isnan(Subject.of(atlas, "pair").states("scaling")["delta_sigma_area"]).all()
    assert "; by A_r(s): no fit: " in draw(atlas, "fig10_scaling", "pair").caption


def test_no_fit_is_said_with_its_reason(atlas):
    caption = draw(atlas, "fig10_scaling", "pair").caption
    assert "no fit: enough contact at 1 of the 3 resolutions needed" in caption


def test_nodes_of_compared_maps_are_all_drawn_alike(atlas):
    """With a width for each map, finer domains would look fuller than coarser ones."""
    subject = Subject.of(atlas, "sliding")
    maps = [
        axes.images[0].get_array()
        for axes in draw(atlas, "fig08_prefractals", "sliding").figure.axes
        if axes.images
    ]
    ks = sorted(int(k) for k in subject["scaling"]["resolution"])
    load = subject.reported.reference
    for shown, k in zip(maps, ks, strict=True):
        np.testing.assert_array_equal(shown, contact_domain(subject, k, load))


def test_pressures_without_a_stated_strength_stand_beside_usual_ones(atlas):
    other, material = judged_anew(atlas, hardness=np.inf, joint_wall_strength=np.nan)
    (axes,) = (a for a in draw(other, "fig08_prefractals", "sliding").figure.axes if not a.images)
    low, high = material["modulus"] / 1000, material["modulus"] / 200
    (band,) = axes.patches
    np.testing.assert_allclose([band.get_y(), band.get_y() + band.get_height()], [low, high])


def test_an_interval_that_ends_far_below_the_axes_is_drawn(atlas, tmp_path):
    """Dashes of the edge of an area would be laid out over all its decades."""
    changed = atlas.copy()
    scaling = changed["scaling/sliding"].to_dataset()
    for key in ("area", "box"):
        scaling[f"delta_sigma_{key}_low"] = scaling[f"delta_sigma_{key}_low"] * 0 - 80.0
        scaling[f"delta_sigma_{key}_high"] = scaling[f"delta_sigma_{key}_high"] * 0 + 80.0
    side = np.sqrt(Subject.of(atlas, "sliding").area)
    scaling.update(extrapolated_pressure(scaling, side))
    changed["scaling/sliding"] = xr.DataTree(scaling)
    drawing = draw(changed, "fig10_scaling", "sliding")
    areas = [one for axes in drawing.figure.axes for one in axes.collections]
    with_data = [one for one in areas if any(len(path.vertices) > 3 for path in one.get_paths())]
    assert with_data
    assert all(one.get_linewidth() == 0 for one in with_data)
