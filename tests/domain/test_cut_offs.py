"""Cut-offs of box counts: sizes at which nodes are alone, or boxes all occupied, are left out."""

import numpy as np
import pytest

from fractalcontact.domain.cut_offs import SATURATED, between_cut_offs

SIZES = np.array([1.0, 2.0, 4.0, 8.0, 16.0, 32.0])
SHAPE = (32, 32)
NODES = 100


def sizes_of(count, nodes=NODES):
    used, alone, full = between_cut_offs(np.array(count), SIZES, nodes, SHAPE)
    return SIZES[used].tolist(), SIZES[alone].tolist(), SIZES[full].tolist()


def test_sizes_of_lone_nodes_and_of_occupied_boxes_are_left_out():
    # At 2 cells two nodes share a box, as many as may; at 8 cells all 16 boxes are occupied.
    assert sizes_of([100, 98, 60, 16, 4, 1]) == ([4.0], [1.0, 2.0], [8.0, 16.0, 32.0])
    assert sizes_of([100, 97, 60, 15, 3, 1]) == ([1.0, 2.0, 4.0, 8.0, 16.0], [], [32.0])


def test_one_box_is_no_size():
    """All nodes of a small domain lie in one box, though others are empty."""
    assert sizes_of([100, 70, 20, 1, 1, 1]) == ([1.0, 2.0, 4.0], [], [32.0])


@pytest.mark.parametrize("nodes", [1, int((1 - SATURATED) * 32 * 32) + 1])
def test_a_single_node_and_a_filled_window_use_every_size(nodes):
    used, alone, full = sizes_of([nodes, 256, 64, 16, 4, 1], nodes)
    assert (used, alone, full) == (SIZES.tolist(), [], [])


def test_a_window_filled_less_is_cut_off():
    nodes = int((1 - SATURATED) * 32 * 32)
    used, _, full = sizes_of([nodes, 256, 64, 16, 4, 1], nodes)
    assert used == [1.0]
    assert full == [2.0, 4.0, 8.0, 16.0, 32.0]
