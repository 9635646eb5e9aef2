"""The size test: A_r/A_0 over b at equal sigma_0, eq. 6's own form, the whole from its parts."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ..kit.drawing import (
    COLOURS,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    heading,
    headline,
    label_short_span,
    legends_below,
    letter,
    settings_of,
    spread,
)
from ..kit.sizes import apart, draw_bars, nothing_in, plain_decades, size_axis
from ..kit.verdicts import claim, sentences
from ..kit.words import interval, place, short, supplementary

TITLE = "Size test on parts of the window: contact at equal pressure, and eq. 6"
SUBJECT = "specimen"
NEEDS = ("size_test", "windows", "statements")
ORDER = 170

#: Loads shown in (a) and (c).
_LOADS = 4
#: Verdicts and their reasons: of the well-conditioned form, of eq. 6's own, and of both.
_JUDGED = ("area_verdict", "area_reason", "slope_verdict", "slope_reason", "verdict", "reason")
#: How each estimator's slope is drawn, and how it is named.
_ESTIMATORS = {
    "area": ("-", "$A_r(s)$"),
    "box": ("--", "box counting"),
    "box_sizes": (":", "occupied windows"),
}
#: Exponents at equal sigma_0: name, what they are of, whether it is the one that eq. 6 is about.
_EXPONENTS = (
    ("area_exponent", "$A_r/A_0$", True),
    ("compliance_exponent", "compliance", False),
    ("gap_exponent", "mean gap", False),
)
_PREDICTORS = {
    "power_law": "power law of small windows",
    "eq6_area": "eq. 6, $A_r(s)$",
    "eq6_box": "eq. 6, box counting",
    "eq6_box_sizes": "eq. 6, occupied windows",
    "no_size_effect": "no size effect",
}
_QUANTITIES = {
    "closure": ("normal_force", r"closure $w_{int}$"),
    "area": ("normal_force", "$A_r/A_0$"),
    "strength": ("dilatancy_load", r"strength $\tau$"),
}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Windows of several sizes at equal sigma_0 and at equal sigma*, predictions of the whole."""
    settings = settings_of(atlas, name)
    test = group(atlas, "size_test", name)
    laws = group(atlas, "windows", name)
    predicted = [of for of in laws if {"predictor", "dilatancy_load"} & set(laws[of].dims)]
    test = test.assign({of: laws[of] for of in predicted})
    figure = Figure(figsize=(WIDTH, 8.6))
    (area, exponents), (equal, slopes), errors = figure.subplots(3, 2)
    shown = _draw_area(area, test)
    said = _draw_exponents(exponents, test)
    inverted = _draw_equal(equal, test)
    measured = _draw_slopes(slopes, test)
    for axes, which, quantity in zip(errors, "ef", ("closure", "area"), strict=True):
        _draw_errors(axes, test, quantity, which)
    predictors = [
        Line2D([], [], color=colour_of(i), marker=MARKERS[i], lw=0.8, label=words)
        for i, words in enumerate(_PREDICTORS.values())
    ]
    of_whole = heading("(e), (f): whole predicted by")
    legends_below(figure, shown + inverted, said + measured, [of_whole, *predictors])
    where = place(str(test["direction"].values), float(test["offset"]))
    headline(figure, settings["label"], where)
    follows = claim(atlas, name, "eq. 6", "size_effect_follows")
    return Drawing(figure, _table(test), _caption(settings, test, where, follows))


