"""The shortcuts of drawing show what matplotlib shows without them."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.mathtext import MathTextParser
from PIL import Image

from fractalcontact.figures.kit import ticks
from fractalcontact.figures.kit.canvas import Canvas
from fractalcontact.figures.kit.drawing import Drawing, print_style, save
from fractalcontact.figures.kit.formulas import formulas_read_once

WORDS = ["undetermined (0.25 [-0.52, 1.02])", "10⁻³ µm", "a line\nand one more", "Ÿ, g, j"]
FORMULAS = [r"$\sqrt{8/\pi}$ = 1.596", r"$\sigma_0/(E^* h'_\mathrm{rms})$", r"$A_r \sim F^m$ (1)"]


def _ink(canvas, words, x, y):
    """Darkness of the pixels of words on a canvas."""
    figure = Figure(figsize=(3, 1), dpi=200)
    figure.text(x, y, words, fontsize=8)
    drawn = canvas(figure)
    drawn.draw()
    return 255.0 - np.asarray(drawn.buffer_rgba())[..., 0]


@pytest.mark.parametrize("words", WORDS + FORMULAS[1:])
@pytest.mark.parametrize("place", [(0.1, 0.3), (0.1013, 0.3127)])
def test_words_stand_within_a_pixel_of_where_they_did(words, place):
    plain = _ink(FigureCanvasAgg, words, *place)
    with formulas_read_once():
        shown = _ink(Canvas, words, *place)
    assert shown.sum() == pytest.approx(plain.sum(), rel=0.02)
    for axis in (0, 1):
        at = np.arange(plain.shape[axis])
        centres = [(ink.sum(1 - axis) * at).sum() / ink.sum() for ink in (plain, shown)]
        assert abs(centres[0] - centres[1]) < 1


@pytest.mark.parametrize("formula", FORMULAS)
@pytest.mark.parametrize(("size", "dpi"), [(8, 200), (7, 72), (100, 72)])
def test_a_formula_is_scaled_to_what_is_read_at_its_size(formula, size, dpi):
    parser, font = MathTextParser("path"), FontProperties(size=size)
    read = parser.parse(formula, dpi, font)
    with formulas_read_once():
        scaled = parser.parse(formula, dpi, font)
    pixel = 1.0  # to which sizes are rounded up
    np.testing.assert_allclose(scaled[:3], read[:3], atol=pixel)
    assert [glyph[2:4] for glyph in scaled.glyphs] == [glyph[2:4] for glyph in read.glyphs]
    for ours, theirs in zip(scaled.glyphs, read.glyphs, strict=True):
        np.testing.assert_allclose(ours[1], theirs[1], rtol=5e-3)
        np.testing.assert_allclose(ours[4:], theirs[4:], atol=pixel)
    np.testing.assert_allclose(scaled.rects, read.rects, atol=pixel)


def test_minor_ticks_drawn_as_one_are_the_same_pixels(tmp_path, monkeypatch):
    def drawing():
        figure = Figure(figsize=(6, 3))
        first, second = figure.subplots(1, 2)
        first.loglog([1e-3, 40], [1, 1e4])
        first.secondary_xaxis("top", functions=(lambda v: 2 * v, lambda v: v / 2))
        second.semilogy([0, 1], [1, 300])
        second.minorticks_on()
        second.twinx().semilogy([0, 1], [5, 7])
        return Drawing(figure, pd.DataFrame({"x": [0]}), "a caption")

    with print_style():
        save(drawing(), tmp_path, "one")
        monkeypatch.setattr(ticks, "_minor_ticks_as_one", lambda axis: axis._update_ticks)
        save(drawing(), tmp_path, "each")
    one, each = (Image.open(tmp_path / f"{name}.png").tobytes() for name in ("one", "each"))
    assert one == each
    assert (tmp_path / "one.svg").stat().st_size < (tmp_path / "each.svg").stat().st_size
