"""Points, their bars and the words of empty panels, as all figures draw them."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from fractalcontact.figures.kit.empty import MARK, say_empty, settle_empty_axes
from fractalcontact.figures.kit.points import draw_points, hollow_entry, reach


def one_panel():
    figure = Figure(figsize=(4, 3))
    return figure, figure.subplots()


def faces(axes):
    """Of every line with points: their x, whether they are hollow, line style, label."""
    return [
        (
            line.get_xdata().tolist(),
            line.get_markerfacecolor() == "white",
            line.get_linestyle(),
            line.get_label(),
        )
        for line in axes.lines
    ]


def test_bars_reach_from_their_values_to_both_ends():
    found = reach([1, 2], [0.5, 1.9], [1.25, 4])
    np.testing.assert_allclose(found, [[0.5, 0.1], [0.25, 2]])
    assert reach(3.0, 2.0, 5.0).tolist() == [[1.0], [2.0]]
    column = pd.Series([1.0, 2.0], index=[7, 3])
    assert reach(column, column - 1, column + 2).tolist() == [[1, 1], [2, 2]]


def test_an_interval_beside_its_value_by_rounding_is_drawn_without_a_bar():
    value = np.array([0.3])
    with pytest.raises(ValueError, match="negative"):
        one_panel()[1].errorbar([1], value, yerr=[value - np.nextafter(value, 1), [0]])
    for ends in ((np.nextafter(value, 1), value), (value, np.nextafter(value, 0))):
        found = reach(value, *ends)
        assert found.tolist() == [[0.0], [0.0]]
        one_panel()[1].errorbar([1], value, yerr=found)


def test_a_value_without_an_interval_has_no_bar():
    found = reach([1.0, 2.0], [np.nan, 1.0], [np.nan, 3.0])
    np.testing.assert_array_equal(found, [[np.nan, 1], [np.nan, 1]])
    _, axes = one_panel()
    drawn = axes.errorbar([1, 2], [1, 2], yerr=found)
    (bars,) = drawn.lines[2]
    ends = [segment[:, 1] for segment in bars.get_segments() if segment.size]
    np.testing.assert_array_equal(ends, [[1, 3]])


def test_trusted_points_are_filled_and_the_others_hollow():
    _, axes = one_panel()
    draw_points(axes, [1, 2, 3], [4, 5, 6], [True, False, True], marker="s", label="all")
    (first, filled, _, label), (second, hollow, _, none) = faces(axes)
    assert (first, filled, label) == ([1, 3], False, "all")
    assert (second, hollow) == ([2], True)
    assert none.startswith("_")
    assert all(line.get_linestyle() == "None" for line in axes.lines)


def test_a_line_runs_through_points_of_both_kinds():
    _, axes = one_panel()
    table = pd.DataFrame({"x": [1, 2, 3], "sure": [True, False, True]}, index=[5, 6, 7])
    draw_points(axes, table["x"], table["x"], table["sure"], {"zorder": 3}, ls="-", marker="o")
    (first, filled, line, _), (second, hollow, none, _) = faces(axes)
    assert (first, filled, line) == ([1, 2, 3], False, "-")
    assert (second, hollow, none) == ([2], True, "None")
    assert [one.get_zorder() for one in axes.lines] == [2, 3]


def test_the_entry_of_hollow_points_draws_none_and_is_hollow():
    _, axes = one_panel()
    hollow_entry(axes, "few nodes")
    hollow_entry(axes, "of one load", color="C1", marker="s", ls="-")
    assert faces(axes) == [([], True, "None", "few nodes"), ([], True, "None", "of one load")]
    assert [line.get_marker() for line in axes.lines] == ["o", "s"]
    assert axes.get_legend_handles_labels()[1] == ["few nodes", "of one load"]


@pytest.mark.parametrize("ticks", [True, False])
def test_an_empty_panel_says_why_once(ticks):
    figure, axes = one_panel()
    axes.set(xscale="log", yscale="log")
    say_empty(axes, "no load at which\nthere is " + "much " * 20, ticks=ticks)
    settle_empty_axes(figure)
    (text,) = axes.texts
    lines = text.get_text().splitlines()
    assert lines[0] == "no load at which"
    assert max(map(len, lines)) <= 48 < len(" ".join(lines))
    assert text.get_gid() == MARK
    if not ticks:
        assert not len(axes.get_xticks())
        assert not len(axes.get_yticks())
