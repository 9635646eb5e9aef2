"""What follows from contact states of a specimen: curves, laws, domains, dimensions, strength."""

from collections.abc import Mapping, Sequence

import xarray as xr

from ..domain.analysis import analyse_domains, scaling_over_resolutions
from ..domain.measures import measures_of_map_states
from ..mechanics.area import area_laws, joint_statistics
from ..mechanics.closure import closure_curves, elastic_dilatancy
from ..mechanics.states import combine, domains_of, force_range, map_states, with_pressure
from ..mechanics.strength import joint_strength
from ..roughness.dimension import best_dimension
from ..surface.specimen import cell_side, nominal_area, window_sides


def state_stages(
    specimens: xr.Dataset,
    surface_dimension: xr.Dataset,
    joints: xr.Dataset,
    parts: Sequence[xr.Dataset],
    settings: Mapping,
    solver: Mapping,
) -> dict[str, xr.Dataset]:
    """Stages that are computed from the contact states of one specimen.

    Parameters
    ----------
    specimens, surface_dimension, joints : xr.Dataset
        Of the stages of these names, from :func:`stages.specimen.specimen_stages`.
    parts : sequence of xr.Dataset
        Contact states, from :func:`mechanics.sweep.joint_states`.
    settings : mapping
        From :func:`study.configuration.resolve_settings`.
    solver : mapping
        From :func:`study.configuration.solver_settings`.

    Returns
    -------
    dict of str to xr.Dataset
        By stage; strength only of a joint that slides.
    """
    states, spacing = combine(parts), cell_side(specimens)
    e_star = settings["material"]["e_star"]
    curves = closure_curves(
        states,
        window_sides(specimens),
        e_star,
        force_range(settings["hyperbola_range"], specimens),
    )
    dilatancy = elastic_dilatancy(curves, joints)
    laws = area_laws(
        curves,
        joint_statistics(specimens, joints),
        e_star,
        best_dimension(surface_dimension)[0],
    )
    fields = domains_of(states)
    domains = analyse_domains(fields, spacing, fit_range=settings["box_range"])
    stages = {
        "closure": curves,
        "dilatancy": dilatancy,
        "area": laws,
        "domains": domains,
        "contact": fields,
        "scaling": scaling_over_resolutions(
            curves, domains, spacing, fit_range=settings["scaling_range"]
        ),
        "domain_measures": measures_of_map_states(map_states(parts), spacing),
    }
    if specimens.attrs["opposite"] != "flat":
        stages["strength"] = joint_strength(dilatancy, joints, specimens, settings)
    area = nominal_area(specimens)
    return {name: with_pressure(stage, area) for name, stage in stages.items()}
