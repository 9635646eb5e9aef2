"""Contact states of several directions put together, on cells that are not square."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from made_settings import made_settings

from fractalcontact.core.settings import Solver
from fractalcontact.core.window import window_sides
from fractalcontact.joint.joint import (
    composite_topography,
    describe_joint,
    face_correlation,
    rigid_dilatancy,
)
from fractalcontact.laws.closure import closure_curves, elastic_dilatancy
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.state_scalars import NOT_WANTED, numbers_of, state_errors
from fractalcontact.states.states import (
    DIP,
    MAP_PRESSURE,
    OFFSETS,
    combine,
    contact_domains,
    map_states,
)
from fractalcontact.states.sweep import contact_states, joint_states, load_steps
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.corrected_area import contact_perimeter, corrected_area
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

SPACING_Y, SPACING_X = 0.12, 0.1
OFFSETS_ASKED = [0.44, 0.7]  # 4 and 7 cells along x, 4 and 6 along y: 0.48 and 0.72 mm
SETTINGS = made_settings(
    directions=["E", "N", "W", "S"],
    contact_directions=["W", "N", "E"],
    offsets=OFFSETS_ASKED,
    loads=[(20.0, "force"), (200.0, "force")],
    surface_range=None,
)
SOLVER = Solver(1e-6, "love", None)


@pytest.fixture(scope="module")
def specimen():
    heights = self_affine((48, 48), 0.1, 0.8, seed=3, rms=0.1)
    coords = {"y": np.arange(48) * SPACING_Y, "x": np.arange(48) * SPACING_X}
    attrs = {"spacing_y": SPACING_Y, "spacing_x": SPACING_X}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    return make_specimen(scan, window=2.4, name="oblong", multiple=2)


@pytest.fixture(scope="module")
def joint(specimen):
    return describe_joint(specimen, SETTINGS)


@pytest.fixture(scope="module")
def parts(specimen, joint):
    """One part a direction, offset and resolution, in the order of the study's directions."""
    return [
        contact_states(
            JointLoading(specimen, direction, cells[i : i + 1], SETTINGS, SOLVER), [resolution]
        )
        for direction in SETTINGS.contact_directions
        for cells in [joint["offset_cells"].sel(contact_direction=direction).values]
        for i in range(len(cells))
        for resolution in (1, 2)
    ]


def test_states_solved_lightly_lack_nothing_but_dips_and_coarse_stiffness(specimen, joint):
    direction = SETTINGS.contact_directions[0]
    cells = joint["offset_cells"].sel(contact_direction=direction).values[:2]
    loading = JointLoading(specimen, direction, cells, SETTINGS, SOLVER)
    full, light = (contact_states(loading, [1, 2], lightly=one) for one in (False, True))
    stiffness = [name for name in light if name.startswith("stiffness")]
    assert len(stiffness) == 4
    fine = full["resolution"] == 1
    numbers = [name for name in stiffness if name != "stiffness_reason"]
    xr.testing.assert_equal(light[numbers], full[numbers].where(fine))
    reasons = full["stiffness_reason"].where(fine, NOT_WANTED).where(full["solved"], "")
    xr.testing.assert_equal(light["stiffness_reason"], reasons)
    xr.testing.assert_identical(light.drop_vars(stiffness), full.drop_vars([*stiffness, DIP]))


def lone_node(space):
    """State of one node in contact, which may as well not touch; and its number."""
    heights = np.zeros(space.shape)
    heights[4, 3] = 1e-3
    return replace(solve_contact(heights, space, closure=1e-4), residual=1.0), (4, 3)


def lone_gap(space):
    """State of all nodes in contact but one, which may as well touch; and its number."""
    heights, closure = np.zeros(space.shape), 0.05
    heights[4, 3] = -1.0
    over_a_pit = solve_contact(heights, space, closure=closure)
    heights[4, 3] = 1.02 * (over_a_pit.displacement[4, 3] - closure)
    return replace(solve_contact(heights, space, closure=closure), residual=4e-3), (4, 3)


@pytest.mark.parametrize("made", [lone_node, lone_gap])
@pytest.mark.parametrize("spacing", [(SPACING_Y, SPACING_X), (SPACING_X, SPACING_Y)])
def test_errors_of_a_domain_are_those_of_an_undecided_node(made, spacing):
    space = HalfSpace((9, 7), spacing, 2e4)
    state, node = made(space)
    assert state.ambiguous == 1
    found, errors = numbers_of(state), state_errors(state)
    other = state.in_contact.copy()
    other[node] = not other[node]
    decided = {
        "nodes": np.count_nonzero(other),
        "area": np.count_nonzero(other) * space.cell_area,
        "perimeter": contact_perimeter(other, spacing),
        "area_corrected": corrected_area(other, spacing),
    }
    for name, value in decided.items():
        off = abs(found[name] - value)
        # No less; and no more than the three times that a corrected area may differ by.
        assert off * (1 - 1e-12) <= errors[f"{name}_error"] <= 3 * off, name


