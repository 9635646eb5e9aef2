"""Dilatancy angle, friction angle and shear strength over the offset, and Barton's law beside."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import ANGLE, Estimate, names_of
from ...core.limits import JRC_RANGE, JRC_SAMPLING, LARGEST_FRICTION_ANGLE
from ..kit.drawing import (
    COLOURS,
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    dilatancy_loads,
    entries,
    group,
    heading,
    headline,
    letter,
    offset_axis,
    settings_of,
)
from ..kit.empty import say_empty
from ..kit.points import draw_points, hollow_entry
from ..kit.sizes import draw_bars, logarithmic, plain_decades, roughness_words
from ..kit.words import opening, place, short

TITLE = "Dilatancy angle, friction angle and shear strength, with Barton's criterion"
SUBJECT = "joint"
NEEDS = ("specimens", "strength")
ORDER = 110


def draw(atlas: DataTree, name: str) -> Drawing:
    """Angles and strength against v, peak and residual strength against pressure.

    Its data are the points of (a) and (b), then those of (c).
    """
    settings = settings_of(atlas, name)
    specimen = group(atlas, "specimens", name)
    direction = settings["contact_directions"][0]
    strength = group(atlas, "strength", name).sel(contact_direction=direction)
    shown = dilatancy_loads(strength["normal_force"].values, settings, specimen)

    figure = Figure(figsize=(WIDTH, 6.2))
    (angles, curves), (summary, legends) = figure.subplots(2, 2)
    _draw_angles(angles, strength, shown)
    _draw_strength(curves, strength, shown)
    _draw_summary(summary, strength)
    legends.axis("off")
    shared = [*entries(angles), *entries(curves), *map(heading, _residual_note(strength, shown))]
    legends.add_artist(
        legends.legend(handles=shared, loc="upper left", title="(a), (b)", labelspacing=_CLOSE)
    )
    of_peaks = [*entries(summary), *map(heading, _scan_words(strength))]
    if of_peaks:
        legends.legend(handles=of_peaks, loc="lower left", title="(c)", labelspacing=_CLOSE)
    headline(figure, settings["label"], place(direction))
    table = pd.concat([_table(strength, shown), _summary_table(strength)], ignore_index=True)
    return Drawing(figure, table, _caption(strength, shown))


def _draw_angles(axes, strength, shown):
    v = strength["midpoint"].values
    rigid = strength["rigid_dilatancy_angle"]
    axes.plot(v, rigid, color="0.6", lw=1, marker=".", label="rigid, $F$ = 0")
    basic = float(strength["basic_friction_angle"])
    for n, j in enumerate(shown):
        angle, held = strength["dilatancy_angle"].values[:, j], _held_at(strength)[:, j]
        style = {"ls": "-", "label": _label(strength, j), **_style(n)}
        draw_points(axes, v, angle, ~held, _ABOVE, **style)
    axes.axhline(0, color="0.8", lw=0.6, zorder=0)
    if np.isfinite(basic):
        axes.axhline(LARGEST_FRICTION_ANGLE - basic, color="0.4", lw=0.8, ls=":", label=_held())
        other = axes.secondary_yaxis(
            "right", functions=(lambda i: i + basic, lambda angle: angle - basic)
        )
        other.set_ylabel(r"friction angle $\varphi_b + i$ (degrees)")
    _offset_axis(axes, v)
    axes.set_ylabel("dilatancy angle $i$ (degrees)")
    letter(axes, "a", "dilatancy and friction angle")


def _held():
    return f"held above: friction angle {LARGEST_FRICTION_ANGLE:g}°"


def _draw_strength(axes, strength, shown):
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")
    letter(axes, "b", "shear strength")
    v = strength["midpoint"].values
    if not np.isfinite(strength["shear_strength"]).any():
        axes.set_xlabel(_OFFSET)
        say_empty(axes, _why_none(strength), ticks=False)
        return
    for n, j in enumerate(shown):
        tau, held = strength["shear_strength"].values[:, j], _held_at(strength)[:, j]
        draw_points(axes, v, tau, ~held, _ABOVE, ls="-", **_style(n))
    if _held_at(strength)[:, shown].any():
        hollow_entry(axes, _NO_RESULT)
    _offset_axis(axes, v)
    logarithmic(axes, strength["shear_strength"].values[:, shown])


def _draw_summary(axes, strength):
    axes.set_xlabel(r"nominal pressure $\sigma_0$ (MPa)")
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")
    letter(axes, "c", "peak and residual shear strength")
    sigma = strength["nominal_pressure"].values
    known = {key: strength[key].values for key in _SUMMARY if np.isfinite(strength[key]).any()}
    if not known:
        say_empty(axes, _why_none(strength), ticks=False)
        return
    for n, (key, words) in enumerate(_SUMMARY.items()):
        if key not in known:
            continue
        law = key.startswith("barton")
        style = (
            {"ls": LINES[n - 1]}
            if law
            else {"ls": "none", "marker": _MARKERS[n], "ms": 6 - 2.5 * n}
        )
        held = _peak_held(strength) if key == "peak_strength" else np.zeros(sigma.shape, bool)
        style |= {"color": "k" if n != 1 else _RESIDUAL}
        label = None if held.all() else words
        draw_points(axes, sigma, known[key], ~held, label=label, **style)
        if held.any():
            hollow_entry(axes, f"{words}: held, no result", **style)
    draw_bars(axes, sigma, *Estimate.read(strength, "residual_strength").ends, _RESIDUAL)
    axes.set(xscale="log")
    logarithmic(axes, np.array(list(known.values())))


def _held_at(strength):
    """Which angles (interval, load) were held at their upper bound."""
    return strength["friction_angle"].values > LARGEST_FRICTION_ANGLE


def _peak_held(strength):
    """Whether the peak under each load is one of an angle that was held: that is no result."""
    peak = strength["peak_offset"].values
    if not np.isfinite(peak).any():  # as of a joint that was not slid, which has no intervals
        return np.zeros(peak.shape, bool)
    at = np.abs(np.subtract.outer(strength["midpoint"].values, peak))
    at[~np.isfinite(at)] = np.inf
    return _held_at(strength)[at.argmin(axis=0), np.arange(peak.size)] & np.isfinite(peak)


#: Of hollow points: they stand above the lines of the other pressures.
_ABOVE = {"zorder": 3}
#: Between the lines of the legends, in letters.
_CLOSE = 0.25
#: Of strengths whose angle was held at its bound.
_NO_RESULT = f"angle held at {LARGEST_FRICTION_ANGLE:g}°, no result"


def _why_none(strength):
    """Why there is no strength at all."""
    if not np.isfinite(float(strength["basic_friction_angle"])):
        return "no strength: the study states\nno basic friction angle"
    one = not strength.sizes["interval"]
    return "no strength: one offset alone" if one else "no strength: no angle is known"


def _residual_note(strength, shown):
    """Entry of a legend: the residual angle under the largest of the loads shown, if known."""
    one = strength.isel(normal_force=shown[-1])
    if not strength.sizes["interval"] or not int(one["residual_n"]):
        return []
    pressure = short(one["nominal_pressure"])
    return [rf"residual $i$ at {pressure} MPa:" + f"\n{_residual_words(one)}"]


def _scan_words(strength):
    """Entry of a legend: the JRC of the scan, if known."""
    jrc = float(strength["jrc"].sel(sampling=JRC_SAMPLING))
    step = float(strength["step"].sel(sampling=JRC_SAMPLING))
    if not np.isfinite(jrc):
        return []
    beyond = np.isfinite(strength["jrc_used"]) and np.isnan(strength["scaled_roughness"])
    scaled = f",\nscaled to this length above Barton's {JRC_RANGE[1]:g}" if beyond else ""
    return [f"JRC of the scan: {short(jrc)} (steps of {short(step)} mm){scaled}"]


#: What (c) shows: variable and words.
_SUMMARY = {
    "peak_strength": "peak over the offsets",
    "residual_strength": "residual; bar: 95 % interval, if known",
    "barton_strength": f"peak by Barton, at most {LARGEST_FRICTION_ANGLE:g}°, JRC of the scan",
    "barton_scaled_strength": "peak by Barton and Bandis, for this length",
}
#: Of peak and residual in (c): colours and markers of no pressure.
_RESIDUAL, _MARKERS = COLOURS[4], ("o", "D")


_OFFSET = "offset $v$, middle of the interval (mm)"


def _offset_axis(axes, v):
    """Offsets along x; drawn last, because its ticks follow the range of what was drawn."""
    offset_axis(axes, np.asarray(v))
    if axes.get_xscale() == "log":
        plain_decades(axes.xaxis)
    axes.set_xlabel(_OFFSET)


def _style(n):
    return {"color": colour_of(n + 1), "marker": MARKERS[n % len(MARKERS)]}


def _label(strength, j):
    return rf"nominal pressure $\sigma_0$ = {short(strength['nominal_pressure'][j])} MPa"


def _table(strength, shown):
    rows = [
        pd.DataFrame(
            {
                "curve": "over the offsets",
                "nominal_pressure_MPa": float(strength["nominal_pressure"][j]),
                "offset_mm": strength["midpoint"].values,
                "rigid_dilatancy_angle_deg": strength["rigid_dilatancy_angle"].values,
                "dilatancy_angle_deg": strength["dilatancy_angle"].values[:, j],
                "friction_angle_deg": strength["friction_angle"].values[:, j],
                "held": _held_at(strength)[:, j],
                "shear_strength_MPa": strength["shear_strength"].values[:, j],
            }
        )
        for j in shown
    ]
    return pd.concat(rows, ignore_index=True)


def _summary_table(strength):
    columns = (*_SUMMARY, *names_of("residual_strength")[1:])
    return pd.DataFrame(
        {
            "curve": "peak and residual",
            "nominal_pressure_MPa": strength["nominal_pressure"].values,
            "peak_offset_mm": strength["peak_offset"].values,
            "peak_held": _peak_held(strength),
            **{f"{key}_MPa": strength[key].values for key in columns},
        }
    )


# -- caption ---------------------------------------------------------------------------------------


def _caption(strength, shown):
    return (
        f"{opening('section 5')} Dilatancy angle i, strength sigma_0 tan(phi_b + i) with the "
        "basic friction angle phi_b, its peak and residual. "
        f"{_strength_words(strength, shown)} {_barton_words(strength)}"
    )


def _strength_words(strength, shown):
    """The warning that peaks held at their bound are no result."""
    if not strength.sizes["interval"]:
        return "One offset alone: there is no angle."
    if not np.isfinite(float(strength["basic_friction_angle"])):
        peaks = [short(a) for a in strength["peak_dilatancy_angle"].values[shown]]
        rigid = strength["rigid_dilatancy_angle"].values
        beside = f" (rigid {short(np.nanmax(rigid))})" if np.isfinite(rigid).any() else ""
        return (
            "The study states no basic friction angle, so there is no strength; the largest i "
            f"under the pressures are {', '.join(peaks)} degrees{beside}."
        )
    held = strength["held_high"].values[shown].astype(int)
    n = strength.sizes["interval"]
    if not (held > 0).any():
        return "No angle had to be held."
    return (
        f"{_counts(held)} of {n} angles were held at {LARGEST_FRICTION_ANGLE:g} degrees: no result."
    )


def _residual_words(strength):
    """The dilatancy angle beyond half of the largest offset, under one load."""
    angle = Estimate.read(strength, "residual_angle", scale=ANGLE)
    count = int(strength["residual_n"])
    if count > 1:
        return f"{angle.text('degrees')}, {count} intervals"
    return f"{short(angle.value)} degrees (one interval)" if count else "none"


def _counts(held):
    low, high = held.min(), held.max()
    return f"{low}" if low == high else f"{low} to {high}"


def _barton_words(strength):
    """The computed peaks over those of Barton's law, with its roughness."""
    words = roughness_words(strength)
    ratio = (strength["peak_strength"] / strength["barton_strength"]).values
    if not np.isfinite(ratio).any():
        return f"{words}; no Barton's law without friction angle and wall strength."
    # A strength of nothing has no place on the axis.
    ratio = ratio[np.isfinite(ratio) & (ratio > 0) & ~_peak_held(strength)]
    if not ratio.size:
        return f"{words}; every peak is held at the bound, none compared with Barton's."
    return f"{words}; peaks {short(ratio.min())} to {short(ratio.max())} times Barton's."
