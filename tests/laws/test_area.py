import numpy as np
import pytest
import xarray as xr
from scipy import fft
from symmetries import LENGTH, STRESS, differences, grown

from fractalcontact import HalfSpace, solve_contact
from fractalcontact.core.limits import LIGHT_LOAD
from fractalcontact.core.settings import Solver
from fractalcontact.core.window import window_sides
from fractalcontact.joint.joint import describe_joint
from fractalcontact.laws import theory
from fractalcontact.laws.area import (
    FULL_CONTACT,
    area_laws,
    composite_statistics,
    joint_statistics,
)
from fractalcontact.laws.closure import closure_curves
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.states import combine
from fractalcontact.states.sweep import contact_states
from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.corrected_area import (
    EDGE_EXCESS,
    cell_areas,
    contact_perimeter,
    corrected_area,
)

E_STAR = 1e4  # MPa
SPACING = 0.1  # mm


# -- perimeter and corrected area ------------------------------------------------------------------


def test_perimeter_of_a_rectangle_counts_its_sides():
    domain = np.zeros((9, 8), bool)
    domain[2:5, 3:7] = True  # 3 cells of 0.2 mm high, 4 of 0.3 mm wide
    assert contact_perimeter(domain, (0.2, 0.3)) == pytest.approx(2 * (3 * 0.2 + 4 * 0.3))
    assert contact_perimeter(~domain, (0.2, 0.3)) == contact_perimeter(domain, (0.2, 0.3))


def test_the_edge_of_the_window_is_no_perimeter():
    domain = np.ones((5, 6), bool)
    assert contact_perimeter(domain, 0.1) == 0
    assert corrected_area(domain, 0.1) == pytest.approx(0.3)
    domain[:, 3:] = False
    assert contact_perimeter(domain, 0.1) == pytest.approx(0.5)


def test_nothing_in_contact():
    empty = np.zeros((4, 4), bool)
    assert contact_perimeter(empty, 1.0) == corrected_area(empty, 1.0) == 0


def test_many_domains_at_once():
    domains = np.random.default_rng(1).random((2, 3, 7, 9)) < 0.4
    for measure in (contact_perimeter, corrected_area):
        found = measure(domains, (0.2, 0.3))
        assert found.shape == (2, 3)
        assert found[1, 2] == pytest.approx(measure(domains[1, 2], (0.2, 0.3)))


def test_correction_is_that_of_the_perimeter_on_square_cells():
    domain = np.random.default_rng(2).random((30, 30)) < 0.3
    expected = domain.sum() * 0.01 - EDGE_EXCESS * contact_perimeter(domain, 0.1) * 0.1
    assert corrected_area(domain, 0.1) == pytest.approx(expected)


def test_corrected_area_does_not_fall_below_zero_nor_change_with_the_unit():
    checkers = np.add.outer(np.arange(8), np.arange(8)) % 2 == 0
    assert 0 <= corrected_area(checkers, 1.0) < checkers.sum()
    assert corrected_area(checkers, 1e-3) == pytest.approx(1e-6 * corrected_area(checkers, 1.0))


def _sphere(nodes, centre):
    """Composite topography of a sphere of radius 400 on unit cells."""
    y, x = np.mgrid[:nodes, :nodes] - (nodes - 1) / 2
    return -((x - centre[1]) ** 2 + (y - centre[0]) ** 2) / 800


def test_hertz_is_nearer_when_corrected():
    # Contacts of known radius on a coarse grid, at several places between the nodes.
    space = HalfSpace((32, 32), (1.0, 1.0), 1.0)
    raw, better = [], []
    for radius in (3.7, 5.2, 7.9, 11.3):
        exact = np.pi * radius**2
        for centre in ((0, 0), (0.31, 0.17), (0.5, 0.5), (0.1, 0.42), (0.25, 0)):
            state = solve_contact(_sphere(32, centre), space, force=4 / 3 * radius**3 / 400)
            raw.append(state.area / exact - 1)
            better.append(corrected_area(state.in_contact, 1.0) / exact - 1)
    assert np.mean(raw) > 0.03
    assert abs(np.mean(better)) < np.mean(raw) / 2
    assert np.sqrt(np.mean(np.square(better))) < np.sqrt(np.mean(np.square(raw))) / 1.5


