"""Figures of clusters, conductance, compliance and of the plateau of rigid dilatancy."""

import json

import numpy as np
import pytest
import xarray as xr
from cases import representative
from drawings import changed, draw
from matplotlib.figure import Figure
from matplotlib.text import Text

from fractalcontact.core.fitting import fit_line
from fractalcontact.core.subject import Subject
from fractalcontact.core.verdicts import ABOVE, BELOW, WITHIN
from fractalcontact.domain.clusters import cluster_sizes, cluster_statistics
from fractalcontact.figures.joint import compliance
from fractalcontact.figures.kit.axes import offset_axis
from fractalcontact.laws.conductance import add_conductance

SLIDING = ("sliding", "pair")


def drawn(atlas, figure, subject):
    return draw(atlas, figure, subject)


# Against the atlas


@pytest.mark.parametrize("name", representative(SLIDING))
def test_clusters_drawn_are_those_of_the_contact_domains(atlas, name):
    table = drawn(atlas, "clusters", name).data
    fields = atlas[f"contact/{name}"].to_dataset()["in_contact_1"].isel(direction=0)
    columns = {
        "a": ("clusters",),
        "b": ("largest_share",),
        "c": ("morisita", "morisita_scatter"),
    }
    points = table[table["panel"] != "d"]
    assert set(points["panel"]) == set(columns)
    for _, point in points.iterrows():
        domain = fields.sel(
            offset=point["offset_mm"], normal_force=point["normal_force_N"], method="nearest"
        )
        found = cluster_statistics(domain.values, 0.1)
        assert point["panel"] != "a" or point["nodes"] == domain.values.sum()
        for column in columns[point["panel"]]:
            np.testing.assert_allclose(point[column], found[column])


def test_sizes_drawn_are_those_of_the_clusters(atlas):
    table = drawn(atlas, "clusters", "sliding").data
    sizes = table[table["panel"] == "d"]
    fields = atlas["contact/sliding"].to_dataset()["in_contact_1"].isel(direction=0)
    assert sizes["offset_mm"].nunique() == 3
    for _, point in sizes.iterrows():
        domain = fields.sel(
            offset=point["offset_mm"], normal_force=point["normal_force_N"], method="nearest"
        )
        areas = cluster_sizes(domain.values) * 0.1**2
        at_least = (areas > point["cluster_area_mm2"] * (1 - 1e-9)).sum()
        assert point["clusters_at_least"] == at_least


@pytest.mark.parametrize("name", [*SLIDING, "flat"])
def test_conductance_is_stiffness_over_the_modulus_and_its_law_that_of_the_points_fitted(
    atlas, name
):
    table = drawn(atlas, "conductance", name).data
    curves = Subject.of(atlas, name).curves()
    e_star = Subject.of(atlas, name).settings["material"]["e_star"]
    np.testing.assert_allclose(
        table["interface_stiffness_MPa_per_mm"], table["conductance_per_mm"] * e_star
    )
    for offset, points in table.groupby("offset_mm"):
        fitted = points[points["conductance_fitted"]]
        line = fit_line(
            np.log(fitted["nominal_pressure_MPa"]), np.log(fitted["conductance_per_mm"])
        )
        np.testing.assert_allclose(points["conductance_exponent"].iloc[0], line.slope.value)
        unit = curves["unit_conductance"].sel(offset=offset, method="nearest")
        np.testing.assert_allclose(unit, np.exp(line.intercept.value))


@pytest.mark.parametrize("name", representative(SLIDING))
def test_compliance_is_the_inverse_of_the_stiffness(atlas, name):
    curves = Subject.of(atlas, name).curves()
    stiffness = curves["interface_stiffness"].values
    np.testing.assert_allclose(
        curves["interface_compliance"] * stiffness, np.where(np.isfinite(stiffness), 1, np.nan)
    )


@pytest.mark.parametrize("name", SLIDING)
def test_closures_drawn_over_the_offset_count_from_the_common_seat_of_the_atlas(atlas, name):
    table = drawn(atlas, "compliance", name).data
    closed = table[table["panel"] == "b"]
    curves = atlas[f"closure/{name}"].to_dataset().isel(direction=0, resolution=0)
    assert closed["common_seating_pressure_MPa"].unique() == [curves["common_seating_pressure"]]
    seats = curves["closure_from_common_seat"]
    for force, points in closed.groupby("normal_force_N"):
        stored = seats.sel(normal_force=force)
        # What lies below the seat closes by nothing, and is not drawn.
        stored = stored if (stored > 0).any() or not (seats > 0).any() else stored.where(False)
        np.testing.assert_array_equal(points["closure_from_common_seat_mm"], stored)


def test_the_slope_of_the_synthetic_joints_is_that_of_the_atlas(atlas):
    told = changed(atlas, "roll_off/surfaces", slope=0.25, slope_low=0.2, slope_high=0.3)
    stage = told["roll_off/surfaces"].to_dataset()
    stage["trend"] = ("surface", ["falling", ""])
    told["roll_off/surfaces"] = xr.DataTree(stage)
    drawing = drawn(told, "plateau", ["sliding"])
    shown = " ".join(text.get_text() for text in drawing.figure.findobj(Text))
    assert shown.count("slope 0.25 [0.2, 0.3] mm/mm") == 2
    assert "synthetic joints falls; without it, it shows no trend" in drawing.caption


