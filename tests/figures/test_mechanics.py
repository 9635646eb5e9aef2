"""Figures of relief, composite topography, closure and dilatancy (Figs. 2 to 7 of the paper)."""

import base64
import re

import numpy as np
import pytest
import xarray as xr
from cases import representative
from drawings import changed, draw
from made_tests import PART, computed_and_read
from matplotlib.colors import to_rgb
from matplotlib.text import Text

from fractalcontact.core.fitting import fit_line
from fractalcontact.core.subject import Subject
from fractalcontact.core.text import force_label, force_unit, length_unit
from fractalcontact.figures.kit.drawing import DPI, print_style, save, spread
from fractalcontact.figures.kit.maps import MISSING
from fractalcontact.figures.kit.relief import shaded
from fractalcontact.joint.joint import composite_topography

FIGURES = ("fig02_relief", "fig03_composite", "fig04_05_closure", "fig06_07_dilatancy")


def drawn(atlas, specimen, figure):
    return draw(atlas, figure, specimen)


# Exact


def test_light_comes_from_the_north_west():
    y, x = np.mgrid[-10:11, -10:11] * 1.0
    dome = np.sqrt(400 - x**2 - y**2)
    # Equal colours for equal heights, so that only the light differs.
    brightness = shaded(dome, (1.0, 1.0), -1e6, 1e6).sum(axis=2)
    north_west, south_east = brightness[15, 5], brightness[5, 15]
    assert north_west > brightness[15, 15] > south_east
    assert north_west > brightness[5, 5] > south_east


def test_missing_cells_are_grey_and_leave_their_neighbours_light_alone():
    heights = np.add.outer(np.arange(12.0), np.zeros(12))
    holed = heights.copy()
    holed[5, 6] = np.nan
    whole, seen = (shaded(z, (1.0, 1.0), 0.0, 11.0) for z in (heights, holed))
    np.testing.assert_allclose(seen[5, 6], to_rgb(MISSING))
    far = np.ones(heights.shape, bool)
    far[4:7, 5:8] = False
    np.testing.assert_allclose(seen[far], whole[far], atol=0.05)


@pytest.mark.parametrize(
    ("span", "unit"), [(3e-2, "µm"), (0.5, "mm"), (50.0, "mm"), (1999.0, "mm"), (3000.0, "m")]
)
def test_lengths_get_a_unit_that_suits_them(span, unit):
    name, size = length_unit(span)
    assert name == unit
    assert size == {"µm": 1e-3, "mm": 1.0, "m": 1e3}[unit]


@pytest.mark.parametrize(
    ("force", "unit", "words"),
    [
        (2e-7, ("µN", 1e-6), "0.2 µN"),
        (0.025, ("mN", 1e-3), "25 mN"),
        (999.0, ("N", 1.0), "999 N"),
        (999.9, ("kN", 1e3), "1 kN"),  # not 1e+03 N
        (3e4, ("kN", 1e3), "30 kN"),
        (2.98e7, ("MN", 1e6), "29.8 MN"),
        (4e11, ("GN", 1e9), "400 GN"),
    ],
)
def test_forces_get_a_unit_that_suits_them(force, unit, words):
    assert force_unit(force) == unit
    assert force_label(force) == words


@pytest.mark.parametrize("decade", range(-7, 14))
def test_no_force_is_written_with_an_exponent(decade):
    for digits in (1, 2.5, 9.99, 9.999):
        words = force_label(digits * 10.0**decade)
        assert re.fullmatch(r"[\d.]+ \S+", words)
        value, unit = words.split()
        size = {"GN": 1e9, "MN": 1e6, "kN": 1e3, "N": 1.0, "mN": 1e-3, "µN": 1e-6}[unit]
        assert float(value) * size == pytest.approx(digits * 10.0**decade, rel=5e-3)


def test_spread_keeps_the_ends_and_never_repeats():
    assert spread(10, 6).tolist() == [0, 2, 4, 5, 7, 9]
    assert spread(3, 6).tolist() == [0, 1, 2]
    assert spread(1, 6).tolist() == [0]


# Against the atlas, by other ways


