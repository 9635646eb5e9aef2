"""Shear strength against the size of the joint, computed (Fig. 1b)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import compact, percent
from .. import kit

TITLE = "Fig. 1b: shear strength against the size of the joint, at equal offset over size"
SUBJECT = "joint"
NEEDS = ("windows", "statements")
ORDER = 10
JOINT_STUDY = True

#: Variables of the table, at every v/b.
_COLUMNS = (
    *("strength_at_equal_v_over_b", "strength_of_whole_at_equal_v", "slope_at_equal_v_over_b"),
    *("slope_of_whole_at_equal_v", "truncated_fraction_at_equal_v_over_b"),
    *("side", "windows", "barton_scaled_strength"),
)


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Strength and slope of the dilatancy curve against b at one v/b; the data have every v/b."""
    subject = Subject.of(atlas, name)
    laws = subject["windows"]
    drawn = laws.sel(share=float(laws["strength_share"]))
    share = percent(float(drawn["share"]))
    figure = Figure(figsize=(kit.WIDTH, 4.6))
    strength, slope = figure.subplots(1, 2)
    kit.letter(strength, "a", f"strength at $v$ = {share} of $b$")
    kit.letter(slope, "b", f"dilatancy at $v$ = {share} of $b$")
    _draw_strength(strength, drawn)
    _draw_slope(slope, drawn)
    whole = kit.mark(
        color="0.4", lw=0.8, label="lines: whole window at the same $v$, no effect of $b$"
    )
    slopes = [*kit.entries(slope), whole, kit.heading(kit.BARS), kit.heading(kit.SHIFTED)]
    kit.legends_below(figure, kit.entries(strength), slopes)
    kit.headline(figure, subject.label, kit.place(str(laws["direction"].values)))
    fitted = drawn["slope_at_equal_v_over_b_exponent"].notnull()
    at_one_v = drawn["slope_at_equal_v_exponent"].values
    words = kit.caption(
        __name__,
        share=float(drawn["share"]),
        trends=drawn["slope_at_equal_v_over_b_trend"].values[fitted].tolist(),
        at_one_v=sorted(at_one_v[np.isfinite(at_one_v)]),
        lost=int((drawn["slope_at_equal_v_over_b"] <= 0).sum()),
        claim=kit.claim(atlas, name, "strength_falls_with_size"),
    )
    table = kit.rows(laws.transpose("normal_force", "share", "part", ...), *_COLUMNS)
    return kit.Drawing(figure, table, words)


def _draw_strength(axes: Axes, laws: xr.Dataset) -> None:
    valid = laws["strength_at_equal_v_over_b_valid"]
    _draw_sizes(axes, laws, "strength", kit.NO_STRENGTH, filled=valid)
    for j in range(laws.sizes["normal_force"]):
        barton = laws["barton_scaled_strength"].isel(normal_force=j)
        axes.plot(laws["side"], barton, color=kit.series(j)["color"], lw=0.8, ls="--")
    kit.name_exponents(axes, laws, "strength_at_equal_v_over_b_exponent", r"\tau")
    if not valid.all():
        kit.hollow_entry(axes, kit.TRUNCATED)
    if np.isfinite(laws["barton_scaled_strength"]).any():
        axes.plot([], [], color="0.4", ls="--", lw=0.8, label="Barton and Bandis (50 to 400 mm)")
    axes.set_ylabel(r"shear strength $\tau$ (MPa)")


def _draw_slope(axes: Axes, laws: xr.Dataset) -> None:
    _draw_sizes(axes, laws, "slope", "no offset lies at one v/b of the sizes")
    kit.name_exponents(axes, laws, "slope_at_equal_v_over_b_exponent", r"d\delta/dv")
    expected = laws["slope_at_equal_v_over_b_expected"]
    if expected.notnull().any():
        exponent = compact(float(laws["expected_hurst"]) - 1)
        label = rf"self-affine, Hurst exponent $H$: $x = H - 1$ = {exponent}"
        axes.plot(laws["side"], expected, color="0.5", ls=":", label=label)
    axes.set_ylabel(r"slope $d\delta/dv$ of the dilatancy curve (mm/mm)")


def _draw_sizes(axes, laws, of, missing, **filled):
    """Means of sub-windows over b at one v/b, and the whole window at the same v."""
    values, whole = laws[f"{of}_at_equal_v_over_b"], laws[f"{of}_of_whole_at_equal_v"]
    kit.draw_over_size(axes, laws, f"{of}_at_equal_v_over_b", **filled)
    for j in range(laws.sizes["normal_force"]):
        line = whole.where(whole > 0).isel(normal_force=j)
        axes.plot(laws["side"], line, color=kit.series(j)["color"], lw=0.8)
    kit.size_axis(axes, laws["side"].values, "joint")
    if (values > 0).any():
        kit.logarithmic(axes, values.values)
    else:
        kit.say_empty(axes, missing, ticks=False)
