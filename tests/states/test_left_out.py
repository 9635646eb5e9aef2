import numpy as np
import xarray as xr

from fractalcontact.states.left_out import (
    PARTS_LEFT_OUT,
    fractions_left,
    left_of_fields,
    part_ends,
)


def left_of(*domains):
    """Fractions left of domains at resolutions 1, 2, 4 ..., (resolution, part)."""
    ends = part_ends(domains[0], 1)
    return np.array([fractions_left(domain, 2**k, ends) for k, domain in enumerate(domains)])


def test_parts_hold_equally_many_nodes_wherever_contact_gathers():
    domain = np.zeros((60, 100), bool)
    domain[7:23, 50:70] = True  # 320 nodes
    # Nodes on the edge of contact stand for less than a cell.
    np.testing.assert_allclose(left_of(domain)[0], 1 - 1 / PARTS_LEFT_OUT, atol=0.01)


def test_parts_are_compact():
    domain = np.ones((64, 64), bool)
    ends = part_ends(domain, 1)
    for corner in ((0, 0), (0, 56), (56, 56)):
        part = np.zeros_like(domain)
        part[corner[0] : corner[0] + 8, corner[1] : corner[1] + 8] = True
        assert np.count_nonzero(fractions_left(part, 1, ends) < 1) == 1


def test_hills_that_all_resolutions_share_are_left_out_of_all():
    # Squares of different numbers of nodes, whole cells of the coarsest resolution.
    hills = np.random.default_rng(0).permutation(64).reshape(8, 8) < 24
    domain = np.kron(hills, np.ones((8, 8), bool))
    left = left_of(*(domain[::k, ::k] for k in (1, 2, 4)))
    np.testing.assert_allclose(left, np.broadcast_to(left[0], left.shape), atol=0.02)
    np.testing.assert_allclose(left.sum(axis=1), PARTS_LEFT_OUT - 1)


def test_a_resolution_that_is_no_power_of_two_sees_the_same_ground():
    domain = np.zeros((60, 60), bool)
    domain[:30] = True
    ends = part_ends(domain, 1)
    np.testing.assert_allclose(fractions_left(domain[::3, ::3], 3, ends), 1 - 1 / 32, atol=0.02)


def test_nodes_that_touch_independently_vary_as_poisson_has_it():
    rng = np.random.default_rng(0)
    variance = []
    for _ in range(40):
        left = left_of(rng.random((128, 128)) < 0.1, rng.random((64, 64)) < 0.1)
        ratio = np.log(left[0] / left[1])
        variance.append((ratio.size - 1) * ratio.var())
    # A tenth of the cells of both grids, less the variance of parts that are as large.
    np.testing.assert_allclose(np.mean(variance), 1 / 1638 + 1 / 410, rtol=0.15)


def test_nothing_in_contact_leaves_nothing():
    empty = np.zeros((16, 16), bool)
    assert np.isnan(left_of(empty, empty[::2, ::2])).all()


def test_fields_of_a_specimen_are_taken_state_by_state():
    rng = np.random.default_rng(0)
    fine, coarse = rng.random((2, 1, 3, 32, 40)) < 0.3, rng.random((2, 1, 3, 16, 20)) < 0.3
    dims = ("direction", "offset", "normal_force")
    table = {"in_contact_1": ((*dims, "y_1", "x_1"), fine)}
    table["in_contact_2"] = ((*dims, "y_2", "x_2"), coarse)
    coords = {"direction": ["E", "W"], "offset": [0.1], "normal_force": [1.0, 2.0, 3.0]}
    left = left_of_fields(xr.Dataset(table, coords))
    of_one = left.sel(direction="W", offset=0.1, normal_force=2.0)
    np.testing.assert_array_equal(of_one, left_of(fine[1, 0, 1], coarse[1, 0, 1]))
