"""The error budget of a specimen: sources, totals, reasons and what is interpolated."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from fractalcontact.domain.analysis import analyse_domains
from fractalcontact.error_budget import refinement
from fractalcontact.error_budget.derived import with_derived
from fractalcontact.error_budget.error_budget import OF_SURFACE, error_budget, over_loads
from fractalcontact.error_budget.solve_plan import solve_plan
from fractalcontact.flow.cubic_law import plane_flow
from fractalcontact.joint.joint import composite_topography, describe_joint
from fractalcontact.laws.closure import closure_curves, elastic_dilatancy
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.other_windows import (
    MAX_OVERLAP,
    other_composites,
    whole_composite,
    window_places,
    window_spread,
)
from fractalcontact.states.state_quantities import state_quantities
from fractalcontact.states.state_scalars import aperture
from fractalcontact.states.states import combine, contact_domains
from fractalcontact.states.subgrid import subgrid
from fractalcontact.states.sweep import joint_states
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.specimen import make_specimen, window_arguments
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

SPACING = 0.1  # mm
STUDY = {
    "study": "budget",
    "materials": {
        "rock": {"modulus": "20 GPa", "poisson": 0.2},
        "weak": {"modulus": "20 GPa", "poisson": 0.2, "hardness": "80 MPa"},
    },
    "defaults": {
        "material": "rock",
        "contact_directions": ["E"],
        "offsets": ["0 mm", "0.3 mm"],
        "map_offset": "0.3 mm",
        "loads": ["1 MPa", "5 MPa", "12.5 MPa", "25 MPa", "50 MPa"],
        "dilatancy_loads": ["5 MPa", "25 MPa"],
        "map_load": "25 MPa",
        "resolutions": [1, 2],
        "window": "3.2 mm",
    },
    "specimens": {
        "one": {},
        "small": {"window": "7.2 mm", "resolutions": [1]},
        "two": {"window": "7.2 mm", "resolutions": [1]},
        "pair": {"window": "3.2 mm", "resolutions": [1]},
        "flat": {"opposite": "flat", "window": "3.2 mm"},
        "crushing": {"material": "weak"},
    },
}


def scan(heights):
    coords = {
        axis: SPACING * (np.arange(n) + 0.5) for axis, n in zip("yx", heights.shape, strict=True)
    }
    attrs = {"spacing_y": SPACING, "spacing_x": SPACING}
    return xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)


def budget_of(name, accuracy=None, **more):
    """A specimen's loading, closure curves and budget."""
    lower = self_affine((80, 80), SPACING, 0.8, rms=0.1, seed=5, roll_off=1.5)
    upper = lower + self_affine((80, 80), SPACING, 0.6, rms=0.02, seed=6) + 0.3
    settings = resolve_settings(STUDY, name, {}, "budget")
    specimen = make_specimen(
        scan(lower),
        scan(upper) if name in ("two", "pair") else None,
        name=name,
        **window_arguments(settings),
    )
    solver = solver_settings({"accuracy": accuracy} if accuracy else {}, "budget")
    joint = describe_joint(specimen, settings)
    directions = settings.contact_directions
    parts = joint_states(
        specimen, joint, directions, slice(None), settings, settings.resolutions, solver
    )
    states = combine([parts])
    loading = JointLoading.of_joint(specimen, joint, directions[0], settings, solver)
    sides = tuple(np.array(loading.shape) * SPACING)
    curves = closure_curves(states, sides, settings.material.e_star)
    # That of a stage, whose states at the reference pressures are solved beside the curves.
    at = {"reference_pressure": [1.0, 5.0, 10.0]}
    stated = xr.Dataset({"reference_stiffness": ("reference_pressure", [20.0, 50.0, 80.0])}, at)
    curves = curves.assign(stated)
    domains = analyse_domains(contact_domains(states), SPACING)
    budget = error_budget(loading.at_map_offset(), curves, domains, **more)
    plan = solve_plan(curves, elastic_dilatancy(curves, joint), solver, budget)
    # Beside the curves, for what is compared with the domains and with the values.
    budget.attrs["interval"] = [domains[f"delta_sigma_{end}"] for end in ("low", "high")]
    return loading.at_map_offset(), curves, budget, plan


