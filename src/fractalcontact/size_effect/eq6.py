"""The direct test of eq. 6 on sub-windows of one joint: at equal sigma_0, and at equal sigma*.

The well-conditioned form comes first: the contact of windows of all sizes at one nominal pressure,
see :mod:`size_effect.size_law`. Then eq. 6's own form. Both are judged by one rule,
:mod:`size_effect.size_verdict`.

Eq. 6 has a joint of side b reach a given sigma* at the nominal pressure sigma_0 ~ b^-(2 - Delta).
Here windows of several sizes are cut from one joint, the pressure at which each has the sigma* of
the whole window is found, and its slope over b is compared with Delta_sigma by each estimator.

What the test comes to: sigma* = F / H_D with H_D the geometric mean of N_n s_n^Delta over the
resolutions. With one Delta and the same resolutions for all windows, as eq. 6 needs them, the
powers of s_n are the same constant everywhere: equal sigma* is equal real mean pressure sigma_n,
whatever Delta is. So one slope is measured, in which Delta does not occur; the estimators differ
in what they predict for it. And where the real area goes with the load alone, A_r = kappa F,
sigma_n is the same at any sigma_0: sigma* then does not determine sigma_0, and no b can come in. A
size effect appears just where the fraction of the window in contact at a given sigma_0 depends on
b. With m = d ln sigma* / d ln sigma_0 (``sensitivity``) a slope e at equal sigma* is an exponent
m e of A_r/A_0 at equal sigma_0: both forms want the same number only where m is 1, as in dilations
of one contact set, and 1/m is the condition number of the own form.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr
from scipy import special

from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.labels import cf_attrs
from ..core.limits import CONFIDENCE
from ..core.settings import WindowSettings
from ..core.verdicts import AGREES, DECIDED, NOT_TESTED
from ..core.window import cell_side
from ..domain.analysis import corrected_scaling
from ..domain.box_dimension import dimension_of_domain
from ..domain.renormalisation import MIN_NODES_PER_RESOLUTION
from ..states.loading import JointLoading
from .division import divisions, split
from .load_ladder import OF_WINDOWS, solve_sub_windows, whole_areas
from .prediction import predict_whole
from .size_law import size_law
from .size_verdict import size_verdicts
from .slope import slopes_at_equal_star

#: Estimators of Delta_sigma in the whole window under each load: its area over resolutions, boxes
#: of all sizes at its finest resolution, and the number of sub-windows that its contact domain
#: occupies, which are boxes too, but of the sizes of the test alone.
DELTA_SIGMA_ESTIMATORS = {
    "area": "A_r(s)",
    "box": "box counting",
    "box_sizes": "occupied windows",
}

#: Estimators that captions quote.
_QUOTED = {name: DELTA_SIGMA_ESTIMATORS[name] for name in ("area", "box")}


def size_test(loading: JointLoading[WindowSettings]) -> xr.Dataset:
    """Size test of a joint: contact against b at equal sigma_0 and at equal sigma*, and eq. 6.

    Contact is tested at the study's map offset (without one the third). The stage has, over
    (estimator, normal_force), ``delta_sigma`` and ``predicted_slope`` of the whole window with
    intervals; over (normal_force) the measured ``slope`` of all windows of a size taken together,
    and ``sensitivity``, which explains it; over (normal_force, part) ``equal_pressure`` (with an
    ``_error``, the solver's, which is infinite where the value may not be reached at all) and
    ``crossings``; and what :func:`size_effect.size_law.size_law`,
    :func:`size_effect.size_verdict.size_verdicts`, :func:`size_effect.prediction.predict_whole` and
    :func:`add_decisions` give. Loads ``beyond_study`` are there while sub-windows hold too few
    nodes under those of the study, see :data:`size_effect.load_ladder.TESTED_DOUBLINGS`. Raises
    `NotConverged`.

    All windows of a size together have sigma_n = sum F / sum A_n: of windows one by one, small ones
    hold too few nodes for a sigma* that means anything. A size counts where its windows hold
    `MIN_NODES_PER_RESOLUTION` on the average. Without that rule the lightest loads show the slope
    -2 exactly: one node in every window.

    The interval of that slope is of a regression over sizes, which are pieces of one joint and not
    independent; that of the exponents at equal sigma_0 is over windows. Where a curve
    sigma*(sigma_0) meets the target several times, the geometric mean of the places is taken and
    they are counted; where that is so for the whole window, its sigma* does not determine sigma_0
    and the verdict is "ambiguous". The composite topography of a sub-window is loaded as it lies,
    see :func:`size_effect.windows.window_states`.
    """
    loading = loading.at_map_offset()

    def estimate(whole: xr.Dataset, domains: np.ndarray, parts: Sequence[int]) -> xr.Dataset:
        return _dimensions(loading, whole, domains, parts)

    states, domains = solve_sub_windows(loading, divisions(loading.shape), estimate)
    of_windows = ["nodes", "nodes_error", "interface_closure", "bulk_compliance"]
    of_windows += ["whole_area", "whole_area_sampling", "whole_left"]
    result = states.drop_vars([*of_windows, *OF_WINDOWS]).merge(size_law(states, domains))
    result = result.merge(slopes_at_equal_star(states, result.sizes["normal_force"]))
    result = result.merge(size_verdicts(result))
    result = result.merge(predict_whole(states, result["delta_sigma"], MIN_NODES_PER_RESOLUTION))
    add_decisions(result)
    opposite = loading.specimen.attrs["opposite"]
    return result.assign_attrs(opposite=opposite)


# -- what eq. 6 predicts ---------------------------------------------------------------------------


_BY_LOAD = ("estimator", "normal_force")


def _dimensions(
    loading: JointLoading[WindowSettings],
    whole: xr.Dataset,
    domains: np.ndarray,
    parts: Sequence[int],
) -> xr.Dataset:
    """Delta_sigma of the whole window by every estimator, and the slope predicted."""
    settings, spacing = loading.settings, cell_side(loading.specimen)
    boxes = [dimension_of_domain(d, spacing, fit_range=settings.box_range) for d in domains]
    occupied = Estimate.stack(_slope_of_occupied(domain, parts) for domain in domains)
    by_estimator = {
        "area": _by_area(loading, whole, domains, spacing),
        "box": Estimate.stack(boxes),
        "box_sizes": occupied.mapped(np.negative, falling=True),
    }
    shape = len(by_estimator), len(domains)
    delta = Estimate.stack((by_estimator[name] for name in DELTA_SIGMA_ESTIMATORS), shape)
    slope = delta.mapped(lambda dimension: dimension - 2)
    result = xr.Dataset(coords={"estimator": list(DELTA_SIGMA_ESTIMATORS)})
    words = "dimension of the contact domain of the whole window"
    result.update(delta.variables("delta_sigma", _BY_LOAD, "1", words))
    words = "slope -(2 - Delta_sigma) of eq. 6"
    result.update(slope.variables("predicted_slope", _BY_LOAD, "1", words))
    return result


def _by_area(
    loading: JointLoading[WindowSettings], whole: xr.Dataset, domains: np.ndarray, spacing: float
) -> Estimate:
    """Delta_sigma (load) from the corrected area of the whole over resolutions."""
    areas, inside = whole_areas(loading, whole, domains), loading.settings.scaling_range
    scaling = corrected_scaling(areas, spacing, left=areas["left"], fit_range=inside)
    return Estimate.read(scaling, "delta_sigma")


def _slope_of_occupied(domain: np.ndarray, parts: Sequence[int]) -> Estimate:
    """Slope of log N over log b, N sub-windows that the domain of the whole window occupies.

    Few whole counts may lie on a line by chance: its interval is never narrower than what counting
    leaves open, N of n x n occupied with the error of a fraction, (1 - N / n^2) / N of log N.
    """
    occupied = [split(domain, n).any(axis=(1, 2)).sum() for n in parts]
    count = np.where(np.array(occupied) > 0, np.array(occupied, float), np.nan)
    x = -np.log(parts)
    slope = fit_line(x, np.log(count)).slope
    dx = x - x.mean()
    spread = np.sum(dx**2)
    if not spread > 0:  # one size: no line
        return slope
    variance = np.sum(dx**2 * (1 - count / np.square(parts)) / count) / spread**2
    half = max(slope.high - slope.value, special.ndtri((1 + CONFIDENCE) / 2) * variance**0.5)
    return replace(slope, low=slope.value - half, high=slope.value + half)


# -- in words --------------------------------------------------------------------------------------


def add_decisions(result: xr.Dataset) -> None:
    """Loads that decide about eq. 6, the load whose predictions are quoted, and the reason.

    ``result`` gets ``decides`` (estimator, normal_force), ``deciding_loads`` and ``agreeing_loads``
    (estimator), ``quoted_load`` (normal_force), the heaviest of the study (else beyond it) with a
    prediction of closure and area by every predictor, and the attribute ``verdict_reason``, why eq.
    6 is judged as it is.
    """
    of_study = ~result["beyond_study"].astype(bool)
    attrs = cf_attrs("1", "whether a load of the study decides about eq. 6")
    result["decides"] = (result["verdict"].isin(DECIDED) & of_study).assign_attrs(attrs)
    errors = result[["closure_error", "area_error"]].to_dataarray()
    every = errors.notnull().all(("variable", "predictor"))
    quotable = every & of_study if (every & of_study).any() else every
    agrees = result["decides"] & (result["verdict"] == AGREES)
    for name, counted, words in (
        ("deciding_loads", result["decides"], "loads that decide about eq. 6"),
        ("agreeing_loads", agrees, "of them, loads at which eq. 6 agrees"),
    ):
        result[name] = counted.sum("normal_force").assign_attrs(cf_attrs("1", words))
    # The heaviest load is the best determined, because most nodes touch. A load beyond the study
    # is quoted only where the study has none.
    heaviest = result["normal_force"] == result["normal_force"].where(quotable).max()
    attrs = cf_attrs("1", "load whose predictions for the whole window are quoted")
    result["quoted_load"] = heaviest.assign_attrs(attrs)
    result.attrs["verdict_reason"] = _verdict_reason(result)


def _verdict_reason(result):
    """Loads that decide about eq. 6, or the reason why none does; empty without loads."""
    of_study = result.isel(normal_force=~result["beyond_study"].values.astype(bool))
    of_study = of_study.sel(estimator=list(_QUOTED))
    if of_study["decides"].any():
        return ", ".join(
            f"by {by} eq. 6 agrees at {int(of_study['agreeing_loads'][i]) or 'none'} of {count} "
            f"conclusive load{'s' * (count > 1)}"
            if (count := int(of_study["deciding_loads"][i]))
            else f"by {by} no load is conclusive"
            for i, by in enumerate(_QUOTED.values())
        )
    tested = of_study["reason"].values[of_study["verdict"].values != NOT_TESTED].astype(str)
    if tested.size:
        return f"inconclusive: {Counter(tested).most_common(1)[0][0]}"
    beyond = result["area_exponent"].notnull().any()
    return "the loads drawn lie beyond those of the study" if beyond else ""