def test_plateau_holds_every_direction_of_all_that_slides(atlas):
    table = drawn(atlas, "plateau", ["flat", "sliding", "pair"]).data
    assert table["specimen"].nunique() == 2 + 2
    for name in SLIDING:
        joint = atlas[f"joints/{name}"].to_dataset()
        label = json.loads(atlas.attrs["configuration"])["settings"][name]["label"]
        for direction, points in table[table["specimen"] == label].groupby("direction_or_seed"):
            stored = joint.sel(direction=direction)
            np.testing.assert_array_equal(points["rigid_dilatancy_mm"], stored["rigid_dilatancy"])
            np.testing.assert_array_equal(points["composite_rms_mm"], stored["composite_rms"])


def test_spread_of_the_composite_is_what_the_correlation_makes_it(atlas):
    # Exact but for the heights' changing with the place of the window.
    joint = atlas["joints/sliding"].to_dataset().transpose(..., "rigid_offset")
    expected, spread = joint["composite_rms_expected"].values, joint["composite_rms"].values
    np.testing.assert_allclose(expected[:, 0], 0, atol=1e-6)
    near = joint["rigid_offset"].values < 0.3 * joint["rigid_offset"].values[-1]
    np.testing.assert_allclose(expected[:, near], spread[:, near], rtol=0.2, atol=1e-6)
    assert np.isnan(joint["dilatancy_over_rms"].values[:, 0]).all()
    assert np.isfinite(joint["dilatancy_over_rms"].values[:, 1:]).all()


# Properties


@pytest.mark.parametrize(
    ("offsets", "scale"),
    [
        ([0.1, 0.5, 10.0], "log"),
        ([0.0, 0.5, 10.0], "symlog"),
        ([0.5, 1.0], "linear"),
        ([2.0], "linear"),
    ],
)
def test_scale_of_offsets_suits_them(offsets, scale):
    axes = Figure().subplots()
    offset_axis(axes, np.array(offsets))
    assert axes.get_xscale() == scale


# Verdicts follow the data


def test_caption_of_the_compliance_says_what_was_judged(atlas):
    caption = drawn(atlas, "compliance", "sliding").caption
    judged = atlas["statements/sliding"].to_dataset()
    for name in ("compliance_rises_at_first", "curves_overlap", "compliance_rises_again"):
        row = judged.sel(statement=name)
        said = f"{compliance.STAGES[name]}: {row['verdict'].item()} ({row['numbers'].item()}"
        assert said in caption


@pytest.mark.parametrize(
    ("verdict", "words"),
    representative(
        [
            (WITHIN, "Every interval reaches this range"),
            (BELOW, "(5 below, 0 above)"),
            (ABOVE, "(0 below, 5 above)"),
        ]
    ),
)
def test_conductance_is_judged_by_its_intervals(atlas, verdict, words):
    told = changed(atlas, "closure/sliding", conductance_beside_theory=verdict)
    assert words in drawn(told, "conductance", "sliding").caption


def test_a_conductance_without_a_fit_is_still_drawn(atlas):
    curves = atlas["closure/flat"].to_dataset()
    curves["resolved"] = xr.zeros_like(curves["resolved"])
    add_conductance(curves, 1.0)
    told = changed(atlas, "closure/flat", lambda _: curves)
    assert "Too few pressures" in drawn(told, "conductance", "flat").caption


def test_synthetic_joints_are_drawn_with_every_seed(atlas):
    drawing = drawn(atlas, "plateau", ["flat"])
    joints = atlas["roll_off/surfaces"].to_dataset()
    for surface in joints["surface"].values:
        mean = joints["rigid_dilatancy"].sel(surface=surface).mean("direction")
        kind = "with a" if surface == "with_roll_off" else "without a"
        points = drawing.data[drawing.data["specimen"].str.contains(f"{kind} roll-off")]
        assert points["direction_or_seed"].nunique() == joints.sizes["seed"]
        stored = mean.transpose("seed", "rigid_offset").values.ravel()
        np.testing.assert_allclose(points["rigid_dilatancy_mm"], stored)


def test_a_scan_has_no_roll_off_that_is_known(atlas):
    table = drawn(atlas, "plateau", ["sliding"]).data
    assert table[table["specimen"] == "synthetic twin of nothing"]["roll_off_mm"].isna().all()


def test_flush_faces_do_not_stretch_decades(atlas):
    axes = drawn(atlas, "plateau", ["sliding"]).figure.axes[0]
    opened = atlas["joints/sliding"]["rigid_dilatancy"].isel(rigid_offset=slice(1, None))
    assert axes.get_ylim()[0] > 0.01 * float(opened.where(opened > 0).min())


def test_one_solved_offset_is_enough(atlas):
    cut = atlas.copy()
    for stage in ("contact", "closure", "domains", "joints"):
        dataset = cut[f"{stage}/sliding"].to_dataset()
        cut[f"{stage}/sliding"] = xr.DataTree(dataset.isel(offset=[2]))
    for figure in ("clusters", "conductance", "compliance"):
        drawing = drawn(cut, figure, "sliding")
        drawing.figure.draw_without_rendering()
        assert "nan" not in drawing.caption
