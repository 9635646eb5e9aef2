"""Fig. 11: the limit slope angle against the size of the joint."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import compact, percent
from .. import kit

TITLE = "Fig. 11: limit slope angle against the size of the joint, computed"
SUBJECT = "joint"
NEEDS = ("windows", "strength", "statements")
ORDER = 180

#: Delta_sigma that later work of the paper's school takes from Bandis' shear tests.
QUOTED_DELTA = 1.66
_COLUMNS = (
    *("limit_slope_angle", "side", "windows", "truncated_fraction_at_equal_v_over_b"),
    *("barton_slope_angle", "strength_at_equal_v_over_b_exponent"),
)


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Limit slope angle of parts of the window against their side b; the data have every v/b."""
    subject = Subject.of(atlas, name)
    laws = subject["windows"]
    direction = str(laws["direction"].values)
    strength = subject["strength"].sel(contact_direction=direction)
    shown = laws.sel(share=float(laws["strength_share"]))
    drawn = bool(shown["strength_at_equal_v_over_b"].notnull().all("normal_force").any())
    # Barton's law is stated but has no value: his scale of roughness ends at 20.
    stated = bool(np.isfinite(strength["joint_wall_strength"]))
    beyond = stated and bool(np.isnan(laws["barton_roughness"]).all())
    figure = Figure(figsize=(kit.WIDTH, 3.4))
    axes = figure.subplots()
    _draw_angle(axes, shown)
    axes.set_title(f"at $v$ = {percent(float(shown['share']))} of $b$", loc="left")
    if drawn:
        handles = [*kit.entries(axes), kit.heading(kit.BARS), kit.heading(kit.SHIFTED)]
        axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.01, 0.5), borderaxespad=0)
    else:
        kit.say_empty(axes, kit.NO_STRENGTH, ticks=False)
    kit.headline(figure, subject.label, kit.place(direction))
    words = kit.caption(
        __name__,
        share=float(shown["share"]),
        drawn=drawn,
        beyond=beyond,
        roughness=kit.roughness_words(strength),
        claim=kit.claim(atlas, name, "friction_angle_falls_with_size"),
    )
    table = kit.rows(laws.transpose("share", "normal_force", "part", ...), *_COLUMNS)
    return kit.Drawing(figure, table, words)


def _draw_angle(axes, laws):
    """Angles, Barton and Bandis' law, and the power of b that was quoted for shear tests."""
    b, valid = laws["side"].values, laws["strength_at_equal_v_over_b_valid"]
    kit.draw_over_size(axes, laws, "limit_slope_angle", filled=valid)
    for j in range(laws.sizes["normal_force"]):
        one, style = laws.isel(normal_force=j), {"color": kit.series(j)["color"], "lw": 0.8}
        axes.plot(b, one["barton_slope_angle"], **style, ls="--")
        whole = np.tan(np.radians(float(one["limit_slope_angle"][0])))
        quoted = whole * (b / b[0]) ** (QUOTED_DELTA - 2)
        axes.plot(b, np.degrees(np.arctan(quoted)), **style, ls=":")
    kit.name_exponents(axes, laws, "strength_at_equal_v_over_b_exponent", r"\tau")
    if not valid.all():
        kit.hollow_entry(axes, kit.TRUNCATED)
    if np.isfinite(laws["barton_slope_angle"]).any():
        axes.plot([], [], color="0.4", ls="--", lw=0.8, label="Barton and Bandis' scale law")
    label = f"$x$ = {compact(QUOTED_DELTA, 6)} - 2, by later work of the same school"
    axes.plot([], [], color="0.4", ls=":", lw=0.8, label=label)
    kit.size_axis(axes, b, "joint")
    axes.set_ylim(0, 90)
    axes.set_ylabel(r"limit slope angle $\arctan(\tau/\sigma_0)$ (degrees)")
