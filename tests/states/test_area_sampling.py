"""Sampling error of the contact area under a given force: limits, and coverage."""

import numpy as np
import pytest

from fractalcontact import HalfSpace, solve_contact
from fractalcontact.states.area_sampling import area_sampling, state_area_sampling
from fractalcontact.surface.synthesis import self_affine


def separate(sizes, pressures):
    """Square contacts in rows of their own: domain, and pressure of each on its nodes."""
    domain, pressure = np.zeros((2, 4 * len(sizes) + 1, 5))
    for i, (size, p) in enumerate(zip(sizes, pressures, strict=True)):
        place = np.s_[4 * i + 1 : 4 * i + 1 + size, 1 : 1 + size]
        domain[place], pressure[place] = 1, p
    return domain.astype(bool), pressure


def test_three_contacts_by_hand():
    # A node alone keeps the same part of its cell at each: areas of 1/3, forces 1/6, 1/3 and 1/2.
    found = area_sampling(*separate([1, 1, 1], [1.0, 2.0, 3.0]))
    t = 4.3026527  # of two degrees of freedom
    assert found == pytest.approx(t * np.sqrt(3 / 2 * 2 / 36))


def test_contacts_of_one_pressure_leave_none():
    assert area_sampling(*separate([2, 2, 2], [7.0, 7.0, 7.0])) == pytest.approx(0, abs=1e-12)


def test_no_separate_contacts_have_no_error():
    domain, pressure = separate([3, 2], [1.0, 2.0])
    assert np.isnan(area_sampling(domain, pressure))
    assert np.isnan(area_sampling(np.zeros((4, 4), bool), np.zeros((4, 4))))
    assert area_sampling(np.ones((4, 4), bool), np.ones((4, 4))) == 0
    most = np.ones((9, 9), bool)
    most[1:, 1] = most[1, 1:] = False
    assert np.isnan(area_sampling(most, most))


def test_it_depends_on_neither_unit_nor_orientation():
    rng = np.random.default_rng(0)
    domain, pressure = separate(rng.integers(1, 4, 9), rng.exponential(1.0, 9))
    found = area_sampling(domain, pressure)
    assert area_sampling(domain, 1e3 * pressure) == pytest.approx(found)
    assert area_sampling(domain.T[::-1], pressure.T[::-1]) == pytest.approx(found)


@pytest.mark.parametrize("contacts", [12, 100])
def test_it_holds_the_mean_pressure_of_the_population(contacts):
    # Independent single nodes: F / A is a mean of pressures, whose population mean is 1.
    rng, inside = np.random.default_rng(1), []
    for _ in range(600):
        pressures = rng.gamma(4.0, 0.25, contacts)
        found = area_sampling(*separate(np.ones(contacts, int), pressures))
        inside.append(abs(np.log(pressures.mean())) <= found)
    assert 0.92 <= np.mean(inside) <= 0.98


def test_yielding_contacts_have_the_area_of_their_force():
    heights = self_affine((64, 64), 0.1, 0.8, rms=0.2, seed=1, roll_off=1.6)
    space = HalfSpace(heights.shape, (0.1, 0.1), 1e4)
    elastic = solve_contact(heights, space, force=1000.0, rtol=1e-4)
    capped = solve_contact(heights, space, force=1000.0, rtol=1e-4, hardness=100.0)
    assert 0.05 < state_area_sampling(elastic) < 1
    assert state_area_sampling(capped) == 0
