"""Transmissivity by the local cubic law: exact solutions, bounds, symmetries, hard geometries."""

import pickle

import numpy as np
import pytest
from ensembles import ensemble
from flow_bounds import face_values, transmissivity_bounds
from scipy import ndimage, sparse

from fractalcontact.flow import network, red_black
from fractalcontact.flow.cubic_law import plane_flow, radial_flow
from fractalcontact.flow.network import (
    AIMED_IMBALANCE,
    FlowNotConverged,
    critical_gap,
    joined_cells,
)


@pytest.fixture(params=["CHOLMOD", "SuperLU"])
def library(request, monkeypatch):
    """Either library that solves the equations."""
    if request.param == "SuperLU":
        monkeypatch.setattr(red_black, "cvxopt", None)
    elif red_black.cvxopt is None:
        pytest.skip("no cvxopt")


def contact_field(seed, shape=(24, 30), smooth=2.0, level=0.35):
    """Filtered noise, 0 where it is below a level: gaps between contacts."""
    noise = np.random.default_rng(seed).normal(size=shape)
    heights = ndimage.gaussian_filter(noise, smooth, mode="wrap")
    return np.clip(heights / heights.std() + level, 0, None)


def by_dense_equations(gap, spacing, faces="mean"):
    """Transmissivity along x by equations written cell by cell, solved densely."""
    if faces == "mean":
        return np.mean([by_dense_equations(gap, spacing, one) for one in ("harmonic", "linear")])
    (ny, nx), (dy, dx) = gap.shape, spacing
    k = gap**3 / 12
    matrix, right = np.zeros((gap.size, gap.size)), np.zeros(gap.size)
    for row in range(ny):
        for column in range(nx):
            cell = row * nx + column
            for i, j, ratio in (
                (row, column + 1, dy / dx),
                (row, column - 1, dy / dx),
                (row + 1, column, dx / dy),
                (row - 1, column, dx / dy),
            ):
                if not 0 <= i < ny:
                    continue
                if not 0 <= j < nx:
                    matrix[cell, cell] += 2 * ratio * k[row, column]
                    right[cell] += 2 * ratio * k[row, column] * (j < 0)
                elif k[row, column] * k[i, j] > 0:
                    face = ratio * face_values(gap[row, column], gap[i, j], faces) / 12
                    matrix[cell, cell] += face
                    matrix[cell, i * nx + j] -= face
    pressure = np.linalg.lstsq(matrix, right, rcond=None)[0].reshape(ny, nx)
    return (2 * dy / dx * k[:, -1] * pressure[:, -1]).sum() * nx * dx / (ny * dy)


# -- exact solutions -------------------------------------------------------------------------------


@pytest.mark.usefixtures("library")
@pytest.mark.parametrize("axis", "xy")
def test_parallel_plates_have_their_own_gap_as_hydraulic_aperture(axis):
    flow = plane_flow(np.full((7, 9), 0.2), (0.1, 0.3), axis)
    assert flow.hydraulic_aperture == pytest.approx(0.2, rel=1e-12)
    assert flow.critical_gap == 0.2
    np.testing.assert_allclose(flow.flux, 1.0, rtol=1e-12)


def sinusoidal(n, periods):
    return np.tile(1 + 0.5 * np.sin(2 * np.pi * periods * (np.arange(n) + 0.5) / n), (4, 1))


def test_a_sinusoidal_channel_is_series_across_its_waves_and_parallel_along_them():
    gap = sinusoidal(64, 1)
    series = (1 - 0.5**2) ** 2.5 / (1 + 0.5**2 / 2)  # 1 / mean(g^-3)
    parallel = 1 + 1.5 * 0.5**2  # mean(g^3)
    harmonic, flow = (plane_flow(gap, (1, 1), faces=faces) for faces in ("harmonic", "mean"))
    assert 12 * harmonic.transmissivity == pytest.approx(series, rel=1e-6)
    # A whole wave leaves harmonic means exact, so that half the difference is the whole error.
    error = flow.transmissivity - series / 12
    assert error == pytest.approx(flow.face_difference / 2, rel=1e-3)
    assert error < 1e-3 * flow.transmissivity
    assert 12 * plane_flow(gap, (1, 1), "y").transmissivity == pytest.approx(parallel, rel=1e-6)


@pytest.mark.parametrize("faces", ["harmonic", "linear", "mean"])
def test_the_error_of_part_of_a_wave_falls_by_four_where_the_spacing_halves(faces):
    exact = 1 / np.mean(sinusoidal(2**20, 0.7)[0] ** -3.0)
    errors = [
        12 * plane_flow(sinusoidal(n, 0.7), (1, 1), faces=faces).transmissivity - exact
        for n in (32, 64, 128)
    ]
    orders = np.log2(np.abs(errors[:-1]) / np.abs(errors[1:]))
    np.testing.assert_allclose(orders, 2, atol=0.05)