def test_corrected_area_of_a_disc_converges_faster_than_the_raw_one():
    # Hertz's discs, 3 and 24 cells in radius, at places that chance gives: mean relative errors.
    rng = np.random.default_rng(1)

    def errors(cells):
        nodes, found = int(2.6 * cells) + 4, []
        space = HalfSpace((nodes, nodes), (1.0, 1.0), 1.0)
        for centre in rng.uniform(-0.5, 0.5, (12, 2)):
            radius = cells * rng.uniform(0.97, 1.03)
            state = solve_contact(_sphere(nodes, centre), space, force=4 / 3 * radius**3 / 400)
            areas = np.array([state.area, float(corrected_area(state.in_contact, 1.0))])
            found.append(areas / (np.pi * radius**2) - 1)
        return np.abs(np.mean(found, axis=0))

    (coarse_raw, coarse), (fine_raw, fine) = errors(3), errors(24)
    assert coarse_raw / fine_raw < 8 < coarse / fine  # eight times finer: order one is between
    assert coarse < coarse_raw
    assert fine < fine_raw / 3


def test_ring_is_nearer_when_corrected():
    # Two edges: a torus pressed flat. No closed form, so four times finer cells and less excess.
    def solved(part):
        nodes = 40 * part
        y, x = (np.mgrid[:nodes, :nodes] - (nodes - 1) / 2) / part
        ring = -((np.hypot(x, y) - 11.3) ** 2) / 60
        space = HalfSpace((nodes, nodes), (1 / part, 1 / part), 1.0)
        state = solve_contact(ring, space, force=12.0)
        return state.area, float(corrected_area(state.in_contact, 1 / part))

    raw, corrected = solved(1)
    fine_raw, fine_corrected = solved(4)
    # What is left on the fine grid is a quarter of the coarse excess, which bounds the truth.
    assert fine_raw > fine_corrected
    for truth in (fine_raw, fine_corrected):
        assert abs(corrected - truth) < abs(raw - truth)


@pytest.mark.parametrize("seed", [1, 2])
def test_rough_contact_on_a_coarse_grid_is_nearer_when_corrected(seed):
    # One surface sampled ever more coarsely, until its shortest waves are two cells long.
    fine = self_affine((512, 512), 1.0, 0.8, rms=5.0, seed=seed, roll_off=64.0)
    waves = np.hypot(*np.meshgrid(*[np.arange(512) / 1024] * 2))
    fine = fft.idctn(np.where(waves < 1 / 16, fft.dctn(fine), 0))

    def solved(cell):
        surface = fine[cell // 2 :: cell, cell // 2 :: cell]
        space = HalfSpace(surface.shape, (float(cell),) * 2, 1.0)
        state = solve_contact(surface, space, force=1800.0)
        return state.area, float(corrected_area(state.in_contact, cell))

    _, truth = solved(1)
    for cell, excess, left in ((4, 0.2, 0.05), (8, 0.5, 0.2)):
        raw, corrected = solved(cell)
        assert raw > (1 + excess) * truth
        assert corrected == pytest.approx(truth, rel=left)


# -- mean ------------------------------------------------------------------------------------------


# -- statistics ------------------------------------------------------------------------------------


STUDY = {
    "study": "tiny",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.0}},
    "defaults": {
        "material": "rock",
        "directions": ["E", "N"],
        "contact_directions": ["E", "N"],
        "offsets": ["0 mm", "0.2 mm", "1 mm"],
        "loads": ["1 MPa", "5 MPa", "25 MPa", "125 MPa", "600 MPa"],
        "resolutions": [1, 2],
        "window": "4.8 mm",
    },
}