def _draw_area(axes, test):
    """A_r/A_0 over b at some sigma_0 with intervals, and what eq. 6 wants; legend entries."""
    b = test["side"].values
    fraction, low, high = (test[f"area_fraction{end}"].values for end in ("", "_low", "_high"))
    fitted = _first_loads(test, "area_exponent_low")
    loads = fitted[spread(len(fitted), _LOADS)]
    handles = [heading(r"(a): $\sigma_0$, exponent measured")]
    for n, i in enumerate(loads):
        style = {"color": COLOURS[n], "marker": MARKERS[n]}
        moved = apart(b, n, len(loads))
        axes.plot(moved, fraction[i], ls="none", **style)
        draw_bars(axes, moved, fraction[i], low[i], high[i], COLOURS[n])
        used = b[np.isfinite(fraction[i])]
        for estimator, (line, _) in _ESTIMATORS.items():
            slope = float(test["predicted_slope"].sel(estimator=estimator)[i])
            axes.plot(used, fraction[i, 0] * (used / b[0]) ** slope, COLOURS[n], ls=line, lw=0.7)
        found = interval(*(float(test[f"area_exponent{end}"][i]) for end in ("", "_low", "_high")))
        pressure = short(float(test["nominal_pressure"][i]))
        handles.append(Line2D([], [], ls="none", **style, label=f"{pressure} MPa: {found}"))
    size_axis(axes, b, "windows")
    axes.set_ylabel(r"$A_r/A_0$ (1)")
    letter(axes, "a", r"equal $\sigma_0$")
    if not len(loads):
        nothing_in(axes, "no load at which two sizes\nhold enough nodes")
        return handles[:1]
    axes.set_yscale("log")
    axes.set_ylim(np.nanmin(fraction[loads]) / 2.5, np.nanmax(fraction[loads]) * 8)
    plain_decades(axes.yaxis)
    return handles


def _first_loads(test, name):
    """Loads with a value: those of the study, or where it has none those beyond."""
    known = np.isfinite(test[name].values)
    of_study = known & ~test["beyond_study"].values.astype(bool)
    return np.flatnonzero(of_study if of_study.any() else known)


def _draw_exponents(axes, test):
    """Exponents over b at equal sigma_0, and those of eq. 6, over the load; legend entries."""
    pressure = test["nominal_pressure"].values
    estimators = _draw_wanted(axes, test)
    for n, (name, words, fill) in enumerate(_EXPONENTS):
        value, low, high = (test[f"{name}{end}"].values for end in ("", "_low", "_high"))
        known = np.isfinite(low)
        x = apart(pressure, 2 * n, 5)[known]
        colour = "k" if fill else "0.5"
        axes.vlines(x, low[known], high[known], color=colour, lw=0.8)
        style = {"color": colour, "marker": MARKERS[n], "mfc": colour if fill else "white"}
        axes.plot(x, value[known], ls="none", ms=4, label=f"(b): {words}", **style)
    _load_axis(axes, test)
    axes.set_ylabel(r"exponent over $b$ (1)")
    letter(axes, "b", r"exponents at equal $\sigma_0$")
    return [heading(r"eq. 6 in (a) to (d); $\Delta_\sigma$ from"), *estimators, *_others(axes)]


def _draw_wanted(axes, test):
    """-(2 - Delta_sigma) over the load with intervals; legend entries."""
    pressure = test["nominal_pressure"].values
    for i, (estimator, (line, words)) in enumerate(_ESTIMATORS.items()):
        one = test.sel(estimator=estimator)
        known = np.isfinite(one["predicted_slope"].values)
        value, low, high = (
            one[f"predicted_slope{end}"].values[known] for end in ("", "_low", "_high")
        )
        style = {"color": COLOURS[i + 1], "ls": line, "marker": MARKERS[i + 1], "ms": 3}
        axes.fill_between(pressure[known], low, high, color=style["color"], alpha=0.15, lw=0)
        axes.plot(pressure[known], value, label=words, **style)
    return entries(axes)


def _load_axis(axes, test):
    """Axis of sigma_0 of the whole, loads beyond the study in grey."""
    pressure = test["nominal_pressure"].values
    beyond = pressure[test["beyond_study"].values.astype(bool)]
    if len(beyond):
        first = np.sqrt(beyond[0] * pressure[pressure < beyond[0]][-1])
        style = {"color": "0.93", "lw": 0, "zorder": 0}
        axes.axvspan(first, beyond[-1] * 1.3, label="beyond the study's loads", **style)
    axes.axhline(0, color="0.5", lw=0.6)
    axes.set_xscale("log")
    axes.set_xlim(pressure[0] / 1.3, pressure[-1] * 1.3)
    axes.set_ylim(-2.3, 0.8)
    axes.set_xlabel(r"$\sigma_0$ of the whole window (MPa)")
    label_short_span(axes.xaxis)


