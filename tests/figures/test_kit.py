"""What all figures share: their titles, the ticks of their axes, and how they are laid out."""

import json
import xml.etree.ElementTree as ElementTree

import numpy as np
import pandas as pd
import pytest
from cases import representative
from matplotlib.figure import Figure
from matplotlib.text import Text
from PIL import Image

from contactlab.figures.experiments import plateau
from fractalcontact.core.text import percent
from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import WIDTH, Drawing, print_style, save
from fractalcontact.figures.kit.titles import headline, letter
from fractalcontact.study.figure_list import figures_of

#: 200 letters, with dollar signs that begin no formula.
LONG = ("Sandstein aus der Grube 7, Kluft 3a, geborgen für $5 $ und \\frac vermessen, " * 3)[:200]


def drawn_texts(folder, name):
    """Every text of an SVG."""
    root = ElementTree.parse(folder / f"{name}.svg").getroot()
    return [
        "".join(node.itertext()).strip() for node in root.iter("{http://www.w3.org/2000/svg}text")
    ]


@pytest.mark.parametrize(
    ("share", "words"),
    [
        (0.0, "0 %"),
        (0.01234, "1.2 %"),
        (0.996, "99.6 %"),
        (1.0, "100 %"),
        (3.57, "360 %"),
        (-1.04, "−100 %"),
    ],
)
def test_shares_in_per_cent_have_no_exponent(share, words):
    assert percent(np.float64(share)) == words


def test_a_change_in_per_cent_has_its_sign():
    assert [percent(change, sign="+") for change in (0.02, -0.02)] == ["+2 %", "−2 %"]


def one_panel(width=4):
    figure = Figure(figsize=(width, 3))
    return figure, figure.subplots()


def drawing_of(figure):
    return Drawing(figure, pd.DataFrame({"x_mm": [1.0]}), "a caption")


@pytest.fixture
def labelled(atlas):
    """The atlas, its specimens with the long label."""
    tree = atlas.copy()
    configuration = json.loads(tree.attrs["configuration"])
    for settings in configuration["settings"].values():
        settings["label"] = LONG
    tree.attrs["configuration"] = json.dumps(configuration)
    return tree


@pytest.mark.parametrize(
    "name", representative([n for n in figures_of("match") if n != "domain_measures"], 2)
)
def test_a_long_label_stays_within_every_figure(labelled, name):
    with print_style():
        figure = drawer_of(name)(labelled, "sliding").figure
        titles = [text for text in figure.findobj(Text) if "Sandstein" in text.get_text()]
        assert titles
        for title in titles:
            assert LONG.strip() in " ".join(title.get_text().replace("\\$", "$").split())
            extent = title.get_window_extent()
            assert 0 <= extent.x0 < extent.x1 <= figure.bbox.width


@pytest.mark.parametrize("width", [3, WIDTH])
def test_a_title_shows_a_label_as_it_was_written_and_reads_formulas_after_it(width, tmp_path):
    with print_style():
        figure, _ = one_panel(width)
        headline(figure, LONG, "$F$ = 10 kN", below="below")
        save(drawing_of(figure), tmp_path, "title")
    words = " ".join(drawn_texts(tmp_path, "title"))
    assert "$5 $ und \\frac" in words
    assert "$F$" not in words
    assert "below" in words


def test_powers_of_ten_are_plain_text_on_both_scales(tmp_path):
    with print_style():
        figure, axes = one_panel()
        axes.loglog([1e-3, 1e2], [1e-12, 1e3])
        axes.secondary_yaxis("right", functions=(lambda y: 10 * y, lambda y: y / 10))
        save(drawing_of(figure), tmp_path, "decades")
    texts = drawn_texts(tmp_path, "decades")
    assert {"10⁻³", "10⁰", "10²", "10⁻¹²"} <= set(texts)
    assert texts.count("10⁻⁸") == 2
    assert "mathdefault" not in (tmp_path / "decades.svg").read_text(encoding="utf-8")


def test_less_than_a_decade_has_numbers_between_the_powers_of_ten(tmp_path):
    with print_style():
        figure, axes = one_panel()
        axes.semilogx([2, 7], [0, 1])
        save(drawing_of(figure), tmp_path, "short")
    assert {"2", "5"} <= set(drawn_texts(tmp_path, "short"))


@pytest.mark.parametrize("factor", [1, 1e9])
def test_a_title_is_clear_of_the_factor_of_the_numbers_along_y(factor, tmp_path):
    with print_style():
        figure, axes = one_panel()
        axes.plot([0, 1], [0, 3 * factor])
        letter(axes, "a", "title of a panel")
        save(drawing_of(figure), tmp_path, "factor")
        (title,) = (t for t in axes.findobj(Text) if t.get_text().startswith("(a)"))
        offset = axes.yaxis.get_offset_text()
        assert bool(offset.get_text()) == (factor > 1)
        assert title.get_window_extent().y0 >= axes.get_window_extent().y1
        assert title.get_window_extent().y1 <= figure.bbox.height
        if factor > 1:
            assert title.get_window_extent().y0 >= offset.get_window_extent().y1 - 1


def test_the_same_figure_twice_is_the_same_files(tmp_path):
    """Two drawings, one after the other: what the first has left behind does not matter."""
    for name in ("first", "second"):
        with print_style():
            figure, axes = one_panel()
            axes.imshow(np.arange(12.0).reshape(3, 4))
            letter(axes, "a", r"$\sigma_0$")
            save(drawing_of(figure), tmp_path / name, "same")
    for ending in ("png", "svg", "csv", "txt"):
        first, second = (tmp_path / name / f"same.{ending}" for name in ("first", "second"))
        assert first.read_bytes() == second.read_bytes()


def test_the_picture_has_the_pixels_of_the_figure(tmp_path):
    with print_style():
        figure, _ = one_panel()
        save(drawing_of(figure), tmp_path, "size")
    with Image.open(tmp_path / "size.png") as picture:
        assert picture.size == (800, 600)
        assert picture.info["dpi"] == pytest.approx((200, 200), abs=0.1)


def test_labels_stay_clear_of_the_numbers_in_both_files(tmp_path):
    with print_style():
        figure, axes = one_panel()
        axes.plot([0, 1], [0, 123456])
        axes.set_ylabel("height (mm)")
        axes.set_xlabel("length (mm)")
        save(drawing_of(figure), tmp_path, "labels")
        # The canvas of the SVG, which was written last, has another resolution than the PNG.
        x, y = axes.xaxis.label.get_window_extent(), axes.yaxis.label.get_window_extent()
        assert y.x1 < min(tick.get_window_extent().x0 for tick in axes.get_yticklabels())
        assert x.y1 < min(tick.get_window_extent().y0 for tick in axes.get_xticklabels())
        assert y.x0 >= 0
        assert x.y0 >= 0


def test_a_long_label_makes_a_figure_higher_and_a_short_one_does_not():
    with print_style():
        heights = []
        for label in ("short", LONG):
            figure, _ = one_panel()
            headline(figure, label)
            heights.append(figure.get_figheight())
    assert heights[0] == 3 < heights[1]


def test_long_labels_stay_within_the_legend_of_a_study(labelled, tmp_path):
    with print_style():
        drawing = plateau.draw(labelled, ["sliding", "pair"])
        save(drawing, tmp_path, "plateau")
        texts = [t for t in drawing.figure.findobj(Text) if t.get_text().startswith("Sandstein")]
        assert texts
        for text in texts:
            extent = text.get_window_extent()
            assert 0 <= extent.x0 < extent.x1 <= drawing.figure.bbox.width
    assert LONG.strip() in set(drawing.data["specimen"].str.strip())