def _scan(heights, spacing=(SPACING, SPACING)):
    coordinates = [s * (np.arange(n) + 0.5) for n, s in zip(heights.shape, spacing, strict=True)]
    attrs = {
        "spacing_y": spacing[0],
        "spacing_x": spacing[1],
        "source": "made",
        "sha256": "0" * 64,
    }
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


@pytest.fixture(scope="module")
def solved():
    """Specimen, joint, closure stage and its area laws, of one face that slides and is flush."""
    settings = resolve_settings(STUDY, "one", {}, "tiny")
    heights = self_affine((96, 96), SPACING, 0.8, rms=0.1, seed=3, roll_off=1.5)
    specimen = make_specimen(_scan(heights), None, name="one", **window_arguments(settings))
    joint = describe_joint(specimen, settings)
    solver = Solver(1e-6, "love", None)
    states = combine(
        [
            contact_states(
                JointLoading.of_joint(specimen, joint, direction, settings, solver),
                settings.resolutions,
            )
            for direction in settings.contact_directions
        ]
    )
    curves = closure_curves(states, window_sides(specimen), E_STAR)
    return specimen, joint, curves, area_laws(curves, joint_statistics(specimen, joint), 1e4, 2.2)


def test_statistics_of_a_wave():
    # A wave of amplitude a in one face; slid by half its length the composite has twice that.
    length, amplitude = 3.2, 0.05
    x = SPACING * np.arange(128)
    wave = np.tile(amplitude * np.cos(2 * np.pi * x / length), (64, 1))
    specimen = make_specimen(
        _scan(wave), None, name="wave", opposite="match", window=3.2, multiple=1, reach={"E": 1.6}
    )
    found = composite_statistics(specimen, "E", [0, 16])
    np.testing.assert_allclose(found["offset"], [0, 1.6])
    slope = 2 * amplitude * np.pi * np.sqrt(2) / length  # rms of the derivative
    assert float(found["rms_slope"][1]) == pytest.approx(slope, rel=0.03)
    # Profiles across the wave are flat: moments are means of both axes.
    assert float(found["m2"][1]) == pytest.approx(slope**2 / 2, rel=0.06)


def test_statistics_stand_at_the_offsets_of_the_curves(solved):
    specimen, joint, curves, _ = solved
    found = joint_statistics(specimen, joint)
    xr.testing.assert_identical(
        found["offset"].drop_vars("offset"), curves["offset"].drop_vars("offset")
    )
    assert list(found["direction"].values) == ["E", "N"]


# -- laws ------------------------------------------------------------------------------------------


def _made_curves(share, statistics, e_star=1.0, nominal=100.0):
    """A closure stage in which A_r/A_0 is given as a function of p / (E* h'_rms)."""
    pressure = e_star * float(statistics["rms_slope"][0, 0]) * np.geomspace(1e-3, 0.3, 12)
    reduced = pressure / (e_star * statistics["rms_slope"].values[0, 0])
    made = np.broadcast_to(share(reduced), (1, 1, 1, 12))
    dims = ("direction", "offset", "resolution", "normal_force")
    return xr.Dataset(
        {
            "area_share": (dims, made),
            "area": (dims, made * nominal),
            "area_corrected": (dims, 0.9 * made * nominal),
            "area_error": (dims, 0.01 * made * nominal),
            "area_corrected_error": (dims, 0.02 * made * nominal),
            "nominal_pressure": ("normal_force", pressure),
        },
        coords={
            "direction": ["E"],
            "offset": [0.1],
            "resolution": [1],
            "normal_force": pressure * nominal,
        },
    )


@pytest.fixture
def statistics():
    values = {"rms_slope": 0.4, "m0": 0.01, "m2": 0.08, "m4": 30.0}
    return xr.Dataset(
        {name: (("direction", "offset"), [[value]]) for name, value in values.items()},
        coords={"direction": ["E"], "offset": [0.1]},
        attrs={"spacing_y": 0.01, "spacing_x": 0.01},
    )


