"""Figures of measured contact maps, and their place beside what is computed."""

import numpy as np
import pytest
import xarray as xr
from print_size import faults
from stated import MAP

from fractalcontact.core.text import number
from fractalcontact.domain.map_series import with_series
from fractalcontact.domain.measured_map import read_contact_map
from fractalcontact.domain.pressure_trend import pressure_trend
from fractalcontact.figures.draw import draw_figure, drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.figures.kit.measured_maps import measured_series, threshold_words
from fractalcontact.study.figure_list import all_figures, study_figures_of

FIGURES = ("contact_maps", "map_trend")
OF_MAPS = {**MAP, "unit": "mm", "spacing": 0.5}


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    """Two series of films, one without loads, and a cast of 0 and 1 under 3 kN."""
    folder, found = tmp_path_factory.mktemp("maps"), {}
    rng = np.random.default_rng(0)
    film = rng.random((32, 32))

    def add(name, values, **keys):
        np.save(folder / f"{name}.npy", values)
        found[name] = read_contact_map(folder / f"{name}.npy", OF_MAPS | keys, label=f"{name}, $x$")

    for n, level in enumerate((0.9, 0.8, 0.6, 0.4)):
        keys = {"series": "films", "threshold": [level - 0.05, level, level + 0.05]}
        add(f"film_{n}", film, load=f"{10.0 ** (1 - n):g} MPa", outline="disc", **keys)
    for n in range(2):
        add(f"lost_{n}", film, series="without loads", threshold=0.7 + 0.1 * n)
    add("cast", (film > 0.9).astype(float), load="3 kN")
    return found


@pytest.fixture
def with_maps(atlas, maps):
    both = atlas.copy()
    for name, one in with_series(maps).items():
        both[f"contact_maps/{name}"] = xr.DataTree(one)
    return both


def only_maps(maps):
    placed = with_series(maps)
    return xr.DataTree.from_dict({f"/contact_maps/{name}": one for name, one in placed.items()})


def drawn(atlas, figure, subject=()):
    with print_style():
        return drawer_of(figure)(atlas, subject)


def test_maps_of_one_series_are_one_line_in_the_order_of_their_pressure(maps):
    series = measured_series(only_maps(maps))
    assert [each.label for each in series] == ["films", "without loads", "cast, $x$"]
    assert series[0].names == ("film_3", "film_2", "film_1", "film_0")
    assert (np.diff(series[0].pressure) > 0).all()
    assert len({each.style["color"] for each in series}) == 3
    # Of the cast, which holds 0 and 1, no threshold is stated.
    assert threshold_words(series) == "thresholds 0.35 to 0.95"
    assert threshold_words(series[2:]) == "maps of 0 and 1"


def test_a_map_stands_at_its_own_pressure_and_its_own_load_is_in_the_table(with_maps, maps):
    drawing = drawn(with_maps, "fig12_evolution", "sliding")
    (axes,) = (axes for axes in drawing.figure.axes if axes.get_ylabel().startswith("dimension"))
    (pressure,) = axes.child_axes
    assert "(MPa)" in pressure.get_xlabel()
    nominal = 4.8**2
    cast = maps["cast"]
    assert float(cast["force"]) == pytest.approx(3000)
    value = float(cast["nominal_pressure"])
    assert value == pytest.approx(3000 / 16**2)
    places = {
        round(float(x) / nominal, 6) for bars in axes.containers for x in bars.lines[0].get_xdata()
    }
    assert round(value, 6) in places
    rows = drawing.data.set_index("map")
    assert rows.loc["cast", "normal_force_N"] == pytest.approx(3000)
    assert rows.loc["cast", "nominal_pressure_MPa"] == pytest.approx(value)
    computed = drawing.data[drawing.data["map"].isna()]
    forces = computed["nominal_pressure_MPa"] * nominal
    np.testing.assert_allclose(computed["normal_force_N"], forces)
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert sum(text.startswith("measured: ") for text in legend) == 3
    assert len(set(legend)) == len(legend)
    assert "Measured (thresholds 0.35 to 0.95)" in drawing.caption


@pytest.mark.parametrize("figure", FIGURES)
def test_words_of_many_maps_are_apart_where_nothing_is_determined(maps, figure):
    """Five maps side by side, each with a name and an interval as long as they get."""
    wide = {}
    for n in range(10):
        one = maps["film_0"].copy()
        one["delta_sigma_low"], one["delta_sigma_high"] = (
            one["delta_sigma"] - 0.9,
            xr.Variable((), 2),
        )
        wide[f"ROCK_OF_THE_LOWER_MINE_{n}"] = one
    assert faults(draw_figure(only_maps(wide), figure, []).figure) == []


def test_maps_of_unknown_load_are_in_the_order_of_the_numbers_in_their_names(maps):
    cast = maps["lost_0"]
    for alone in (cast, cast.assign_attrs(series="")):
        series = measured_series(only_maps({f"film {n}": alone for n in (12, 120, 24, 3)}))
        names = [name for each in series for name in each.names]
        assert names == ["film 3", "film 12", "film 24", "film 120"]


@pytest.mark.parametrize("figure", FIGURES)
def test_figures_of_maps_need_nothing_but_maps(maps, figure):
    drawing = drawn(only_maps(maps), figure)
    assert len(drawing.data) == len(maps)
    assert drawing.caption.startswith("Supplementary figure. ")
    assert "thresholds 0.35 to 0.95" in drawing.caption
    assert len(drawing.caption.split()) < 70
    stored = [float(maps[name]["delta_sigma"]) for name in drawing.data["map"]]
    np.testing.assert_array_equal(drawing.data["delta_sigma"], stored)


def test_every_map_is_drawn_with_its_cells(maps):
    figure = drawn(only_maps(maps), "contact_maps").figure
    panels = [axes for axes in figure.axes if axes.images]
    assert len(panels) == len(maps)
    shown = {axes.get_title(loc="left").split("\n")[0]: axes.images[0] for axes in panels}
    for name, one in maps.items():
        image = np.ma.filled(shown[name].get_array(), np.nan)
        np.testing.assert_array_equal(np.isnan(image), ~one["measured"])
        np.testing.assert_array_equal(image == 1, one["in_contact"])


def test_a_caption_states_the_trend_of_a_series(maps):
    series = measured_series(only_maps(maps))[0]
    trend = pressure_trend(
        series.pressure, series.values("delta_sigma"), series.values("delta_sigma_random")
    )
    caption = drawn(only_maps(maps), "map_trend").caption
    assert f"films (4): {number(trend.line.slope)}" in caption
    assert f"({trend.verdict})" in caption
    assert f"({trend.beyond_random})" in caption
    alone = {name: one for name, one in maps.items() if name.startswith("lost")}
    assert "too few maps with loads for a trend" in drawn(only_maps(alone), "map_trend").caption


def test_maps_ask_for_their_figures():
    assert set(study_figures_of(["contact_maps"])) == set(FIGURES)
    assert {all_figures()[name].needs for name in FIGURES} == {("contact_maps",)}
