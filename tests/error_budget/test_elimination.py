"""Elimination alone, on topographies where it is right and where it is wrong."""

from dataclasses import replace

import numpy as np
import pytest
import tiny_pairs
import xarray as xr
from rough_surfaces import self_affine

from contactlab.accuracy.elimination import counter_example
from fractalcontact.error_budget.elimination import _eliminated, elimination_alone
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace


@pytest.mark.parametrize("fraction", [0.1, 0.6])
def test_elimination_ends_on_the_contact_of_a_rough_face(fraction):
    space = HalfSpace((16, 16), 0.1, 1e4)
    heights = self_affine((16, 16), 0.1, 0.8, rms=0.02, seed=1)
    clearance = heights.max() - heights
    closure = float(np.quantile(clearance, fraction))
    steps, nodes, wrong = _eliminated(clearance, space, closure)
    state = solve_contact(heights, space, closure=closure, rtol=1e-8)
    assert (nodes, wrong) == (np.count_nonzero(state.in_contact), 0)
    assert steps > 1


def test_elimination_drops_a_node_in_contact_where_the_inverse_has_a_positive_entry():
    space = HalfSpace((12, 12), 1.0, 1.0, kernel="rigid square")
    heights = counter_example(space)
    *_, wrong = _eliminated(1.0 - heights, space, 1.0)
    assert wrong > 0


def test_the_set_of_a_mirrored_joint_is_that_of_its_window_alone():
    joint = tiny_pairs.loading_of(tiny_pairs.pair())
    free, mirrored = (
        elimination_alone(replace(joint, settings=replace(joint.settings, boundary=boundary)))
        for boundary in ("free", "mirrored")
    )
    xr.testing.assert_identical(free, mirrored)
    assert (free["elimination_steps"] > 1).any()


def test_flush_faces_have_no_answer():
    assert np.isnan(_eliminated(np.zeros((8, 8)), HalfSpace((8, 8), 0.1, 1e4), 0.0)).all()