@pytest.mark.parametrize("specimen", ["sliding", "pair"])
def test_lifted_upper_face_touches_once_and_never_cuts_the_lower(atlas, specimen):
    profiles = drawn(atlas, specimen, "fig03_composite").data
    gap = (profiles["upper_after_mm"] - profiles["lower_mm"]).dropna()
    assert gap.min() == pytest.approx(0, abs=1e-12)
    assert (gap < 1e-9).sum() == 1
    before = (profiles["upper_before_mm"] - profiles["lower_mm"]).dropna()
    assert before.min() > -1e-12


def test_a_single_face_lies_on_its_match_before_sliding(atlas):
    profiles = drawn(atlas, "sliding", "fig03_composite").data.dropna(subset="upper_before_mm")
    step = np.ptp(atlas["specimens/sliding/lower"].values) / 1e6  # the atlas keeps faces so
    np.testing.assert_allclose(profiles["upper_before_mm"], profiles["lower_mm"], atol=2 * step)


@pytest.mark.parametrize("specimen", ["sliding", "pair"])
def test_composite_drawn_is_that_of_the_joint_at_the_largest_offset(atlas, specimen):
    stored = atlas[f"specimens/{specimen}"].to_dataset()
    joint = atlas[f"joints/{specimen}"].to_dataset().isel(offset=-1, contact_direction=0)
    direction, cells = str(joint["contact_direction"].values), int(joint["offset_cells"])
    assert cells == round(float(joint["offset"]) / 0.1)
    again = composite_topography(stored, direction, cells)
    drawing = drawn(atlas, specimen, "fig03_composite")
    _, composite = (axes for axes in drawing.figure.axes if axes.images)
    face_step = float(stored["lower"].max() - stored["lower"].min()) / 1e6
    step = np.ptp(again) / 65532 + 2 * face_step
    np.testing.assert_allclose(composite.images[0].get_array(), again, atol=step)
    # The dilatancy is from faces with all their digits, the composite from those of the atlas.
    mated = composite_topography(stored, direction, 0)
    opening = joint["rigid_dilatancy"].sel(direction=direction).isel(rigid_offset=cells)
    assert float(opening) == pytest.approx(again.max() - mated.max(), abs=2 * face_step)
    assert f"delta_r = {float(opening):.3g} mm" in drawing.caption
    touch = joint[["first_touch_y", "first_touch_x"]]
    at = xr.DataArray(again, {"y": joint["window_y"].values, "x": joint["window_x"].values})
    assert at.sel(y=touch["first_touch_y"], x=touch["first_touch_x"]) == again.max()


def closures_drawn(atlas, specimen):
    """The points of panels (a) and (b)."""
    table = drawn(atlas, specimen, "fig04_05_closure").data
    return table[table["panel"] == "a, b, c"]


def test_area_exponent_is_that_of_the_points_marked_as_fitted(atlas):
    table = closures_drawn(atlas, "sliding")
    for _, points in table.groupby("offset_mm"):
        fitted = points[points["corrected_fitted"]]
        assert (fitted["nodes"] >= 30).all()
        line = fit_line(np.log(fitted["normal_force_N"]), np.log(fitted["area_corrected_mm2"]))
        np.testing.assert_array_equal(points["corrected_exponent"].unique(), line.slope.value)


def test_both_laws_are_drawn_over_the_loads_fitted_each_with_its_own_line(atlas):
    figure = drawn(atlas, "flat", "fig04_05_closure").figure
    curve = atlas["closure/flat"].to_dataset().isel(direction=0, resolution=0, offset=0)
    k_ni, w_m = float(curve["hyperbola_k_ni"]), float(curve["hyperbola_w_m"])
    a, b = (float(curve[f"semi_logarithmic_{name}"]) for name in "ab")
    laws = [line for line in figure.axes[0].lines if len(line.get_xdata()) == 100]
    for line, law in zip(
        laws, (lambda w: k_ni * w / (1 - w / w_m), lambda w: np.exp((w - a) / b)), strict=True
    ):
        w, force = line.get_data()
        sigma = force * 1000 / 4.8**2  # kN on the window, MPa
        np.testing.assert_allclose(sigma, law(w), rtol=1e-9)
        ends = [float(curve[f"closure_fit_{end}"]) for end in ("min", "max")]
        np.testing.assert_allclose(force[[0, -1]] * 1000, ends)
    assert [line.get_linestyle() for line in laws] == ["--", "-"]
    light = {line.get_linestyle() for line in figure.axes[1].lines}
    assert light <= {"None", "--", ":"}  # the hyperbola, and its end beyond the loads fitted


