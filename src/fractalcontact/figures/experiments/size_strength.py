"""Size effect of the strength of sliding mated joints: at equal v, and at equal v/b."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import Estimate
from ...experiments.size_decision import PROBABILITY
from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    group,
    heading,
    legends_below,
    letter,
)
from ..kit.points import reach
from ..kit.words import SUPPLEMENTARY, number

TITLE = "Size effect of the strength at equal displacement and at equal displacement over size"
SUBJECT = "study"
NEEDS = ("size_strength",)
KEY = "size_strength"
ORDER = 8

#: Labels of ticks stand at least this fraction of the axis apart.
_CLEAR = 0.15
#: Colour of exponents: those of the sides stand for sides alone.
_OF_EXPONENTS = "k"


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Strength over v by side, and its exponents over the side with what v alone makes of them."""
    test = group(atlas, "size_strength", "surfaces")
    hursts = test["hurst"].values
    figure = Figure(figsize=(WIDTH, 7.4))
    panels = figure.subplots(2, len(hursts), sharey="row", squeeze=False)
    strengths, exponents = _strengths(test), _exponents(test)
    for i, hurst in enumerate(hursts):
        upper, lower = panels[:, i]
        _draw_strength(upper, strengths[strengths["hurst"] == hurst], test)
        letter(upper, "abcdefgh"[i], rf"$H$ = {hurst:g}: strength")
        upper.set_xlabel("shear displacement $v$, middle of its interval (nodes)")
        _draw_exponents(lower, exponents[exponents["hurst"] == hurst], test)
        letter(lower, "abcdefgh"[i + len(hursts)], rf"$H$ = {hurst:g}: its exponent over the side")
        lower.set_xlabel("at equal $v$ (nodes)  |  at equal $v/b$ (1)")
    panels[0, 0].set_ylabel(r"strength $\tau/\sigma_0$ (1)")
    panels[1, 0].set_ylabel(r"$\mathrm{d}\ln(\tau/\sigma_0)/\mathrm{d}\ln b$ (1)")
    legends_below(figure, _side_entries(test), _law_entries(test), _line_entries(test))
    table = pd.concat([strengths, exponents], ignore_index=True)
    return Drawing(figure, table, _caption(test, exponents))


def _strengths(test: xr.Dataset) -> pd.DataFrame:
    """One row a class, load, side and interval: the strength and that from S(v)."""
    rows = []
    for hurst, law, load in _classes(test):
        for k in range(test.sizes["interval"]):
            one = test.sel(hurst=hurst, law=law, reduced_pressure=load).isel(interval=k)
            for side in test["side"].values:
                of_side = one.sel(side=side)
                rows.append(
                    {
                        "drawn": "strength",
                        "hurst": hurst,
                        "law": law,
                        "p_over_E_slope": load,
                        "side": side,
                        "low": float(one["interval_low"]),
                        "high": float(one["interval_high"]),
                        **Estimate.read(of_side, "strength").columns("value"),
                        "by_theory": float(one["theory_strength"]),
                        "truncated_share": float(of_side["truncated_share"]),
                    }
                )
    return pd.DataFrame(rows)


def _exponents(test: xr.Dataset) -> pd.DataFrame:
    """One row a class, load and interval of v, or of v/b: the exponent and that by v alone."""
    rows = []
    for hurst, law, load in _classes(test):
        for dim, name in (
            ("interval", "strength_exponent"),
            ("fraction", "scaled_strength_exponent"),
        ):
            if dim == "interval":
                rows.append(_pooled(test, hurst, law, load))
            for k in range(test.sizes[dim]):
                one = test.sel(hurst=hurst, law=law, reduced_pressure=load).isel({dim: k})
                scaled = dim == "fraction"
                rows.append(
                    {
                        "drawn": "equal v/b" if scaled else "equal v",
                        "hurst": hurst,
                        "law": law,
                        "p_over_E_slope": load,
                        "low": float(one[f"{dim}_low"]),
                        "high": float(one[f"{dim}_high"]),
                        **Estimate.read(one, name).columns("value"),
                        "by_v_alone": float(one["predicted_exponent"]) if scaled else 0.0,
                        "by_theory": float(one["theory_exponent"]) if scaled else 0.0,
                        "verdict": one[f"{name}_verdict"].item(),
                    }
                )
    return pd.DataFrame(rows)