def test_exact_power_law_is_recovered(statistics):
    made = _made_curves(lambda reduced: 0.8 * reduced**0.9, statistics)
    found = area_laws(made, statistics, 1.0, 2.2).isel(direction=0, offset=0)
    assert float(found["corrected_exponent"]) == pytest.approx(0.9)
    force = made["normal_force"].values
    np.testing.assert_allclose(
        float(found["corrected_unit_area"]) * force**0.9,
        made["area_corrected"].values.squeeze(),
        rtol=1e-9,
    )
    assert float(found["corrected_force_low"]) == pytest.approx(force[0])
    assert float(found["corrected_force_high"]) == pytest.approx(force[-1])


def test_errors_of_the_areas_are_passed_on(statistics):
    made = _made_curves(lambda reduced: 0.8 * reduced**0.9, statistics)
    found = area_laws(made, statistics, 1.0, 2.2)
    np.testing.assert_allclose(found["kappa_error"], 0.01 * found["kappa"])
    np.testing.assert_allclose(
        found["corrected_kappa_error"], 0.02 / 0.9 * found["corrected_kappa"]
    )


def test_area_at_one_newton_has_its_interval(statistics):
    wavy = _made_curves(lambda reduced: reduced * (1 + 0.1 * (-1) ** np.arange(12)), statistics)
    found = area_laws(wavy, statistics, 1.0, 2.2).isel(direction=0, offset=0)
    low, value, high = (found[f"corrected_unit_area{end}"].item() for end in ("_low", "", "_high"))
    assert low < value < high
    assert low * high == pytest.approx(value**2)


def test_line_of_a_theory_is_its_kappa(statistics):
    kappa = theory.BUSH_GIBSON_THOMAS_KAPPA
    found = area_laws(
        _made_curves(lambda reduced: kappa * reduced, statistics), statistics, 1.0, 2.2
    )
    np.testing.assert_allclose(found["kappa"], kappa)
    np.testing.assert_allclose(found["corrected_kappa"], 0.9 * kappa)
    assert found["mean_kappa"].item() == pytest.approx(kappa)
    assert found["corrected_mean_kappa_high"].item() == pytest.approx(0.9 * kappa)
    assert found["mean_kappa_n"].item() == np.sum(np.geomspace(1e-3, 0.3, 12) <= LIGHT_LOAD)


def test_theories_of_a_surface(statistics):
    made = _made_curves(lambda reduced: 2 * reduced, statistics)
    found = area_laws(made, statistics, 1.0, 2.2).isel(direction=0, offset=0)
    light = found.isel(normal_force=0)
    reduced = float(light["reduced_pressure"])
    assert reduced == pytest.approx(1e-3)
    assert float(light["persson_share"]) == pytest.approx(1.596e-3, rel=1e-3)
    assert float(light["bush_gibson_thomas_share"]) == pytest.approx(2.507e-3, rel=1e-3)
    summits = theory.asperities(0.01, 0.08, 30.0)
    law = np.sqrt(np.pi * summits.radius / summits.height_deviation)
    expected = law * made["normal_force"].values / 100
    np.testing.assert_allclose(found["greenwood_williamson_share"], expected)
    growth = np.diff(np.log(found["majumdar_bhushan_share"])) / np.diff(
        np.log(found["normal_force"])
    )
    np.testing.assert_allclose(growth, 2 / 1.8)


def test_theories_are_in_the_units_that_they_state(solved):
    specimen, joint, curves, _ = solved
    statistics = joint_statistics(specimen, joint)
    first = area_laws(curves, statistics, 1e4, 2.2)
    spacing = {name: LENGTH * value for name, value in statistics.attrs.items()}
    other = area_laws(grown(curves), grown(statistics).assign_attrs(spacing), STRESS * 1e4, 2.2)
    at_one_newton = [name for name in first if "unit_area" in name]
    found = differences(
        other.drop_vars(at_one_newton), grown(first).drop_vars(at_one_newton), rtol=1e-9
    )
    assert not found
    assert np.isfinite(first["majumdar_bhushan_share"]).any()