def test_stiffness_stands_over_the_spacing_of_its_grid(atlas):
    table = drawn(atlas, "sliding", "fig04_05_closure").data
    table = table[table["panel"] == "d"]
    np.testing.assert_allclose(table["spacing_mm"], 0.1 * table["resolution"])


def test_few_nodes_are_hollow(atlas):
    figure = drawn(atlas, "sliding", "fig04_05_closure").figure
    table = closures_drawn(atlas, "sliding")
    points = [line for line in figure.axes[0].lines if line.get_marker() not in ("None", None)]
    hollow = [line for line in points if line.get_markerfacecolor() == "none"]
    assert sum(len(line.get_xdata()) for line in hollow) == (table["nodes"] < 10).sum() > 0
    whole = sum(len(line.get_xdata()) for line in points)
    assert whole == len(table)


@pytest.mark.parametrize("specimen", ["sliding", "pair"])
def test_elastic_dilatancy_is_rigid_dilatancy_less_closure(atlas, specimen):
    table, _ = computed_and_read(drawn(atlas, specimen, "fig06_07_dilatancy").data)
    curves = atlas[f"closure/{specimen}"].to_dataset().isel(direction=0, resolution=0)
    direction = str(curves["direction"].values)
    elastic = table[table["panel"] == "b"]
    rigid = table[(table["panel"] == "a") & (table["direction"] == direction)]
    assert set(elastic["direction"]) == {direction}
    for _, point in elastic.iterrows():
        state = curves.sel(
            offset=point["offset_mm"], normal_force=point["normal_force_N"], method="nearest"
        )
        opened = np.interp(
            point["offset_mm"], rigid["rigid_offset_mm"], rigid["rigid_dilatancy_mm"]
        )
        expected = opened - float(state["interface_closure"])
        assert point["elastic_dilatancy_mm"] == pytest.approx(expected, abs=1e-12)
        assert point["area_share"] == float(state["area_share"])


@pytest.mark.parametrize(
    ("figure", "kind", "x", "unit"),
    [
        ("seated_closure", "closure", "pressure_MPa", "mm"),
        ("hydraulic_aperture", "flow", "pressure_MPa", "mm3"),
        ("fig06_07_dilatancy", "dilatancy", "displacement_mm", "mm"),
        ("strength", "shear", "displacement_mm", "MPa"),
        ("strength", "strength", "pressure_MPa", "MPa"),
    ],
)
def test_laboratory_tests_stand_in_the_panels_of_the_computed_curves(atlas, figure, kind, x, unit):
    """Every reading, as the atlas has it; the ratio stands in the caption."""
    drawing = drawn(atlas, "sliding", figure)
    _, table = computed_and_read(drawing.data)
    table = table[table[f"{kind}_test"].notna()]
    stage = atlas["measured/sliding"].to_dataset().isel({f"{kind}_test": 0})
    stored = stage[f"{kind}_read"].dropna(f"{kind}_reading")
    np.testing.assert_array_equal(table[f"{kind}_read_{unit}"], stored)
    assert table[f"{kind}_{x}"].is_monotonic_increasing
    if kind != "strength":  # every peak of this joint is truncated
        assert float(stage[f"{kind}_ratio_at_last"]) == pytest.approx(1 / PART, rel=0.05)
        assert "Computed/measured" in drawing.caption
    sizes = [
        {
            line.get_label(): line.get_markersize()
            for line in axes.lines
            if line.get_marker() != "None"
        }
        for axes in drawing.figure.axes
    ]
    for panel in sizes:
        read = [size for label, size in panel.items() if str(label).startswith("test: ")]
        assert min(read, default=np.inf) >= max(panel.values(), default=0)
    assert any(str(label).startswith("test: ") for panel in sizes for label in panel)


def test_contact_domains_drawn_hold_the_area_of_the_atlas(atlas):
    figure = drawn(atlas, "sliding", "fig06_07_dilatancy").figure
    maps = [axes for axes in figure.axes if axes.images]
    assert len(maps) == 6
    curves = atlas["closure/sliding"].to_dataset().isel(direction=0, resolution=0, normal_force=-1)
    for axes, i in zip(maps, spread(curves.sizes["offset"], 6), strict=True):
        share = float(np.mean(axes.images[0].get_array()))
        assert share == pytest.approx(float(curves["area_share"][i]))