def published(curves, budget, quantity):
    """Numbers of a quantity of the closure curves, whose errors the budget has."""
    stage, _, variable = str(budget["of"].sel(quantity=quantity).values).partition("/")
    assert stage == "closure"
    state = {"direction": budget.attrs["direction"], "resolution": budget.attrs["resolution"]}
    here = curves.sel(state).sel(offset=budget.attrs["offset_mm"], method="nearest")
    return here[variable]


def reason_of(budget, source):
    """Why a source of error of the closure has no value."""
    return str(budget["reason"].sel(quantity="closure", source=source).values)


@pytest.fixture(scope="module")
def one():
    return budget_of("one")


def test_totals_are_root_sums_of_squares(one):
    _, curves, budget, _ = one
    errors = budget["error"]
    known = np.isfinite(budget["total"].values)
    assert known[:4].all()
    of_surface = np.sqrt((errors.sel(source=list(OF_SURFACE)) ** 2).sum("source", skipna=False))
    np.testing.assert_allclose(budget["total"], of_surface.transpose(*budget["total"].dims))
    larger = np.fmax(errors.sel(source="counting"), errors.sel(source="window"))
    np.testing.assert_allclose(
        budget["total_of_population"].values[known],
        np.hypot(budget["total"], larger).values[known],
    )
    # What may be zero or of either sign has no fraction, whatever its value.
    absolute = budget["absolute"]
    assert absolute["quantity"].values[absolute].tolist() == ["separation", "delta_sigma"]
    for name in ("relative_error", "relative_total", "relative_total_of_population"):
        error = budget[name.removeprefix("relative_")]
        assert np.isfinite(error.where(absolute)).any()
        for quantity in ("closure", "area_corrected", "stiffness"):
            value = abs(published(curves, budget, quantity))
            fraction = error.sel(quantity=quantity) / value
            np.testing.assert_allclose(budget[name].sel(quantity=quantity), fraction)
        assert np.isnan(budget[name].where(absolute)).all()


def test_the_largest_source_has_no_larger_beside_it(one):
    _, _, budget, _ = one
    groups = {
        "largest_source": OF_SURFACE,
        "largest_source_of_population": ("counting", "window"),
    }
    for name, sources in groups.items():
        largest = budget["error"].sel(source=list(sources)).max("source")
        named = budget[name].values != ""
        np.testing.assert_array_equal(named, np.isfinite(largest.values))
        for i, j in np.argwhere(named):
            source = budget[name].values[i, j]
            assert source in sources
            assert budget["error"].sel(source=source)[i, j] == largest[i, j]


def test_the_interval_of_the_dimension_counts_contacts_and_no_other_estimator_is_in_a_total():
    loading, _, budget, _ = budget_of("crushing")  # under whose loads more than 30 nodes touch
    (offset,) = loading.offsets
    low, high = (
        end.sel(direction="E", resolution=1).sel(offset=offset, method="nearest").values
        for end in budget.attrs["interval"]
    )
    of_dimension = budget.sel(quantity="delta_sigma")
    error = of_dimension["error"].sel(source="counting").values
    half = (high - low) / 2
    known = np.isfinite(half)
    assert known.any()
    assert (error[known] >= half[known] - 1e-12).all()
    assert (of_dimension["error"].sel(source="estimator") > 0).any()
    own = of_dimension["error"].sel(source=["solver", "numerical"])
    np.testing.assert_allclose(of_dimension["total"], np.sqrt((own**2).sum("source", skipna=False)))


def test_the_budget_names_the_variables_whose_errors_it_has(one):
    loading, curves, budget, _ = one
    here = curves.sel(direction="E", resolution=1).isel(offset=1)
    for quantity, name in (("closure", "interface_closure"), ("stiffness", "interface_stiffness")):
        np.testing.assert_array_equal(published(curves, budget, quantity), here[name])
    separation = here["rigid_opening"] - here["closure"]
    np.testing.assert_allclose(published(curves, budget, "separation"), separation)
    assert str(budget["of"].sel(quantity="delta_sigma").values) == "domains/delta_sigma"
    solver = budget["error"].sel(source="solver", quantity="closure")
    np.testing.assert_array_equal(solver, here["interface_closure_error"])
    assert budget.attrs["offset_mm"] == pytest.approx(loading.offsets[0])


