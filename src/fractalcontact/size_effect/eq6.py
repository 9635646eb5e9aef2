"""The direct test of eq. 6: parts of one joint pressed until they reach the same sigma*.

Eq. 6 has a joint of side b reach a given sigma* at the nominal pressure sigma_0 ~ b^-(2 - Delta).
Here windows of several sizes are cut from one joint, the pressure at which each has the sigma* of
the whole window is found, and its slope over b is held against Delta_sigma by each estimator.

What the test comes to: sigma* = F / H_D with H_D the geometric mean of N_n s_n^Delta over the
resolutions. With one Delta and the same resolutions for all windows, as eq. 6 needs them, the
powers of s_n are the same constant everywhere: equal sigma* is equal real mean pressure sigma_n,
whatever Delta is. So one slope is measured, in which Delta does not occur; the estimators differ
in what they predict for it. And where the real area goes with the load alone, A_r = kappa F,
sigma_n is the same at any sigma_0: sigma* then tells nothing of sigma_0, and no b can come in. A
size effect appears just where the part of the window in contact at a given sigma_0 depends on b.
"""

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.intervals import INTERVAL
from ..core.labels import cf_attrs
from ..domain.box_dimension import box_dimension
from ..domain.renormalisation import FEWEST_NODES, renormalisation
from ..mechanics.joint import direction_spacing
from ..mechanics.states import chosen_offset
from ..surface.specimen import cell_side
from .load_ladder import press_parts, whole_areas
from .prediction import predict_whole, predict_whole_strength
from .slope import real_pressures, slopes_at_equal_star
from .windows import PARTS, split

#: A slope whose 95 % interval is wider than this decides nothing.
WIDEST = 1.0
#: Slopes that differ by less than this are the same but for rounding.
_ROUNDING = 1e-9

#: Estimators of Delta_sigma in the whole window under each load: its area over resolutions, boxes
#: of all sizes at its finest resolution, and the number of sub-windows that its contact domain
#: meets, which are boxes too, but of the sizes of the test alone.
ESTIMATORS = {
    "area": "A_r(s)",
    "box": "box counting",
    "box_sizes": "windows met",
}

#: What may come of one estimator under one load.
VERDICTS = (
    "agrees",
    "measured steeper",
    "measured flatter",
    "undecided",
    "ambiguous",
    "not tested",
)


def size_test(specimen, direction, cells, settings, solver, windows, parts=PARTS):
    """Slope of log sigma_0 over log b at equal sigma*, beside what eq. 6 predicts.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : str
    cells : (n,) int array_like
        Offsets in cells, ascending. Contact is tested at the study's map offset (without one the
        third).
    settings : dict
        From :func:`study.configuration.resolve_settings`.
    solver : dict
        ``rtol`` and ``kernel``.
    windows : xr.Dataset
        From :func:`size_effect.laws.joint_by_size`: strength of the parts at all offsets.
    parts : sequence of int
        Sub-windows along each side; all of them are pressed. Sizes below `FEWEST_CELLS` cells a
        side are left out.

    Returns
    -------
    xr.Dataset
        Over (estimator, load): ``delta_sigma``, ``sigma_star`` and ``predicted_slope`` of the whole
        window with intervals, ``slope_difference`` and ``verdict``. Over (load): the measured
        ``slope`` of all windows of a size taken together and ``window_slope`` of the median of
        windows one by one, each with ``_low``, ``_high``, ``_n``, ``_b_min``, ``_b_max``;
        ``share_exponent`` and ``sensitivity``, which explain it. Over (load, part):
        ``equal_pressure``, ``window_pressure`` (each with an ``_error``, the solver's, which is
        infinite where the value may not be reached at all), ``windows_below``, ``windows_above``,
        ``windows_unknown``, ``crossings``; and what is predicted for the whole window, see
        :func:`size_effect.prediction.predict_whole`. Loads ``beyond_study`` are those of
        :data:`size_effect.load_ladder.BEYOND`.

    Notes
    -----
    All windows of a size together have sigma_n = sum F / sum A_n. Windows one by one are what a
    laboratory would test, but small ones hold few nodes: a window with fewer than `FEWEST_NODES` at
    a resolution has no sigma* that means anything, and a mean over those that are left would be one
    over the few whose contacts are many and soft. So their median is taken, with the windows whose
    place is only known to lie below or above the loads pressed. The verdict rests on all windows
    together; a size counts where they hold `FEWEST_NODES` on the average. Without that rule the
    lightest loads show the slope -2 exactly: one node in every window.

    The sizes are pieces of one joint and not independent, and the interval is that of a regression
    over them. Where a curve sigma*(sigma_0) meets the target several times, the geometric mean of
    the places is taken and they are counted; where that is so for the whole window, its sigma* does
    not tell sigma_0 and the verdict is "ambiguous". The composite topography of a sub-window is
    pressed as it lies, see :func:`size_effect.windows.window_states`.

    Raises
    ------
    NotConverged
        If a state could not be verified; the message names it.
    """
    cells = np.asarray(cells, int)
    offsets = cells * direction_spacing(specimen, direction)
    chosen = int(cells[offsets == chosen_offset(settings["map_offset"], offsets)][0])

    def estimate(whole, domains, parts):
        areas = whole_areas(specimen, direction, chosen, settings, solver, whole)
        return _dimensions(specimen, whole, domains, parts, areas, settings)

    pressed, _ = press_parts(specimen, direction, chosen, settings, solver, parts, estimate)
    result = pressed.drop_vars(["nodes", "nodes_error", "interface_closure"])
    result = result.merge(slopes_at_equal_star(pressed, result.sizes["load"]))
    result = result.merge(_verdicts(result))
    result = result.merge(predict_whole(pressed, result["delta_sigma"], FEWEST_NODES))
    if direction != "none":
        result = result.merge(predict_whole_strength(windows, result["delta_sigma"]))
    return result.assign_attrs(opposite=specimen.attrs["opposite"], summary=summary(result))


