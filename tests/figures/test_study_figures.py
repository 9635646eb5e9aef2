"""The figures of a whole study."""

import numpy as np
import pandas as pd
from PIL import Image
from stage_names import EXPERIMENTS

from fractalcontact.figures.draw import draw_study_figures
from fractalcontact.study.figure_list import study_figures_of


def test_figures_of_a_study(atlas_file, atlas, tmp_path):
    names = study_figures_of(EXPERIMENTS)
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
