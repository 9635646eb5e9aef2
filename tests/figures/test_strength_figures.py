"""Figures of strength and of size (Fig. 1b, sects. 3 and 5 of the paper)."""

import numpy as np
import pytest
import xarray as xr
from cases import representative
from drawings import changed, draw
from made_tests import computed_and_read
from matplotlib.figure import Figure

from fractalcontact.core.estimate import names_of
from fractalcontact.core.limits import LARGEST_FRICTION_ANGLE
from fractalcontact.figures.kit.sizes import draw_over_size, plain_decades, roughness_words
from fractalcontact.laws.strength import ABOVE_SCALE, OFF_LENGTHS

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
    return draw(atlas, figure, specimen)


def unstated(atlas):
    """The atlas of a study that states neither basic friction angle nor wall strength."""
    other = atlas.copy()
    lost = ("strength", "truncated", "barton", "scaled", "friction_angle", "joint_wall")
    for stage in ("strength", "windows"):
        for specimen in other[stage].children:
            dataset = other[f"{stage}/{specimen}"].to_dataset()
            for name in dataset.data_vars:
                stated = name != "strength_share" and dataset[name].dtype.kind == "f"
                if any(word in name for word in lost) and stated:
                    dataset[name] = xr.full_like(dataset[name], np.nan)
            other[f"{stage}/{specimen}"] = xr.DataTree(dataset)
    return other


# Exact


def test_short_axes_are_numbered_in_plain_words(atlas):
    axes = drawn(atlas.copy(), "flat", "window_size").figure.axes[0]
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


def test_the_right_axis_adds_the_basic_angle(atlas):
    axes = drawn(atlas, "sliding", "strength").figure.axes[0]
    (other,) = axes.child_axes
    basic = float(atlas["strength/sliding"]["basic_friction_angle"])
    axes.figure.draw_without_rendering()
    np.testing.assert_allclose(np.subtract(other.get_ylim(), axes.get_ylim()), basic)
    held = next(line for line in axes.lines if line.get_label().startswith("truncated above"))
    assert held.get_ydata()[0] + basic == LARGEST_FRICTION_ANGLE


# Properties


@pytest.mark.parametrize(("specimen", "figure"), representative(DRAWN, 3))
def test_a_study_that_states_no_friction_angle_is_drawn_and_says_so(atlas, specimen, figure):
    caption = drawn(unstated(atlas), specimen, figure).caption
    assert "nan" not in caption
    if figure == "strength":
        assert "states no basic friction angle" in caption


def test_no_fit_is_said_and_no_line_drawn(atlas):
    def without_fits(laws):
        fits = [name for name in laws if "exponent" in name or "hurst" in name]
        return laws.assign({name: laws[name].astype(float) * np.nan for name in fits})

    drawing = drawn(changed(atlas, "windows/flat", without_fits), "flat", "window_size")
    assert "No fit of eq. 2" in drawing.caption


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        ((0.79, 0.79), "3 - Delta_g = 0.79, known of this synthetic surface"),
        ((0.7, 0.9), ", by the power spectrum"),
    ],
)
def test_an_exponent_known_by_construction_has_no_error(atlas, ends, words):
    def expecting(laws):
        parts = zip(("", "_low", "_high"), (0.79, *ends), strict=True)
        known = {
            f"expected_hurst{part}": laws[f"expected_hurst{part}"] * 0 + x for part, x in parts
        }
        return laws.assign(known | {"face_hurst": 0.8})

    drawing = drawn(changed(atlas, "windows/sliding", expecting), "sliding", "window_size")
    assert words in " ".join(drawing.caption.split())
    assert "not known" not in drawing.caption


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


def test_both_figures_of_strength_word_the_roughness_alike(atlas):
    off = atlas["strength/sliding"].to_dataset().isel(contact_direction=0)
    assert off["barton_scaled_reason"] == OFF_LENGTHS
    assert "this length lies off his law of scale" in roughness_words(off)
    beyond = {"scaled_roughness": np.nan, "barton_scaled_reason": ABOVE_SCALE}
    other = changed(atlas, "strength/sliding", **beyond)
    other = changed(other, "windows/sliding", barton_roughness=np.nan)
    strength = other["strength/sliding"].to_dataset()
    words = roughness_words(strength.isel(contact_direction=0))
    assert "scaled to this length it exceeds 20, the largest of his law" in words
    for figure in ("strength", "fig11_slope_angle"):
        assert words in drawn(other, "sliding", figure).caption
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
    other = atlas.copy()
    strength = other["strength/sliding"].to_dataset().isel(interval=slice(0, 0))
    for name, values in strength.data_vars.items():
        if "interval" not in values.dims and values.dtype.kind == "f" and values.dims:
            strength[name] = values * np.nan
    other["strength/sliding"] = xr.DataTree(strength)
    drawing = drawn(other, "sliding", "strength")
    assert drawing.data["peak_strength_MPa"].isna().all()