def test_a_symmetric_log_normal_field_has_the_geometric_mean():
    # Duality in two dimensions (Matheron 1967): k and 1/k alike make T the geometric mean of k.
    logs = []
    for seed in range(50):
        noise = np.random.default_rng(seed).normal(size=(64, 64))
        smooth = ndimage.gaussian_filter(noise, 3, mode="wrap")
        cubed = np.exp(smooth / smooth.std())
        both = [12 * plane_flow(np.cbrt(k), (1, 1)).transmissivity for k in (cubed, 1 / cubed)]
        logs.append(np.log(both).mean())
    half = 2.01 * np.std(logs, ddof=1) / np.sqrt(len(logs))
    assert abs(np.mean(logs)) < half < 0.02


def test_radial_flow_between_parallel_discs_follows_the_logarithm_of_the_radii():
    errors = [
        radial_flow(np.full((n, n), 0.1), (2 / n, 2 / n), 0.2, 0.95).transmissivity * 12e3 - 1
        for n in (64, 128, 256)
    ]
    assert np.abs(errors[-1]) < 1e-4
    assert np.all(np.abs(errors[1:]) < 0.4 * np.abs(errors[:-1]))


def test_radial_flow_takes_oblong_cells():
    flow = radial_flow(np.full((256, 128), 0.1), (2 / 256, 2 / 128), 0.2, 0.95)
    assert 12e3 * flow.transmissivity == pytest.approx(1, rel=2e-3)


# -- an independent solution, bounds and symmetries ------------------------------------------------


@pytest.mark.usefixtures("library")
def test_random_fields_with_contact_agree_with_dense_equations():
    for seed in range(ensemble("fields solved densely")):
        gap = contact_field(seed, (14, 17), level=0.8)
        faces = ("harmonic", "linear", "mean")[seed % 3]
        expected = by_dense_equations(gap, (0.3, 0.2), faces)
        found = plane_flow(gap, (0.3, 0.2), faces=faces)
        assert found.transmissivity == pytest.approx(expected, rel=1e-8, abs=1e-13)
        lower, upper = transmissivity_bounds(gap, 1, faces)
        assert lower * (1 - 1e-12) <= found.transmissivity <= upper * (1 + 1e-12)
        assert found.imbalance <= AIMED_IMBALANCE


def test_mirrored_and_scaled_fields_have_mirrored_and_scaled_flows():
    gap = contact_field(3, level=1.0)
    flow = plane_flow(gap, (0.3, 0.2))
    for mirrored in (gap[::-1], gap[:, ::-1]):
        assert plane_flow(mirrored, (0.3, 0.2)).transmissivity == pytest.approx(flow.transmissivity)
    twice = plane_flow(2 * gap, (0.6, 0.4))
    assert twice.transmissivity == pytest.approx(8 * flow.transmissivity, rel=1e-10)
    assert twice.channel_fraction == pytest.approx(flow.channel_fraction)


def test_the_mean_flux_of_every_section_is_that_of_the_window():
    flow = plane_flow(sinusoidal(64, 1).T, (1, 1))
    np.testing.assert_allclose(flow.flux.mean(axis=0), 1.0, rtol=1e-10)


def test_with_x_for_y_the_flux_is_the_same_in_each_cell():
    gap = contact_field(5, (20, 26), level=1.0)
    along_x, along_y = plane_flow(gap, (0.3, 0.2)), plane_flow(gap.T, (0.2, 0.3), "y")
    assert along_y.transmissivity == pytest.approx(along_x.transmissivity, rel=1e-9)
    np.testing.assert_allclose(along_y.flux, along_x.flux.T, rtol=1e-6, atol=1e-9)


def test_the_channel_fraction_counts_the_cells_that_carry_nine_tenths():
    # Three alike channels of seven cells: 18.9 cells carry nine tenths, so 19 of 70 do.
    gap = np.zeros((10, 7))
    gap[[1, 4, 8]] = 0.2
    assert plane_flow(gap, (1, 1)).channel_fraction == pytest.approx(19 / 70)


# -- hard geometries -------------------------------------------------------------------------------


def test_all_contact_and_a_wall_let_nothing_pass():
    for gap in (np.zeros((5, 6)), np.where(np.arange(6) == 3, 0.0, np.ones((5, 6)))):
        flow = plane_flow(gap, (1, 1))
        assert flow.transmissivity == flow.hydraulic_aperture == flow.critical_gap == 0
        assert np.isnan(flow.channel_fraction)
    assert plane_flow(gap, (1, 1), "y").transmissivity > 0


