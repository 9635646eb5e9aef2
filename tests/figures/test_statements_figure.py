"""The table of the paper's statements, and the figures of a whole study."""

import numpy as np
import pandas as pd
import pytest
from cases import representative
from PIL import Image

from fractalcontact.core.stage import EXPERIMENT
from fractalcontact.figures.draw import draw_study_figures
from fractalcontact.figures.joint import statements
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.study.figure_list import study_figures_of
from fractalcontact.study.stages import paths_of


@pytest.mark.parametrize("name", representative(["sliding", "pair", "flat"]))
def test_every_statement_is_a_row_of_the_table(atlas, name):
    with print_style():
        drawing = statements.draw(atlas, name)
    judged = atlas[f"statements/{name}"].to_dataset()
    assert drawing.data["verdict"].tolist() == judged["verdict"].values.tolist()
    shown = " ".join(text.get_text() for text in drawing.figure.axes[0].texts).replace("\n", " ")
    for claim in judged["claim"].values:
        assert claim in shown
    assert f"Of {judged.sizes['statement']} statements" in drawing.caption


def test_no_row_is_cut_off(atlas):
    with print_style():
        figure = statements.draw(atlas, "pair").figure
    figure.canvas.draw()
    whole = figure.bbox
    for text in figure.axes[0].texts:
        box = text.get_window_extent()
        assert whole.x0 <= box.x0
        assert box.x1 <= whole.x1
        assert whole.y0 <= box.y0
        assert box.y1 <= whole.y1


def test_figures_of_a_study(atlas_file, atlas, tmp_path):
    names = study_figures_of(paths_of(EXPERIMENT))
    assert names == [
        "three_exponents",
        "size_effect",
        "resolution_law",
        "contact_geometry",
        "size_strength",
        "plateau",
        "area_slope",
        "estimator_bias",
    ]
    assert study_figures_of({"study": "x", "area_slope": {}}) == ["area_slope"]
    specimens = ["flat", "pair", "sliding"]
    captions = draw_study_figures(atlas_file, specimens, tmp_path, ["area_slope"]).captions
    assert list(captions) == ["area_slope"]
    written = (tmp_path / "area_slope.txt").read_text(encoding="utf-8")
    assert written == captions["area_slope"].text + "\n"
    with Image.open(tmp_path / "area_slope.png") as picture:
        assert np.ptp(np.asarray(picture.convert("L"))) > 100  # something is drawn
    assert "<svg" in (tmp_path / "area_slope.svg").read_text(encoding="utf-8")
    table = pd.read_csv(tmp_path / "area_slope.csv")
    slopes = atlas["area_slope/surfaces"]
    np.testing.assert_allclose(table["kappa"], slopes["kappa"].values.ravel(), rtol=1e-7)
