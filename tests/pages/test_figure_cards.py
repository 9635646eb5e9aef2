"""Cards of figures: the lines on each draw it again."""

import functools
import html
import re

import matplotlib
import numpy as np
import pytest
import xarray as xr
from cases import representative
from PIL import Image

from fractalcontact.figures.draw import draw_figures, draw_study_figures
from fractalcontact.pages.figure_cards import redrawn
from fractalcontact.study.atlas import read_atlas, read_named_atlas
from fractalcontact.study.figure_list import figures_of

#: Settings that a user may have, in a file of matplotlib's or in his notebook.
OWN_STYLE = {"font.size": 14, "figure.dpi": 72, "axes.grid": True, "xtick.labelsize": "x-large"}
#: Cards of the pages and the settings under which their lines are run: the first stand for all.
CARDS = [
    ("fig04_05_closure", "pair", {}),
    *((figure, "pair", OWN_STYLE) for figure in figures_of("match")),
    ("comparison", "", OWN_STYLE),
]
#: To open an atlas takes seconds: one does for all figures.
open_once = functools.cache(xr.open_datatree)


@pytest.fixture(scope="module")
def groups(results):
    """Names of the groups of the atlas."""
    return read_named_atlas(results / "atlas.nc")[1]


def words_of(results, specimen):
    """Text of the page of a specimen."""
    return html.unescape((results / f"pages/{specimen}.html").read_text(encoding="utf-8"))


@pytest.mark.parametrize(("figure", "specimen", "style"), representative(CARDS, 3))
def test_the_lines_on_the_page_draw_the_figure_again(
    results, groups, tmp_path, monkeypatch, figure, specimen, style
):
    """The same picture to the pixel, whatever the style where they are pasted."""
    code = redrawn(figure, specimen, "results/tiny/atlas.nc", groups)
    if specimen:  # no figure of the study is drawn beside this page
        assert code in words_of(results, specimen)
    (tmp_path / "results").symlink_to(results.parent)
    monkeypatch.chdir(tmp_path)
    if specimen:
        draw_figures("results/tiny/atlas.nc", specimen, "drawn", [figure])
    else:
        draw_study_figures("results/tiny/atlas.nc", ["flat.1", "pair"], "drawn", [figure])
    monkeypatch.setattr(xr, "open_datatree", open_once)
    values = {}
    with matplotlib.rc_context(style):
        exec(code, values)
        values["drawing"].figure.savefig("again.png")
    assert (tmp_path / f"{figure}.pdf").read_bytes().startswith(b"%PDF")
    assert len(values["drawing"].data) > 0
    with Image.open("again.png") as again, Image.open(f"drawn/{figure}.png") as drawn:
        # The program leaves out the opacity, which is full everywhere.
        pictures = [np.asarray(one.convert("RGB")) for one in (again, drawn)]
    np.testing.assert_array_equal(*pictures)


def test_the_lines_on_the_page_read_groups_that_exist(results, groups):
    """Those of every figure: run on the atlas, each leads to a group with numbers in it."""
    whole = read_atlas(results / "atlas.nc")
    assert groups == {
        node.path.strip("/")
        for node in whole.subtree
        if node.path != "/" and (node.data_vars or node.children)
    }
    for name, opposite in (("pair", "match"), ("flat.1", "flat")):
        text = words_of(results, name)
        for figure in figures_of(opposite):
            code = redrawn(figure, name, "results/tiny/atlas.nc", groups)
            assert code in text
            read = re.findall(r"^(\w+) = (atlas\[.+\])$", code, re.MULTILINE)
            assert read, figure
            for _, expression in read:
                assert eval(expression, {"atlas": whole}).to_dataset().data_vars, expression


def test_measured_maps_are_read_where_the_atlas_has_them():
    """They are no specimen's."""
    specimens = {"specimens", "specimens/a", "contact/a"}
    code = redrawn("fig12_evolution", "a", "atlas.nc", specimens)
    assert "contact_maps" not in code
    assert "specimens = atlas['specimens/a']" in code
    code = redrawn("fig12_evolution", "a", "atlas.nc", specimens | {"contact_maps"})
    assert "contact_maps = atlas['contact_maps']\n" in code
