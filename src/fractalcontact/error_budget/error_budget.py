"""Error budget: the error of every published quantity, split by where it comes from."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled_dataset
from ..core.labels import OF_SURFACE, REALISATIONS, TWINS, cf_attrs
from ..core.limits import MIN_NODES
from ..core.reported import states_at
from ..core.settings import StateSettings
from ..joint.joint import prefractal
from ..states.loading import JointLoading
from ..states.other_windows import MIN_EFFECTIVE, TOO_SMALL, other_composites, window_spread
from ..states.sweep import load_steps
from .counting import counting_error
from .derived import with_derived
from .ensemble_spread import ensemble_spread, position_in_band, seated_spread
from .hardness import of_the_hardest
from .refinement import (
    ABSOLUTE,
    BUDGET_QUANTITIES,
    PLACES,
    LoadCurve,
    Refinement,
    budget_values,
    chosen_loads,
    refine,
)

#: Sources of error: those of the number as a property of this surface, those of the population the
#: window is a sample of; and, in no total, the change of the surface with its resolution, what a
#: harder material would change, and what another estimator gives.
OF_POPULATION = ("counting", "window", TWINS, REALISATIONS, "registration")
#: Sources of which only the larger enters a total, as a spread over windows holds that of counting;
#: where an ensemble was solved, neither enters.
_OF_WINDOW = ("counting", "window")
SOURCES = (*OF_SURFACE, "scan", *OF_POPULATION, "resolution", "model", "estimator")

#: Factor on numerical errors that are interpolated between refined states, as chance differs from
#: state to state. With it 95 to 100 % of 100 other joints were covered, without it 68 to 92 %.
WIDENED = 2.0

_EACH, _ALL = ("quantity", "source", "normal_force"), ("quantity", "normal_force")
_UNIT = "unit of the quantity"
_TABLE = {
    "error": (_EACH, _UNIT, "error by source, half-width at 95 %"),
    "relative_error": (_EACH, "1", "error by source, fraction of the quantity"),
    "total": (_ALL, _UNIT, "error of the number for this surface, half-width at 95 %"),
    "relative_total": (_ALL, "1", "that error, fraction of the quantity"),
    "total_of_population": (
        _ALL,
        _UNIT,
        "error of the number for the whole joint that the window is cut from, half-width at 95 %",
    ),
    "relative_total_of_population": (_ALL, "1", "that error, fraction of the quantity"),
    "largest_source": (_ALL, "1", "source of the largest error of the number for this surface"),
    "largest_source_of_population": (
        _ALL,
        "1",
        "source of the error of the window: count of its contacts, other windows, or ensemble",
    ),
    "limit": (_ALL, _UNIT, "value extrapolated to zero spacing of the same surface"),
    "observed_order": (_ALL, "1", "observed order of convergence of the same surface"),
    "finest_spacing": ("normal_force", "mm", "finest spacing solved; NaN where interpolated"),
    "numerical_from": (
        "normal_force",
        "1",
        "source of the numerical error: spacings solved, or interpolation",
    ),
    "of": ("quantity", "1", "variable whose errors they are, STAGE/VARIABLE"),
    "unit": ("quantity", "1", "unit of the quantity"),
    "meaning": ("quantity", "1", "quantity"),
    "absolute": ("quantity", "1", "its errors are in its unit alone: it may be zero or negative"),
    "reason": (("quantity", "source"), "1", "why a source has no value, or is none"),
    "windows_solved": ((), "1", "windows of the scan compared, this one among them"),
    "windows_effective": ((), "1", "area that those windows cover, in windows"),
}

_FROM = {1: "interpolated between loads", 2: "s and s/2", 4: "s, s/2 and s/4"}
#: Reasons why a source does not apply to a quantity.
_NONE = {
    "estimator": "applies to Delta_sigma alone",
    "secant": "applies to stiffness where contacts yield",
}


def map_curve(
    loading: JointLoading, curves: xr.Dataset, domains: xr.Dataset, resolution: int
) -> LoadCurve:
    """The load curve at the offset of the contact maps, in one direction.

    ``loading`` is at that offset alone; ``curves`` and ``domains`` are the stages ``closure`` and
    ``domains``.
    """
    (cells,) = loading.cells
    (offset,) = loading.offsets
    place = {"direction": loading.direction, "offset": offset, "resolution": resolution}
    stages = [states_at(stage, **place) for stage in (curves, domains)]
    composite = prefractal(loading.composite(int(cells)), resolution)
    # Against a plane there is no mated position; distances count from the mean plane.
    mated = loading.composite(0)
    mated = mated.max() if loading.slides else mated.mean()
    return LoadCurve(loading, composite, float(mated), resolution, *stages)


def error_budget(
    loading: JointLoading[StateSettings],
    curves: xr.Dataset,
    domains: xr.Dataset,
    *,
    registration_spread: Mapping[str, ArrayLike] | None = None,
    scan_spread: Mapping[str, ArrayLike] | None = None,
    ensemble: xr.Dataset | None = None,
) -> xr.Dataset:
    """Errors of closure, separation, area, stiffness and Delta_sigma at the map offset, by source.

    ``loading`` is in the first direction of contact, at the offset of the contact maps alone;
    ``curves`` and ``domains`` are the stages ``closure`` and ``domains``. ``registration_spread``
    has by quantity half-widths (normal_force,) of the spread over registrations of two scanned
    faces that are statistically as good, in the quantity's unit; ``scan_spread`` likewise has the
    errors of two scans, a source "scan" of this surface, which may hold those of registration. The
    stage ``ensemble``, twins of a scan or realisations of an embedded specimen, is a source of its
    own, in place of counting and windows in the total of the population.

    The variables of :data:`_TABLE` over (quantity, source, normal_force), and those of
    :func:`derived.with_derived`; with twins ``within_twins`` (quantity, normal_force). Raises
    `NotConverged` if a state on a finer grid, or of another window, could not be verified.

    All errors are half-widths of intervals of about 95 %. The sources are independent: totals are
    root sums of squares, but for the scan: a distance of readings is no chance and is added. A
    spread over windows holds that of counting: only the larger enters.
    """
    finest = int(curves["resolution"].min())
    curve = map_curve(loading, curves, domains, finest)
    accuracy = loading.solver.accuracy
    refinement = refine(curve, loading.settings, None if accuracy is None else accuracy["closure"])
    values = curve.values()
    windows, n_windows, effective = _window_spread(curve)
    hardest = of_the_hardest(curve)
    errors = {
        "solver": _solver(curve),
        "numerical": over_loads(curve.forces, refinement.error, _scale(curve), WIDENED),
        "counting": counting_error(curve),
        "window": over_loads(curve.forces, windows, _scale(curve)),
        "registration": curve.over_quantities(**(registration_spread or {})),
        "resolution": _resolution(loading, curves, domains, curve),
        "model": np.abs(hardest["hardest"][1] - values),
        "secant": _secant(curve),
        "estimator": _estimator(curve),
    }
    if scan_spread is not None:
        errors["scan"] = curve.over_quantities(**scan_spread)
    if ensemble is not None:
        spread = ensemble_spread(curve, ensemble)
        errors[ensemble.attrs["members"]] = over_loads(curve.forces, spread, _scale(curve))
    errors = {source: errors[source] for source in SOURCES if source in errors}
    reasons = _reasons(curve, errors, refinement, effective, registration_spread is not None)
    budget = _budget(curve, values, errors, refinement, reasons, (n_windows, effective))
    sampling = _seated_sampling(curve, ensemble, registration_spread, scan_spread)
    of_scan = None if scan_spread is None else scan_spread.get("seated_closure", np.nan)
    budget = with_derived(budget.assign(hardest), curve, sampling, of_scan)
    if ensemble is not None and TWINS in errors:
        words = cf_attrs("1", "position of the scan relative to the 95 % band of its twins")
        budget["within_twins"] = (_ALL, position_in_band(curve, ensemble), words)
    return budget


def _budget(curve, values, errors, refinement, reasons, windows) -> xr.Dataset:
    """The dataset from its parts."""
    by_source = np.stack(list(errors.values()), axis=1)
    total = np.sqrt(sum(errors[source] ** 2 for source in OF_SURFACE))
    of_surface: tuple[str, ...] = OF_SURFACE
    if "scan" in errors:
        # No other reading of Delta_sigma is known. A quantity that another reading lacks under
        # some loads has no total there.
        is_read = np.isfinite(errors["scan"]).any(axis=1, keepdims=True)
        # A distance of readings is no chance: where another one is right, this one is off by all of
        # it and by its other errors.
        total = total + np.where(is_read, errors["scan"], 0.0)
        of_surface = (*OF_SURFACE, "scan")
    sampling = np.fmax(errors["counting"], errors["window"])
    largest = _largest(errors, _OF_WINDOW)
    for members in (TWINS, REALISATIONS):
        if members in errors:
            finite = np.isfinite(errors[members])
            sampling = np.where(finite, errors[members], sampling)
            largest = np.where(finite, members, largest)
    if curve.loading.specimen.attrs["opposite"] == "scanned":
        # What the source scan holds already is not counted twice.
        scan = np.nan_to_num(errors.get("scan", 0.0))
        beyond = np.sqrt(np.maximum(errors["registration"] ** 2 - scan**2, 0.0))
        sampling = np.hypot(sampling, beyond)
    of_population = np.hypot(total, sampling)
    absolute = np.isin(list(BUDGET_QUANTITIES), ABSOLUTE)
    size = np.abs(np.where((values == 0) | absolute[:, np.newaxis], np.nan, values))
    side = float(np.sqrt(curve.space.cell_area))
    n_windows, effective = windows
    table: dict[str, Any] = {
        "error": by_source,
        "relative_error": by_source / size[:, np.newaxis],
        "total": total,
        "relative_total": total / size,
        "total_of_population": of_population,
        "relative_total_of_population": of_population / size,
        "largest_source": _largest(errors, of_surface),
        "largest_source_of_population": largest,
        "limit": refinement.limit,
        "observed_order": refinement.order,
        "finest_spacing": np.where(refinement.finest > 1, side / refinement.finest, np.nan),
        "numerical_from": [
            _FROM[n] if refinement.finest.max() > 1 else "" for n in refinement.finest
        ],
        "of": [PLACES[name] for name in BUDGET_QUANTITIES],
        "unit": [unit for unit, _ in BUDGET_QUANTITIES.values()],
        "meaning": [words for _, words in BUDGET_QUANTITIES.values()],
        "absolute": absolute,
        "reason": reasons,
        "windows_solved": n_windows,
        "windows_effective": effective,
    }
    coords = {
        "quantity": list(BUDGET_QUANTITIES),
        "source": list(errors),
        "normal_force": curve.curve["normal_force"],
    }
    attrs = {
        "direction": curve.loading.direction,
        "offset_mm": float(curve.loading.offsets[0]),
        "resolution": curve.resolution,
    }
    budget = labelled_dataset(_TABLE, table, coords, attrs)
    for name, words in (("quantity", "published quantity"), ("source", "source of error")):
        budget[name].attrs = cf_attrs("1", words)
    return budget


def _largest(errors: Mapping[str, np.ndarray], sources: Sequence[str]) -> np.ndarray:
    """Source of the largest error (quantity, normal_force); empty where no error is known.

    The first of equal ones.
    """
    by_source = np.stack([errors[source] for source in sources])
    largest = np.argmax(np.where(np.isnan(by_source), -np.inf, by_source), axis=0)
    return np.where(np.isnan(by_source).all(axis=0), "", np.array(sources)[largest])


def over_loads(
    forces: np.ndarray, errors: np.ndarray, scale: np.ndarray, widened: float = 1.0
) -> np.ndarray:
    """Errors (quantity, n) under all loads, from those under some: their fractions interpolated.

    Errors are NaN under other loads, and fractions of ``scale`` (quantity, n); forces (n,), N,
    ascend. The logarithm of the fraction is linear in that of the force between loads that are
    known; beyond them the fraction is that of the last. Interpolated errors are multiplied by
    ``widened``.
    """
    filled = errors.copy()
    for row, error, size in zip(filled, errors, np.abs(scale), strict=True):
        with np.errstate(all="ignore"):
            fraction = np.log(np.maximum(error / size, np.finfo(float).tiny))
        finite = np.isfinite(error) & np.isfinite(fraction)
        if finite.any():
            between = np.exp(np.interp(np.log(forces), np.log(forces[finite]), fraction[finite]))
            row[~finite] = widened * (between * size)[~finite]
    return filled


def _scale(curve: LoadCurve) -> np.ndarray:
    """Scale of interpolated errors: the values, and of separations their length."""
    # A separation may be zero; the length over which the pressure falls by e never is.
    length = curve.over_quantities(separation=curve.decay_length())
    is_separation = np.array(list(BUDGET_QUANTITIES)) == "separation"
    return np.where(is_separation[:, np.newaxis], length, curve.values())


def _solver(curve: LoadCurve) -> np.ndarray:
    """Solver error bounds, as the stages state them."""
    states = curve.curve
    stiffness = states["interface_stiffness_error"] - states["interface_stiffness_scatter"]
    return curve.over_quantities(
        closure=states["interface_closure_error"].values,
        separation=states["closure_error"].values,
        area_corrected=states["area_corrected_error"].values,
        stiffness=stiffness.values,
        delta_sigma=curve.domains["delta_sigma_error"].values,
    )


def _estimator(curve: LoadCurve) -> np.ndarray:
    """Distance of the ordinary box-counting slope; only Delta_sigma has estimators to choose."""
    distance = curve.domains["delta_sigma_ordinary"] - curve.domains["delta_sigma"]
    return curve.over_quantities(0.0, delta_sigma=np.abs(distance.values))


def _secant(curve: LoadCurve) -> np.ndarray:
    """Scatter of the secant that stands for the slope of a yielding contact."""
    scatter = curve.curve["interface_stiffness_scatter"].values
    return curve.over_quantities(0.0, stiffness=np.nan_to_num(scatter))


def _window_spread(curve: LoadCurve) -> tuple[np.ndarray, int, float]:
    """Spread over other windows under some loads, how many windows, and the area they cover."""
    loading, values = curve.loading, curve.values()
    spread = np.full(values.shape, np.nan)
    composites, effective = other_composites(loading, int(loading.cells[0]))
    places = chosen_loads(curve, loading.settings.drawn_loads)
    limits = loading.settings.box_range
    if not composites:
        return spread, 1, effective
    of_windows = np.full((len(composites) + 1, *values.shape), np.nan)
    of_windows[0] = values
    # The mean plane of each window is its datum, as for registrations: the highest node of its
    # mated faces differs between windows by more than their gaps do.
    separation = list(BUDGET_QUANTITIES).index("separation")
    of_windows[0, separation] += curve.reference - curve.composite.mean()
    for i, whole in enumerate(composites, 1):
        composite = prefractal(whole, curve.resolution)
        datum = float(composite.max()), float(composite.mean())
        states = load_steps(
            composite, curve.space, curve.forces[places], loading.solving, f"{curve.where}, windows"
        )
        for place, state in zip(places, states, strict=True):
            of_windows[i, :, place] = budget_values(state, *datum, limits)
    spread[:, places] = window_spread(of_windows[:, :, places], effective)
    return spread, len(of_windows), effective


def _seated_sampling(curve, ensemble, registration, scan) -> np.ndarray:
    """Sampling and registration error of the closure from the seat (normal_force), mm.

    NaN without an ensemble: neither counts nor windows tell how much two separations share.
    """
    if ensemble is None:
        return np.full(len(curve.forces), np.nan)
    scale = curve.curve["seated_closure"].values[np.newaxis]
    (half,) = over_loads(curve.forces, seated_spread(curve, ensemble)[np.newaxis], scale)
    if curve.loading.specimen.attrs["opposite"] == "scanned":
        moved = (registration or {}).get("seated_closure", np.nan)
        beyond = np.square(moved) - np.nan_to_num((scan or {}).get("seated_closure", 0.0)) ** 2
        half = np.hypot(half, np.sqrt(np.maximum(beyond, 0.0)))
    return half


def _resolution(loading, curves, domains, curve: LoadCurve) -> np.ndarray:
    """Change from twice the spacing: of another surface, its every second node."""
    coarse = 2 * curve.resolution
    if coarse not in curves["resolution"]:
        return curve.over_quantities()
    coarser = map_curve(loading, curves, domains, coarse)
    return np.abs(coarser.values() - curve.values())


def _reasons(curve, errors, refinement: Refinement, effective, registered: bool) -> np.ndarray:
    """Reason why a source has no value, (quantity, source)."""
    scanned = curve.loading.specimen.attrs["opposite"] == "scanned"
    missing = {
        "solver": "not stated for these states",
        "numerical": "the grid is too large to refine, or the faces are flush"
        if refinement.finest.max() == 1
        else "not resolved at any load refined",
        "secant": "no slope at any load",
        "scan": "not known of this quantity",
        "estimator": "no other estimate at any load",
        "counting": f"fewer than {MIN_NODES} nodes, or no stiffness, at any load",
        "window": TOO_SMALL
        if effective < MIN_EFFECTIVE
        else "no value in every window at any load",
        TWINS: "not in every twin at any load",
        REALISATIONS: "not in every realisation at any load",
        "registration": "no spread of registrations is known"
        if scanned
        else "only one face was scanned",
        "resolution": "twice the spacing is not solved",
        "model": "elastic contact: no hardness is stated",
    }
    if scanned and registered:
        missing["registration"] = "not known of this quantity"
    reasons = np.full((len(BUDGET_QUANTITIES), len(errors)), "", object)
    for i in range(len(BUDGET_QUANTITIES)):
        for j, (source, error) in enumerate(errors.items()):
            if not np.isfinite(error[i]).any():
                reasons[i, j] = missing[source]
            elif source in _NONE and not error[i].any():
                reasons[i, j] = _NONE[source]
    return reasons.astype(str)
