import itertools

import numpy as np
import pytest

from fractalcontact.domain.count_law import best_law, law_dimension

SIZES = np.array([3, 4, 5, 6, 8, 10, 13, 16, 20, 26, 32, 45, 64.0])


def counts(dimension, c, outline, side=256):
    rho = SIZES - c
    terms = sum(a * (rho / side) ** k for k, a in enumerate(outline))
    return rho ** (2 - dimension) * terms / SIZES**2


#: Dimensions and outlines; below 1 there is none.
LAWS = [
    *itertools.product([0.3, 0.8, 1.0, 1.26, 1.6, 2.0], [(1.0,)]),
    *itertools.product([1.1, 1.26, 1.6, 2.0], [(2.0, 3.0), (1.0, 2.0, 1.0)]),
]


@pytest.mark.parametrize(("dimension", "outline"), LAWS)
@pytest.mark.parametrize("c", [0, 1])
def test_law_is_found_again(dimension, outline, c):
    law = best_law(SIZES, counts(dimension, c, outline), 256)
    assert law.dimension == pytest.approx(dimension, abs=2e-3)
    # With an outline, what a node stands for may not show: sets of whole numbers do without.
    if len(outline) == 1:
        assert law.c == c or law.misfit < 1e-6
    assert law.misfit < 1e-3
    # A law found from all is found from any part.
    part = law_dimension(law, SIZES[3:], counts(dimension, c, outline)[3:], 256)
    assert part == pytest.approx(dimension, abs=5e-3)


def test_filled_figures_of_any_outline_are_plane():
    for half_perimeter in (1.8, 2.5, 3.9):
        law = best_law(SIZES, counts(2.0, 0, (1.0, half_perimeter, 1.0)), 256)
        assert law.dimension == pytest.approx(2, abs=1e-3)


@pytest.mark.parametrize("whole_cells", [True, False])
def test_what_fills_less_than_a_line_has_no_outline(whole_cells):
    bent = counts(0.8, int(not whole_cells), (1.0, 1.0))
    law = best_law(SIZES, bent, 256, whole_cells)
    assert (law.outline, law.dimension) == (0, pytest.approx(0.8, abs=0.1))


def test_rough_counts_are_taken_for_centres():
    rng = np.random.default_rng(0)
    noisy = counts(1.4, 0, (1.0,)) * np.exp(0.1 * rng.standard_normal(SIZES.size))
    law = best_law(SIZES, noisy, 256)
    assert law.c == 1


def test_no_law_with_too_few_scales():
    law = best_law(SIZES[:2], SIZES[:2], 256)
    assert law is None
