"""The elastic operator: exact displacements, direct summation, properties."""

import numpy as np
import pytest

from roughcontact.elastic.convolution import THREADED_CELLS
from roughcontact.elastic.halfspace import (
    RIGID_PLATE_SELF_TERMS,
    HalfSpace,
    rectangle_mean_displacement,
)
from roughcontact.elastic.influence import influence_table, love_displacement

# shape, (dy, dx): square, odd, prime, strips, not square cells, one row, one node
GRIDS = [
    ((16, 16), (0.1, 0.1)),
    ((17, 13), (0.1, 0.1)),
    ((31, 7), (2.0, 0.5)),
    ((5, 40), (1e-3, 3e-3)),
    ((1, 23), (1.0, 1.5)),
    ((1, 1), (0.3, 0.7)),
]


@pytest.mark.parametrize("sides", [(2.0, 0.5), (0.5, 2.0)])
@pytest.mark.parametrize("shape", [(3, 300), (300, 3)])
def test_the_influence_is_loves_near_and_far_of_stretched_cells(sides, shape):
    dy, dx = sides
    y, x = (np.arange(n) * d for n, d in zip(shape, sides, strict=True))
    exact = love_displacement(x, y[:, np.newaxis], dx, dy)
    np.testing.assert_allclose(influence_table(shape, sides, None), exact, rtol=1e-11)


def love_by_logarithms(x, y, dx, dy):
    """E* u / p as K. L. Johnson prints it (Contact Mechanics, eq. 3.25), for x, y >= 0."""
    a, b = dx / 2, dy / 2

    def ratio(p, q, r, s, t, u):
        return np.log((p + np.hypot(p, q)) / (r + np.hypot(s, t))) * u

    return (
        ratio(y + b, x + a, y - b, y - b, x + a, x + a)
        + ratio(x + a, y + b, x - a, y + b, x - a, y + b)
        + ratio(y - b, x - a, y + b, y + b, x - a, x - a)
        + ratio(x - a, y - b, x + a, y - b, x + a, y - b)
    ) / np.pi


def directly_summed(pressure, spacing, modulus):
    """Displacement by summing Love's field of every cell at every cell, in mm."""
    dy, dx = spacing
    y, x = (index.ravel() for index in np.indices(pressure.shape))
    matrix = love_by_logarithms(np.abs(x[:, None] - x) * dx, np.abs(y[:, None] - y) * dy, dx, dy)
    return (matrix @ pressure.ravel()).reshape(pressure.shape) / modulus


# Exact results


def test_centre_of_a_uniformly_loaded_square():
    # 4 ln(1 + sqrt 2) / pi: the factor 1.122 of Love's kernel on the diagonal.
    exact = 4 * np.log(1 + np.sqrt(2)) / np.pi
    assert love_displacement(0.0, 0.0, 2.0, 2.0) == pytest.approx(2 * exact, rel=1e-14)
    assert HalfSpace((3, 3), (0.2, 0.2), 1.0).influence()[0, 0] == pytest.approx(1.122, abs=3e-4)


def test_corner_of_a_uniformly_loaded_square_sinks_half_as_far_as_its_centre():
    corner = love_displacement(0.5, 0.5, 1.0, 1.0)
    assert corner == pytest.approx(love_displacement(0.0, 0.0, 1.0, 1.0) / 2, rel=1e-14)


def test_mean_settlement_of_a_square_has_its_closed_form():
    exact = (4 * np.log(1 + np.sqrt(2)) - 4 / 3 * (np.sqrt(2) - 1)) / np.pi
    assert rectangle_mean_displacement(3.0, 3.0) == pytest.approx(3 * exact, rel=1e-13)
    # The closed form is 0.9464020; the last digit of the often quoted 0.946403 is not its own.
    assert exact == pytest.approx(0.9464020, abs=5e-8)


