"""Dilatancy angle, friction angle and shear strength over the offset, and Barton's law beside."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate
from ...core.limits import LARGEST_FRICTION_ANGLE
from ...core.subject import Subject
from ...core.text import compact
from .. import kit

TITLE = "Dilatancy angle, friction angle and shear strength, with Barton's criterion"
SUBJECT = "joint"
NEEDS = ("closure", "strength", "measured")
ORDER = 110
JOINT_STUDY = True

_TITLES = ("dilatancy and friction angle", "shear strength", "peak and residual shear strength")
_LIMIT = f"{compact(LARGEST_FRICTION_ANGLE, 6)}°"
#: Words and style of the variables of (c), and variables that state which points are results.
_SUMMARY: dict[str, tuple[str, dict[str, Any]]] = {
    "peak_strength": ("peak over the offsets", {"marker": "o", "ms": 6, "color": "k"}),
    "peak_contact_strength": (
        "peak from the contact itself",
        {"marker": "^", "ms": 4, "color": kit.COLOURS[1]},
    ),
    "residual_strength": (
        "residual; bar: 95 % interval, if known",
        {"marker": "D", "ms": 3.5, "color": kit.COLOURS[4]},
    ),
    "barton_strength": (
        f"peak by Barton, at most {_LIMIT}, JRC of the scan",
        {"ls": "--", "color": "k"},
    ),
    "barton_scaled_strength": (
        "peak by Barton and Bandis, for this length",
        {"ls": "-.", "color": "k"},
    ),
}
_VALID = {"peak_strength": "peak_strength_valid", "peak_contact_strength": "peak_contact_valid"}
#: Style of curves over the offset: hollow points lie above the lines of the other pressures.
_CURVES: dict[str, Any] = {
    "hue": "normal_force",
    "first": 1,
    "filled": "shear_strength_valid",
    "hollow": {"zorder": 3},
    "ls": "-",
}


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Angles and strength against v, peak and residual strength against pressure."""
    subject = Subject.of(atlas, name)
    strength = subject.along("strength").transpose("interval", "normal_force", ...)
    shown = strength.isel(normal_force=list(subject.reported.loads))
    figure = Figure(figsize=(kit.WIDTH, 7.2))
    *places, legend = figure.subplots(2, 2).flat
    a, b, c = kit.panels_of(places, _TITLES)
    _draw_angles(a, shown)
    _draw_strength(b, shown)
    kit.draw_tests(b, subject, "shear")
    _draw_summary(c, strength)
    kit.draw_tests(c, subject, "strength")
    legend.axis("off")
    of_offsets = [kit.heading("(a), (b)"), *a.entries, *b.entries]
    of_pressures = [kit.heading(""), kit.heading("(c)"), *c.entries]
    legend.legend(handles=[*of_offsets, *of_pressures], loc="center left", labelspacing=0.35)
    kit.headline(figure, subject.label, kit.place(subject.direction))
    return kit.Drawing(
        figure, kit.table_of(a, b, c), kit.caption(__name__, **_words(subject, strength, shown))
    )


def _draw_angles(panel: kit.Panel, strength: xr.Dataset) -> None:
    axes = panel.axes
    rigid: dict[str, Any] = {"color": "0.6", "lw": 1, "marker": ".", "ls": "-"}
    panel.curve(
        strength.drop_dims("normal_force"),
        "midpoint",
        "rigid_dilatancy_angle",
        label="rigid, $F$ = 0",
        **rigid,
    )
    pressures = [compact(pressure) for pressure in strength["nominal_pressure"].values]
    labels = [rf"nominal pressure $\sigma_0$ = {pressure} MPa" for pressure in pressures]
    keep = ("friction_angle", "nominal_pressure")
    panel.curves(strength, "midpoint", "dilatancy_angle", labels=labels, keep=keep, **_CURVES)
    basic = float(strength["basic_friction_angle"])
    if np.isfinite(basic):
        label = f"truncated above: friction angle {_LIMIT}"
        axes.axhline(LARGEST_FRICTION_ANGLE - basic, color="0.4", lw=0.8, ls=":", label=label)
        functions = (lambda i: i + basic, lambda angle: angle - basic)
        other = axes.secondary_yaxis("right", functions=functions)
        other.set_ylabel(r"friction angle $\varphi_b + i$ (degrees)")
    _offset_axis(panel, strength)
    axes.set_ylabel("dilatancy angle $i$ (degrees)")


