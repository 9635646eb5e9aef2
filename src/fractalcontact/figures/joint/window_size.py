"""Roughness (eq. 2), closure and compliance (sect. 5) against the size of the window."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.subject import Subject
from ...core.text import number, pressure_label
from .. import kit

TITLE = "Roughness (eq. 2), closure and compliance (section 5) against the size of the window"
SUBJECT = "specimen"
NEEDS = ("closure", "windows", "surface_dimension", "statements")
ORDER = 90
JOINT_STUDY = True

#: Variable, exponent, axis and head of the legend of the panels on contact in sub-windows.
_CONTACT = {
    "b": (
        *("interface_closure", "closure_exponent", r"interface closure $w_\mathrm{int}$ (mm)"),
        r"(b) $w_\mathrm{int} \sim b^x$ at nominal pressure",
    ),
    "c": (
        *("interface_compliance", "compliance_exponent"),
        r"compliance $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0$ (mm/MPa)",
        r"(c) $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0 \sim b^x$",
    ),
}
_CLAIM = "larger_samples_close_more"


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """sigma_z, closure and compliance of the interface against the side b of sub-windows."""
    subject = Subject.of(atlas, name)
    laws = subject["windows"]
    shown = subject.reported.at_offset(laws)
    where = kit.place(subject.direction, float(shown["offset"]))
    figure = Figure(figsize=(kit.WIDTH, 5.8))
    *places, legend = figure.subplots(2, 2).flat
    titles = ("roughness", f"closure, {where}", f"compliance, {where}")
    a, b, c = kit.panels_of(places, titles)
    _draw_roughness(a, shown, slides=subject.direction != "none")
    handles = [kit.heading("(a) sub-windows of this window"), *a.entries]
    for panel in (b, c):
        _draw_contact(panel, shown)
        handles += [kit.heading(_CONTACT[panel.which][-1]), *panel.entries]
    label = "hollow: not fitted (out of range, few nodes)"
    handles.append(kit.mark(ls="none", marker="o", color="0.4", mfc="white", label=label))
    handles.append(kit.mark(label="line: fit (thin: undetermined)", color="0.4", lw=0.8))
    legend.axis("off")
    legend.legend(handles=[*handles, kit.heading(kit.BARS)], loc="center left", labelspacing=0.4)
    kit.headline(figure, subject.label)
    return kit.Drawing(
        figure,
        kit.table_of(a, b, c),
        kit.caption(__name__, **_words(atlas, name, laws, subject["surface_dimension"])),
    )


def _draw_roughness(panel: kit.Panel, laws: xr.Dataset, *, slides: bool) -> None:
    """sigma_z of the face and, of a joint that slides, of the gap; eq. 2 through the face's."""
    axes, b = panel.axes, laws["scale_side"].values
    fitted = laws["face_sigma_z_fitted"].values
    drawn = {"face_sigma_z": ("face: $\\sigma_z \\sim b^H$, $H$", "face_hurst", "k", "o")}
    if slides:
        drawn["sigma_z_all"] = ("gap of both faces: $H$", "hurst", "0.65", "D")
    for name, (words, law, colour, marker) in drawn.items():
        # The line through nested sizes of one face has no interval of its own.
        exponent = number(float(laws[law]))
        style: dict[str, Any] = {"color": colour, "marker": marker}
        style |= {"ls": "none", "label": f"{words} = {exponent}"}
        style |= {"filled": "face_sigma_z_fitted", "keep": ("scale_n", "scale_used")}
        panel.curve(laws, "scale_side", name, **style)
    expected = Estimate.read(laws, "expected_hurst", scale=EXPONENT)
    if expected.known and fitted.any():
        label = rf"eq. 2: $H = 3-\Delta_g$ = {_in_words(expected)}"
        axes.plot(b[fitted], laws["face_sigma_z_expected"][fitted], "k--", label=label)
    kit.size_axis(axes, b, "sub-windows")
    if (laws["face_sigma_z"] > 0).any():
        kit.logarithmic(axes, np.concatenate([laws[name].values for name in drawn]))
    axes.set_ylabel(r"roughness $\sigma_z$ about the own plane (mm)")


def _draw_contact(panel: kit.Panel, laws: xr.Dataset) -> None:
    """Closure or compliance over b under every pressure, with the power law of each."""
    axes, b = panel.axes, laws["side"].values
    name, law, label, _ = _CONTACT[panel.which]
    exponents = Estimate.read(laws, law, scale=EXPONENT)
    pressures = laws["nominal_pressure"].values
    labels = [f"{pressure_label(p)}: $x$ = {exponents[j].text()}" for j, p in enumerate(pressures)]
    of_curves: dict[str, Any] = {"hue": "normal_force", "first": 1, "labels": labels, "ls": "none"}
    kept = ("windows", law)
    panel.curves(laws, "side", name, filled=f"{name}_fitted", keep=kept, **of_curves)
    for j in np.flatnonzero(exponents.known).tolist():
        one = laws[f"{name}_law"].where(laws[f"{name}_fitted"]).isel(normal_force=j)
        line = {"color": kit.series(j)["color"], "linewidth": 0.8}
        axes.plot(b, one, **line | ({} if exponents[j].determined else kit.WEAK))
    kit.size_axis(axes, b, "sub-windows")
    if (laws[name] > 0).any():
        kit.logarithmic(axes, laws[name].values)
    else:
        kit.say_empty(axes, "no size holds ten nodes in contact", ticks=False)
    axes.set_ylabel(label)


def _in_words(expected: Estimate) -> str:
    """Exponent that eq. 2 expects; that of a synthetic surface is known without an error."""
    exact = expected.low == expected.high
    return number(float(expected.value)) if exact else expected.text()


def _words(atlas: DataTree, name: str, laws: xr.Dataset, surface: xr.Dataset) -> dict[str, Any]:
    """Values of the caption: H of sigma_z, that of eq. 2, the claim on larger samples."""
    of_windows = surface.sel(estimator=str(surface["recommended"].item()))
    hurst = Estimate.read(of_windows, "hurst", scale=EXPONENT)
    force = float(atlas[f"statements/{name}"].attrs["force"])
    judged = laws["nominal_pressure"].sel(normal_force=force, method="nearest")
    fitted = laws["compliance_exponent"].notnull().any()
    expected = Estimate.read(laws, "expected_hurst", scale=EXPONENT)
    return {
        "hurst": hurst if laws["face_hurst"].notnull() else Estimate(),
        "expected": _in_words(expected) if expected.known else "",
        "is_exact": bool(expected.low == expected.high),
        "claim": kit.claim(
            atlas, name, _CLAIM, why=f"at {pressure_label(float(judged))}" if fitted else ""
        ),
    }
