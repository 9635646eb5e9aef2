"""Numbers along short logarithmic axes: two or more, and apart from each other."""

from itertools import pairwise

import numpy as np
import pytest
from matplotlib.figure import Figure
from print_size import shown_texts

from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.figures.kit.layout import lay_out

#: Pixels at 200 a inch that stand at least between two numbers.
GAP = 3


@pytest.mark.parametrize("ratio", [1.06, 1.15, 1.4, 2, 3, 5, 9, 20, 90])
def test_numbers_of_a_short_logarithmic_axis_stand_apart(ratio):
    """In a panel of a third of the page, wherever the axis begins."""
    for low in np.geomspace(0.11, 10, 12):
        with print_style():
            figure = Figure(figsize=(7.2, 3.4), layout="constrained")
            axes = figure.add_subplot(1, 3, 1)
            axes.plot([low, low * ratio], [1, 2])
            axes.set(xscale="log", xlim=(low, low * ratio))
            canvas = lay_out(figure)
            canvas.draw()
        labels = {*axes.xaxis.get_ticklabels(which="both")}
        boxes = [
            text.get_window_extent(canvas.get_renderer())
            for text in shown_texts(figure)
            if text in labels
        ]
        ends = sorted((box.x0, box.x1) for box in boxes)
        assert len(ends) >= 2, low
        assert min(b[0] - a[1] for a, b in pairwise(ends)) > GAP, low
