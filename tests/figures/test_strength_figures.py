"""Figures of strength and of size (Fig. 1b, sects. 3 and 5 of the paper)."""

import json

import numpy as np
import pytest
import xarray as xr
from cases import representative
from made_tests import computed_and_read
from matplotlib.figure import Figure

from fractalcontact.core.estimate import names_of
from fractalcontact.core.limits import LARGEST_FRICTION_ANGLE
from fractalcontact.core.subject import Subject
from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style, save
from fractalcontact.figures.kit.sizes import draw_over_size, plain_decades, roughness_words

DRAWN = [
    ("sliding", "strength"),
    ("sliding", "window_size"),
    ("sliding", "fig01_strength"),
    ("pair", "strength"),
    ("pair", "window_size"),
    ("pair", "fig01_strength"),
    ("flat", "window_size"),
]


def drawn(atlas, specimen, figure):
    with print_style():
        return drawer_of(figure)(atlas, specimen)


def unstated(atlas):
    """The atlas of a study that states neither basic friction angle nor wall strength."""
    changed = atlas.copy()
    lost = ("strength", "truncated", "barton", "scaled", "friction_angle", "joint_wall")
    for stage in ("strength", "windows"):
        for specimen in changed[stage].children:
            dataset = changed[f"{stage}/{specimen}"].to_dataset()
            for name in dataset.data_vars:
                stated = name != "strength_share" and dataset[name].dtype.kind == "f"
                if any(word in name for word in lost) and stated:
                    dataset[name] = xr.full_like(dataset[name], np.nan)
            changed[f"{stage}/{specimen}"] = xr.DataTree(dataset)
    return changed


# Exact


def test_short_axes_are_numbered_in_plain_words(atlas):
    axes = drawn(atlas, "flat", "window_size").figure.axes[0]
    axes.set_xlim(0.9, 21)
    plain_decades(axes.xaxis)
    ticks = [t for t in axes.xaxis.get_major_locator()() if 0.9 <= t <= 21]
    assert ticks == pytest.approx([1, 2, 5, 10, 20])
    assert axes.xaxis.get_major_formatter()(5.0) == "5"


def test_series_stand_apart_about_the_size_itself():
    b = np.array([1.0, 10.0])
    means = (("part", "normal_force"), np.ones((2, 3)))
    laws = xr.Dataset({"side": ("part", b)} | dict.fromkeys(names_of("mean"), means))
    axes = Figure().subplots()
    draw_over_size(axes, laws, "mean")
    places = np.array([line.get_xdata() for line in axes.lines if len(line.get_xdata())])
    np.testing.assert_allclose(places[1], b)
    np.testing.assert_allclose(places.mean(axis=0), b)
    assert (np.diff(places, axis=0) > 0).all()


# Against the atlas


@pytest.mark.parametrize("specimen", ["sliding", "pair"])
def test_strength_drawn_is_that_of_the_atlas(atlas, specimen):
    table, _ = computed_and_read(drawn(atlas, specimen, "strength").data)
    stored = atlas[f"strength/{specimen}"].to_dataset().isel(contact_direction=0)
    panels = {which: table[table["panel"] == which] for which in "abc"}
    rigid = panels["a"][panels["a"]["normal_force_N"].isna()]
    np.testing.assert_array_equal(rigid["midpoint_mm"], stored["midpoint"])
    np.testing.assert_array_equal(
        rigid["rigid_dilatancy_angle_degree"], stored["rigid_dilatancy_angle"]
    )
    for panel, column, name in (
        ("a", "midpoint_mm", "midpoint"),
        ("a", "dilatancy_angle_degree", "dilatancy_angle"),
        ("b", "shear_strength_MPa", "shear_strength"),
    ):
        for force, points in panels[panel].groupby("normal_force_N"):
            values = stored.sel(normal_force=force)[name]
            np.testing.assert_array_equal(points[column], values)
    for name in ("peak_strength", "barton_strength"):
        np.testing.assert_array_equal(panels["c"][f"{name}_MPa"], stored[name])


