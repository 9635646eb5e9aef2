"""Numbers in words, and pictures."""

import base64
import io
import math

import numpy as np
import pytest
import xarray as xr
from matplotlib.image import imread

from fractalcontact.pages.summary import Quantity
from fractalcontact.pages.thumbnails import SIDE, relief_thumbnail, shaded
from fractalcontact.pages.words import (
    duration,
    interval,
    measured,
    percent,
    short,
    undetermined,
    with_unit,
)


@pytest.mark.parametrize(
    ("value", "trimmed", "whole"),
    [
        (2.2, "2.2", "2.20"),
        (-0.05, "−0.05", "−0.0500"),
        (19.999, "20", "20.0"),
        (0, "0", "0"),
        (123456, "123000", "123000"),
        (0.9996, "1", "1.00"),
        (1.234e-7, "1.23e−07", "1.23e−07"),
        (-9.0e-6, "−9e−06", "−9.00e−06"),
        (math.inf, "–", "–"),
        (float("nan"), "–", "–"),
    ],
)
def test_three_digits(value, trimmed, whole):
    assert short(value) == trimmed
    assert measured(value) == whole


def test_units_suit_the_number():
    assert with_unit(0.0123, "mm") == "12.3 µm"
    assert with_unit(1.65, "mm2") == "1.65 mm²"
    assert with_unit(2760, "MPa/mm") == "2.76 GPa/mm"
    assert with_unit(30000, "N") == "30 kN"
    assert with_unit(1.3, "1") == "1.3"
    assert with_unit(math.nan, "mm") == "–"
    assert percent(0.0469) == "4.7 %"
    assert [duration(s) for s in (47, 192, 7500)] == ["47 s", "3 min 12 s", "2 h 5 min"]


def test_a_length_is_in_micrometres_from_one_of_them_to_a_thousand():
    lengths = (1.0, 0.5, 0.005, 1e-3, 5e-4)
    words = ["1 mm", "500 µm", "5 µm", "1 µm", "500 nm"]
    assert [with_unit(one, "mm") for one in lengths] == words


def test_uneven_ends_stand_in_brackets():
    assert interval(1.0, 0.9, 1.13) == "1.00 [0.900, 1.13]"
    assert interval(1.0, 0.9, 1.1) == "1.00 ± 0.10"


def test_what_is_undetermined_is_shown_with_its_error():
    assert undetermined(interval(0.96, 0.02, 1.9)) == "undetermined (0.960 ± 0.94)"
    assert undetermined(interval(212, 49.1, 914)) == "undetermined (212 [49.1, 914])"
    assert undetermined(interval(1.4, math.nan, math.nan)) == "undetermined (1.40, error not known)"
    assert interval(math.nan, math.nan, math.nan) == "–"


@pytest.mark.parametrize("value", [2.0, 1e-6, 0.0, -0.04])
def test_what_may_cross_zero_has_its_errors_in_its_unit_whatever_its_value(value):
    """A dimension and a separation: the form of an error follows from the kind of the quantity."""
    for unit, words in (("1", "0.25"), ("mm", "250 µm")):
        found = Quantity("name", "meaning", unit, True, value, {}, {})
        assert found.error_words(0.25) == words
    assert Quantity("name", "meaning", "mm", False, 0.04, {}, {}).error_words(0.25) == "620 %"


def test_relief_is_lit_from_the_upper_left_and_missing_cells_are_white():
    """A hill's slope towards it is brighter than the one away from it."""
    y, x = np.mgrid[1:-1:40j, -1:1:40j]
    hill = np.exp(-4 * (x**2 + y**2))
    hill[-3:, :3] = np.nan
    grey = shaded(hill, 0.05).astype(int)
    assert grey[:20, :20].mean() > grey[20:, 20:].mean() + 20
    assert (grey[-3:, :3] == 255).all()
    assert (shaded(np.zeros((8, 8)), 1.0) == shaded(np.ones((8, 8)), 1.0)).all()


def test_a_thumbnail_has_means_of_what_is_known_north_up():
    """A ridge in the South of a window of twice the pixels, with a missing cell."""
    lower = np.zeros((2 * SIDE, 2 * SIDE))
    lower[20:24] = 1.0
    lower[21, 7] = np.nan
    attrs = {"window_y0": 0, "window_x0": 0, "window_ny": 2 * SIDE, "window_nx": 2 * SIDE}
    attrs |= {"spacing_x": 0.1, "spacing_y": 0.1}
    start, _, data = relief_thumbnail(
        xr.Dataset({"lower": (("y", "x"), lower)}, attrs=attrs)
    ).partition(",")
    assert start == "data:image/png;base64"
    found = imread(io.BytesIO(base64.b64decode(data)), format="png")
    assert found.shape == (SIDE, SIDE)
    edges = np.flatnonzero(np.abs(found[:, 50] - np.median(found)) > 0.1)
    assert edges.size
    assert (edges > SIDE // 2).all()
