"""Words, colours and load shared by the figures over specimens and groups."""

from textwrap import fill

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from ...core.estimate import DIMENSION, SIZE, Estimate, names_of
from ...core.labels import printable
from ..kit.axes import label_short_span
from ..kit.empty import say_empty
from ..kit.words import short

#: What each quantity is on an axis.
AXES = {
    "delta_g": r"surface dimension $\Delta_g$ (1)",
    "stiffness": r"tangent stiffness $\mathrm{d}\sigma_0/\mathrm{d}w_\mathrm{int}$ (MPa/mm)",
    "delta_sigma": r"$\Delta_\sigma$ by box counting (1)",
    "dilatancy": r"elastic dilatancy $\delta$ (mm)",
    "size_exponent": r"exponent of $A_r/A_0$ against $b$ (1)",
}
#: What it is above a panel.
TITLES = {
    "delta_g": "surface dimension",
    "stiffness": "stiffness of the interface",
    "delta_sigma": "dimension of the contact",
    "dilatancy": "dilatancy",
    "size_exponent": "size effect",
}
#: Ends of what can only lie between: a mean of few specimens has an interval far beyond.
BETWEEN = {"delta_sigma": (-0.05, 2.05)}
#: Those drawn over decades.
LOGARITHMIC = ("stiffness",)
#: Ends of an axis whose quotient is smaller are no decade.
_DECADE = 10
#: What stands for a group in a study that states none.
UNGROUPED = "no group"
#: Specimens of a study without groups up to which each stands for itself: colours there are.
MAX_ALONE = 7
#: Letters of the name of a group that are shown, and groups that a caption names.
LONGEST, MAX_NAMED = 24, 3


def group_labels(comparison: xr.Dataset) -> list[str]:
    """Names of the groups as they are shown."""
    return [
        printable(name, LONGEST).replace("$", r"\$") for name in comparison["group_name"].values
    ]


def alone(comparison: xr.Dataset) -> bool:
    """True if specimens are drawn one by one: few specimens and no groups."""
    few = comparison.sizes["specimen"] <= MAX_ALONE
    return few and list(comparison["group_name"].values) == [UNGROUPED]


def specimen_labels(comparison: xr.Dataset, width: int) -> list[str]:
    """Labels of the specimens, in lines of ``width`` letters; names for those without a label."""
    shown = (printable(label, 2 * width) for label in comparison["label"].values)
    return [fill(label, width).replace("$", r"\$") for label in shown]


def settle_axis(axes: Axes, name: str, *, drawn: bool) -> None:
    """Scale and ends of the axis of a quantity, once it is drawn; words where nothing is.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    name : str
    drawn : bool
        Whether any specimen has a value.
    """
    axes.set_ylabel(AXES[name])
    if not drawn:
        say_empty(axes, "no specimen\nhas a value")
        axes.set_yticks([])
    elif name in LOGARITHMIC:
        low, high = axes.get_ylim()
        if low <= 0 or high > _DECADE * low:  # else a logarithmic axis would have a label or two
            axes.set_yscale("log", nonpositive="mask")
            label_short_span(axes.yaxis)
    elif name in BETWEEN:
        axes.set_ylim(*BETWEEN[name])


def under_common_pressure(comparison: xr.Dataset) -> xr.Dataset:
    """Quantities of specimens and groups at the most common pressure."""
    under = comparison.sel(pressure=float(comparison["common_pressure"]))
    for name in AXES:
        of = f"{name}_at_common_pressure"
        if of in comparison:
            ends = dict(zip(names_of(of), names_of(name), strict=True))
            under = under.drop_vars(ends.values()).rename(ends)
    return under.drop_dims("load")


def means_of_groups(under: xr.Dataset, name: str, unit: str = "") -> list[str]:
    """Means of the groups with their intervals: "rough 2.41 [2.38, 2.44] of 50"."""
    means = Estimate.read(under, f"{name}_mean", scale=SIZE if unit else DIMENSION)
    found = []
    for i, group in enumerate(under["group_name"].values):
        n = int(under[f"{name}_n"][i])
        words = means[i].text(unit) if n > 1 else short(means.value[i])
        found.append(f"{printable(group, LONGEST)} {words} of {n}")
    return found


def values_range(values: np.ndarray, unit: str = "") -> str:
    """Least and largest of the known values, rounded for captions."""
    known = values[np.isfinite(values)]
    ends = dict.fromkeys(short(end) for end in (known.min(), known.max())) if known.size else ()
    return " to ".join(ends) + unit if ends else ""


def least_and_largest(values: np.ndarray, labels: np.ndarray) -> list[tuple[str, float]]:
    """Least and largest of some values with the labels of their specimens, one if they are one."""
    known = np.flatnonzero(np.isfinite(values))
    if not known.size:
        return []
    ends = dict.fromkeys(known[[np.argmin(values[known]), np.argmax(values[known])]].tolist())
    return [(printable(labels[i], 2 * LONGEST), float(values[i])) for i in ends]