# -- what eq. 6 predicts ---------------------------------------------------------------------------


def _dimensions(specimen, whole, domains, parts, areas, settings):
    """Delta_sigma of the whole window by every estimator, with sigma* and the slope predicted."""
    spacing = cell_side(specimen)
    s = spacing * areas["resolution"]
    if settings["scaling_range"] is not None:
        first, last = settings["scaling_range"]
        areas = areas.where((s >= first - 1e-9 * spacing) & (s <= last + 1e-9 * spacing))
    by_area = renormalisation(s, areas, whole["load"])
    boxes = [box_dimension(d, spacing, fit_range=settings["box_range"]) for d in domains]
    lines = [_meeting_line(domain, parts) for domain in domains]
    found = {
        "area": [by_area[f"delta_sigma{end}"].values for end in ("", "_low", "_high")],
        "box": np.transpose([(box.dimension, box.low, box.high) for box in boxes]),
        "box_sizes": np.transpose([(-x.slope, -x.slope_high, -x.slope_low) for x in lines]),
    }
    delta = np.array([found[name] for name in ESTIMATORS])
    star = delta[:, 0] - 2  # sigma* = sigma_n s_n^(2 - Delta), geometric mean over the resolutions
    star = real_pressures(whole)[0][0, : len(domains)] * np.exp(
        -star * np.log(whole["spacing"].values).mean()
    )
    dims = ("estimator", "load")
    result = xr.Dataset(
        {
            "sigma_star": (
                dims,
                star,
                cf_attrs("N mm^-delta_sigma", "fractal mean pressure sigma* of the whole window"),
            )
        },
        coords={"estimator": list(ESTIMATORS)},
    )
    for n, (ending, words) in enumerate(INTERVAL.items()):
        text = f"dimension of the contact domain of the whole window{words}"
        result[f"delta_sigma{ending}"] = (dims, delta[:, n], cf_attrs("1", text))
        text = f"slope -(2 - Delta_sigma) of eq. 6{words}"
        result[f"predicted_slope{ending}"] = (dims, delta[:, n] - 2, cf_attrs("1", text))
    result["box_fit_min"] = (
        "load",
        [b.r_min for b in boxes],
        cf_attrs("mm", "smallest box fitted"),
    )
    result["box_fit_max"] = ("load", [b.r_max for b in boxes], cf_attrs("mm", "largest box fitted"))
    return result


def _meeting_line(domain, parts):
    """Line through log N over log b, N sub-windows that the domain of the whole window meets."""
    met = [split(domain, n).any(axis=(1, 2)).sum() for n in parts]
    count = np.array(met, float)
    return fit_line(-np.log(parts), np.log(np.where(count > 0, count, np.nan)))


# -- verdicts --------------------------------------------------------------------------------------


def _verdicts(result):
    """Measured slope less the one predicted, and in a word whether they agree."""
    slope, low, high = (result[f"slope{end}"] for end in ("", "_low", "_high"))
    said, said_low, said_high = (result[f"predicted_slope{end}"] for end in ("", "_low", "_high"))
    difference = slope - said
    lower = difference - np.hypot(slope - low, said_high - said)
    upper = difference + np.hypot(high - slope, said - said_low)
    verdict = xr.where(lower > _ROUNDING, "measured flatter", "agrees")
    verdict = xr.where(upper < -_ROUNDING, "measured steeper", verdict)
    verdict = xr.where((verdict == "agrees") & (high - low > WIDEST), "undecided", verdict)
    verdict = xr.where(result["crossings"].isel(part=0) > 1, "ambiguous", verdict)
    verdict = xr.where(np.isfinite(lower), verdict, "not tested")
    found = xr.Dataset(
        {
            "slope_difference": difference,
            "slope_difference_low": lower,
            "slope_difference_high": upper,
            "verdict": verdict.astype(str),
            "size_effect": (low > _ROUNDING) | (high < -_ROUNDING),
        }
    ).transpose("estimator", "load")
    words = {
        "slope_difference": "measured slope less that of eq. 6",
        "slope_difference_low": "lower end of its 95 % interval",
        "slope_difference_high": "upper end of its 95 % interval",
        "verdict": "whether the measured slope agrees with that of eq. 6",
        "size_effect": "whether the measured slope differs from zero",
    }
    for name, text in words.items():
        found[name].attrs = cf_attrs("1", text)
    return found


def summary(result):
    """The verdicts in words: by estimator, the loads at which eq. 6 has the measured slope.

    Parameters
    ----------
    result : xr.Dataset
        From :func:`size_test`.

    Returns
    -------
    str
    """
    known = np.isfinite(result["slope"].values)
    if not known.any():
        return "no load at which three sizes hold nodes enough to be tested"
    told = known & (result["crossings"].isel(part=0).values == 1)
    effect = int(result["size_effect"].values[told].sum())
    rows = [
        f"of {int(known.sum())} loads tested sigma* tells sigma_0 at {int(told.sum())}, and the "
        f"slope differs from zero at {effect}"
    ]
    for name, words in ESTIMATORS.items():
        verdicts = result["verdict"].sel(estimator=name).values
        tested = verdicts[verdicts != "not tested"]
        counts = {v: int((tested == v).sum()) for v in VERDICTS[:-1]}
        found = ", ".join(f"{v} at {n}" for v, n in counts.items() if n)
        rows.append(f"eq. 6 with Delta_sigma from {words}: {found or 'not tested'}")
    return "; ".join(rows)