def _others(axes):
    """Legend entries but those of the predictions."""
    return entries(axes)[len(_ESTIMATORS) :]


def _draw_equal(axes, test):
    """sigma_0 over b at the sigma* of the whole, with the slopes predicted; legend entries."""
    b = test["side"].values
    fitted = _first_loads(test, "slope")
    loads = fitted[spread(len(fitted), _LOADS)]
    handles = [heading(r"(c): $\sigma_0$ of the whole, measured slope")]
    for n, i in enumerate(loads):
        style = {"color": COLOURS[n], "marker": MARKERS[n]}
        pressure = test["equal_pressure"].values[i]
        axes.plot(b, pressure, ls="none", **style)
        axes.plot(b * 1.03, test["window_pressure"].values[i], ls="none", mfc="none", **style)
        own, anchor = float(test["nominal_pressure"][i]), pressure[0]
        for estimator, (line, _) in _ESTIMATORS.items():
            slope = float(test["predicted_slope"].sel(estimator=estimator)[i])
            axes.plot(b, anchor * (b / b[0]) ** slope, color=COLOURS[n], ls=line, lw=0.7)
        found = interval(*(float(test[f"slope{end}"][i]) for end in ("", "_low", "_high")))
        handles.append(Line2D([], [], ls="none", **style, label=f"{short(own)} MPa: {found}"))
    handles.append(
        Line2D([], [], ls="none", marker="o", color="k", mfc="none", label="median window")
    )
    size_axis(axes, b, "windows")
    axes.set_ylabel(r"$\sigma_0$ at the same $\sigma^*$ (MPa)")
    letter(axes, "c", r"equal $\sigma^*$")
    if not len(loads):
        nothing_in(axes, "no load at which three sizes\nhold enough nodes")
        return handles[:1]
    axes.set_yscale("log")
    drawn = test["equal_pressure"].values[loads]
    axes.set_ylim(np.nanmin(drawn) / 2, np.nanmax(drawn) * 3)
    plain_decades(axes.yaxis)
    return handles


def _draw_slopes(axes, test):
    """Slopes at equal sigma*, measured and predicted, over the load; legend entries."""
    pressure = test["nominal_pressure"].values
    _draw_wanted(axes, test)
    slope, low, high = (test[f"slope{end}"].values for end in ("", "_low", "_high"))
    known = np.isfinite(slope)
    axes.vlines(pressure[known], low[known], high[known], color="k", lw=0.8)
    determined = known & test["well_conditioned"].values.astype(bool)
    for chosen, face, words in (
        (determined, "k", "(d): measured"),
        (known & ~determined, "white", "(d): ill-conditioned"),
    ):
        axes.plot(pressure[chosen], slope[chosen], "ko", mfc=face, ms=4, label=words)
    _load_axis(axes, test)
    axes.set_ylabel(r"slope of $\log\sigma_0$ over $\log b$ (1)")
    letter(axes, "d", r"slopes at equal $\sigma^*$")
    return _others(axes)[:2]


def _draw_errors(axes, test, quantity, which):
    """Predicted over solved values of the whole window."""
    words = _QUANTITIES[quantity][1]
    pressure = test["nominal_pressure"].values
    drawn = False
    for i, predictor in enumerate(_PREDICTORS):
        ratio = 1 + test[f"{quantity}_error"].sel(predictor=predictor).values
        known = np.isfinite(ratio)
        drawn |= known.any()
        style = {"color": colour_of(i), "marker": MARKERS[i], "ms": 3}
        axes.plot(pressure[known], ratio[known], lw=0.8, **style)
    axes.axhline(1, color="0.5", lw=0.6)
    axes.set_xlabel(r"$\sigma_0$ of the whole window (MPa)")
    axes.set_ylabel(f"{words}: predicted / solved (1)")
    letter(axes, which, f"prediction of {words}")
    if not drawn:
        # Without data a logarithmic axis has no limits.
        nothing_in(axes, "nothing to predict from")
        return
    axes.set_xscale("log")
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, 0.5), max(high, 2))
    plain_decades(axes.yaxis)
    label_short_span(axes.xaxis)


