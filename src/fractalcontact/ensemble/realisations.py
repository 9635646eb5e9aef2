"""Contact of an ensemble: realisations of an embedded specimen, or twins of a scan.

They differ in their seed alone. What one specimen shows may be its own. What is said of specimens
of a kind is said of the ensemble: of its mean, whose interval tells how well it is known, and of
its spread. Twins of a scan judge nothing; their spread is the population error of its numbers.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.datasets import labelled, labelled_dataset, titled
from ..core.labels import REALISATIONS, TWINS, cf_attrs
from ..core.limits import RESOLVED_NODES
from ..core.settings import EnsembleSettings, Solver
from ..core.window import cell_side, window_sides
from ..domain.analysis import corrected_scaling
from ..domain.box_dimension import dimension_of_domain
from ..domain.isotropy import interval_dimensions
from ..domain.null_models import OCTAVES
from ..domain.random_nodes import expected_dimension
from ..laws.closure import interface_states
from ..size_effect.division import solvable_parts, spread_windows
from ..size_effect.laws import RANDOM_VOID
from ..size_effect.size_exponents import of_usable_sizes, size_exponent
from ..size_effect.size_law import WINDOW_QUANTITIES
from ..size_effect.windows import solved_windows
from ..states.loading import JointLoading
from ..states.seat import closure_from, seat_of
from ..states.states import MAP_GAP, forces_of, with_pressure
from ..states.sweep import contact_states
from ..surface.embedded import embedded_surface
from ..surface.specimen import make_specimen, window_arguments
from .null_slopes import NULL_SLOPES, null_slopes
from .sliding import LAG_ENDS, SLIDING, sliding, spread_offsets
from .statistics import add_statistics, add_trends
from .twins import doubt_of_twins, twin_loadings

#: Sub-windows along a side of the window, and how many of each size are solved.
PARTS, MAX_WINDOWS = (1, 2, 4), 4

#: Numbers of every realisation under every load, named as in the stages of the specimen that the
#: ensemble stands for: unit, long name.
STATES = {
    "nodes": ("1", "nodes in contact"),
    "interface_closure": ("mm", "interface closure w_int = w - w_b, from first touch"),
    "mean_gap": ("mm", "mean gap of the window"),
    "area_corrected_share": ("1", "real contact area A_r / A_0, corrected for the perimeter"),
    "interface_stiffness": ("MPa/mm", "tangent stiffness d sigma_0 / d w_int of the interface"),
    "delta_sigma": ("1", "Delta_sigma from box counting"),
    "delta_sigma_random": ("1", "Delta_sigma expected of as many random nodes over the same boxes"),
    "delta_sigma_area": ("1", "Delta_sigma from the contact area over resolutions"),
    "area_bend": (
        "1",
        "Delta_sigma from the area of the two finest resolutions less that of the two coarsest",
    ),
    "difference": ("1", "Delta_sigma from area less that from box counting"),
}
#: Numbers of every realisation under the reference load: unit, long name.
ISOTROPY = {
    "interval_difference": (
        "1",
        "exponent of occupied intervals across sliding less that along it",
    ),
}
#: Closure from one load at which all realisations are resolved, so that they can be compared.
_SEATED = "closure_from_common_seat"

#: Exponent of the corrected area less that of eq. 6: Delta_sigma that eq. 6 takes, and its words.
_EQ6 = {
    "eq6_area": ("delta_sigma_area", "A_r(s)"),
    "eq6_box": ("delta_sigma", "boxes"),
}

#: Exponents of every realisation against the size of sub-windows under the reference load: quantity
#: of the sub-windows, fewest nodes of each, what it is.
EXPONENTS = {
    exponent: ({"area_fraction": "corrected_area_share"}.get(name, name), fewest, words)
    for name, (exponent, fewest, words) in WINDOW_QUANTITIES.items()
} | {
    "closure_exponent": ("interface_closure", RESOLVED_NODES, "interface closure from first touch"),
    "roughness_exponent": ("sigma_z", RESOLVED_NODES, "rms height about the own plane"),
    "void_exponent": ("largest_void", RESOLVED_NODES, "largest void"),
    "random_void_exponent": ("random_void", RESOLVED_NODES, RANDOM_VOID),
}


@titled("realisations of an embedded specimen or twins of a scan, their mean and spread")
def ensemble(
    specimens: xr.Dataset,
    joints: xr.Dataset,
    recipe: Mapping | None,
    realisations: int,
    settings: EnsembleSettings,
    solver: Solver,
) -> xr.Dataset:
    """Contact of realisations of a specimen, in the reported direction and offset.

    The named specimen is the first realisation of its recipe, which
    :func:`study.configuration.resolve_embedded` gives; the realisations have its seed and those
    that follow it, and none is chosen. Without a recipe they are twins of a scan, of seeds from 1.
    The attribute ``members`` says what they are, ``doubt`` why first touch and dilatancy of twins
    mean little; it is empty where nothing says so.

    :data:`STATES`, ``closure_from_common_seat`` and :data:`ensemble.null_slopes.NULL_SLOPES` are
    over (realisation, normal_force): under the first load at the seat, the loads that figures draw
    and the heaviest. Over (realisation,) stand :data:`EXPONENTS` under the reference load and the
    trends of :func:`ensemble.statistics.add_trends`; over both, by how much eq. 6 is missed,
    ``eq6_area`` and ``eq6_box``; of realisations of a joint that slides
    :data:`ensemble.sliding.SLIDING`. Of each there are the mean over the realisations with its
    interval and the spread, as :func:`ensemble.statistics.add_statistics` names them.

    Raises `NotConverged`, whose message names the realisation, and `InputError` as
    :func:`ensemble.twins.twin_loadings`.
    """
    whole = JointLoading.of_joint(
        specimens, joints, settings.contact_directions[0], settings, solver
    )
    loading = replace(whole, settings=_light(settings, whole.area)).at_map_offset()
    seeds = (1 if recipe is None else recipe["seed"]) + np.arange(realisations)
    members = _members(loading, recipe, [int(seed) for seed in seeds])
    slides = recipe is not None and whole.slides
    longest = float(joints["lag_max"].max())
    rows = []
    for member in members:
        slid = [sliding(member.at(spread_offsets(whole.cells)), longest)] if slides else []
        rows.append(xr.merge([_realisation(member), *slid]))
    result = xr.concat(rows, "realisation")
    for name in result.data_vars:
        result[name].attrs = rows[0][name].attrs
    for name in (*OCTAVES, *(LAG_ENDS if slides else ())):
        result[name] = rows[0][name]
    _add_seated_closure(result, settings.seating_pressure * whole.area)
    result["seed"] = ("realisation", seeds, cf_attrs("1", "seed of the synthesis"))
    _add_eq6(result)
    add_trends(result)
    names = [*STATES, *NULL_SLOPES, _SEATED, *EXPONENTS, *_EQ6, *ISOTROPY]
    add_statistics(result, names + (list(SLIDING) if slides else []))
    return with_pressure(result, whole.area).assign_attrs(
        members=REALISATIONS if recipe is not None else TWINS,
        doubt="" if recipe is not None else doubt_of_twins(loading),
        direction=loading.direction,
        offset=float(loading.offsets[0]),
        map_load=_reference(loading),
    )


def _light(settings: EnsembleSettings, area: float) -> EnsembleSettings:
    """Settings with the loads of the ensemble alone, as forces, sub-windows under one."""
    forces = forces_of(settings.loads, area)
    seat = float(seat_of(forces, settings.seating_pressure * area))
    wanted = {seat, *forces_of(settings.drawn_loads, area), forces[-1]}
    return replace(
        settings,
        # All loads of the study may be lighter than the seat, which is NaN then.
        loads=[(float(force), "force") for force in sorted(filter(np.isfinite, wanted))],
        dilatancy_loads=[settings.map_load],
    )


def _add_seated_closure(result: xr.Dataset, seat: float) -> None:
    """Closure from the first load, N, at or above ``seat`` that resolves every realisation."""
    forces, closing = result["normal_force"].values, result["interface_closure"]
    resolved = (result["nodes"] >= RESOLVED_NODES).all("realisation").values
    seated = closure_from(closing.values, forces, float(seat_of(forces, seat, resolved)))
    attrs = cf_attrs("mm", "interface closure from the first load at which all have ten nodes on")
    result[_SEATED] = closing.dims, seated, attrs


def _add_eq6(result: xr.Dataset) -> None:
    """Exponent of the corrected area less Delta_sigma - 2 of the same window, into ``result``."""
    for name, (dimension, by) in _EQ6.items():
        words = f"exponent of corrected A_r/A_0 against b less Delta_sigma - 2 of eq. 6 by {by}"
        residual = result["area_exponent"] - (result[dimension] - 2)
        result[name] = residual.assign_attrs(cf_attrs("1", words))


def _members(
    loading: JointLoading[EnsembleSettings], recipe: Mapping | None, seeds: list[int]
) -> Iterator[JointLoading[EnsembleSettings]]:
    """Loadings of the realisations of a recipe, or of the twins of a scan."""
    if recipe is None:
        yield from twin_loadings(loading, seeds)
        return
    for seed in seeds:
        specimen = _realised(loading.specimen, {**recipe, "seed": seed}, loading.settings)
        yield replace(loading, specimen=specimen)


def _realised(specimens: xr.Dataset, recipe: Mapping, settings: EnsembleSettings) -> xr.Dataset:
    """Specimen made from a recipe, cleaned and cut as the study's own specimen is."""
    spacing = {key: specimens.attrs[key] for key in ("spacing_y", "spacing_x")}
    lower = specimens["lower"].copy(data=embedded_surface(recipe)).assign_attrs(spacing)
    name = f"{specimens.attrs['name']}, realisation of seed {recipe['seed']}"
    return make_specimen(lower, name=name, judged=False, **window_arguments(settings))