# What every figure must be


@pytest.mark.parametrize("specimen", representative(["sliding", "pair"], 0))
def test_maps_are_true_to_scale(atlas, specimen):
    for figure in FIGURES:
        for axes in drawn(atlas, specimen, figure).figure.axes:
            if axes.images:
                assert axes.get_aspect() == 1


def test_maps_in_the_svg_are_as_fine_as_those_in_the_png(atlas, tmp_path):
    with print_style():
        save(drawn(atlas, "flat", "fig02_relief"), tmp_path, "fig02_relief")
    svg = (tmp_path / "fig02_relief.svg").read_text(encoding="utf-8")
    pixels = base64.b64decode(re.search(r"image/png;base64,([^\"]+)", svg)[1])
    width = float(re.search(r"<image [^>]*?width=\"([\d.]+)", svg)[1])
    columns = int.from_bytes(pixels[16:20], "big")  # of the PNG's header
    assert columns == pytest.approx(width / 72 * DPI, rel=0.02)


# Where something is missing


def test_a_missing_fit_is_said_with_its_reason(atlas):
    drawing = drawn(atlas, "pair", "fig04_05_closure")
    words = [text.get_text() for text in drawing.figure.legends[0].get_texts()]
    missing = [text for text in words if "no fit" in text]
    assert len(missing) == 6  # of closure, then of contact area
    assert all(re.search(r"no fit: \d points with w_int > 0, 4 needed", x) for x in missing[:3])
    assert "No law fitted" in drawing.caption


def test_a_surface_without_a_dimension_is_still_drawn(atlas):
    ends = dict.fromkeys(("dimension", "dimension_low", "dimension_high"), np.nan)
    ends["dimensions_fitted"] = 0
    drawing = drawn(changed(atlas, "surface_dimension/flat", **ends), "flat", "fig02_relief")
    assert "No dimension could be fitted" in drawing.caption


def test_the_legend_counts_the_estimators_that_separate_the_axes(atlas):
    def legend(compared, differing):
        counts = {"axes_compared": compared, "axes_differing": differing}
        other = changed(atlas, "surface_dimension/flat", **counts)
        texts = drawn(other, "flat", "fig02_relief").figure.legends[0].get_texts()
        return " ".join(" ".join(text.get_text() for text in texts).split())

    assert "differ by 7 of 7 estimators" in legend(7, 7)
    assert "differ by 0 of 7 estimators" in legend(7, 0)
    assert "differ" not in legend(0, 0)


def test_the_recommended_and_the_known_dimension_are_drawn(atlas):
    group = "surface_dimension/flat"
    changes = {
        "recommended_dimension": 2.2,
        "recommended_dimension_low": 2.1,
        "recommended_dimension_high": 2.3,
    }
    for known, words in ((2.25, "inside the interval"), (2.4, "OUTSIDE the interval")):
        other = changed(atlas, group, known_dimension=known, **changes)
        drawing = drawn(other, "flat", "fig02_relief")
        assert "is 2.20 [2.10, 2.30] by roughness length" in drawing.caption
        assert f"known {known:g}, {words}" in drawing.caption
        assert len(drawing.caption.split()) < 70
        legend = [text.get_text() for text in drawing.figure.legends[0].get_texts()]
        assert any(text.startswith("recommended: window sides ") for text in legend)
        assert any("recommended" in text and "2.20 [2.10, 2.30]" in text for text in legend)
        assert any("known" in text and f"{known:g}" in text for text in legend)
    measured = drawn(changed(atlas, group, **changes), "flat", "fig02_relief")
    assert "known" not in measured.caption
    assert measured.data["recommended"].sum() == 1


