"""Cells of the tables of the pages: published numbers in words."""

import pytest

from fractalcontact.core.estimate import Estimate
from fractalcontact.pages.cells import error_words
from fractalcontact.report.published import Number, Row


@pytest.mark.parametrize("value", [2.0, 1e-6, 0.0, -0.04])
def test_what_may_cross_zero_has_its_errors_in_its_unit_whatever_its_value(value):
    """A dimension and a separation: the form of an error follows from the kind of the quantity."""
    one = Number({}, Estimate(value))
    dimension = Row("name", "title", "stage/name", "1", dimension=True)
    separation = Row("name", "title", "stage/name", "mm", within=(-1, 1))
    assert error_words(dimension, one, 0.25) == "± 0.25"
    assert error_words(separation, one, 0.25) == "± 250 µm"
    gap = Row("name", "title", "stage/name", "mm")
    assert error_words(gap, Number({}, Estimate(0.04)), 0.25) == "± 620 %"