def _pooled(test: xr.Dataset, hurst: float, law: str, load: float) -> dict:
    """The exponent of all intervals of v together, which the caption states."""
    one = test.sel(hurst=hurst, law=law, reduced_pressure=load)
    return {
        "drawn": "all v",
        "hurst": hurst,
        "law": law,
        "p_over_E_slope": load,
        "low": float(test["interval_low"].min()),
        "high": float(test["interval_high"].max()),
        **Estimate.read(one, "pooled_exponent").columns("value"),
        "by_v_alone": 0.0,
        "by_theory": 0.0,
        "verdict": one["pooled_exponent_verdict"].item(),
    }


def _classes(test: xr.Dataset) -> list[tuple]:
    return [
        (hurst, law, load)
        for hurst in test["hurst"].values
        for law in test["law"].values
        for load in test["reduced_pressure"].values
    ]


def _draw_strength(axes: Axes, table: pd.DataFrame, test: xr.Dataset) -> None:
    """Strength over v at the lightest load; points of one v stand side by side."""
    table = table[table["p_over_E_slope"] == table["p_over_E_slope"].min()]
    sides = list(test["side"].values)
    middles = np.sqrt(np.maximum(table["low"], table["high"] / 4) * table["high"])
    for (law, side), one in table.groupby(["law", "side"]):
        i = sides.index(side)
        shift = 1.06 ** (i - (len(sides) - 1) / 2) * (1.0 if law == "elastic" else 1.03)
        colour = colour_of(i + 1)
        axes.errorbar(
            middles[one.index] * shift,
            one["value"],
            yerr=reach(*Estimate.read(one, "value").ends),
            fmt=MARKERS[i],
            color=colour,
            mfc=colour if law == "elastic" else "white",
            elinewidth=0.7,
        )
    of_theory = table[(table["law"] == "elastic") & (table["side"] == sides[-1])]
    axes.plot(middles[of_theory.index], of_theory["by_theory"], "-", color="0.6", lw=1, zorder=0)
    axes.axhline(
        np.tan(np.radians(test.attrs["basic_friction_angle"])), color="0.6", ls=":", lw=1, zorder=0
    )
    axes.set_xscale("log")
    ticks = _apart(of_theory["high"].to_numpy())
    axes.set_xticks(ticks, [f"{v:g}" for v in ticks])
    axes.minorticks_off()


def _apart(ticks: np.ndarray) -> list[float]:
    """Of ticks along a logarithmic axis those whose labels stand clear of each other."""
    chosen: list[float] = []
    least = (ticks.max() / ticks.min()) ** _CLEAR
    for tick in np.sort(ticks):
        if not chosen or tick >= least * chosen[-1]:
            chosen.append(float(tick))
    return chosen


def _draw_exponents(axes: Axes, table: pd.DataFrame, test: xr.Dataset) -> None:
    """Exponents with their intervals, those at equal v to the left, at equal v/b to the right."""
    places = list(
        dict.fromkeys(zip(table["drawn"], table["low"], table["high"], strict=True)),
    )
    groups = _groups(test)
    axes.axhspan(-test.attrs["bound"], test.attrs["bound"], color="0.9", lw=0, zorder=0)
    axes.axhline(0, color="0.6", lw=0.8, zorder=0)
    for n, (law, load) in enumerate(groups):
        one = table[(table["law"] == law) & (table["p_over_E_slope"] == load)]
        x = np.array(
            [places.index(key) for key in zip(one["drawn"], one["low"], one["high"], strict=True)],
            float,
        )
        x += 0.7 * ((n + 0.5) / len(groups) - 0.5)
        colour, marker = _style(load, test)
        axes.errorbar(
            x,
            one["value"],
            yerr=reach(*Estimate.read(one, "value").ends),
            fmt=marker,
            color=colour,
            mfc=colour if law == "elastic" else "white",
            elinewidth=0.7,
        )
        scaled = (one["drawn"] == "equal v/b").to_numpy()
        axes.plot(x[scaled], one["by_v_alone"][scaled], "_", color=colour, ms=12, zorder=0)
        axes.plot(x[scaled], one["by_theory"][scaled], "x", color="0.6", ms=5, zorder=0)
    if any(kind == "equal v/b" for kind, _, _ in places):
        axes.axvline(test.sizes["interval"] + 0.5, color="0.6", lw=0.8)
    axes.set_xticks(range(len(places)), [_ends_text(*place) for place in places], fontsize=7)
    axes.tick_params(axis="x", rotation=90)