def test_a_dimension_out_of_bounds_is_not_recommended(atlas):
    group = "surface_dimension/flat"
    ends = dict.fromkeys(
        ("recommended_dimension", "recommended_dimension_low", "recommended_dimension_high"), np.nan
    )
    other = atlas.copy()
    dataset = changed(atlas, group, **ends)[group].to_dataset()
    dataset["no_dimension"] = ((), "Delta_g 1.80 [1.70, 1.90] does not lie between 2 and 3")
    other[group] = xr.DataTree(dataset)
    drawing = drawn(other, "flat", "fig02_relief")
    assert "No dimension is recommended: Delta_g 1.80 [1.70, 1.90]" in drawing.caption
    legend = [text.get_text() for text in drawing.figure.legends[0].get_texts()]
    assert not any("recommended" in text for text in legend)


def test_one_solved_offset_is_enough(atlas):
    cut = atlas.copy()
    for stage, dims in {
        "contact": ("offset",),
        "closure": ("offset",),
        "dilatancy": ("offset",),
        "joints": ("offset",),
    }.items():
        dataset = cut[f"{stage}/sliding"].to_dataset()
        cut[f"{stage}/sliding"] = xr.DataTree(dataset.isel({dim: [2] for dim in dims}))
    for figure in FIGURES:
        drawing = drawn(cut, "sliding", figure)
        drawing.figure.draw_without_rendering()


# Verdicts follow the data


def without_statements(atlas, name):
    """The atlas of a specimen that nothing is asked of."""
    unasked = atlas.copy()
    judged = unasked[f"statements/{name}"].to_dataset()
    unasked[f"statements/{name}"] = xr.DataTree(judged.isel(statement=slice(0, 0)))
    return unasked


def test_parts_may_have_a_strength_where_the_whole_has_none(atlas):
    other = atlas.copy()
    laws = other["windows/sliding"].to_dataset()
    strength = laws["strength_at_equal_v_over_b"].values.copy()
    strength[:, 0] = np.nan
    strength[:, 1:] = 1.0
    laws["strength_at_equal_v_over_b"] = laws["strength_at_equal_v_over_b"].copy(data=strength)
    other["windows/sliding"] = xr.DataTree(laws)
    assert len(drawn(other, "sliding", "fig11_slope_angle").data)


def test_plateaus_are_those_of_the_atlas(atlas):
    """In the legend, and in the caption where the paper says nothing of the material."""
    atlas = without_statements(atlas, "sliding")
    ends = {"plateau_change": 0.25, "plateau_change_low": 0.2, "plateau_change_high": 0.3}
    for trend, words in (
        ("level", "4 of 4 directions have a plateau up to v = "),
        ("rising", "; rising: East, North, West, South."),
        ("falling", "(changes within 10 %); falling: East, North, West, South."),
    ):
        told = changed(atlas, "joints/sliding", plateau_trend=trend, **ends)
        drawing = drawn(told, "sliding", "fig06_07_dilatancy")
        assert words in drawing.caption
        shown = " ".join(text.get_text() for text in drawing.figure.findobj(Text))
        assert shown.count(f"+25 % [+20, +30], {trend}") == 4


@pytest.mark.parametrize("specimen", ["sliding", "flat", "pair"])
def test_the_figure_calls_that_k_ni_undetermined_which_the_atlas_does(atlas, specimen):
    state = Subject.of(atlas, specimen).state("closure")
    figure = drawn(atlas, specimen, "fig04_05_closure").figure
    legend = " ".join(text.get_text() for text in figure.legends[0].get_texts())
    wanted = np.isfinite(state["hyperbola_k_ni"]) and not state["hyperbola_k_ni_determined"]
    assert ("bars 95 %:\nundetermined, " in legend) == wanted


def test_every_k_ni_of_the_closure_curves_is_as_determined_as_the_atlas_says(atlas):
    ends = {f"hyperbola_k_ni{end}": x for end, x in (("", 20.0), ("_low", 16.0), ("_high", 25.0))}
    ends |= {"hyperbola_misfit": 0.01, "semi_logarithmic_misfit": 0.01}
    for determined, words in ((True, "; 20 [16, 25]"), (False, "; undetermined (20")):
        told = changed(atlas, "closure/sliding", **ends, hyperbola_k_ni_determined=determined)
        figure = drawn(told, "sliding", "fig04_05_closure").figure
        legend = [text.get_text() for text in figure.legends[0].get_texts()]
        assert sum(words in text for text in legend) == 5
        table = drawn(told, "sliding", "fig04_05_closure").data
        assert set(table["hyperbola_k_ni_determined"].dropna()) == {determined}