@pytest.mark.parametrize("specimen", ["sliding", "pair", "flat"])
def test_sizes_drawn_are_those_of_the_atlas(atlas, specimen):
    table = drawn(atlas, specimen, "window_size").data
    laws = atlas[f"windows/{specimen}"].to_dataset()
    face = table[table["panel"] == "a"].dropna(subset="face_sigma_z_mm")
    np.testing.assert_array_equal(face["scale_side_mm"], laws["scale_side"])
    np.testing.assert_array_equal(face["face_sigma_z_mm"], laws["face_sigma_z"])
    closure = table[table["panel"] == "b"]
    laws = laws.sel(offset=Subject.of(atlas, specimen).offset, method="nearest")
    expected = laws["interface_closure"].transpose("normal_force", "part").values.ravel()
    np.testing.assert_array_equal(closure["interface_closure_mm"], expected)


def test_strength_by_size_is_that_of_the_atlas(atlas):
    table = drawn(atlas, "sliding", "fig01_strength").data
    laws = atlas["windows/sliding"].to_dataset()
    for name, unit in (("slope", ""), ("strength", "_MPa")):
        for of in ("at_equal_v_over_b", "of_whole_at_equal_v"):
            stored = laws[f"{name}_{of}"].transpose("normal_force", "share", "part").values.ravel()
            np.testing.assert_array_equal(table[f"{name}_{of}{unit}"], stored)


def test_the_right_axis_adds_the_basic_angle(atlas):
    axes = drawn(atlas, "sliding", "strength").figure.axes[0]
    (other,) = axes.child_axes
    basic = float(atlas["strength/sliding"]["basic_friction_angle"])
    axes.figure.draw_without_rendering()
    np.testing.assert_allclose(np.subtract(other.get_ylim(), axes.get_ylim()), basic)
    held = next(line for line in axes.lines if line.get_label().startswith("truncated above"))
    assert held.get_ydata()[0] + basic == LARGEST_FRICTION_ANGLE


# Properties


@pytest.mark.parametrize(("specimen", "figure"), representative(DRAWN, 1))
def test_every_axis_states_its_unit(atlas, specimen, figure):
    for axes in drawn(atlas, specimen, figure).figure.axes:
        if axes.axison and axes.lines:
            for label in (axes.get_xlabel(), axes.get_ylabel()):
                assert label.endswith(("(mm)", "(MPa)", "(degrees)", "(mm/mm)")), label


@pytest.mark.parametrize(("specimen", "figure"), representative(DRAWN, 1))
def test_caption_names_the_specimen_and_its_claim(atlas, specimen, figure):
    drawing = drawn(atlas, specimen, figure)
    caption = drawing.caption
    label = json.loads(atlas.attrs["configuration"])["settings"][specimen]["label"]
    assert label in drawing.figure.get_suptitle()
    assert "nan" not in caption
    assert "  " not in caption
    assert ("Fig. 1b" in caption) == (figure == "fig01_strength")
    assert ("section 5" in caption) == (figure != "fig01_strength")


@pytest.mark.parametrize(("specimen", "figure"), representative(DRAWN, 3))
def test_a_study_that_states_no_friction_angle_is_drawn_and_says_so(atlas, specimen, figure):
    caption = drawn(unstated(atlas), specimen, figure).caption
    assert "nan" not in caption
    if figure == "strength":
        assert "states no basic friction angle" in caption


def test_no_fit_is_said_and_no_line_drawn(atlas):
    changed = atlas.copy()
    laws = changed["windows/flat"].to_dataset()
    for name in list(laws.data_vars):
        if "exponent" in name or "hurst" in name:
            laws[name] = xr.full_like(laws[name], np.nan, dtype=float)
    changed["windows/flat"] = xr.DataTree(laws)
    drawing = drawn(changed, "flat", "window_size")
    assert "No fit of eq. 2" in drawing.caption