@pytest.mark.parametrize("sides", [(1.0, 1.0), (2.0, 1.0), (1.0, 2.0)])
def test_discrete_mean_settlement_reaches_the_exact_one(sides):
    ny, nx = 256, 256
    space = HalfSpace((ny, nx), (sides[0] / ny, sides[1] / nx), 1.0)
    mean = space.displacement(np.ones((ny, nx))).mean()
    assert mean == pytest.approx(rectangle_mean_displacement(*sides), rel=1e-4)


@pytest.mark.parametrize("kernel", ["love", *RIGID_PLATE_SELF_TERMS])
def test_far_field_is_that_of_a_point_load(kernel):
    spacing, modulus, pressure = 0.25, 30e3, 7.0
    space = HalfSpace((61, 61), (spacing, spacing), modulus, kernel=kernel)
    load = np.zeros(space.shape)
    load[0, 0] = pressure
    y, x = np.indices(space.shape) * spacing
    distance = np.hypot(x, y)
    far = distance > 30 * spacing
    point_load = pressure * spacing**2 / (np.pi * modulus * distance[far])
    np.testing.assert_allclose(space.displacement(load)[far], point_load, rtol=1e-3)


def test_love_exceeds_a_point_load_by_little_already_at_one_spacing():
    influence = HalfSpace((1, 3), (1.0, 1.0), 1.0).influence()[0, 1:]
    excess = influence * np.pi * np.array([1, 2]) - 1
    np.testing.assert_allclose(excess, [0.03805, 0.01018], atol=1e-5)


def test_rigid_plate_self_terms():
    for kernel, self_term in RIGID_PLATE_SELF_TERMS.items():
        influence = HalfSpace((2, 2), (0.5, 0.5), 1.0, kernel=kernel).influence()
        assert influence[0, 0] == self_term
        assert influence[0, 1] == pytest.approx(1 / np.pi, rel=1e-14)


# Independent method


@pytest.mark.parametrize(("shape", "spacing"), GRIDS)
def test_operator_is_the_direct_summation_of_love(shape, spacing):
    pressure = np.random.default_rng(0).standard_normal(shape)
    space = HalfSpace(shape, spacing, 123.0)
    expected = directly_summed(pressure, spacing, 123.0)
    error = np.abs(space.displacement(pressure) - expected).max()
    assert error <= 1e-12 * np.abs(expected).max()


# Properties


@pytest.mark.parametrize("kernel", ["love", *RIGID_PLATE_SELF_TERMS])
@pytest.mark.parametrize("shape", [(16, 16), (17, 13), (3, 64)])
def test_reciprocity_and_positive_energy(shape, kernel):
    generator = np.random.default_rng(1)
    space = HalfSpace(shape, (0.1, 0.1), 1.0, kernel=kernel)
    checker = (-1.0) ** np.indices(shape).sum(axis=0)
    assert np.vdot(checker, space.convolve(checker)) > 0
    for _ in range(5):
        p1, p2 = generator.standard_normal((2, *shape))
        there, back = np.vdot(p1, space.convolve(p2)), np.vdot(p2, space.convolve(p1))
        scale = np.linalg.norm(p1) * np.linalg.norm(space.convolve(p2))
        assert abs(there - back) <= 1e-13 * scale
        assert np.vdot(p1, space.convolve(p1)) > 0


@pytest.mark.parametrize("kernel", ["love", *RIGID_PLATE_SELF_TERMS])
def test_operator_is_positive_definite(kernel):
    space = HalfSpace((9, 7), (1.0, 1.0), 1.0, kernel=kernel)
    columns = [space.convolve(unit.reshape(9, 7)).ravel() for unit in np.eye(63)]
    assert np.linalg.eigvalsh(np.array(columns)).min() > 0.1