def test_errors_cover_a_solve_at_an_eighth_of_the_spacing(one):
    loading, curves, budget, _ = one
    composite = loading.composite(int(loading.cells[0]))
    finer = subgrid(composite, 8)
    sides = (SPACING / 8, SPACING / 8)
    space = HalfSpace(finer.shape, sides, loading.settings.material.e_star)
    within, separation, gap = [], [], []
    for force in budget["normal_force"].values:
        state = solve_contact(finer, space, force=force, rtol=1e-5)
        for name, true in state_quantities(state, float(finer.max())).items():
            here = budget.sel(normal_force=force, quantity=name)
            value = published(curves, budget, name).sel(normal_force=force)
            within.append(abs(true - float(value)) <= float(here["total"]))
            separation += [true] if name == "separation" else []
        gap.append(state.gap.mean())
    assert np.mean(within) >= 0.75
    # Closure from the seat, to whose error first touch adds nothing.
    curve = curves.sel(direction="E", resolution=1).isel(offset=1)
    # The mean gap, which is as wide as the mean planes are apart.
    of_surface = budget["total"].sel(quantity="separation").values
    assert np.mean(abs(gap - curve["mean_gap"].values) <= of_surface) >= 0.75
    settled = (curve["closure"] - curve["interface_closure"]).values
    seat = np.flatnonzero(curve["seated_closure"].values == 0)[0]
    fallen = -np.array(separation) - settled
    off = abs(fallen - fallen[seat] - curve["seated_closure"].values)[seat:]
    total = budget["seated_closure_total"].values[seat:]
    assert np.mean(off <= total) >= 0.75
    assert (total < budget["total"].sel(quantity="closure").values[seat:]).all()


def test_stiffness_at_a_pressure_has_the_relative_error_of_the_states_beside_it():
    pressure, relative = np.array([1.0, 4.0, 6.25, 16.0]), np.array([np.nan, 0.1, 0.2, 0.2])
    loads = {"normal_force": 2 * pressure}
    curve = xr.Dataset(
        {
            "seated_closure": ("normal_force", [np.nan, 0.0, 0.1, 0.2]),
            "reference_stiffness": ("reference_pressure", [np.nan, 50.0, 80.0]),
        },
        {"reference_pressure": [1.0, 5.0, 10.0], "nominal_pressure": ("normal_force", pressure)}
        | loads,
    )
    errors = {
        "separation": [0.1, 0.03, 0.04, 0.0],
        "area_corrected": [np.nan, 0.4, 0.8, 1.2],
        "stiffness": [np.nan] * 4,
    }
    coords = {"quantity": list(errors)} | loads
    dims = ("quantity", "normal_force")
    both = {
        "total_of_population": (dims, 3 * np.array(list(errors.values()))),
        "relative_total": (dims, [relative] * 3),
        "relative_total_of_population": (dims, [2 * relative] * 3),
    }
    budget = xr.Dataset({"total": (dims, list(errors.values())), **both}, coords)
    sampling = np.array([np.nan, 0.0, 0.12, np.nan])
    one = SimpleNamespace(curve=curve, loading=SimpleNamespace(area=4.0))
    found = with_derived(budget, one, sampling)
    # 5 MPa lies in the middle of 4 and 6.25, as the logarithm has it.
    expected = [np.nan, 50 * np.sqrt(0.1 * 0.2), 80 * 0.2]
    np.testing.assert_allclose(found["reference_stiffness_total"], expected)
    of_population = found["reference_stiffness_total_of_population"]
    np.testing.assert_allclose(of_population, 2 * np.array(expected))
    np.testing.assert_allclose(found["seated_closure_total"], [np.nan, 0.0, 0.05, 0.03])
    of_population = found["seated_closure_total_of_population"]
    np.testing.assert_allclose(of_population, [np.nan, 0.0, 0.13, np.nan])
    np.testing.assert_allclose(found["seated_closure_relative"], [np.nan, np.nan, 0.5, 0.15])
    np.testing.assert_allclose(found["mean_gap_total_of_population"], [0.3, 0.09, 0.12, 0])
    np.testing.assert_allclose(found["contact_fraction_total"], [np.nan, 0.1, 0.2, 0.3])