def test_a_bridge_of_one_cell_carries_the_flow_of_the_bridge():
    gap = np.ones((41, 41))
    gap[:, 20] = 0
    gap[17, 20] = 1e-2
    flow = plane_flow(gap, (1, 1), faces="harmonic")
    assert flow.critical_gap == 1e-2
    # Both halves are wide open: the pressure falls within the bridge.
    assert 12 * flow.transmissivity == pytest.approx(1e-6, rel=1e-4)
    # One cell does not say how the bridge widens: linear apertures let a hundred times more pass.
    both = plane_flow(gap, (1, 1))
    assert not both.resolved
    assert "does not resolve" in both.reason


@pytest.mark.usefixtures("library")
def test_gaps_a_million_times_narrower_are_solved():
    gap = np.ones((9, 12))
    gap[:, 6] = 1e-6
    flow = plane_flow(gap, (1, 1), faces="harmonic")
    assert 12 * flow.transmissivity == pytest.approx(12e-18, rel=1e-9)
    # Two faces beside the narrow cells, of g^2 to the first order.
    linear = plane_flow(gap, (1, 1), faces="linear")
    assert 12 * linear.transmissivity == pytest.approx(12e-12, rel=1e-5)


def test_corners_let_nothing_pass():
    assert plane_flow(np.eye(6), (1, 1)).transmissivity == 0


def test_masked_cells_are_walls():
    gap = np.full((30, 40), 0.5)
    rows = np.arange(30)[:, np.newaxis]
    masked = np.where((rows < 10) | (rows >= 20), np.nan, gap)
    assert plane_flow(masked, (1, 1)).transmissivity == pytest.approx(0.5**3 / 12 / 3)


@pytest.mark.parametrize("shape", [(1, 1), (1, 6), (6, 1), (2, 3)])
def test_windows_of_few_cells_are_solved_whichever_cells_are_eliminated(shape):
    gap = np.full(shape, 0.3)
    assert plane_flow(gap, (1, 2)).hydraulic_aperture == pytest.approx(0.3)
    gap[np.add.outer(*map(np.arange, shape)) % 2 == 0] = 0
    # A window as long as a cell: each open cell joins both ends.
    through = 0.3**3 / 2 if shape == (6, 1) else 0
    assert 12 * plane_flow(gap, (1, 2)).transmissivity == pytest.approx(through)