def _draw_strength(panel: kit.Panel, strength: xr.Dataset) -> None:
    panel.curves(strength, "midpoint", "shear_strength", **_CURVES)
    panel.axes.set_ylabel(r"shear strength $\tau$ (MPa)")
    _offset_axis(panel, strength)
    if not strength["shear_strength"].notnull().any():
        kit.say_empty(panel.axes, kit.NO_STRENGTH, ticks=False)
        return
    if not strength["shear_strength_valid"].all():
        kit.hollow_entry(
            panel.axes, f"excluded: truncated at {_LIMIT},\nor half of the window touches"
        )
    kit.logarithmic(panel.axes, strength["shear_strength"].values)


def _offset_axis(panel: kit.Panel, strength: xr.Dataset) -> None:
    """Axis of offsets, drawn last because its ticks follow the range drawn."""
    kit.offset_axis(panel.axes, strength["midpoint"].values)
    if panel.axes.get_xscale() == "log":
        kit.plain_decades(panel.axes.xaxis)
    panel.axes.set_xlabel("offset $v$, middle of the interval (mm)")


def _draw_summary(panel: kit.Panel, strength: xr.Dataset) -> None:
    """Strengths by every law over sigma_0; hollow where it is no result."""
    axes, sigma = panel.axes, strength["nominal_pressure"].values
    axes.set_xlabel(f"{kit.NOMINAL_PRESSURE} (MPa)")
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")
    panel.keep(strength, "peak_offset", *_VALID.values(), *_SUMMARY, "peak_over_barton")
    strengths = {name: strength[name].values for name in _SUMMARY if strength[name].notnull().any()}
    if not strengths:
        kit.say_empty(axes, kit.NO_STRENGTH, ticks=False)
        return
    for name, values in strengths.items():
        words, style = _SUMMARY[name]
        valid = strength[_VALID[name]].values if name in _VALID else np.ones(sigma.shape)
        kit.draw_points(axes, sigma, values, valid, label=words, **style)
    if not all(strength[valid].all() for valid in _VALID.values()):
        kit.hollow_entry(axes, "hollow: truncated, no result but a bound")
    bars = Estimate.read(strength, "residual_strength").ends
    kit.draw_bars(axes, sigma, *bars, _SUMMARY["residual_strength"][1]["color"])
    axes.set(xscale="log")
    kit.logarithmic(axes, np.array(list(strengths.values())))


def _words(subject: Subject, strength: xr.Dataset, shown: xr.Dataset) -> dict[str, Any]:
    """Values of the caption: angles and strengths."""
    valid = strength["peak_strength_valid"] & (strength["peak_strength"] > 0)
    return {
        "tests": [*kit.test_words(subject, "shear"), *kit.test_words(subject, "strength")],
        "intervals": strength.sizes["interval"],
        "stated": bool(np.isfinite(strength["basic_friction_angle"])),
        "peaks": shown["peak_dilatancy_angle"].values.tolist(),
        "rigid": max(strength["rigid_dilatancy_angle"].values, default=np.nan),
        "truncated": shown["truncated_high"].values.tolist(),
        "limit": LARGEST_FRICTION_ANGLE,
        "roughness": kit.roughness_words(strength),
        "law": bool(np.isfinite(strength["peak_over_barton"]).any()),
        "ratios": strength["peak_over_barton"].values[valid].tolist(),
        "sides": _sides_of_barton(strength.isel(normal_force=valid.values)),
    }


def _sides_of_barton(strength: xr.Dataset) -> list[str]:
    """Sides of Barton's law on which peak strengths lie beyond both intervals, load by load."""
    peak, barton = (Estimate.read(strength, f"{of}_strength") for of in ("peak", "barton"))
    sides = np.where(peak.low > barton.high, "above", "not distinguishable from")
    return np.where(peak.high < barton.low, "below", sides).tolist()