def test_resolution_is_the_change_from_twice_the_spacing_and_in_no_total(one):
    loading, curves, budget, _ = one
    here = curves.sel(direction="E").isel(offset=1)
    composite = loading.composite(int(loading.cells[0]))
    lowered = composite.max() - composite[::2, ::2].max()
    fine, coarse = (here["closure"].sel(resolution=k).values for k in (1, 2))
    found = budget["error"].sel(source="resolution")
    np.testing.assert_allclose(found.sel(quantity="separation"), abs(coarse - fine + lowered))
    changed = abs(here["area_corrected"].diff("resolution").squeeze())
    np.testing.assert_allclose(found.sel(quantity="area_corrected"), changed)


def test_the_model_is_what_three_times_the_hardness_changes(one):
    """And in no total; where nothing yields there is none, and the budget says so."""
    loading, curves, budget, _ = budget_of("crushing")
    composite = loading.composite(int(loading.cells[0]))
    space, forces = loading.half_space(composite.shape), curves["normal_force"].values
    closure = budget["error"].sel(source="model", quantity="closure")
    at_seat = []
    assert budget["hardest_hardness"] == 240
    seat = int(np.flatnonzero(curves.sel(resolution=1).isel(offset=1)["seated_closure"][0] == 0)[0])
    for place in (seat, 4):
        both = [
            solve_contact(composite, space, force=forces[place], hardness=hardness)
            for hardness in (80.0, 240.0)
        ]
        closed = [state.closure for state in both]
        assert closure[place] == pytest.approx(abs(closed[1] - closed[0]), rel=1e-3)
        gap = budget["mean_gap_hardest"][place]
        assert gap == pytest.approx(np.maximum(both[1].gap, 0).mean(), rel=1e-3)
        at_seat.append(closed)
        for way, axis in (("along", "x"), ("across", "y")):
            flow = plane_flow(aperture(both[1]), (SPACING, SPACING), axis)
            found = float(budget[f"transmissivity_{way}_hardest"][place])
            assert np.isnan(found) or found == pytest.approx(flow.transmissivity, rel=1e-2)
    assert np.isfinite(budget["transmissivity_along_hardest"][seat])
    # Since the seat the faces come together by the difference of the closures.
    harder, own = (at_seat[1][i] - at_seat[0][i] for i in (1, 0))
    seated = budget["seated_closure_hardest"] - curves["seated_closure"].sel(
        direction="E", resolution=1
    ).isel(offset=1)
    assert float(seated[4]) == pytest.approx(harder - own, rel=1e-3)
    assert (closure > 0).all()
    assert reason_of(budget, "model") == ""
    squares = sum(budget["error"].sel(source=source) ** 2 for source in OF_SURFACE)
    np.testing.assert_allclose(budget["total"], np.sqrt(squares))
    _, _, elastic, _ = one
    assert np.isnan(elastic["error"].sel(source="model")).all()
    assert np.isnan(elastic["hardest"]).all()
    assert np.isnan(elastic["transmissivity_along_hardest"]).all()
    assert "elastic contact" in reason_of(elastic, "model")


def test_solved_and_interpolated_loads_are_told(one):
    """Refined are the smallest and largest load, and those that figures show."""
    _, _, budget, _ = one
    refined = np.isfinite(budget["finest_spacing"].values)
    np.testing.assert_array_equal(refined, [True, True, False, True, True])
    words = budget["numerical_from"].values
    assert [str(word).startswith("interpolated") for word in words] == list(~refined)
    assert np.isfinite(budget["error"].sel(source="numerical", quantity="closure")).all()
    order = budget["observed_order"].values
    assert ((order >= 0.5) & (order <= 3))[np.isfinite(order)].all()
    assert np.isnan(order[:, 2]).all()


def test_all_states_are_refined_where_the_study_asks_for_all():
    _, _, budget, _ = budget_of("flat", "full")
    assert (budget["finest_spacing"] == SPACING / 4).all()
    assert "one face was scanned" in reason_of(budget, "registration")


