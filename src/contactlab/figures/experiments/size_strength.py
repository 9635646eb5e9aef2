"""Size effect of the strength of sliding mated joints: at equal v, and at equal v/b."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.points import reach
from fractalcontact.figures.kit.titles import letter
from fractalcontact.figures.kit.words import number

from ...experiments.size_decision import PROBABILITY
from ._strength_exponents import ELASTIC, draw_exponents, faces_of, law_entries

TITLE = "Size effect of the strength at equal displacement and at equal displacement over size"
SUBJECT = "study"
NEEDS = ("size_strength",)
KEY = "size_strength"
ORDER = 8

#: Labels of ticks stand at least this fraction of the axis apart.
_CLEAR = 0.15


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Strength over v by side; its exponents over the side, beside those that v alone predicts."""
    test = atlas["size_strength/surfaces"].to_dataset()
    hursts = test["hurst"].values
    figure = Figure(figsize=(WIDTH, 7.4))
    panels = figure.subplots(2, len(hursts), sharey="row", squeeze=False)
    for i, hurst in enumerate(hursts):
        upper, lower = panels[:, i]
        _draw_strength(upper, test.sel(hurst=hurst))
        letter(upper, "abcdefgh"[i], rf"$H$ = {hurst:g}: strength")
        upper.set_xlabel("shear displacement $v$, middle of its interval (nodes)")
        draw_exponents(lower, test.sel(hurst=hurst))
        letter(lower, "abcdefgh"[i + len(hursts)], rf"$H$ = {hurst:g}: its exponent over the side")
        lower.set_xlabel("at equal $v$ (nodes)  |  at equal $v/b$ (1)")
    panels[0, 0].set_ylabel(r"strength $\tau/\sigma_0$ (1)")
    panels[1, 0].set_ylabel(r"$\mathrm{d}\ln(\tau/\sigma_0)/\mathrm{d}\ln b$ (1)")
    legends_below(figure, _side_entries(test), law_entries(test), _line_entries(test))
    return Drawing(figure, _table(test), caption(__name__, **_words(test)))


def _table(test: xr.Dataset) -> pd.DataFrame:
    """Strengths of every side and interval; exponents of all v, at equal v and at equal v/b."""
    test = test.transpose("hurst", "law", "reduced_pressure", ..., "side")
    at_fractions = ("scaled_strength_exponent", "predicted_exponent", "theory_exponent")
    tables = [
        rows(test, "strength", "theory_strength", "truncated_share", drawn="strength"),
        rows(test, "pooled_exponent", "pooled_exponent_verdict", drawn="all v"),
        rows(test, "strength_exponent", "strength_exponent_verdict", drawn="equal v"),
        rows(test, *at_fractions, "scaled_strength_exponent_verdict", drawn="equal v/b"),
    ]
    return pd.concat(tables, ignore_index=True)


def _draw_strength(axes: Axes, test: xr.Dataset) -> None:
    """Strength over v at the lightest load; points at one v are shifted sideways."""
    test = test.isel(reduced_pressure=0)
    low, high = test["interval_low"].values, test["interval_high"].values
    middles = np.sqrt(np.maximum(low, high / 4) * high)
    sides = test.sizes["side"]
    for law, i in product(test["law"].values, range(sides)):
        one = Estimate.read(test.sel(law=law).isel(side=i), "strength")
        shift = 1.06 ** (i - (sides - 1) / 2) * (1.0 if law == ELASTIC else 1.03)
        bars: dict[str, Any] = {"yerr": reach(*one.ends), "elinewidth": 0.7}
        colour = colour_of(i + 1)
        axes.errorbar(middles * shift, one.value, fmt=MARKERS[i], **faces_of(law, colour), **bars)
    of_theory = test["theory_strength"].sel(law=ELASTIC)
    axes.plot(middles, of_theory, "-", color="0.6", lw=1, zorder=0)
    friction = np.tan(np.radians(test.attrs["basic_friction_angle"]))
    axes.axhline(friction, color="0.6", ls=":", lw=1, zorder=0)
    axes.set_xscale("log")
    ticks = _apart(high)
    axes.set_xticks(ticks, [f"{v:g}" for v in ticks])
    axes.minorticks_off()


def _apart(ticks: np.ndarray) -> list[float]:
    """Ticks of a logarithmic axis whose labels do not overlap."""
    chosen: list[float] = []
    least = (ticks.max() / ticks.min()) ** _CLEAR
    for tick in np.sort(ticks):
        if not chosen or tick >= least * chosen[-1]:
            chosen.append(float(tick))
    return chosen


def _side_entries(test: xr.Dataset) -> list:
    marks = [
        mark(color=colour_of(i + 1), marker=MARKERS[i], ls="none", label=f"{side:g}")
        for i, side in enumerate(test["side"].values)
    ]
    filled = [
        mark(color="0.3", marker="o", ls="none", label="filled: elastic"),
        mark(color="0.3", marker="o", mfc="white", ls="none", label="hollow: capped"),
    ]
    return [heading("strength: side $b$ (nodes)"), *marks, *filled]


def _line_entries(test: xr.Dataset) -> list:
    return [
        mark(color="0.3", marker="_", ms=12, ls="none", label="as $v$ alone makes it"),
        mark(color="0.6", marker="x", ls="-", label="theory: height differences at $v$"),
        mark(color="0.6", ls=":", label=r"basic friction $\tan\varphi_b$"),
        Patch(color="0.9", label=f"no size effect: within {test.attrs['bound']:g}"),
        heading(f"side by side; bars: {100 * PROBABILITY:.0f} % intervals"),
    ]


def _words(test: xr.Dataset) -> dict[str, Any]:
    """Ranges of the exponents, and how many classes have which verdict."""
    names = ("pooled_exponent", "scaled_strength_exponent", "beyond_exponent")
    pooled, scaled, beyond = (test[name].values[np.isfinite(test[name].values)] for name in names)
    texts, count = np.unique(test["overall"].values, return_counts=True)
    return {
        "pooled": _range(pooled),
        "scaled": _range(scaled),
        "beyond": float(abs(beyond).max()) if beyond.size else np.nan,
        "verdicts": dict(zip(texts.tolist(), count.tolist(), strict=True)),
    }


def _range(values: np.ndarray) -> dict[str, None]:
    """Least and largest in words, once if they read alike; empty without any."""
    return (
        dict.fromkeys(number(end, 3) for end in (values.min(), values.max())) if len(values) else {}
    )
