"""Contact at a lag along and across sliding."""

import numpy as np
import pytest

from fractalcontact.domain.isotropy import LAG_FIELDS, contact_at_lag

STRIPES = np.zeros((24, 30), bool)
STRIPES[::4] = True


def test_stripes_have_contact_along_and_none_across():
    found = contact_at_lag(STRIPES, "W")
    assert found.keys() == LAG_FIELDS.keys()
    assert (found["contact_at_lag_along"], found["contact_at_lag_across"]) == (1, 0)
    turned = contact_at_lag(STRIPES, "S")
    assert (turned["contact_at_lag_along"], turned["contact_at_lag_across"]) == (0, 1)


def test_pairs_are_counted_as_by_hand():
    domain = np.random.default_rng(0).random((9, 12)) < 0.4
    both = either = 0
    for y in range(9):
        for x in range(12):
            for other in (x - 2, x + 2):
                if domain[y, x] and 0 <= other < 12:
                    either += 1
                    both += domain[y, other]
    assert contact_at_lag(domain, "E")["contact_at_lag_along"] == pytest.approx(both / either)


def test_random_nodes_have_the_fraction_in_contact_within_their_interval():
    inside = 0
    for seed in range(40):
        domain = np.random.default_rng(seed).random((80, 80)) < 0.2
        found = contact_at_lag(domain, "E")
        low, high = (found[f"contact_at_lag_along_{end}"] for end in ("low", "high"))
        inside += low <= 0.2 <= high
        assert low <= found["contact_at_lag_along"] <= high
    assert inside >= 34


def test_turning_the_domain_swaps_the_directions():
    domain = np.random.default_rng(1).random((40, 40)) < 0.1
    first, turned = contact_at_lag(domain, "E"), contact_at_lag(domain.T, "N")
    assert first == pytest.approx(turned)


def test_no_contact_has_no_probability():
    assert np.isnan(list(contact_at_lag(np.zeros((8, 8), bool), "E").values())).all()