def test_a_profile_dimension_outside_the_fractal_law_leaves_only_that_out(statistics):
    made = _made_curves(lambda reduced: 2 * reduced, statistics)
    for dimension in (2.6, np.nan):
        found = area_laws(made, statistics, 1.0, dimension)
        assert np.isnan(found["majumdar_bhushan_share"]).all()
        assert found["no_majumdar_bhushan"].item()
        assert np.isfinite(found["persson_share"]).all()


def test_few_nodes_and_full_contact_are_not_fitted(statistics):
    # 9 nodes of 1e-6 of the window at the lightest load; full contact at the two heaviest.
    def share(reduced):
        made = 0.5 * reduced
        made[0], made[-2:] = 9e-6, 1.0
        return made

    found = area_laws(_made_curves(share, statistics), statistics, 1.0, 2.2)
    np.testing.assert_array_equal(found["fitted"].values.squeeze(), [0] + [1] * 9 + [0] * 2)
    assert found["corrected_exponent"].item() == pytest.approx(1)
    assert found["corrected_n"].item() == 9
    assert not found["light"].values.squeeze()[0]


def test_corrected_areas_of_few_nodes_are_in_no_law(statistics):
    # A node is 1e-6 of the window: 20 nodes at the lightest load are fitted raw, not corrected.
    def share(reduced):
        made = 0.5 * reduced
        made[0] = 20e-6
        return made

    found = area_laws(_made_curves(share, statistics), statistics, 1.0, 2.2)
    assert (found["fitted"].sum().item(), found["corrected_n"].item()) == (12, 11)
    assert not found["corrected_fitted"].values.squeeze()[0]
    assert found["corrected_exponent"].item() == pytest.approx(1)
    assert found["no_corrected_law"].item() == ""


def test_too_few_loads_say_so(statistics):
    made = _made_curves(lambda reduced: 2 * reduced, statistics).isel(normal_force=[9, 11])
    found = area_laws(made, statistics, 1.0, 2.2)
    assert np.isnan(found["corrected_exponent"]).all()
    assert found["no_corrected_law"].item().startswith("2 of 3 loads")
    assert "no load" in found["no_mean_kappa"].item()


@pytest.mark.filterwarnings("error")
def test_flush_faces_have_reasons_instead_of_numbers(solved):
    *_, found = solved
    flush = found.sel(offset=0)
    assert (flush["no_corrected_law"] == FULL_CONTACT).all()
    assert (flush["no_mean_kappa"] == "the faces are flush and have no slope").all()
    for name in ("corrected_exponent", "kappa", "mean_kappa", "persson_share"):
        assert np.isnan(flush[name]).all()


def test_laws_of_a_solved_joint(solved):
    *_, curves, found = solved
    slid = found.sel(offset=[0.2, 1.0])
    fitted = slid["corrected_n"] >= 3
    assert fitted.any()
    assert (slid["no_corrected_law"] == "").equals(fitted)
    exponent = slid["corrected_exponent"]
    assert ((exponent > 0.7) & (exponent < 1.1)).equals(fitted)
    assert (slid["corrected_exponent_low"] < exponent).equals(fitted)
    assert (slid["corrected_kappa"] < slid["kappa"]).where(slid["fitted"], True).all()
    share = curves["area_share"].sel(resolution=1)
    again = slid["kappa"] * slid["reduced_pressure"]
    np.testing.assert_allclose(again, share.sel(offset=[0.2, 1.0]))


def test_everything_is_labelled(solved):
    *_, found = solved
    for name, variable in found.data_vars.items():
        assert {"units", "long_name"} <= variable.attrs.keys(), name


def test_statistics_of_other_offsets_are_refused(solved, statistics):
    _, _, curves, _ = solved
    with pytest.raises(ValueError, match=r"direction|offset"):
        area_laws(curves, statistics, 1.0, 2.2)


def test_areas_of_cells_add_up_to_the_corrected_area():
    domain = np.random.default_rng(0).random((40, 30)) < 0.3
    found = cell_areas(domain)
    assert found.shape == (np.count_nonzero(domain),)
    assert found.sum() == pytest.approx(float(corrected_area(domain, 1.0)))