def test_rigid_offsets_are_the_nearest_cells_of_each_direction(specimen, joint):
    spacing = dict(zip("ENWS", (SPACING_X, SPACING_Y) * 2, strict=True))
    for direction in joint["direction"].values:
        cells = np.rint(joint["rigid_offset"].values / spacing[direction]).astype(int)
        found = joint.sel(direction=direction)
        opened, spread = rigid_dilatancy(specimen, direction, cells)
        np.testing.assert_allclose(found["rigid_dilatancy"], opened, rtol=1e-12)
        np.testing.assert_allclose(found["composite_rms"], spread, rtol=1e-9)
        correlation = face_correlation(specimen, direction, cells)
        np.testing.assert_allclose(found["face_correlation"], correlation, rtol=1e-9)


def test_directions_keep_the_order_of_the_study(parts, joint):
    states = combine(parts)
    assert states.direction.values.tolist() == SETTINGS.contact_directions
    np.testing.assert_allclose(states.offset, joint.offset)
    np.testing.assert_allclose(states.offset, [0.4, 0.7])
    made = states.offset_on_grid.sel(direction="N")
    np.testing.assert_allclose(made, [0.48, 0.72])
    np.testing.assert_allclose(states.offset_on_grid.sel(direction="W"), states.offset)


def test_parts_may_come_in_any_order_within_a_direction(parts):
    n = len(parts) // 3
    mixed = [part for i in range(3) for part in reversed(parts[i * n : (i + 1) * n])]
    xr.testing.assert_identical(combine(mixed), combine(parts))


def of_jobs(specimen, joint, directions, offsets, resolutions):
    """What jobs write that each take some of them; the maps are at the second offset."""
    settings = replace(SETTINGS, map_offset=0.7, resolutions=[1, 2])
    return [
        joint_states(specimen, joint, some, slice(*these), settings, factors, SOLVER)
        for some in directions
        for these in offsets
        for factors in resolutions
    ]


GRAINS = {
    "one job": ([["W", "N", "E"]], [(0, 2)], [[1, 2]]),
    "a direction each": ([["W"], ["N"], ["E"]], [(0, 2)], [[1, 2]]),
    "an offset and a resolution each": ([["W", "N", "E"]], [(0, 1), (1, 2)], [[1], [2]]),
    "a job without offsets": ([["W", "N", "E"]], [(0, 2), (2, 4)], [[1, 2]]),
}


@pytest.fixture(params=GRAINS.values(), ids=GRAINS)
def jobs(request, specimen, joint):
    return of_jobs(specimen, joint, *request.param)


def test_the_grain_of_jobs_does_not_matter(jobs, parts):
    xr.testing.assert_identical(combine(jobs), combine(parts))


def test_pressures_of_the_maps_are_those_solved(jobs, specimen, joint):
    states = map_states(jobs)
    assert states["direction"] == "W"
    assert states["resolution"] == 1
    assert states["offset"] == pytest.approx(0.7)
    assert sum(MAP_PRESSURE in job for job in jobs) == 1
    contact = combine(jobs)["in_contact_1"].sel(direction="W").isel(offset=1)
    np.testing.assert_array_equal(states["pressure"].values > 0, contact.values)
    composite = composite_topography(specimen, "W", joint["offset_cells"].values[0, 1])
    space = HalfSpace(composite.shape, (SPACING_Y, SPACING_X), 2e4)
    solved = load_steps(composite, space, states["normal_force"].values, {"rtol": 1e-6}, "rock")
    for pressure, state in zip(states["pressure"].values, solved, strict=True):
        np.testing.assert_allclose(pressure, state.pressure, rtol=1e-6)
        assert pressure.sum() * space.cell_area == pytest.approx(state.force)


def test_every_state_stands_at_its_own_place(parts):
    states = combine(parts)
    for part in parts:
        direction, resolution = part.direction.item(), part.resolution.item()
        row = states.sel(direction=direction, resolution=resolution)
        i = int(np.argmin(np.abs(row.offset_on_grid.values - part.offset_on_grid.item())))
        np.testing.assert_array_equal(row.closure[i], part.closure.squeeze())
        name = f"in_contact_{resolution}"
        np.testing.assert_array_equal(row[name][i], part[name].squeeze())


def test_elastic_dilatancy_opens_by_the_cells_that_were_solved(specimen, joint, parts):
    curves = closure_curves(combine(parts), window_sides(specimen), 2e4)
    result = elastic_dilatancy(curves, joint)
    assert result.contact_direction.values.tolist() == SETTINGS.contact_directions
    np.testing.assert_allclose(result.offset, joint.offset)
    for direction in SETTINGS.contact_directions:
        mated = composite_topography(specimen, direction, 0).max()
        cells = joint["offset_cells"].sel(contact_direction=direction).values
        opened = [composite_topography(specimen, direction, n).max() - mated for n in cells]
        closed = curves["interface_closure"].sel(direction=direction, resolution=1)
        np.testing.assert_allclose(
            result["elastic_dilatancy"].sel(contact_direction=direction),
            np.array(opened)[:, np.newaxis] - closed.values,
            atol=1e-12,
        )
    assert {"units", "long_name"} <= set(result["elastic_dilatancy"].attrs)
    assert {"units", "long_name"} <= set(result["offset_on_grid"].attrs)


def test_directions_with_different_numbers_of_offsets_are_refused(parts):
    with pytest.raises(ValueError, match="offset"):
        combine(parts[:-2])


def test_domains_alone(parts):
    fields = contact_domains(combine(parts))
    assert set(fields.data_vars) == {"in_contact_1", "in_contact_2", "solved", "nodes_error"}
    assert not set(OFFSETS) & set(fields.variables)