@pytest.mark.parametrize(
    ("most_cheap", "most", "solved"), [(2304, 2304, [1, 2, 4]), (2303, 2304, [2]), (2303, 2303, [])]
)
def test_grids_at_a_quarter_of_the_spacing_have_16_times_the_cells(
    monkeypatch, most_cheap, most, solved
):
    """Few cells are solved at all loads, more only where the closure changed, too many nowhere."""
    monkeypatch.setattr(refinement, "CHEAP_CELLS", most_cheap)
    monkeypatch.setattr(refinement, "MAX_CELLS", most)
    curve = SimpleNamespace(composite=np.zeros((9, 16)))
    levels = np.ones((3, 5, 6))
    levels[1, 0] = [1.5, 1.005, 1.2, 1.3, 1.0, 1.0]
    places = refinement._needing_more(curve, levels, np.array([1, 2, 4]), 0.01)
    assert places.tolist() == solved


def test_what_is_not_known_has_its_reason(one):
    _, _, budget, _ = one
    known = np.isfinite(budget["error"]).any("normal_force")
    told = budget["reason"] != ""
    assert bool((known | told).all())
    assert reason_of(budget, "estimator") == "applies to Delta_sigma alone"
    nothing = ~known & (budget["source"] == "numerical")
    assert not nothing.isel(quantity=slice(4)).any()


def test_a_scan_no_larger_than_its_window_has_no_others():
    _, _, budget, _ = budget_of("small")
    window = budget["error"].sel(source="window")
    assert np.isnan(window).all()
    assert "not large enough" in reason_of(budget, "window")
    assert int(budget["windows_solved"]) == 1
    # What is counted still is.
    assert np.isfinite(budget["total_of_population"].sel(quantity="closure")).all()


def test_registration_enters_the_population_of_two_scanned_faces():
    _, _, unknown, _ = budget_of("two")
    assert np.isnan(unknown["total_of_population"]).all()
    reason = reason_of(unknown, "registration")
    assert reason == "no spread of registrations is known"
    spread = {"closure": np.full(5, 0.5), "stiffness": 3.0}
    _, _, budget, _ = budget_of("two", registration_spread=spread)
    assert (budget["total_of_population"].sel(quantity="closure") > 0.5).all()
    np.testing.assert_array_equal(
        budget["error"].sel(source="registration", quantity="stiffness"), np.full(5, 3.0)
    )
    np.testing.assert_array_equal(budget["total"], unknown["total"])


def test_other_readings_of_the_scans_are_an_error_of_this_surface():
    _, _, unknown, _ = budget_of("two")
    assert "scan" not in unknown["source"]
    spread = {"closure": np.full(5, 0.5), "stiffness": 3.0}
    _, _, budget, _ = budget_of("two", scan_spread=spread)
    for quantity, half in (("closure", 0.5), ("stiffness", 3.0)):
        # A distance is no chance: it is added.
        expected = unknown["total"].sel(quantity=quantity) + half
        np.testing.assert_allclose(budget["total"].sel(quantity=quantity), expected)
    # Of other quantities no other reading is known, which takes nothing from their total.
    others = ["separation", "area_corrected", "delta_sigma"]
    np.testing.assert_array_equal(
        budget["total"].sel(quantity=others), unknown["total"].sel(quantity=others)
    )
    assert (budget["largest_source"].sel(quantity="closure") == "scan").all()


def test_counting_falls_as_contacts_grow_more(one):
    _, _, budget, _ = one
    counting = budget["relative_error"].sel(source="counting", quantity="area_corrected").values
    assert counting[0] > counting[-1]
    assert counting[0] <= 1.96


def test_the_plan_says_whether_the_accuracy_can_be_had(one):
    _, _, budget, plan = one
    row = plan.set_index(choice="choice").sel(choice="numerical error of the closure")
    assert "1 % reached under" in str(row["reason"].values)
    numerical = budget["relative_error"].sel(quantity="closure", source="numerical")
    refined = np.isfinite(budget["finest_spacing"])
    assert float(row["error"]) == pytest.approx(float(numerical.where(refined).max()))


# -- what lies between loads, and other windows ----------------------------------------------------


