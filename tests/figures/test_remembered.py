"""What is remembered of ticks and texts while a figure is written changes no byte of it."""

import contextlib

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from fractalcontact.figures.kit import drawing, layout
from fractalcontact.figures.kit.drawing import Drawing, print_style, save
from fractalcontact.figures.kit.remembered import remember_ticks


def _figure():
    figure = Figure(figsize=(6, 5))
    (first, second), (third, fourth) = figure.subplots(2, 2)
    x = np.geomspace(1e-3, 40, 30)
    first.loglog(x, x**1.3, "o-", label="$F^{1.3}$")
    first.set(xlabel="normal force $F$ (kN)", ylabel="two\nlines")
    first.legend(title="a legend")
    second.plot(1e6 + x, 1e-5 * np.sin(x))
    second.tick_params(axis="x", rotation=30)
    second.secondary_xaxis("top", functions=(lambda v: v / 2, lambda v: 2 * v))
    third.semilogx(x, x)
    third.twinx().plot(x, -x, color="red")
    third.text(0.5, 0.5, "turned", rotation=45, transform=third.transAxes, ha="right")
    third.annotate("here", (1, 20), (3, 30), arrowprops={"arrowstyle": "->"})
    image = fourth.imshow(np.arange(12.0).reshape(3, 4))
    figure.colorbar(image, ax=fourth, label="a bar")
    figure.suptitle("A title that wraps " * 5, wrap=True)
    return Drawing(figure, pd.DataFrame({"x": x}), "a caption")


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_files_are_the_same_bytes_without(tmp_path, monkeypatch, ending):
    with print_style():
        save(_figure(), tmp_path, "with")
        monkeypatch.setattr(drawing, "layouts_remembered", contextlib.nullcontext)
        monkeypatch.setattr(layout, "remember_ticks", lambda figure: None)
        save(_figure(), tmp_path, "without")
    assert (tmp_path / f"with.{ending}").read_bytes() == (
        tmp_path / f"without.{ending}"
    ).read_bytes()


def test_ticks_follow_the_view_and_the_size_of_their_axis():
    figure = Figure(figsize=(6, 4), dpi=100)
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1])
    remember_ticks(figure)
    before = [tick.get_loc() for tick in axes.xaxis._update_ticks()]
    assert [tick.get_loc() for tick in axes.xaxis._update_ticks()] == before
    axes.set_xlim(0, 7)
    wide = [tick.get_loc() for tick in axes.xaxis._update_ticks()]
    assert max(wide) == 7
    axes.set_position((0.1, 0.1, 0.08, 0.8))
    narrow = [tick.get_loc() for tick in axes.xaxis._update_ticks()]
    assert len(narrow) < len(wide)