def _ends_text(kind: str, low: float, high: float) -> str:
    if kind == "all v":
        return "all together"
    if kind == "equal v":
        return f"{low:g} to {high:g}"
    return f"1/{1 / low:.4g} to 1/{1 / high:.4g}"


def _groups(test: xr.Dataset) -> list[tuple[str, float]]:
    return [(law, load) for load in test["reduced_pressure"].values for law in test["law"].values]


def _style(load: float, test: xr.Dataset) -> tuple[str, str]:
    return _OF_EXPONENTS, MARKERS[list(test["reduced_pressure"].values).index(load)]


def _side_entries(test: xr.Dataset) -> list:
    marks = [
        Line2D([], [], color=colour_of(i + 1), marker=MARKERS[i], ls="none", label=f"{side:g}")
        for i, side in enumerate(test["side"].values)
    ]
    filled = [
        Line2D([], [], color="0.3", marker="o", ls="none", label="filled: elastic"),
        Line2D([], [], color="0.3", marker="o", mfc="white", ls="none", label="hollow: capped"),
    ]
    return [heading("strength: side $b$ (nodes)"), *marks, *filled]


def _law_entries(test: xr.Dataset) -> list:
    entries: list = [heading("exponent: $p/(E^* h'_\\mathrm{rms})$")]
    for law, load in _groups(test):
        colour, marker = _style(load, test)
        fill = colour if law == "elastic" else "white"
        entries.append(
            Line2D(
                [],
                [],
                color=colour,
                marker=marker,
                ls="none",
                mfc=fill,
                label=f"{law}, {load:g}",
            )
        )
    return entries


def _line_entries(test: xr.Dataset) -> list:
    return [
        Line2D([], [], color="0.3", marker="_", ms=12, ls="none", label="as $v$ alone makes it"),
        Line2D([], [], color="0.6", marker="x", ls="-", label="theory: height differences at $v$"),
        Line2D([], [], color="0.6", ls=":", label=r"basic friction $\tan\varphi_b$"),
        Patch(color="0.9", label=f"no size effect: within {test.attrs['bound']:g}"),
        heading(f"side by side; bars: {100 * PROBABILITY:.0f} % intervals"),
    ]


def _caption(test: xr.Dataset, exponents: pd.DataFrame) -> str:
    pooled = test["pooled_exponent"].values.ravel()
    scaled = exponents[exponents["drawn"] == "equal v/b"]["value"].dropna()
    beyond = test["beyond_exponent"].values
    texts, count = np.unique(test["overall"].values, return_counts=True)
    verdicts = "; ".join(f"{text} ({n})" for text, n in zip(texts, count, strict=True))
    at_v = (
        f"At equal v, all together, the exponent is {_range(pooled)}"
        if np.isfinite(pooled).any()
        else ""
    )
    at_fraction = (
        f", at equal v/b {_range(scaled)}, within {number(np.nanmax(abs(beyond)), 3)} of what v "
        "alone makes of it"
        if len(scaled) and np.isfinite(beyond).any()
        else ""
    )
    found = f"{at_v}{at_fraction}. " if at_v else ""
    return (
        f"{SUPPLEMENTARY} Strength of mated joints over the displacement v, and its exponent over "
        f"their side b. {found}Size effect in the classes of H, law and load: {verdicts}."
    )


def _range(values: np.ndarray) -> str:
    low, high = (number(end, 3) for end in (np.nanmin(values), np.nanmax(values)))
    return low if low == high else f"{low} to {high}"
