"""Richardson's extrapolation: exact where it should be, honest where it cannot be."""

import numpy as np
import pytest
from ensembles import ensemble

from contactlab.accuracy.convergence import richardson_trials
from contactlab.accuracy.richardson import richardson


@pytest.mark.parametrize("order", [1, 1.5, 2, 4])
def test_exact_for_an_error_of_its_order(order):
    spacing = np.array([0.1, 0.2, 0.4])
    found = richardson(3.0 - 0.7 * spacing**order, order)
    assert found.value == pytest.approx(3.0, abs=1e-12)
    assert found.error == pytest.approx(0.7 * (0.2**order - 0.1**order))


def test_a_constant_has_no_error():
    assert richardson([2.0, 2.0, 2.0], 2) == (2.0, 0.0)


def test_a_wrong_order_stays_within_the_bar():
    spacing = np.array([0.1, 0.2, 0.4])
    found = richardson(1 + spacing, 2)
    assert abs(found.value - 1) <= found.error


def test_nine_of_ten_cases_are_within_their_bar():
    cases = ensemble("extrapolations")
    trials = richardson_trials(cases, (16, 24), seed=5)
    assert (trials["within"] >= 0.9 * cases).all()
    assert (trials["error"] <= trials["bar"]).sum("case").values.tolist() == (
        trials["within"].values.tolist()
    )
