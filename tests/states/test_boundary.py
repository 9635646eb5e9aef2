"""Boundaries of a window through the chain: exact states, reflection, what is stated."""

import numpy as np
import pytest
from made_settings import made_settings
from made_stages import scan, stages_of

from fractalcontact.core.errors import InputError
from fractalcontact.core.settings import Material
from fractalcontact.laws.branches import KEPT_BOWL
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.settlement import bulk_settlement, window_settlement
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.study.scan_files import ScanFiles
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

SPACING, E_STAR = 0.1, 20e3
SOLVER = solver_settings({"solver": {"rtol": 1e-8}}, "boundary")
ROCK = Material(30.0, np.nan, E_STAR, np.inf, "rock", 38.4e3, 0.2)
WEAK = Material(30.0, np.nan, E_STAR, 80.0, "rock", 38.4e3, 0.2)
LOADS = [(pressure, "pressure") for pressure in (0.5, 2.0, 8.0, 20.0, 40.0)]


def stages(heights, boundary, material=ROCK, loads=LOADS, later=("closure",)):
    """Stages of a surface against a plane; the whole of it is the window."""
    settings = made_settings(
        material=material,
        loads=loads,
        dilatancy_loads=loads[-1:],
        map_load=loads[-1],
        boundary=boundary,
        opposite="flat",
        directions=["none"],
        contact_directions=["none"],
        offsets=[0.0],
        map_offset=None,
        window=[SPACING * n for n in heights.shape],
        seating_pressure=0.5,
    )
    return stages_of("made", (scan(heights, SPACING), None), settings, SOLVER, later)


def rough(seed=3):
    """Heights (36, 40), mm, without a mean plane of their own."""
    heights = self_affine((36, 40), SPACING, 0.8, rms=0.02, seed=seed, roll_off=1.6)
    y, x = np.indices(heights.shape)
    terms = np.column_stack([np.ones(x.size), x.ravel(), y.ravel()])
    plane = terms @ np.linalg.lstsq(terms, heights.ravel(), rcond=None)[0]
    return heights - plane.reshape(heights.shape)


def test_blocks_settle_only_beside_a_free_window():
    assert bulk_settlement(100.0, E_STAR, 20, 20) > 0
    for boundary in ("periodic", "mirrored"):
        np.testing.assert_array_equal(
            bulk_settlement([1.0, 2.0], E_STAR, 20, 20, boundary=boundary), 0
        )
        space = HalfSpace((4, 4), 0.1, E_STAR, boundary=boundary)
        assert window_settlement(space, 100.0) == 0


@pytest.mark.parametrize("boundary", ["periodic", "mirrored"])
def test_faces_in_full_contact_close_to_their_mean_planes(boundary):
    """No gap is left, the closure is max h - mean h, and it has no compliance."""
    n, amplitude = 32, 1e-3
    wave = np.cos(2 * np.pi * (np.arange(n) + 0.5) / n)
    full = np.pi * E_STAR * amplitude / (n * SPACING)  # Johnson (1985), section 13.2
    found = stages(
        np.tile(amplitude * wave, (n, 1)), boundary, loads=[(1.05 * full, "pressure")] * 1
    )["closure"].squeeze()
    assert found.attrs["boundary"] == boundary
    assert found["area_share"] == 1
    assert found["mean_gap"] == pytest.approx(0, abs=1e-9)
    assert found["interface_closure"] == pytest.approx(amplitude * wave.max(), rel=1e-5)
    assert np.isnan(found["interface_stiffness"])


