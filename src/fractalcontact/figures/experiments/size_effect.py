"""The decision on eq. 6 at a glance: exponent of the contact area over the size, and prediction."""

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
from ...experiments.size_decision import NO_EFFECT, PROBABILITY, REFUTED, UPHELD
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

TITLE = "Size effect of the contact area on synthetic surfaces: measured against eq. 6"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 5

#: Arms that vary the size, in words.
_ARMS = {
    "S1": "surfaces of several sides $b$, roll-off length fixed",
    "S2": "roll-off in proportion to the side $b$",
    "S3": "surfaces without a roll-off",
    "W": "windows of surfaces without a roll-off",
}
#: Estimators of Delta_sigma: variable, words, filled.
_ESTIMATORS = (("area_delta", "$A_r(s)$", True), ("box_delta", "box counts", False))


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """alpha of every class and load against what eq. 6 wants by both estimators."""
    test = group(atlas, "size_effect", "surfaces")
    arms = test["arm"].values
    columns = min(len(arms), 2)
    rows = -(-len(arms) // columns)
    figure = Figure(figsize=(WIDTH, 1.1 + 3 * rows))
    panels = figure.subplots(rows, columns, sharey=True, squeeze=False)
    table = _table(test)
    for axes in panels.ravel()[len(arms) :]:
        axes.remove()
    for which, axes, arm in zip("abcd", panels.ravel(), arms, strict=False):
        _draw_arm(axes, table[table["arm"] == arm], test)
        title = _ARMS[str(arm)]
        if len(arms) > 1:
            letter(axes, which, title)
        else:
            axes.set_title(title, loc="left")
        axes.set_xlabel(r"exponent wanted by eq. 6: $-(2-\Delta_\sigma)$ (1)")
    for axes in panels[:, 0]:
        axes.set_ylabel(r"exponent found: $\alpha=\mathrm{d}\ln(A_r/A_0)/\mathrm{d}\ln b$ (1)")
    bars = heading(f"bars: {100 * PROBABILITY:.0f} % intervals")
    legends_below(figure, [*_classes(test), bars], _loads(test), _lines())
    return Drawing(figure, table, _caption(test))


def _table(test: xr.Dataset) -> pd.DataFrame:
    """One row a class, load and estimator: alpha and the prediction, with their intervals."""
    rows = []
    for arm in test["arm"].values:
        for hurst in test["hurst"].values:
            for load in test["reduced_pressure"].values:
                one = test.sel(arm=arm, hurst=hurst, reduced_pressure=load)
                for name, words, _ in _ESTIMATORS:
                    predicted = Estimate.read(one, name).mapped(lambda delta: delta - 2)
                    rows.append(
                        {
                            "arm": arm,
                            "hurst": hurst,
                            "p_over_E_slope": load,
                            "estimator": words.strip("$"),
                            **Estimate.read(one, "alpha").columns("alpha"),
                            **predicted.columns("eq6"),
                            "central_alpha": float(one["central_alpha"]),
                            "theory_alpha": float(one["theory_alpha"]),
                            "verdict": str(one["verdict"].values),
                            "no_size_effect": bool(one["no_size_effect"]),
                        }
                    )
    return pd.DataFrame(rows)


def _draw_arm(axes: Axes, table: pd.DataFrame, test: xr.Dataset) -> None:
    """Points of one arm: colours are Hurst exponents, markers loads, hollow ones box counts."""
    axes.axhspan(-NO_EFFECT, NO_EFFECT, color="0.88", lw=0, zorder=0)
    axes.axline((0, 0), slope=1, color="k", lw=1.2, ls="--")
    hursts, loads = list(test["hurst"].values), list(test["reduced_pressure"].values)
    for _, row in table.dropna(subset=["alpha", "eq6"]).iterrows():
        colour = colour_of(hursts.index(row["hurst"]))
        filled = row["estimator"] == _ESTIMATORS[0][1].strip("$")
        axes.errorbar(
            row["eq6"],
            row["alpha"],
            xerr=reach(*Estimate.read(row, "eq6").ends),
            yerr=reach(*Estimate.read(row, "alpha").ends),
            fmt=MARKERS[loads.index(row["p_over_E_slope"])],
            color=colour,
            mfc=colour if filled else "white",
            elinewidth=0.7,
        )


def _classes(test: xr.Dataset) -> list:
    return [
        Line2D([], [], color=colour_of(i), marker="o", ls="none", label=_class_words(test, hurst))
        for i, hurst in enumerate(test["hurst"].values)
    ]


def _class_words(test: xr.Dataset, hurst: float) -> str:
    """A Hurst exponent, and what was decided of eq. 6 where all arms say the same."""
    decided = np.unique(test["overall"].sel(hurst=hurst).values)
    words = f": {decided[0]}" if len(decided) == 1 else ""
    return f"$H$ = {hurst:g}{words}"


def _loads(test: xr.Dataset) -> list:
    return [heading(r"pressure $p/(E^*h'_\mathrm{rms})$")] + [
        Line2D([], [], color="0.3", marker=MARKERS[i], ls="none", label=f"{load:g}")
        for i, load in enumerate(test["reduced_pressure"].values)
    ]


def _lines() -> list:
    marks = [
        Line2D(
            [], [], color="0.3", marker="o", ls="none", mfc=fill, label=r"$\Delta_\sigma$ by " + of
        )
        for (_, of, filled) in _ESTIMATORS
        for fill in ["0.3" if filled else "white"]
    ]
    return [
        *marks,
        Line2D([], [], color="k", lw=1.2, ls="--", label="eq. 6 would lie here"),
        Patch(color="0.88", label=rf"no size effect: $|\alpha|$ < {NO_EFFECT:g}"),
    ]


def _caption(test: xr.Dataset) -> str:
    classes = test["overall"]
    refuted = int((classes == REFUTED).sum())
    supported = int((classes == UPHELD).sum())
    flat = int(test["no_size_effect"].sum())
    largest = float(np.nanmax(abs(test["alpha"].values)))
    return (
        f"{SUPPLEMENTARY} Exponent alpha of the contact area over the side b, and eq. 6's. "
        f"Eq. 6 is refuted for {refuted} of {classes.size} classes and supported for "
        f"{supported}: |alpha| is at most {number(largest)}, shown below "
        f"{NO_EFFECT:g} in {flat} of {test['no_size_effect'].size} cases (H, pressure)."
    )
