"""Closure from the seat with the laws that laboratories fit, and tangent stiffness."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate
from ...core.limits import RESOLVED_NODES
from ...core.subject import Subject
from ...core.text import compact, pressure_label
from ...core.verdicts import UNDETERMINED
from ...core.window import window_sides
from ...report.published import Number, read, row_of
from .. import kit
from ..paper._closure_laws import hyperbola, offset_words
from ._permanent_set import draw_permanent_set

TITLE = "Closure from the seat, its laws, and tangent stiffness"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "branches", "error_budget", "measured")
ORDER = 45
JOINT_STUDY = True
SECTION = "closure"

_AGAIN: dict[str, Any] = {
    "labels": ["unloading and reloading"],
    "color": kit.colour_of(4),
    "marker": "s",
    "ls": ":",
    "ms": 3,
}
_KEPT = (
    *("nodes", "seating_pressure", "seated_k_ni", "seated_k_ni_determined", "seated_v_m"),
    *("seated_d_0", "seated_chi", "seated_hyperbola_misfit", "seated_logarithm_misfit"),
)


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Closure under the loads from the seat on, and stiffness, at the reported offset."""
    subject = Subject.of(atlas, name)
    curve = subject.states("closure")
    branches = subject["branches"]
    crushed = bool(branches["yielded"].any())
    figure = Figure(figsize=(kit.WIDTH, 7.0 if crushed else 4.2))
    parts: Any = figure.subfigures(2, 1, height_ratios=[3.4, 2.4]) if crushed else [figure]
    top = parts[0]
    seat = float(curve["seating_pressure"])
    since = f"from {pressure_label(seat)} on" if np.isfinite(seat) else "from no seat"
    titles = (f"closure {since}, {offset_words(subject, subject.offset)}", "tangent stiffness")
    a, b = kit.panels_of(top.subplots(1, 2), titles)
    style: dict[str, Any] = {
        "filled": "resolved",
        "ls": "none",
        "color": kit.colour_of(0),
        "marker": "o",
    }
    a.curve(curve, "seated_closure", "nominal_pressure", keep=_KEPT, label="states", **style)
    reloading = branches.sel(branch=["reload"])
    a.curves(reloading, "seated_closure", "nominal_pressure", hue="branch", **_AGAIN)
    _draw_laws(a.axes, curve)
    kit.draw_tests(a, subject, "closure", turned=True)
    _draw_stiffness(b, curve, style)
    b.curves(reloading, "nominal_pressure", "interface_stiffness", hue="branch", **_AGAIN)
    if not np.isfinite(curve["seated_closure"]).any():
        kit.say_empty(a.axes, f"no load from the seat on has {RESOLVED_NODES} nodes in contact")
    a.axes.set_xlabel("closure $d$ from the seat (mm)")
    a.axes.set_ylabel(f"{kit.NOMINAL_PRESSURE} (MPa)")
    why = str(subject["error_budget"]["k_ni_reason"].item())
    remarks: list[Any] = [kit.heading(f"$k_{{ni}}$ undetermined: {why}")] if why else []
    kit.legends_below(top, [*a.entries, *remarks], b.entries)
    kit.headline(figure, subject.label, kit.place(subject.direction))
    sides = window_sides(subject["specimens"])
    below = draw_permanent_set(parts[1], branches, sides) if crushed else []
    table = kit.table_of(a, b, *below)
    words = {"tests": kit.test_words(subject, "closure"), **_words(subject, seat, reloading)}
    return kit.Drawing(figure, table, kit.caption(__name__, **words))


def _draw_laws(axes: Axes, curve: xr.Dataset) -> None:
    """Both laws over the pressures that they are fitted to."""
    ends = float(curve["seating_pressure"]), float(curve["seated_fit_max"])
    if not np.isfinite(ends).all():
        return
    pressure = np.geomspace(*ends, 100)
    d_0, chi = (float(curve[f"seated_{name}"]) for name in ("d_0", "chi"))
    law = hyperbola(np.append(pressure, ends[0]), curve["seated_k_ni"], curve["seated_v_m"])
    bent = r"hyperbola $w = \sigma_0/(k_{ni} + \sigma_0/v_m)$ less $w$(seat)"
    for closure, words, line, colour in (
        (law[:-1] - law[-1], bent, "--", 1),
        (d_0 + chi * np.log(pressure), r"logarithm $d = d_0 + \chi\ln\sigma_0$", "-", 2),
    ):
        if np.isfinite(closure).any():
            axes.plot(closure, pressure, ls=line, lw=1.0, color=kit.colour_of(colour), label=words)


def _draw_stiffness(panel: kit.Panel, curve: xr.Dataset, style: dict[str, Any]) -> None:
    """Stiffness of the states, and at the pressures at which it is stated."""
    kept = ("interface_stiffness_reason",)
    panel.curve(
        curve, "nominal_pressure", "interface_stiffness", keep=kept, label="states", **style
    )
    stated: dict[str, Any] = {
        "ls": "none",
        "marker": "D",
        "color": kit.colour_of(3),
        "ms": 6,
        "mfc": "none",
    }
    panel.curve(
        curve, "reference_pressure", "reference_stiffness", label="stated pressures", **stated
    )
    axes = panel.axes
    axes.set(xscale="log", yscale="log")
    if not np.isfinite(curve["interface_stiffness"]).any():
        kit.say_empty(axes, kit.TOO_FULL)
    axes.set_xlabel(f"{kit.NOMINAL_PRESSURE} (MPa)")
    axes.set_ylabel(r"$\mathrm{d}\sigma_0/\mathrm{d}w_\mathrm{int}$ (MPa/mm)")


def _words(subject: Subject, seat: float, reloading: xr.Dataset) -> dict[str, Any]:
    """Values of the caption."""
    curve, budget = subject.states("closure"), subject["error_budget"]
    on_reload = reloading["reference_stiffness"].sel(branch="reload")
    middle = on_reload["reference_pressure"].values[len(on_reload) // 2]
    return {
        "residual": float(reloading["residual_closure"]),
        "yielded": float(reloading["yielded_fraction"][0, -1]),
        "top": float(reloading["nominal_pressure"][-1]),
        "reload": float(on_reload.sel(reference_pressure=middle)),
        "middle": float(middle),
        "seat": seat,
        "largest": float(curve["seated_fit_max"]),
        **{name: Estimate.read(budget, name) for name in ("k_ni", "v_m", "chi")},
        "misfits": [float(curve[f"seated_{law}_misfit"]) for law in ("hyperbola", "logarithm")],
        "reason": str(budget["k_ni_reason"].item()),
        "stated": [
            (compact(number.at["pressure"]), _stiffness_words(number))
            for number in read(row_of("tangent_stiffness"), subject)
            if not number.missing
        ],
    }


def _stiffness_words(number: Number) -> str:
    """Stiffness with its error, as the page of the specimen has it."""
    if not number.determined:
        return UNDETERMINED
    return f"{compact(number.value, 3)} ± {compact(number.error, 2)} MPa/mm"