def _table(test):
    tables = []
    for i, force in enumerate(test["normal_force"].values):
        common = {
            "load_N": force,
            "nominal_pressure_MPa": float(test["nominal_pressure"][i]),
            "beyond_study": bool(test["beyond_study"][i]),
        }
        counts = {
            name: test[name].values[i]
            for name in ("windows_below", "windows_above", "windows_unknown")
        }
        tables.append(
            pd.DataFrame(
                {
                    "quantity": "equal_pressure",
                    **common,
                    "b_mm": test["side"].values,
                    "value_MPa": test["equal_pressure"].values[i],
                    "median_window_MPa": test["window_pressure"].values[i],
                    "windows": test["windows"].values,
                    **counts,
                }
            )
        )
        tables.append(_equal_pressure_table(test, i, common))
        ends = {end: float(test[f"slope{end}"][i]) for end in ("", "_low", "_high", "_n")}
        tables.append(
            pd.DataFrame(
                [{"quantity": "slope", **common, **{f"slope{e}": v for e, v in ends.items()}}]
            )
        )
        tables.append(
            pd.DataFrame(
                {
                    "quantity": "predicted_slope",
                    **common,
                    "estimator": test["estimator"].values,
                    **{
                        f"slope{end}": test[f"predicted_slope{end}"].values[:, i]
                        for end in ("", "_low", "_high")
                    },
                    **{name: test[name].values[:, i] for name in _JUDGED},
                }
            )
        )
    for quantity, (dim, _) in _QUANTITIES.items():
        if f"direct_{quantity}" not in test:
            continue
        for j, force in enumerate(test[dim].values):
            tables.append(
                pd.DataFrame(
                    {
                        "quantity": f"predicted_{quantity}",
                        "load_N": force,
                        "predictor": test["predictor"].values,
                        "predicted": test[f"predicted_{quantity}"].values[:, j],
                        "predicted_low": test[f"predicted_{quantity}_low"].values[:, j],
                        "predicted_high": test[f"predicted_{quantity}_high"].values[:, j],
                        "solved": float(test[f"direct_{quantity}"][j]),
                        "unit": test[f"direct_{quantity}"].attrs["units"],
                    }
                )
            )
    return pd.concat(tables, ignore_index=True)


def _equal_pressure_table(test, i, common):
    """Contact over b at one sigma_0, and the exponents."""
    means = [
        {
            "quantity": name,
            **common,
            "b_mm": test["side"].values,
            "unit": test[name].attrs["units"],
            **{
                words: test[f"{name}{end}"].values[i]
                for end, words in (("", "mean"), ("_low", "mean_low"), ("_high", "mean_high"))
            },
            "fewest_nodes": test["least_nodes"].values[i],
            "central_load": test["central_load"].values[i],
        }
        for name in ("area_fraction", "interface_compliance", "mean_gap")
    ]
    exponents = [
        {
            "quantity": name,
            **common,
            **{f"slope{e}": [float(test[f"{name}{e}"][i])] for e in ("", "_low", "_high", "_n")},
        }
        for name, *_ in _EXPONENTS
    ]
    return pd.concat([pd.DataFrame(rows) for rows in means + exponents], ignore_index=True)


# -- caption ---------------------------------------------------------------------------------------


def _caption(settings, test, where, follows):
    return (
        f"{supplementary(settings['label'], where)} Parts of the window: (a), (b) at equal "
        "sigma_0; (c), (d) eq. 6's own form; (e), (f) the whole predicted. "
        f"{sentences(follows, _edge_words(test))}"
    )


def _edge_words(test):
    """Compliance of the bulk beside that of the interface, at the last load that has both."""
    if not np.isfinite(test["area_exponent_low"].values).any():
        return "Parts hold too few nodes in contact."
    ratio = test["edge_ratio"].sel(part=1).values
    known = np.flatnonzero(ratio > 0)
    if not len(known):
        return ""
    pressure = short(test["nominal_pressure"][known[-1]])
    return (
        f"Bulk over interface compliance: {short(ratio[known[-1]], 2)} at {pressure} MPa; from 1 "
        "on edges matter."
    )
