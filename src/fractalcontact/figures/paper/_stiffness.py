"""Stiffness of the interface over the spacing, tangent and initial, in the closure figure."""

from typing import Any

import numpy as np
import xarray as xr

from ...core.subject import Subject
from ...core.text import compact, force_label, percent
from ...core.verdicts import UNDETERMINED
from ...core.window import cell_side
from .. import kit

#: Greys and markers of the loads; the offsets have the colours and the other markers.
_GREYS, _MARKERS = ("0.65", "0.45", "0.25", "0"), kit.MARKERS[5:]


def over_spacing(subject: Subject) -> xr.Dataset:
    """Closure curves of the reported offset under the loads that are quoted, over the spacing."""
    curves = subject.reported.at_offset(subject.along("closure"))
    curves = curves.isel(normal_force=subject.reported.quoted).sortby("resolution")
    spacing = curves["resolution"].values * cell_side(subject["specimens"])
    return curves.assign_coords(spacing=("resolution", spacing, {"units": "mm"}))


def draw_stiffness(panel: kit.Panel, curves: xr.Dataset) -> list[str]:
    """Tangent stiffness and k_ni over the spacing, of the curves of :func:`over_spacing`.

    Returns the lines of the legend on stiffnesses that are missing beside others.
    """
    axes, finest = panel.axes, curves.isel(resolution=0)
    tangent, initial = curves["interface_stiffness"], curves["hyperbola_k_ni"]
    kept = ("interface_stiffness_reason", "reference_load")
    for n, force in enumerate(curves["normal_force"].values):
        style: dict[str, Any] = {"color": _GREYS[n % len(_GREYS)], "ls": "-", "lw": 0.7, "ms": 5}
        style |= {"marker": _MARKERS[n % len(_MARKERS)], "filled": "resolved", "keep": kept}
        if tangent[:, n].notnull().any():
            numbers = _numbers(finest.isel(normal_force=n), "interface_stiffness")
            style["label"] = f"tangent, $F$ = {force_label(force)}: {numbers}"
        panel.curve(curves.isel(normal_force=n), "spacing", "interface_stiffness", **style)
    style = {"color": "0", "marker": "_", "ls": (0, (4, 2)), "lw": 0.8}
    style["keep"] = ("hyperbola_k_ni_determined",)
    if initial.notnull().any():
        numbers = _numbers(finest, "hyperbola_k_ni")
        doubted = np.isfinite(initial[0]) and not finest["hyperbola_k_ni_determined"]
        words = f"\n{UNDETERMINED}, {numbers}" if doubted else f" {numbers}"
        style["label"] = f"$k_{{ni}}$ from first touch, bars 95 %:{words}"
    panel.curve(curves, "spacing", "hyperbola_k_ni", **style)
    kit.spacing_axis(axes, curves["spacing"])
    axes.set_ylabel(r"stiffness $\mathrm{d}\sigma_0/\mathrm{d}w_\mathrm{int}$ (MPa/mm)")
    reasons = curves["interface_stiffness_reason"]
    if not (tangent.notnull().any() or initial.notnull().any()):
        kit.say_empty(axes, "\n".join(kit.different_reasons(reasons)) or kit.TOO_FULL)
        return []
    axes.set_yscale("log")
    return kit.missing_lines(reasons, "d")


def _numbers(state, name):
    """Stiffness, and its change at twice the spacing, for a legend."""
    value, change = float(state[name]), float(state[f"{name}_change"])
    if not np.isfinite(value):
        return "not known"
    change_words = f" ({percent(change, sign='+')})" if np.isfinite(change) else ""
    return f"{compact(value)}{change_words}"
