"""Results derived from contact states of a specimen: curves, laws, domains, errors."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from ..core.datasets import titled
from ..core.labels import cf_attrs
from ..core.reported import Reported, states_at
from ..core.settings import Solver, StateSettings
from ..core.tolerance import ACCURACY
from ..core.units import share_of
from ..core.window import cell_side, nominal_area, window_sides
from ..domain.analysis import analyse_domains, scaling_over_resolutions
from ..domain.measures import measures_of_map_states
from ..domain.null_models import beside_domains, nulls_of_map_states
from ..domain.renormalisation import extrapolated_pressure
from ..error_budget.closure_constants import closure_constants
from ..error_budget.elimination import elimination_alone
from ..error_budget.error_budget import error_budget
from ..error_budget.solve_plan import solve_plan
from ..error_budget.two_scans import (
    reading_values,
    registration_spread,
    registration_values,
    scan_spread,
    wider_spread,
)
from ..joint.openings import prefractal_openings
from ..joint.overlap import node_marks
from ..laws.area import area_laws, joint_statistics
from ..laws.branches import joint_branches
from ..laws.closure import closure_curves, elastic_dilatancy, full_contact_warning
from ..laws.contact_strength import SAMPLED_BY
from ..laws.reference_states import reference_stiffness
from ..laws.scan_errors import load_warning
from ..laws.slid_variants import slid_variants
from ..registration.registration_scatter import stored_motions
from ..roughness.plane_spectrum import amplitude_error
from ..roughness.recommended import best_dimension
from ..scan.other_readings import other_readings
from ..states.contact_fields import contact_fields
from ..states.left_out import left_of_fields
from ..states.loading import JointLoading
from ..states.states import (
    DIP,
    chosen_offset,
    combine,
    contact_domains,
    force_range,
    forces_of,
    map_states,
    with_pressure,
)


@titled(
    closure="closure curves, stiffness, real contact area",
    dilatancy="rigid and elastic dilatancy",
    area="laws of the real contact area, and the classical theories beside it",
    domains="box counts, Delta_sigma and clusters of the contact domains",
    contact="contact domains",
    scaling="renormalisation over resolutions",
    domain_measures="lacunarity and generalised dimensions of the contact at the map offset",
    branches="closure of loading, unloading and reloading, at the reported offset",
    choices="solve plan: states solved, accuracy, reasons, and resulting errors",
    error_budget="error of the published quantities, split by source",
)
def state_stages(
    specimens: xr.Dataset,
    surface_dimension: xr.Dataset,
    joints: xr.Dataset,
    parts: Sequence[xr.Dataset],
    settings: StateSettings,
    solver: Solver,
    ensemble: xr.Dataset | None = None,
) -> dict[str, xr.Dataset]:
    """Stages that are computed from the contact states of one specimen, by name.

    ``parts`` are contact states from :func:`states.sweep.joint_states`; ``ensemble`` is the stage
    of this name, of twins of a scan or of realisations. The branches and the error budget solve
    some states again.
    """
    states, maps = combine(parts), map_states(parts)
    spacing, area = cell_side(specimens), nominal_area(specimens)
    e_star = settings.material.e_star
    curves = closure_curves(
        states,
        window_sides(specimens),
        e_star,
        force_range(settings.hyperbola_range, specimens),
        openings=prefractal_openings(
            specimens, joints, [int(k) for k in states["resolution"].values]
        ),
        seating_pressure=settings.seating_pressure,
    )
    reported = _reported(curves, settings, area)
    warnings = (load_warning(curves, reported), full_contact_warning(curves))
    curves.attrs["warning"] = "; ".join(filter(None, warnings))
    curves.update(reported.variables())
    joint = JointLoading.of_joint(specimens, joints, reported.direction, settings, solver)
    loading = joint.at_map_offset()
    dilatancy = elastic_dilatancy(curves, joints)
    if DIP in states:
        finest = {"resolution": states["resolution"].min()}
        dips = states[DIP].where(curves["resolved"]).sel(finest, drop=True)
        dips = dips.assign_attrs(states[DIP].attrs)
        dilatancy[DIP] = dips.rename(direction="contact_direction")
    laws = area_laws(
        curves,
        joint_statistics(specimens, joints),
        e_star,
        best_dimension(surface_dimension).value,
        settings.map_offset,
    )
    fields = contact_domains(states)
    counts = analyse_domains(fields, spacing, fit_range=settings.box_range)
    nulls = nulls_of_map_states(maps, spacing, joints["composite"], settings.box_range)
    counts = beside_domains(counts, nulls)
    if DIP in dilatancy:
        dilatancy.update(_of_sampling(counts, joints["composite"], loading))
    left = left_of_fields(fields)
    fitted = settings.scaling_range
    scaling = scaling_over_resolutions(curves, counts, spacing, left=left, fit_range=fitted)
    stages = {
        "closure": curves,
        "dilatancy": dilatancy,
        "area": laws,
        "domains": counts,
        "contact": contact_fields(fields, parts, joints, settings, area).assign(
            node_marks(specimens, joints)
        ),
        "scaling": scaling.merge(extrapolated_pressure(scaling, float(np.sqrt(area)))),
        "domain_measures": measures_of_map_states(maps, spacing),
    }
    stages = {name: with_pressure(stage, area) for name, stage in stages.items()}
    # Some states are solved again, on finer grids and on unloading, in the reported direction.
    if joint.slides:
        variants = slid_variants(joint, reported.force)
        stages["dilatancy"] = stages["dilatancy"].assign(variants)
    stated = reference_stiffness(loading, stages["closure"], maps)
    stages["closure"] = stages["closure"].assign(stated)
    budget = reported_budget(loading, stages, reported, ensemble)
    plan = solve_plan(stages["closure"], stages["dilatancy"], solver, budget)
    return stages | {
        "branches": joint_branches(loading, stages["closure"], maps),
        "error_budget": with_pressure(budget, area).merge(elimination_alone(loading)),
        "choices": plan.assign(requested_accuracy(solver)),
    }


def reported_budget(
    loading: JointLoading[StateSettings],
    stages: Mapping[str, xr.Dataset],
    reported: Reported,
    ensemble: xr.Dataset | None = None,
) -> xr.Dataset:
    """Error budget at the reported state, with the errors of two scans where there are two.

    Other readings of the scans and other registrations are solved at the finest resolution, as the
    numbers are whose errors they show, and count closure from the same seat.
    """
    curve, factor = reported.states(stages["closure"]), reported.resolution
    seat = float(curve["seating_pressure"]) * loading.area
    forces = curve["normal_force"].values
    readings = motions = of_scans = of_motions = None
    if other_readings(loading.specimen):
        readings = reading_values(loading, factor=factor)
        of_scans = scan_spread(readings, forces, seat)
    if stored_motions(loading.specimen):
        motions = registration_values(loading, factor=factor)
        of_motions = registration_spread(motions, forces, seat)
    budget = error_budget(
        loading,
        stages["closure"],
        stages["domains"],
        registration_spread=of_motions,
        scan_spread=wider_spread(of_scans, of_motions),
        ensemble=ensemble,
    )
    seating = loading.settings.seating_pressure
    return budget.assign(closure_constants(curve, seating, readings, motions))


def requested_accuracy(solver: Solver) -> dict[str, tuple]:
    """Requested error of the closure, as ``xr.Dataset`` takes it.

    A study that solves all states at full cost requests none: the usual error stands for it.
    """
    accuracy = solver.accuracy or {"closure": share_of(ACCURACY["closure"])}
    words = cf_attrs("1", "requested error of the closure, a fraction")
    return {"closure_accuracy": ((), accuracy["closure"], words)}


def _reported(curves: xr.Dataset, settings: StateSettings, area: float) -> Reported:
    """States that the study publishes."""
    return Reported.choose(
        curves,
        direction=str(settings.contact_directions[0]),
        offset=chosen_offset(settings.map_offset, curves["offset"].values),
        loads=forces_of(settings.dilatancy_loads, area),
        reference=float(forces_of([settings.map_load], area)[0]),
    )


def _of_sampling(
    counts: xr.Dataset, composites: xr.DataArray, loading: JointLoading
) -> dict[str, xr.DataArray]:
    """Variables of :data:`laws.contact_strength.SAMPLED_BY`; the amplitude is at one offset."""
    clusters = counts["clusters"].sel(resolution=counts["resolution"].min(), drop=True)
    clusters = clusters.rename(direction="contact_direction")
    (offset,) = loading.offsets
    composite = states_at(composites, offset=offset).values
    try:
        amplitude = amplitude_error(composite, tuple(loading.spacing))
    except ValueError:  # flush faces have no waves
        amplitude = 0.0
    values = {"contact_clusters": clusters, "amplitude_error": xr.DataArray(amplitude)}
    return {name: values[name].assign_attrs(cf_attrs(*SAMPLED_BY[name])) for name in SAMPLED_BY}
