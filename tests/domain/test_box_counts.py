import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from fractalcontact.domain.box_counts import (
    box_count,
    box_sizes,
    mean_count,
    minimal_cover,
    whole_sizes,
    window_sizes,
)

DOMAINS = arrays(bool, st.tuples(st.integers(1, 14), st.integers(1, 14)))

# -- exact -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("r", [1, 2, 7, 20, 50])
def test_mean_counts_of_simple_sets(r):
    square, point, row = (np.zeros((40, 60), dtype=bool) for _ in range(3))
    square[5:25, 10:30] = point[3, 4] = row[9, 10:40] = True
    assert mean_count(square, [r]).item() == pytest.approx(((20 + r - 1) / r) ** 2)
    assert mean_count(point, [r]).item() == pytest.approx(1)
    assert mean_count(row, [r]).item() == pytest.approx((30 + r - 1) / r)


def test_whole_sizes():
    assert whole_sizes(8).tolist() == [1, 2, 3, 4, 5, 6, 7, 8]
    assert whole_sizes(0.5).tolist() == [1]
    assert whole_sizes(64)[-1] == 64


# -- independent -----------------------------------------------------------------------------------


@given(DOMAINS, st.integers(1, 9), st.integers(1, 4))
@settings(max_examples=60, deadline=None)
def test_mean_counts_agree_with_counting_by_hand(domain, r, blocks):
    ny, nx = domain.shape
    places = np.zeros((blocks, blocks))
    for y in range(1 - r, ny):
        for x in range(1 - r, nx):
            if domain[max(y, 0) : y + r, max(x, 0) : x + r].any():
                part_y = np.clip((2 * y + r) * blocks // (2 * ny), 0, blocks - 1)
                part_x = np.clip((2 * x + r) * blocks // (2 * nx), 0, blocks - 1)
                places[part_y, part_x] += 1
    np.testing.assert_allclose(mean_count(domain, [r], blocks=blocks)[0], places / r**2)


@given(DOMAINS, st.integers(1, 9))
@settings(max_examples=60, deadline=None)
def test_cover_is_the_same_on_halved_cells(domain, r):
    """No origin between the old nodes covers them with fewer boxes of whole cells."""
    halved = np.kron(domain, np.ones((2, 2), bool))
    assert box_count(halved, [2 * r])[0] == box_count(domain, [r])[0]


def counted_at_every_origin(domain, size, step):
    """N(r) by putting every centre in its box, at origins a step apart along both axes."""
    y, x = np.nonzero(domain)
    origins = np.arange(step / 2, size, step)
    rows = [np.floor((y + 0.5 + origin) / size).astype(int) for origin in origins]
    columns = [np.floor((x + 0.5 + origin) / size).astype(int) for origin in origins]
    return min(len(set(zip(row, column, strict=True))) for row in rows for column in columns)


@pytest.mark.parametrize("size", [17, 20, 23, 32])
def test_cover_is_minimal_over_every_origin_of_large_boxes(size):
    # More origins along an axis than the 16 that were once tried.
    for seed in range(3):
        domain = np.random.default_rng(seed).random((70, 55)) < 0.02
        assert box_count(domain, [size])[0] == counted_at_every_origin(domain, size, 1)


@given(DOMAINS, st.integers(3, 20), st.integers(2, 4))
@settings(max_examples=30, deadline=None)
def test_cover_of_parts_of_cells_is_minimal(domain, numerator, denominator):
    size = max(numerator / denominator, 1.0)
    expected = counted_at_every_origin(domain, size, 0.05) if domain.any() else 0
    assert box_count(domain, [size])[0] == expected


def test_every_origin_is_tried_of_boxes_that_divide_a_window_and_not_of_all():
    domain = np.random.default_rng(4).random((200, 248)) < 0.02
    for sizes in ([1, 7, 12.5, 200 / 3], window_sizes(domain.shape)):
        few = box_count(domain, sizes, max_shifts=1)
        np.testing.assert_array_equal(few, box_count(domain, sizes))
    sizes = box_sizes(200)
    assert (box_count(domain, sizes, max_shifts=1) > box_count(domain, sizes)).any()


@given(DOMAINS, st.lists(st.integers(1, 20), min_size=1, max_size=4))
@settings(max_examples=40, deadline=None)
def test_whole_sides_count_covers_and_means_alike(domain, sizes):
    sizes = np.array(sizes)
    np.testing.assert_array_equal(minimal_cover(domain, sizes), box_count(domain, sizes))
    mean = mean_count(domain, sizes).ravel()
    np.testing.assert_allclose(mean, mean_count(domain, sizes, blocks=2).sum(axis=(1, 2)))


# -- properties ------------------------------------------------------------------------------------


@given(DOMAINS, st.integers(1, 9))
@settings(max_examples=60, deadline=None)
def test_the_fewest_are_no_more_than_the_mean(domain, r):
    mean = mean_count(domain, [r]).sum()
    assert box_count(domain, [r])[0] <= mean + 1e-9
    for turned in (domain.T, domain[::-1], np.pad(domain, 3)):
        assert mean_count(turned, [r]).sum() == pytest.approx(mean)