@pytest.mark.full
@pytest.mark.parametrize(("specimen", "figure"), DRAWN)
def test_drawn_twice_the_files_are_the_same(atlas, specimen, figure, tmp_path):
    for folder in ("once", "twice"):
        with print_style():
            save(drawn(atlas, specimen, figure), tmp_path / folder, figure)
    for ending in ("png", "svg", "csv", "txt"):
        once, twice = (
            (tmp_path / f / f"{figure}.{ending}").read_bytes() for f in ("once", "twice")
        )
        assert once == twice
        assert once


def test_strengths_of_truncated_angles_are_marked_and_compared_with_nothing(atlas):
    strength = atlas["strength/sliding"].to_dataset().isel(contact_direction=0)
    table, _ = computed_and_read(drawn(atlas, "sliding", "strength").data)
    over = table[(table["panel"] == "a") & table["normal_force_N"].notna()]
    held = over["friction_angle_degree"] > LARGEST_FRICTION_ANGLE
    assert (over["shear_strength_valid"].astype(bool) == ~held).all()
    counts = over[held].groupby("normal_force_N").size()
    stored = strength["truncated_high"].sel(normal_force=over["normal_force_N"].unique())
    assert counts.sum() == stored.sum() > 0
    # Where any angle is held, the strength there is the largest that there can be.
    valid = table[table["panel"] == "c"]["peak_strength_valid"].astype(bool)
    assert (valid.values == (strength["truncated_high"].values == 0)).all()
    none = "Every peak is truncated" in drawn(atlas, "sliding", "strength").caption
    assert none == (not valid.any())


def test_compliance_over_size_is_drawn_as_the_atlas_has_it(atlas):
    laws = atlas["windows/sliding"].to_dataset()
    table = drawn(atlas, "sliding", "window_size").data
    rows = table[table["panel"] == "c"]
    laws = laws.sel(offset=Subject.of(atlas, "sliding").offset, method="nearest")
    stored = laws["interface_compliance"].transpose("normal_force", "part").values
    np.testing.assert_array_equal(rows["interface_compliance_mm_per_MPa"], stored.ravel())


def test_both_figures_of_strength_word_the_roughness_alike(atlas):
    changed = atlas.copy()
    strength = changed["strength/sliding"].to_dataset()
    strength["scaled_roughness"] = strength["scaled_roughness"] * np.nan
    changed["strength/sliding"] = xr.DataTree(strength)
    laws = changed["windows/sliding"].to_dataset()
    laws["barton_roughness"] = laws["barton_roughness"] * np.nan
    changed["windows/sliding"] = xr.DataTree(laws)
    words = roughness_words(strength.isel(contact_direction=0))
    assert "scaled to this length it exceeds 20, the largest of his law" in words
    for figure in ("strength", "fig11_slope_angle"):
        assert words in drawn(changed, "sliding", figure).caption
    known = strength.assign(scaled_roughness=strength["jrc_used"])
    assert "beyond" not in roughness_words(known.isel(contact_direction=0))


def test_points_that_no_exponent_goes_through_are_hollow(atlas):
    laws = atlas["windows/sliding"].to_dataset()
    axes = drawn(atlas, "sliding", "window_size").figure.axes[0]
    used = laws["scale_used"].values & np.isfinite(laws["face_sigma_z"].values)
    used &= np.isfinite(float(laws["face_hurst"]))
    face = [line for line in axes.lines if line.get_color() == "k" and line.get_marker() == "o"]
    drawn_sides = {line.get_markerfacecolor(): set(line.get_xdata()) for line in face[:2]}
    assert drawn_sides["k"] == set(laws["scale_side"].values[used])
    assert drawn_sides["white"] == set(laws["scale_side"].values[~used])


def test_a_joint_that_was_not_slid_has_no_strength(atlas):
    changed = atlas.copy()
    strength = changed["strength/sliding"].to_dataset().isel(interval=slice(0, 0))
    for name, values in strength.data_vars.items():
        if "interval" not in values.dims and values.dtype.kind == "f" and values.dims:
            strength[name] = values * np.nan
    changed["strength/sliding"] = xr.DataTree(strength)
    drawing = drawn(changed, "sliding", "strength")
    assert drawing.data["peak_strength_MPa"].isna().all()