@pytest.mark.parametrize("boundary", ["free", "mirrored"])
def test_mated_faces_do_not_close_and_slid_ones_open_by_their_separation(boundary):
    """Eq. 4: delta = u + w_b, without w_b where no half-space stands beside the window."""
    settings = made_settings(
        material=ROCK,
        loads=LOADS,
        boundary=boundary,
        directions=["E"],
        contact_directions=["E"],
        offsets=[0.0, 0.3],
        map_offset=0.3,
        window=[3.2, 3.6],
    )
    found = stages_of("made", (scan(rough(), SPACING), None), settings, SOLVER, ("closure",))
    mated, slid = (found["closure"].squeeze().isel(offset=i) for i in (0, 1))
    assert (mated["interface_closure"] == 0).all()
    assert mated["interface_stiffness"].isnull().all()
    np.testing.assert_allclose(mated["mean_gap"], 0, atol=1e-12)
    settled = slid["bulk_settlement"].values
    assert (settled > 0).all() if boundary == "free" else (settled == 0).all()
    opened = found["dilatancy"]["elastic_dilatancy"].squeeze().isel(offset=1)
    np.testing.assert_allclose(opened, slid["separation"] + settled, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("material", [ROCK, WEAK], ids=["elastic", "crushing"])
def test_mirrored_is_periodic_on_the_reflected_surface(material):
    """Through closure, its laws, branches and errors: one surface, its four images beside it."""
    heights = rough()
    images = np.pad(heights, [(0, n) for n in heights.shape], "symmetric")
    one, four = (
        stages(h, boundary, material)
        for h, boundary in ((heights, "mirrored"), (images, "periodic"))
    )
    names = ["interface_closure", "separation", "mean_gap", "area_share"]
    # A stiffness of contacts that crush needs many of them: four windows have four times as many.
    names += ["interface_stiffness"] if material is ROCK else []
    for name in names:
        first, other = (of["closure"][name].squeeze() for of in (one, four))
        np.testing.assert_allclose(other, first, rtol=2e-4, atol=1e-7, err_msg=name)
    for name in ("interface_closure", "interface_stiffness"):
        first, other = (of["branches"][name].sel(branch="reload") for of in (one, four))
        np.testing.assert_allclose(other, first, rtol=2e-3, atol=1e-6, err_msg=name)
    sets = [of["branches"]["permanent_set"].values for of in (one, four)]
    np.testing.assert_allclose(sets[1][: len(sets[0]), : sets[0].shape[1]], sets[0], atol=1e-6)
    assert (sets[0].max() > 0) == (material is WEAK)


def test_free_windows_that_crush_state_no_stiffness_on_reloading():
    """The bowl of their settlement stays in the permanent set; mirrored ones have none."""
    heights = rough()
    free, mirrored = (stages(heights, of, WEAK)["branches"] for of in ("free", "mirrored"))
    on_load, again = {"branch": "load"}, {"branch": "reload"}
    for name in ("reference_stiffness", "interface_stiffness"):
        assert free[name].drop_sel(on_load).isnull().all()
    assert mirrored["interface_stiffness"].sel(again).notnull().all()
    assert free["reload_reason"] == KEPT_BOWL
    # At the pressures between which it lies, solved there and not interpolated.
    stiffness = mirrored["reference_stiffness"].sel(again)
    assert (stiffness.diff("reference_pressure") > 0).all() or mirrored["reload_reason"] != ""
    # Loading hardly knows the edges.
    closures = [of["seated_closure"].sel(on_load) for of in (free, mirrored)]
    np.testing.assert_allclose(*closures, rtol=0.05)


@pytest.mark.parametrize("material", [ROCK, WEAK], ids=["elastic", "crushing"])
def test_mirrored_windows_have_no_unit_and_no_first_face(material):
    """Lengths by 3 and pressures by 2, or both faces exchanged: the same states of contact."""
    space = HalfSpace((36, 40), SPACING, E_STAR, boundary="mirrored")
    grown = HalfSpace((36, 40), 3 * SPACING, 2 * E_STAR, boundary="mirrored")
    lower, upper = rough(), 0.6 * rough(4)
    hardness, solving = material.hardness, {"rtol": 1e-8}
    first = solve_contact(lower - upper, space, mean_pressure=8.0, hardness=hardness, **solving)
    other = solve_contact(
        3 * (lower - upper), grown, mean_pressure=16.0, hardness=2 * hardness, **solving
    )
    np.testing.assert_allclose(other.pressure, 2 * first.pressure, atol=1e-3)
    assert other.closure == pytest.approx(3 * first.closure, rel=1e-6)
    # Turned over about y, the upper face is the lower one: h has the same heights, x reversed.
    turned = (-upper[:, ::-1]) - (-lower[:, ::-1])
    again = solve_contact(turned, space, mean_pressure=8.0, hardness=hardness, **solving)
    np.testing.assert_allclose(again.pressure[:, ::-1], first.pressure, atol=1e-3)


def test_a_force_there_moves_this_node_as_a_force_here_moves_that_one():
    """Betti's reciprocity of the mirrored operator, at a corner, an edge and in the middle."""
    space = HalfSpace((12, 15), (0.1, 0.13), E_STAR, boundary="mirrored")
    nodes, fields = [(0, 0), (0, 7), (6, 8)], []
    for node in nodes:
        pressure = np.zeros(space.shape)
        pressure[node] = 1.0
        fields.append(space.displacement(pressure))
    moved = np.array([[field[node] for node in nodes] for field in fields])
    np.testing.assert_allclose(moved, moved.T, rtol=1e-10, atol=1e-18)


STUDY = {
    "study": "made",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
    "defaults": {"material": "rock", "loads": ["1 MPa"], "resolutions": [1]},
}


def settings_of(tmp_path, own=None, scanned=True, **study):
    scan_files = ScanFiles("rock", tmp_path / "rock.csv", None, None) if scanned else None
    return resolve_settings(STUDY | study, "rock", own or {}, "study.yaml", scan_files)


def test_scans_are_mirrored_and_embedded_specimens_free(tmp_path):
    assert settings_of(tmp_path).boundary == "mirrored"
    assert settings_of(tmp_path, scanned=False).boundary == "free"
    for boundary in ("free", "periodic", "mirrored"):
        assert settings_of(tmp_path, {"boundary": boundary}).boundary == boundary


def test_rigid_plates_are_those_of_free_windows(tmp_path):
    solver = {"solver": {"kernel": "rigid square"}}
    assert settings_of(tmp_path, **solver).boundary == "free"
    with pytest.raises(InputError, match=r"boundary: the kernel 'rigid square' .* free'"):
        settings_of(tmp_path, {"boundary": "mirrored"}, **solver)


def test_every_solve_has_the_boundary(tmp_path):
    settings = settings_of(tmp_path, {"boundary": "periodic"})

    class Grid:
        attrs = {"spacing_y": 0.1, "spacing_x": 0.1}  # noqa: RUF012

    loading = JointLoading(Grid, "E", [0], settings, SOLVER)
    assert loading.half_space((4, 4)).boundary == "periodic"
