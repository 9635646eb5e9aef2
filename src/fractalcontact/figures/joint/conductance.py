"""Thermal or electrical conductance of the interface against pressure (Barber 2003)."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import CONDUCTANCE_EXPONENTS, RESOLVED_NODES
from ...core.subject import Subject
from ...core.text import compact
from .. import kit

TITLE = "Thermal or electrical conductance of the interface against pressure"
SUBJECT = "specimen"
NEEDS = ("closure",)
ORDER = 80

#: Number of offsets drawn.
CURVES = 5


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Conductance at about five offsets, at the finest resolution."""
    subject = Subject.of(atlas, name)
    every = subject.curves()
    curves = every.isel(offset=kit.spread(every.sizes["offset"], CURVES))
    figure = Figure(figsize=(kit.WIDTH, 4.4))
    panel = kit.Panel(figure.subplots())
    axes = panel.axes
    labels = [_label(curves.isel(offset=n)) for n in range(curves.sizes["offset"])]
    kept = ("interface_stiffness", "interface_stiffness_reason", "conductance_exponent")
    panel.curves(
        curves,
        "nominal_pressure",
        "conductance",
        hue="offset",
        labels=labels,
        filled="conductance_fitted",
        keep=kept,
    )
    axes.set(xscale="log", yscale="log")
    _draw_laws(axes, curves)
    _draw_theory(axes, curves)
    axes.set_xlabel(f"{kit.NOMINAL_PRESSURE} (MPa)")
    axes.set_ylabel("conductance over conductivity $h_c/k$ (mm$^{-1}$)")
    label = r"interface stiffness $\mathrm{d}\sigma_0/\mathrm{d}w_\mathrm{int}$ (MPa/mm)"
    kit.second_axis(axes, subject.settings["material"]["e_star"], label)
    remarks = [
        *kit.entries(axes)[len(labels) :],
        kit.heading("lines: fits, exponents with 95 % intervals"),
    ]
    if not curves["conductance_fitted"].all():
        remarks.append(kit.heading(f"hollow: not fitted (fewer than {RESOLVED_NODES} nodes)"))
    if np.isfinite(curves["conductance"]).any():
        remarks += [
            kit.heading(line) for line in kit.missing_lines(curves["interface_stiffness_reason"])
        ]
    kit.legends_below(figure, kit.entries(axes)[: len(labels)], remarks)
    kit.headline(figure, subject.label, kit.place(subject.direction))
    exponents = Estimate.read(curves, "conductance_exponent", scale=EXPONENT)
    verdicts = curves["conductance_beside_theory"].values
    judged = [exponents[i] for i in np.flatnonzero(verdicts != "")]
    words = {"exponents": judged, "powers": [float(one.value) for one in judged]}
    words |= {"beside": verdicts.tolist(), "theory": CONDUCTANCE_EXPONENTS}
    return kit.Drawing(figure, kit.table_of(panel), kit.caption(__name__, **words))


def _label(curve):
    """Offset and exponent of a curve."""
    offset = f"$v$ = {compact(float(curve['offset']))} mm"
    state = "without sliding" if curve["direction"] == "none" else offset
    if not np.isfinite(curve["conductance"]).any():
        return f"{state}: no stiffness of the interface"
    exponent = Estimate.read(curve, "conductance_exponent", scale=EXPONENT)
    return f"{state}: exponent {exponent.text()}"


def _draw_laws(axes, curves):
    """The power law of each curve over the pressures that it was fitted to."""
    for n in range(curves.sizes["offset"]):
        law = curves.isel(offset=n)
        ends = np.array([law[f"conductance_pressure_{end}"].item() for end in ("low", "high")])
        line = law["unit_conductance"].item() * ends ** law["conductance_exponent"].item()
        axes.plot(ends, line, color=kit.colour_of(n), lw=0.8)


def _draw_theory(axes, curves):
    """The slopes of the theories, through the middle of the points fitted and behind them."""
    if not np.isfinite(curves["conductance"]).any():
        why = kit.different_reasons(curves["interface_stiffness_reason"])
        kit.say_empty(axes, "\n".join(why) or kit.TOO_FULL)
        return
    fitted = curves["conductance_fitted"]
    height = np.log(curves["conductance"].where(fitted | ~fitted.any()))
    pressure = np.log(curves["nominal_pressure"]).where(np.isfinite(height))
    ends = np.array([float(pressure.min()), float(pressure.mean()), float(pressure.max())])
    slopes = " and ".join(compact(slope) for slope in CONDUCTANCE_EXPONENTS)
    label = f"theory: slopes {slopes} (at any height)"
    for slope, words in zip(CONDUCTANCE_EXPONENTS, (label, None), strict=True):
        line = np.exp(float(height.mean()) + slope * (ends - ends[1]))
        axes.plot(np.exp(ends), line, color="0.5", lw=1.2, ls="--", zorder=0, label=words)
