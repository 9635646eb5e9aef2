"""Dilatancy angle, friction angle and shear strength over the offset, and Barton's law beside."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import ANGLE, Estimate
from ...core.limits import LARGEST_FRICTION_ANGLE
from ...core.subject import Subject
from ..kit.axes import offset_axis
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing
from ..kit.empty import say_empty
from ..kit.laboratory import draw_tests, test_words
from ..kit.legends import entries, heading
from ..kit.panel import Panel, table_of
from ..kit.points import hollow_entry
from ..kit.sizes import logarithmic, plain_decades, roughness_words
from ..kit.titles import headline
from ..kit.words import place, short
from ._peak_strength import draw_summary, scan_entries, why_none

TITLE = "Dilatancy angle, friction angle and shear strength, with Barton's criterion"
SUBJECT = "joint"
NEEDS = ("closure", "strength", "measured")
ORDER = 110

_OFFSET = "offset $v$, middle of the interval (mm)"
#: Of strengths whose friction angle was truncated.
_NO_RESULT = f"excluded: truncated at {LARGEST_FRICTION_ANGLE:g}°,\nor half of the window touches"
#: Of curves over the offset: hollow points stand above the lines of the other pressures.
_CURVES = {
    "hue": "normal_force",
    "first": 1,
    "filled": "shear_strength_valid",
    "hollow": {"zorder": 3},
    "ls": "-",
}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Angles and strength against v, peak and residual strength against pressure."""
    subject = Subject.of(atlas, name)
    strength = subject.along("strength").transpose("interval", "normal_force", ...)
    shown = strength.isel(normal_force=list(subject.reported.loads))

    figure = Figure(figsize=(WIDTH, 7.2))
    (angles, curves), (summary, legends) = figure.subplots(2, 2)
    a = Panel(angles, "a", "dilatancy and friction angle")
    b = Panel(curves, "b", "shear strength")
    c = Panel(summary, "c", "peak and residual shear strength")
    _draw_angles(a, shown)
    _draw_strength(b, shown)
    draw_tests(b, subject, "shear")
    draw_summary(c, strength)
    draw_tests(c, subject, "strength")
    legends.axis("off")
    style = {"labelspacing": 0.25}  # between the lines, in letters
    shared = [*entries(angles), *entries(curves), *_residual_note(shown)]
    legends.add_artist(legends.legend(handles=shared, loc="upper left", title="(a), (b)", **style))
    if of_peaks := [*entries(summary), *scan_entries(strength)]:
        legends.legend(handles=of_peaks, loc="lower left", title="(c)", **style)
    headline(figure, subject.label, place(subject.direction))
    return Drawing(figure, table_of(a, b, c), caption(__name__, **_words(subject, strength, shown)))


def _draw_angles(panel, strength):
    axes = panel.axes
    rigid = {"color": "0.6", "lw": 1, "marker": ".", "ls": "-", "label": "rigid, $F$ = 0"}
    panel.curve(strength.drop_dims("normal_force"), "midpoint", "rigid_dilatancy_angle", **rigid)
    pressures = [short(pressure) for pressure in strength["nominal_pressure"].values]
    labels = [rf"nominal pressure $\sigma_0$ = {pressure} MPa" for pressure in pressures]
    keep = {"keep": ("friction_angle", "nominal_pressure")}
    panel.curves(strength, "midpoint", "dilatancy_angle", labels=labels, **keep, **_CURVES)
    axes.axhline(0, color="0.8", lw=0.6, zorder=0)
    basic = float(strength["basic_friction_angle"])
    if np.isfinite(basic):
        label = f"truncated above: friction angle {LARGEST_FRICTION_ANGLE:g}°"
        axes.axhline(LARGEST_FRICTION_ANGLE - basic, color="0.4", lw=0.8, ls=":", label=label)
        other = axes.secondary_yaxis(
            "right", functions=(lambda i: i + basic, lambda angle: angle - basic)
        )
        other.set_ylabel(r"friction angle $\varphi_b + i$ (degrees)")
    _offset_axis(axes, strength)
    axes.set_ylabel("dilatancy angle $i$ (degrees)")


def _draw_strength(panel, strength):
    axes = panel.axes
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")
    axes.set_xlabel(_OFFSET)
    panel.curves(strength, "midpoint", "shear_strength", **_CURVES)
    if not np.isfinite(strength["shear_strength"]).any():
        say_empty(axes, why_none(strength), ticks=False)
        return
    if not strength["shear_strength_valid"].all():
        hollow_entry(axes, _NO_RESULT)
    _offset_axis(axes, strength)
    logarithmic(axes, strength["shear_strength"].values)


def _offset_axis(axes, strength):
    """Axis of offsets, drawn last because its ticks follow the range drawn."""
    offset_axis(axes, strength["midpoint"].values)
    if axes.get_xscale() == "log":
        plain_decades(axes.xaxis)
    axes.set_xlabel(_OFFSET)


def _residual_note(strength):
    """Entry of a legend: the residual angle under the largest of the loads shown, if known."""
    one = strength.isel(normal_force=-1)
    count = int(one["residual_n"])
    if not strength.sizes["interval"] or not count:
        return []
    angle = Estimate.read(one, "residual_angle", scale=ANGLE)
    words = f"{angle.text('degrees')}, {count} intervals"
    words = words if count > 1 else f"{short(angle.value)} degrees (one interval)"
    return [heading(rf"residual $i$ at {short(one['nominal_pressure'])} MPa:" + f"\n{words}")]


def _words(subject, strength, shown):
    """Values of the caption: angles and strengths."""
    valid = strength["peak_strength_valid"] & (strength["peak_strength"] > 0)
    return {
        "tests": [*test_words(subject, "shear"), *test_words(subject, "strength")],
        "intervals": strength.sizes["interval"],
        "stated": bool(np.isfinite(strength["basic_friction_angle"])),
        "peaks": shown["peak_dilatancy_angle"].values.tolist(),
        "rigid": max(strength["rigid_dilatancy_angle"].values, default=np.nan),
        "truncated": shown["truncated_high"].values.tolist(),
        "limit": LARGEST_FRICTION_ANGLE,
        "roughness": roughness_words(strength),
        "law": bool(np.isfinite(strength["peak_over_barton"]).any()),
        "ratios": strength["peak_over_barton"].values[valid].tolist(),
    }
