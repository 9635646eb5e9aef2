"""Numbers in words: what is undetermined is said with its value and its error."""

import numpy as np
import pytest

from fractalcontact.figures.kit.words import estimate, interval, undetermined


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        ((0.96, 0.02, 1.9), "undetermined (0.96 ± 0.94)"),
        ((1.45, -0.34, 3.24), "undetermined (1.45 ± 1.79)"),
        ((0.9, 0.3, 1.9), "undetermined (0.90 [0.30, 1.90])"),
        ((400, -1e4, 9e3), "undetermined (400 [-10000, 9000])"),
        ((-1e-9, -1, 1), "undetermined (0.00 ± 1.00)"),
        ((1.0, 1.0 - 1e-14, 1.0 + 1e-14), "undetermined (1, error not known)"),
        ((0.5, np.nan, np.nan), "undetermined (0.5, error not known)"),
        ((0.5, -np.inf, np.inf), "undetermined (0.5, error not known)"),
        ((np.nan, np.nan, np.nan), "undetermined"),
    ],
)
def test_what_is_undetermined_has_its_value_and_error(ends, words):
    assert undetermined(*ends) == words


def test_error_has_two_digits_however_small_or_large():
    for size in 10.0 ** np.arange(-6, 7):
        words = undetermined(3 * size, -1.1 * size, 7.1 * size)
        value, error = (float(part) for part in words.split("(")[1].rstrip(")").split(" ± "))
        assert value == pytest.approx(3 * size, rel=0.02)
        assert error == pytest.approx(4.1 * size, rel=0.02)


def test_both_ways_to_print_an_interval_agree_on_what_is_undetermined():
    assert interval(0.96, 0.02, 1.9) == undetermined(0.96, 0.02, 1.9)
    assert (
        estimate(3.0, -40, 46, "mm")
        == undetermined(3.0, -40, 46, "mm")
        == ("undetermined (3 ± 43 mm)")
    )
    assert interval(0.96, 0.9, 1.02) == "0.96 [0.90, 1.02]"
    assert estimate(np.nan, 0, 1) == "no fit"
