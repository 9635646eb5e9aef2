"""The joint slid: window, profile with dilatancy, composite topography (Fig. 3)."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import length_unit, number
from ...core.window import window_sides
from .. import kit
from ._slid_profile import TOUCH, draw_profile, slid_profile, way_of

TITLE = "Fig. 3: the joint slid to its largest offset, dilatancy and composite topography"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "statements")
ORDER = 40
JOINT_STUDY = True

#: Reason why a correlation may be inconclusive.
_TOO_SMALL = "in so small a window chance may give as much"


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Plan, profile and composite topography at the largest offset; the data are the profiles."""
    subject = Subject.of(atlas, name)
    specimen, joint = subject["specimens"], subject["joints"]
    slid = joint.isel(contact_direction=0, offset=int(joint["offset"].values.argmax()))
    # The n-th rigid offset is n cells along the first contact direction.
    slid = slid.sel(direction=slid["contact_direction"].item())
    slid = slid.isel(rigid_offset=int(slid["offset_cells"]))

    figure = Figure(figsize=(kit.WIDTH, 5.6))
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.3, 1])  # type: ignore[misc]  # an array
    plan, composite = top.subplots(1, 2)
    axes = bottom.subplots()
    profile = slid_profile(specimen, slid)
    handles = _draw_plan(top, plan, specimen, slid)
    _draw_composite(top, composite, specimen, slid)
    draw_profile(axes, profile, slid, before=specimen.attrs["opposite"] == "scanned")
    bottom.legend(handles=handles + kit.entries(axes), loc="outside lower center", ncols=3)
    limited = bool(np.isfinite(slid["correlation_limit"]))
    chance = (
        f", by chance up to {number(slid['correlation_limit'])}" if limited else f"\n{_TOO_SMALL}"
    )
    correlation = f"correlation of the faces {number(slid['face_correlation'], 2, '+')}{chance}"
    kit.letter(plan, "a", "lower face and window")
    kit.letter(composite, "b", f"composite topography $h$\n{correlation}")
    kit.letter(axes, "c", "profile through the point of first touch")
    offset = float(slid["offset"])
    kit.headline(figure, subject.label, kit.place(slid["direction"].item(), offset))
    left = kit.claim(atlas, name, "no_correlation_is_left", why="" if limited else _TOO_SMALL)
    words = {"offset": offset, "opening": float(slid["rigid_dilatancy"]), "left": left}
    return kit.Drawing(
        figure, kit.rows(profile, *profile.data_vars), kit.caption(__name__, **words)
    )


def _draw_heights(figure, axes, heights, sides, label, cmap):
    """Map of heights with a colour bar; returns the unit of its axes in mm."""
    unit, size = length_unit(np.nanmax(heights) - np.nanmin(heights))
    image = kit.draw_map(axes, heights / size, sides, cmap=cmap)
    figure.colorbar(image, ax=axes, shrink=0.8, label=f"{label} ({unit})")
    return length_unit(max(sides))[1]


def _draw_plan(figure, axes, specimen, slid):
    """Scan with the window before and after; entries of a legend."""
    heights = specimen["lower"].values
    size = _draw_heights(figure, axes, heights, kit.scan_extent(specimen), "height", "Greys_r")
    axis, sign = way_of(slid)
    moved = tuple(sign * float(slid["offset"]) * (axis == one) for one in "yx")
    dashed = {"edgecolor": kit.COLOURS[1], "ls": "--", "label": "window before"}
    whole = {"edgecolor": kit.COLOURS[4], "label": "window after"}
    outlines = [
        axes.add_patch(kit.window_outline(specimen, size, way, lw=1.5, **style))
        for way, style in (((0.0, 0.0), dashed), (moved, whole))
    ]
    return outlines + ([kit.missing_patch()] if np.isnan(heights).any() else [])


def _draw_composite(figure, axes, specimen, slid):
    """Composite topography with the node that touches first."""
    heights = slid["composite"].values
    size = _draw_heights(figure, axes, heights, window_sides(specimen), "$h$", "cividis")
    corner = {"x": slid["window_x"][0], "y": slid["window_y"][0]}  # centre of its cell
    x, y = (
        float(slid[f"first_touch_{axis}"] - origin + specimen.attrs[f"spacing_{axis}"] / 2) / size
        for axis, origin in corner.items()
    )
    axes.plot(x, y, path_effects=kit.HALO, **TOUCH)
