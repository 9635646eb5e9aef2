"""The direct test of eq. 6: sigma_0 over b at equal sigma*, and the whole predicted from parts."""

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
from ..kit.sizes import nothing_in, plain_decades, size_axis
from ..kit.verdicts import claim
from ..kit.words import estimate, interval, place, short, supplementary

TITLE = "Direct test of eq. 6 on parts of the window"
SUBJECT = "specimen"
NEEDS = ("size_test", "windows", "statements")
ORDER = 170

#: Loads shown in (a).
_LOADS = 4
#: How each estimator's slope is drawn, and how it is named.
_ESTIMATORS = {
    "area": ("-", "$A_r(s)$"),
    "box": ("--", "box counting"),
    "box_sizes": (":", "occupied windows"),
}
#: Estimates of Delta_sigma in words.
_BY = {"area": "by A_r(s)", "box": "by box counting", "box_sizes": "by occupied windows"}
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
    """Windows of several sizes at equal sigma*, slopes of eq. 6, predictions of the whole."""
    settings = settings_of(atlas, name)
    test = group(atlas, "size_test", name)
    laws = group(atlas, "windows", name)
    predicted = [of for of in laws if {"predictor", "dilatancy_load"} & set(laws[of].dims)]
    test = test.assign({of: laws[of] for of in predicted})
    figure = Figure(figsize=(WIDTH, 6.2))
    (equal, slopes), errors = figure.subplots(2, 2)
    shown = _draw_equal(equal, test)
    said = _draw_slopes(slopes, test)
    for axes, which, quantity in zip(errors, "cd", ("closure", "area"), strict=True):
        _draw_errors(axes, test, quantity, which)
    predictors = [
        Line2D([], [], color=colour_of(i), marker=MARKERS[i], lw=0.8, label=words)
        for i, words in enumerate(_PREDICTORS.values())
    ]
    legends_below(figure, shown, said, [heading("(c), (d): whole predicted by"), *predictors])
    where = place(str(test["direction"].values), float(test["offset"]))
    headline(figure, settings["label"], where)
    follows = claim(atlas, name, "eq. 6", "size_effect_follows")
    return Drawing(figure, _table(test), _caption(settings, test, where, follows))


def _draw_equal(axes, test):
    """sigma_0 over b at the sigma* of the whole, with the slopes predicted; legend entries."""
    b = test["side"].values
    fitted = np.flatnonzero(np.isfinite(test["slope"].values))
    loads = fitted[spread(len(fitted), _LOADS)] if len(fitted) else fitted
    handles = [heading(r"(a): $\sigma_0$ of the whole, measured slope")]
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
    letter(axes, "a", r"equal $\sigma^*$")
    if not len(loads):
        nothing_in(axes, "no load at which three sizes\nhold enough nodes")
        return handles[:1]
    axes.set_yscale("log")
    drawn = test["equal_pressure"].values[loads]
    axes.set_ylim(np.nanmin(drawn) / 2, np.nanmax(drawn) * 3)
    plain_decades(axes.yaxis)
    return handles


def _draw_slopes(axes, test):
    """Measured and predicted slopes over the load; legend entries."""
    pressure = test["nominal_pressure"].values
    for i, (estimator, (line, words)) in enumerate(_ESTIMATORS.items()):
        one = test.sel(estimator=estimator)
        colour = COLOURS[i + 1]
        known = np.isfinite(one["predicted_slope"].values)
        low, high = (one[f"predicted_slope_{end}"].values[known] for end in ("low", "high"))
        axes.fill_between(pressure[known], low, high, color=colour, alpha=0.15, lw=0)
        axes.plot(
            pressure[known],
            one["predicted_slope"].values[known],
            color=colour,
            ls=line,
            marker=MARKERS[i + 1],
            ms=3,
            label=words,
        )
    slope = test["slope"].values
    known = np.isfinite(slope)
    low, high = test["slope_low"].values[known], test["slope_high"].values[known]
    axes.vlines(pressure[known], low, high, color="k", lw=0.8)
    axes.plot(pressure[known], slope[known], "ko", label="(b): measured, all windows")
    beyond = pressure[test["beyond_study"].values.astype(bool)]
    if len(beyond):
        axes.axvspan(
            np.sqrt(beyond[0] * pressure[pressure < beyond[0]][-1]),
            beyond[-1] * 1.3,
            color="0.93",
            lw=0,
            zorder=0,
            label="beyond the study's loads",
        )
    axes.axhline(0, color="0.5", lw=0.6)
    axes.set_xscale("log")
    axes.set_xlim(pressure[0] / 1.3, pressure[-1] * 1.3)
    axes.set_ylim(-2.3, 0.8)
    axes.set_xlabel(r"$\sigma_0$ of the whole window (MPa)")
    axes.set_ylabel(r"slope of $\log\sigma_0$ over $\log b$ (1)")
    letter(axes, "b", "slopes")
    label_short_span(axes.xaxis)
    shown = entries(axes)
    estimators, others = shown[: len(_ESTIMATORS)], shown[len(_ESTIMATORS) :]
    title = heading(r"eq. 6, lines in (a) and (b); $\Delta_\sigma$ from")
    return [title, *estimators, *others]


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
                    "verdict": test["verdict"].values[:, i],
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


# -- caption ---------------------------------------------------------------------------------------


def _caption(settings, test, where, follows):
    return (
        f"{supplementary(settings['label'], where)} Eq. 6 tested on parts: (a) pressure at "
        "the sigma* of the whole, (b) slopes over b, (c), (d) predictions of the whole. "
        f"{follows} {_slope_words(test)}"
    )


def _slope_words(test):
    """Slope measured under the smallest and the largest load."""
    known = np.flatnonzero(np.isfinite(test["slope"].values))
    if not len(known):
        return "Parts hold too few nodes in contact."
    ends = [
        f"{estimate(*(float(test[f'slope{end}'][i]) for end in ('', '_low', '_high')))} at "
        f"{short(test['nominal_pressure'][i])} MPa"
        for i in (known[0], known[-1])
    ]
    return f"Slope: {', '.join(dict.fromkeys(ends))}."