def slit(n, narrow):
    """Row of n open cells, and beside it one with a narrow cell in its middle; T of both along x.

    T by harmonic means and by linear apertures: cells of one row are in series, rows are parallel.
    """
    gap = np.ones((3, n))
    gap[1], gap[2, n // 2] = 0, narrow
    ends = {"harmonic": 1 / 2 + narrow**-3 / 2, "linear": (1 + narrow) / (2 * narrow**2)}
    return gap, {faces: (1 + n / (n - 2 + 2 * end)) / 36 for faces, end in ends.items()}


def serpentine(n, wall):
    """Channel one cell wide that turns n // 2 times, with walls of a gap between its reaches."""
    gap = np.ones((n, n))
    gap[:-1, 1::4] = gap[1:, 3::4] = wall
    return gap


@pytest.mark.parametrize("narrow", [9e-4, 4e-5, 1e-5])
def test_a_slit_beside_a_channel_adds_what_it_carries(narrow):
    gap, exact = slit(400, narrow)
    for faces, expected in exact.items():
        flow = plane_flow(gap, (1, 1), faces=faces)
        assert abs(flow.transmissivity / expected - 1) <= flow.imbalance + 1e-15
        assert flow.imbalance < 1e-6
    harmonic = plane_flow(gap, (1, 1), faces="harmonic")
    assert harmonic.transmissivity == pytest.approx(exact["harmonic"], rel=1e-12)


def test_the_walls_of_a_serpentine_leak_as_by_dense_equations():
    # Ten reaches of ten cells: walls of a thousandth already leak a part in ten million.
    gap = serpentine(21, 9e-4)
    for faces, expected in (("harmonic", 4e-7), ("linear", 4.4e-4)):
        closed = plane_flow(serpentine(21, 0.0), (1, 1), faces=faces).transmissivity
        leak = by_dense_equations(gap, (1, 1), faces) / closed - 1
        assert leak == pytest.approx(expected, rel=0.1)
        found = plane_flow(gap, (1, 1), faces=faces).transmissivity / closed - 1
        assert found == pytest.approx(leak, rel=1e-3)


def closed_below(fraction, gap, spacing, monkeypatch, faces="harmonic"):
    """Flow with gaps below a fraction of the critical gap closed, whatever error it states."""
    with monkeypatch.context() as stated:
        stated.setattr(network, "CLOSED_BELOW", fraction)
        stated.setattr(network, "MAX_IMBALANCE", np.inf)
        return plane_flow(gap, spacing, faces=faces)


@pytest.mark.parametrize(("faces", "decades"), [("harmonic", 2), ("linear", 1.3)])
def test_the_stated_error_bounds_what_closed_gaps_carry(faces, decades, monkeypatch):
    for seed in range(ensemble("fields solved densely")):
        # Widths of six or four decades: pools behind narrow gaps, and narrow gaps at both ends.
        noise = contact_field(seed, (14, 17), smooth=1.0, level=3.0)
        gap = np.where(noise > 2, 10 ** (decades * (noise - 3)), 0)
        of_gap = gap, (0.3, 0.2), monkeypatch, faces
        whole, part = (closed_below(one, *of_gap) for one in (0, 0.3))
        if whole.transmissivity:
            lost = whole.transmissivity / part.transmissivity - 1
            assert -whole.imbalance <= lost <= part.imbalance + whole.imbalance


@pytest.mark.parametrize(
    ("gap", "fraction", "faces", "loosest"),
    [
        (slit(40, 0.01)[0], 0.1, "harmonic", 1.01),
        # Both faces of the narrow cell share the drop that the bound puts on one of them.
        (slit(40, 0.01)[0], 0.1, "linear", 2.01),
        (serpentine(41, 2e-3), 1e-2, "harmonic", 4),
    ],
    ids=["slit", "slit, linear", "serpentine"],
)
def test_the_stated_error_is_near_what_closed_gaps_carry(
    gap, fraction, faces, loosest, monkeypatch
):
    whole, part = (closed_below(one, gap, (1, 1), monkeypatch, faces) for one in (0, fraction))
    lost = whole.transmissivity / part.transmissivity - 1
    assert lost <= part.imbalance <= loosest * lost


def test_flow_is_refused_where_closed_gaps_could_carry_too_much(monkeypatch):
    monkeypatch.setattr(network, "CLOSED_BELOW", 0.3)
    with pytest.raises(FlowNotConverged, match="narrow gaps") as refused:
        plane_flow(slit(40, 0.1)[0], (1, 1))
    assert refused.value.imbalance > network.MAX_IMBALANCE


@pytest.mark.full
def test_a_long_strip_is_solved():
    gap = 1 + 0.3 * contact_field(1, (16384, 64))
    flow = plane_flow(gap, (1, 1), "y")
    assert flow.imbalance < 1e-6
    lower, upper = transmissivity_bounds(gap, 0)
    assert lower < flow.transmissivity < upper


@pytest.mark.parametrize(
    "gap", [np.full((3, 3), np.nan), -np.ones((3, 3)), np.ones(3), np.full((3, 3), np.inf)]
)
def test_gaps_that_are_none_are_refused(gap):
    with pytest.raises(ValueError, match="gap: expected"):
        plane_flow(gap, (1, 1))


@pytest.mark.parametrize(("hole", "rim"), [(0, 1), (1, 0.5), (0.1, 2)])
def test_radii_that_do_not_fit_are_refused(hole, rim):
    with pytest.raises(ValueError, match="expected 0 < hole < rim"):
        radial_flow(np.ones((10, 10)), (0.2, 0.2), hole, rim)


# -- the solver ------------------------------------------------------------------------------------


def test_a_wrong_solution_is_refused(monkeypatch):
    solve = red_black.RedBlackCells.solve
    monkeypatch.setattr(red_black.RedBlackCells, "solve", lambda *of: 1.7 * solve(*of))
    with pytest.raises(FlowNotConverged, match="flow not solved") as refused:
        plane_flow(np.ones((8, 8)), (1, 1))
    again = pickle.loads(pickle.dumps(refused.value))
    assert (again.reason, again.imbalance) == (refused.value.reason, refused.value.imbalance)


@pytest.mark.usefixtures("library")
def test_singular_equations_are_refused():
    lower = sparse.coo_array(np.tril([[1.0, -1.0], [-1.0, 1.0]]))
    try:
        found = red_black._factorised(lower)(np.ones(2))
    except ArithmeticError:
        return
    assert not np.isfinite(found).all() or np.abs(found).max() > 1e12


def test_the_critical_gap_is_the_largest_at_which_a_path_joins_both_ends():
    for seed in range(ensemble("fields solved densely")):
        rng = np.random.default_rng(seed)
        shape = tuple(rng.integers(2, 40, 2))
        gap = rng.random(shape) * (rng.random(shape) < rng.choice([0.55, 0.6, 0.65, 0.9]))
        ends = rng.random((2, *shape)) < 0.02
        ends[0, :, 0] = ends[1, :, -1] = True
        critical = critical_gap(gap, *ends)
        assert not joined_cells(gap > critical, *ends).any()
        assert joined_cells((gap >= critical) & (gap > 0), *ends).any() == (critical > 0)
