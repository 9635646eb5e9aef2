"""Roughness (eq. 2), closure and compliance (sect. 5) against the size of the window."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.subject import Subject
from ..kit.caption import caption
from ..kit.drawing import WEAK, WIDTH, Drawing
from ..kit.empty import say_empty
from ..kit.legends import entries, heading, mark
from ..kit.panel import Panel, table_of
from ..kit.points import draw_points
from ..kit.sizes import (
    BARS,
    draw_bars,
    draw_over_size,
    logarithmic,
    series,
    size_axis,
)
from ..kit.titles import headline
from ..kit.verdicts import claim, row_of
from ..kit.words import place, pressure_label

TITLE = "Roughness (eq. 2), closure and compliance (section 5) against the size of the window"
SUBJECT = "specimen"
NEEDS = ("closure", "windows", "statements")
ORDER = 90

#: Of the contact of sub-windows: variable, exponent and axis.
_CONTACT = {
    "b": ("interface_closure", "closure_exponent", r"interface closure $w_\mathrm{int}$ (mm)"),
    "c": (
        "interface_compliance",
        "compliance_exponent",
        r"compliance $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0$ (mm/MPa)",
    ),
}
#: Heads of the legend, by panel.
_HEADS = {
    "a": "(a) exponents with 95 % intervals",
    "b": r"(b) $w_\mathrm{int} \sim b^x$ at nominal pressure",
    "c": r"(c) $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0 \sim b^x$",
}
_CLAIM = "larger_samples_close_more"
#: Points that no exponent goes through: beyond the range of eq. 2, or of few nodes in contact.
_HOLLOW = "hollow: not fitted (out of range, few nodes)"


def draw(atlas: DataTree, name: str) -> Drawing:
    """sigma_z, closure and compliance of the interface against the side b of sub-windows.

    Its data are the means over sub-windows with their intervals; those of contact at all offsets.
    """
    subject = Subject.of(atlas, name)
    laws = subject["windows"]
    shown = laws.sel(offset=subject.offset, method="nearest")
    where = place(subject.direction, float(shown["offset"]))

    figure = Figure(figsize=(WIDTH, 5.8))
    *places, legends = figure.subplots(2, 2).flat
    titles = ("roughness", f"closure, {where}", f"compliance, {where}")
    a, b, c = panels = [Panel(*one) for one in zip(places, "abc", titles, strict=True)]
    _draw_roughness(a, shown, subject.direction != "none")
    for panel in (b, c):
        _draw_contact(panel, shown)
        quantity, exponent, _ = _CONTACT[panel.which]
        every = laws.transpose("offset", "normal_force", "part", ...)
        panel.keep(every, quantity, "side", "windows", exponent)
    legends.axis("off")
    handles = [
        entry for panel in panels for entry in (heading(_HEADS[panel.which]), *entries(panel.axes))
    ]
    handles.append(mark(ls="none", marker="o", color="0.4", mfc="white", label=_HOLLOW))
    if any(np.isfinite(shown[exponent]).any() for _, exponent, _ in _CONTACT.values()):
        label = "line: fit (thin: undetermined)"
        handles.append(mark(label=label, color="0.4", lw=0.8))
    handles.append(heading(BARS))
    legends.legend(handles=handles, loc="center left", labelspacing=0.4)
    headline(figure, subject.label)
    return Drawing(figure, table_of(*panels), caption(__name__, **_words(atlas, name, laws)))


def _draw_roughness(panel, laws, slides):
    """sigma_z of the face and, of a joint that slides, of the gap; eq. 2 through the face's."""
    axes, b = panel.axes, laws["scale_side"].values
    fitted = laws["face_sigma_z_fitted"].values
    shown = {"face_sigma_z": ("face: $\\sigma_z \\sim b^H$, $H$", "face_hurst", "k", "o")}
    if slides:
        shown["sigma_z_all"] = ("gap of both faces: $H$", "hurst", "0.65", "D")
    for name, (words, law, colour, marker) in shown.items():
        means = Estimate.read(laws, name)
        style = {"color": colour, "marker": marker}
        draw_bars(axes, b, *means.ends, colour)
        draw_points(axes, b, means.value, fitted, **style)
        exponent = Estimate.read(laws, law, scale=EXPONENT).text()
        axes.plot([], [], **style | _face(fitted), ls="none", label=f"{words} = {exponent}")
        panel.keep(laws, name, "scale_side", "scale_n", "scale_used", "face_sigma_z_fitted")
    expected = Estimate.read(laws, "expected_hurst", scale=EXPONENT)
    face = laws["face_sigma_z"].values
    if expected.known and fitted.any():
        style = {"color": "k", "ls": "--", "label": rf"eq. 2: $H = 3-\Delta_g$ = {expected.text()}"}
        axes.plot(b[fitted], laws["face_sigma_z_expected"].values[fitted], **style)
    size_axis(axes, b, "sub-windows")
    if (face > 0).any():
        logarithmic(axes, np.concatenate([laws[name].values for name in shown]))
    axes.set_ylabel(r"roughness $\sigma_z$ about the own plane (mm)")


def _draw_contact(panel, laws):
    """Closure or compliance over b under every pressure, with the power law of each."""
    axes, b = panel.axes, laws["side"].values
    name, law, label = _CONTACT[panel.which]
    fitted = laws[f"{name}_fitted"]
    draw_over_size(axes, laws, name, filled=fitted, apart=0)
    exponents = Estimate.read(laws, law, scale=EXPONENT)
    for j, pressure in enumerate(laws["nominal_pressure"].values):
        exponent, inside = exponents[j], fitted.isel(normal_force=j).values
        if exponent.known:
            line = {"color": series(j)["color"], "linewidth": 0.8}
            line |= {} if exponent.determined else WEAK
            axes.plot(b[inside], laws[f"{name}_law"].isel(normal_force=j)[inside], **line)
        words = f"{pressure_label(pressure)}: $x$ = {exponent.text()}"
        axes.plot([], [], **series(j) | _face(inside), ls="none", label=words)
    size_axis(axes, b, "sub-windows")
    if (laws[name] > 0).any():
        logarithmic(axes, laws[name].values)
    else:
        say_empty(axes, "no size holds ten nodes in contact", ticks=False)
    axes.set_ylabel(label)


def _face(fitted):
    """Face of the marker in a legend: white where no symbol drawn is filled."""
    return {} if fitted.any() else {"mfc": "white"}


def _words(atlas, name, laws):
    """Values of the caption: H, that of eq. 2, the claim on larger samples."""
    force = float(atlas[f"statements/{name}"].attrs["force"])
    judged = laws["nominal_pressure"].sel(normal_force=force, method="nearest")
    fitted = np.isfinite(laws["compliance_exponent"]).any()
    row = row_of(atlas, "statements", name, _CLAIM)
    of_specimen = row is None or "realisations" not in row["judged_on"].item()
    why = f"at {pressure_label(float(judged))}" if fitted else ""
    why += ", filled sizes alone" if why and of_specimen else ""
    return {
        "hurst": Estimate.read(laws, "face_hurst", scale=EXPONENT),
        "expected": Estimate.read(laws, "expected_hurst", scale=EXPONENT),
        "claim": claim(atlas, name, _CLAIM, why=why),
    }
