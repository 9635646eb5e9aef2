"""Seats: the lightest load that may seat a joint, and closures counted from it."""

import numpy as np

from fractalcontact.states.seat import closure_from, seat_of

LOADS = np.array([1.0, 2.0, 4.0])


def test_the_seat_is_the_lightest_load_from_the_stated_one_on():
    assert seat_of(LOADS, 0.0) == 1
    assert seat_of(LOADS, 1.5) == seat_of(LOADS, 2.0) == 2
    # The same pressure may come out a last bit lighter as a force over an area.
    assert seat_of(LOADS, np.nextafter(2.0, 3.0)) == 2
    assert np.isnan(seat_of(LOADS, 5.0))
    assert np.isnan(seat_of([], 0.0))


def test_no_load_seats_a_joint_whose_contact_is_not_decided_there():
    decided = np.array(
        [[[True, True, True], [False, False, True]], [[False] * 3, [True, False, True]]]
    )
    np.testing.assert_array_equal(seat_of(LOADS, 0.5, decided), [[1, 4], [np.nan, 1]])
    np.testing.assert_array_equal(seat_of(LOADS, 1.5, decided), [[2, 4], [np.nan, 4]])


def test_closure_counts_from_the_seat_that_is_given():
    closure = np.array([[0.1, 0.3, 0.6], [0.2, 0.2, 0.9]])
    np.testing.assert_allclose(closure_from(closure, LOADS, 2.0)[:, 1:], [[0, 0.3], [0, 0.7]])
    assert np.isnan(closure_from(closure, LOADS, 2.0)[:, 0]).all()
    for no_seat in (np.nan, 3.0):
        assert np.isnan(closure_from(closure, LOADS, no_seat)).all()


def test_closure_of_other_branches_counts_from_the_seat_on_loading():
    branches = np.array([[0.1, 0.3, 0.6], [0.4, 0.5, 0.6]])
    seated = closure_from(branches, LOADS, 2.0, on_loading=branches[0])
    np.testing.assert_allclose(seated[:, 1:], [[0, 0.3], [0.2, 0.3]])