def test_a_power_law_is_interpolated_exactly():
    forces = np.array([1.0, 3.0, 10.0, 100.0])
    scale = np.array([[2.0, 3.0, 5.0, 7.0]])
    true = scale * 0.3 * forces**-0.5
    known = true.copy()
    known[0, 1] = np.nan
    np.testing.assert_allclose(over_loads(forces, known, scale), true)
    assert over_loads(forces, known, scale, 2.0)[0] == pytest.approx(true[0] * [1, 2, 1, 1])
    known[0, 3] = np.nan
    assert over_loads(forces, known, scale)[0, 3] == pytest.approx(7 * 0.3 * 10**-0.5)
    assert np.isnan(over_loads(forces, np.full((1, 4), np.nan), scale)).all()


def test_windows_have_no_holes_and_overlap_little():
    present = np.ones((60, 90), bool)
    present[50:, :20] = False
    own = (slice(20, 40), slice(30, 60))
    places, effective = window_places(present, own)
    assert places[0] == own
    assert len(places) == 5
    covered = np.zeros(present.shape, int)
    for rows, columns in places:
        assert present[rows, columns].all()
        assert present[rows, columns].shape == (20, 30)
        covered[rows, columns] += 1
    assert effective == pytest.approx(np.count_nonzero(covered) / 600)
    for i, (rows, columns) in enumerate(places):
        for other in places[:i]:
            shared = np.zeros(present.shape, int)
            shared[rows, columns] += 1
            shared[other] += 1
            assert np.count_nonzero(shared == 2) <= MAX_OVERLAP * 600


def test_composite_of_the_whole_scan_is_that_of_its_windows(one):
    loading = one[0]
    (cells,) = loading.cells
    whole = whole_composite(loading.specimen, "E", cells)
    attrs = loading.specimen.attrs
    rows, columns = (
        slice(attrs[f"window_{a}0"], attrs[f"window_{a}0"] + attrs[f"window_n{a}"]) for a in "yx"
    )
    np.testing.assert_array_equal(
        whole[rows, columns], composite_topography(loading.specimen, "E", cells)
    )
    assert np.isnan(whole[:, -cells:]).all()
    assert np.isfinite(whole[:, :-cells]).all()


def test_windows_of_a_scan_that_repeats_itself_are_alike():
    """Of a flat joint whose scan is one patch, four times."""
    patch = self_affine((24, 24), SPACING, 0.8, rms=0.1, seed=7)
    patch -= patch.mean()
    heights = np.tile(patch, (2, 2))
    specimen = make_specimen(
        scan(heights), opposite="flat", window=2.4, window_centre=(1.2, 1.2), name="tiles"
    )
    settings = resolve_settings(STUDY, "flat", {}, "budget")
    loading = JointLoading(specimen, "none", [0], settings, solver_settings({}, "budget"))
    composites, effective = other_composites(loading, 0)
    assert effective == 4
    first = loading.composite(0)
    assert len(composites) == 4
    for composite in composites:
        # Levelling has taken a common plane off; the fifth window lies across the four.
        apart = np.sort(composite, axis=None) - np.sort(first, axis=None)
        assert np.ptp(apart) < 0.2 * np.ptp(first)


def test_the_separation_of_other_windows_counts_from_their_mean_planes():
    """So that it differs between windows as their mean gaps do, whichever node stands highest."""
    loading, _, budget, _ = budget_of("pair")
    (cells,) = loading.cells
    others, effective = other_composites(loading, int(cells))
    space = loading.half_space(loading.shape)
    force = loading.forces(loading.settings.loads)[-1]
    gaps = [
        aperture(solve_contact(h, space, force=force, rtol=1e-4)).mean()
        for h in (loading.composite(int(cells)), *others)
    ]
    window = budget["error"].sel(quantity="separation", source="window")[-1]
    assert float(window) == pytest.approx(window_spread(np.array(gaps), effective), rel=0.1)


def test_spread_of_windows_is_students():
    values = np.array([1.0, 2.0, 3.0, 4.0])
    assert window_spread(values, 4.0) == pytest.approx(3.182446 * np.std(values, ddof=1))
    assert window_spread(values, 2.5) > window_spread(values, 4.0)
    assert window_spread(np.full(4, 2.0), 4.0) == 0