def _realisation(loading: JointLoading[EnsembleSettings]) -> xr.Dataset:
    """:data:`STATES` over the loads, and :data:`EXPONENTS`, of one realisation."""
    settings, spacing = loading.settings, cell_side(loading.specimen)
    map_cells = int(loading.cells[0])
    states = contact_states(loading, settings.resolutions, map_cells=map_cells, lightly=True)
    curves = interface_states(states, window_sides(loading.specimen), settings.material.e_star)
    finest = min(settings.resolutions)
    place = {"direction": loading.direction, "offset": loading.offsets[0], "resolution": finest}
    touching = states[f"in_contact_{finest}"].sel(direction=loading.direction).values[0]
    solved = states["solved"].sel(place).values
    cell, fitted = spacing * finest, settings.box_range
    boxes = [
        dimension_of_domain(domain, cell, fit_range=fitted).value if is_solved else np.nan
        for domain, is_solved in zip(touching, solved, strict=True)
    ]
    scaling = corrected_scaling(curves, spacing, fit_range=settings.scaling_range)
    scaling = scaling.sel({dim: place[dim] for dim in ("direction", "offset")})
    by_area = scaling["delta_sigma"].values
    values = {
        "mean_gap": states[MAP_GAP].mean(states[MAP_GAP].dims[1:]).values,
        "delta_sigma": boxes,
        "delta_sigma_random": [
            expected_dimension(domain, cell, fit_range=fitted) for domain in touching
        ],
        "delta_sigma_area": by_area,
        "area_bend": scaling["area_bend"].values,
        "difference": by_area - np.array(boxes),
    }
    for name in STATES.keys() - values.keys():
        values[name] = curves[name].sel(place).values
    table = {name: ("normal_force", *words) for name, words in STATES.items()}
    result = labelled_dataset(table, values, coords={"normal_force": curves["normal_force"]})
    composite = loading.composite(map_cells)[::finest, ::finest]
    slopes = null_slopes(touching, composite, cell, fit_range=fitted)
    reference = int(np.argmin(np.abs(result["normal_force"].values - _reference(loading))))
    sides = tuple(loading.spacing * finest)
    along, across = interval_dimensions(touching[reference], sides, loading.direction)
    of_domain = {name: ((), *words) for name, words in ISOTROPY.items()}
    isotropy = labelled(of_domain, {"interval_difference": across.value - along.value})
    return result.merge(slopes).assign(isotropy | _size_exponents(loading))


def _reference(loading: JointLoading[EnsembleSettings]) -> float:
    """Reference load, N."""
    return float(loading.forces([loading.settings.map_load])[0])


def _size_exponents(loading: JointLoading[EnsembleSettings]) -> dict:
    """Exponents of one realisation against the size of its sub-windows, as variables."""
    parts = solvable_parts(PARTS, loading.shape)
    windows = solved_windows(loading, parts, MAX_WINDOWS).isel(offset=0, normal_force=0)
    windows = windows.transpose("part", "window", ...)
    places = [spread_windows(n, MAX_WINDOWS) for n in parts]
    table, values = {}, {}
    for exponent, (name, fewest, words) in EXPONENTS.items():
        counted = windows[[name, "nodes"]]
        if name == "corrected_area_share":
            counted = counted.where(windows["occupied"] != 0)
        usable = of_usable_sizes(counted[name].values, counted["nodes"].values, fewest)
        values[exponent] = size_exponent(parts, windows["side"].values, usable, places).value
        table[exponent] = ((), "1", f"exponent of {words} against b at equal sigma_0")
    return labelled(table, values)