@pytest.mark.parametrize("shape", [(48, 40), (33, 70), (1, 90)])
def test_coarser_cells_are_the_same_half_space(shape):
    space = HalfSpace(shape, (0.1, 0.3), 5.0)
    coarse = space.coarser(4)
    alone = HalfSpace(coarse.shape, (0.4, 1.2), 5.0)
    assert coarse.shape == tuple(-(-n // 4) for n in shape)
    assert coarse.spacing == pytest.approx(alone.spacing, rel=1e-15)
    np.testing.assert_allclose(coarse.influence(), alone.influence(), rtol=1e-12)


def test_stacked_fields_are_displaced_one_by_one():
    space = HalfSpace((20, 31), (0.1, 0.3), 1.0)
    fields = np.random.default_rng(5).standard_normal((3, 20, 31)).astype(np.float32)
    together = space.convolve(fields)
    for field, image in zip(fields, together, strict=True):
        np.testing.assert_allclose(image, space.convolve(field), atol=1e-5)


def test_bits_do_not_depend_on_the_number_of_threads(monkeypatch):
    values = np.random.default_rng(6).standard_normal((400, 600))
    assert values.size > THREADED_CELLS
    images = []
    for count in ("1", "2", "5"):
        monkeypatch.setenv("OMP_NUM_THREADS", count)
        images.append(HalfSpace((400, 600), (1.0, 1.0), 1.0).convolve(values))
    np.testing.assert_array_equal(images[0], images[1])
    np.testing.assert_array_equal(images[0], images[2])


def test_loads_on_opposite_edges_do_not_feel_each_other_round_the_back():
    space = HalfSpace((1, 50), (1.0, 1.0), 1.0)
    load = np.zeros((1, 50))
    load[0, 0] = 1.0
    displacement = space.displacement(load)[0]
    assert (np.diff(displacement) < 0).all()


@pytest.mark.parametrize(("shape", "spacing"), GRIDS)
def test_single_precision_follows_double(shape, spacing):
    values = np.random.default_rng(3).standard_normal(shape)
    space = HalfSpace(shape, spacing, 1.0)
    double, single = space.convolve(values), space.convolve(values.astype(np.float32))
    assert single.dtype == np.float32
    assert np.abs(single - double).max() <= 1e-5 * np.abs(double).max()


def test_displacement_scales_with_units_and_modulus():
    pressure = np.random.default_rng(4).random((12, 10))
    in_mm = HalfSpace((12, 10), (0.1, 0.2), 20e3).displacement(pressure)
    in_um = HalfSpace((12, 10), (100.0, 200.0), 20e3).displacement(pressure)
    np.testing.assert_allclose(in_um, 1e3 * in_mm, rtol=1e-12)
    stiffer = HalfSpace((12, 10), (0.1, 0.2), 40e3).displacement(pressure)
    np.testing.assert_allclose(stiffer, in_mm / 2, rtol=1e-12)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((0, 4), (1.0, 1.0), 1.0), "shape"),
        (((4, 4), (0.0, 1.0), 1.0), "spacing"),
        (((4, 4), (1.0, np.nan), 1.0), "spacing"),
        (((4, 4), (1.0, 1.0), -1.0), "modulus"),
        (((4, 4), (1.0, 1.0), np.inf), "modulus"),
    ],
)
def test_senseless_grids_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        HalfSpace(*arguments)


def test_unknown_kernel_is_refused_and_the_known_ones_named():
    with pytest.raises(ValueError, match=r"love.*rigid square"):
        HalfSpace((4, 4), (1.0, 1.0), 1.0, kernel="hertz")


def test_rigid_plates_are_refused_on_cells_that_are_not_square():
    with pytest.raises(ValueError, match="square cells"):
        HalfSpace((4, 4), (1.0, 1.1), 1.0, kernel="rigid square")


def test_a_coarser_half_space_makes_single_precision_alone_to_the_same_bit():
    fine = HalfSpace((64, 90), (0.1, 0.1), 1.0)
    coarse = fine.coarser(2)
    field = np.random.default_rng(0).random(coarse.shape).astype(np.float32)
    found = coarse.convolve(field)
    assert "_convolutions" not in vars(coarse)
    both = HalfSpace(coarse.shape, coarse.spacing, 1.0)
    np.testing.assert_array_equal(found, both.convolve(field))
    double = coarse.convolve(field.astype(float))
    np.testing.assert_array_equal(double, both.convolve(field.astype(float)))
    np.testing.assert_array_equal(found, coarse.convolve(field))
