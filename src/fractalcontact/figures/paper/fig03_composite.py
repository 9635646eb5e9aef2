"""The joint slid: window, profile with dilatancy, composite topography (Fig. 3)."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.datasets import labelled_dataset
from ...core.directions import axis_and_sign
from ...core.subject import Subject
from ...core.window import faces, window_sides, window_slices
from ..kit.caption import caption
from ..kit.drawing import COLOURS, WIDTH, Drawing
from ..kit.legends import entries
from ..kit.maps import HALO, draw_map, missing_patch, scan_extent, window_outline
from ..kit.panel import rows
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ..kit.words import length_unit, place

TITLE = "Fig. 3: the joint slid to its largest offset, dilatancy and composite topography"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "statements")
ORDER = 40

#: Why a correlation may decide nothing.
_TOO_SMALL = "window too small to separate it from chance"
_TOUCH = {"marker": "o", "ms": 7, "mfc": "none", "mec": COLOURS[2], "mew": 1.5, "ls": "none"}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Plan, profile and composite topography at the largest offset.

    Its data are the profiles.
    """
    subject = Subject.of(atlas, name)
    specimen, joint = subject["specimens"], subject["joints"]
    slid = joint.isel(contact_direction=0, offset=int(joint["offset"].values.argmax()))
    # The n-th rigid offset is n cells along the first contact direction.
    slid = slid.sel(direction=slid["contact_direction"].item())
    slid = slid.isel(rigid_offset=int(slid["offset_cells"]))

    figure = Figure(figsize=(WIDTH, 5.6))
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.3, 1])  # type: ignore[misc]  # an array
    plan, composite = top.subplots(1, 2)
    axes = bottom.subplots()
    profile = _profile(specimen, slid)
    handles = _draw_plan(top, plan, specimen, slid)
    _draw_composite(top, composite, specimen, slid)
    _draw_profile(axes, profile, slid, before=specimen.attrs["opposite"] == "scanned")
    bottom.legend(handles=handles + entries(axes), loc="outside lower center", ncols=3)
    known = bool(np.isfinite(slid["correlation_limit"]))
    chance = f", by chance up to {slid['correlation_limit']:.2f}" if known else f"\n{_TOO_SMALL}"
    correlation = f"correlation of the faces {slid['face_correlation']:+.2f}{chance}"
    letter(plan, "a", "lower face and window")
    letter(composite, "b", f"composite topography $h$\n{correlation}")
    letter(axes, "c", "profile through the point of first touch")
    offset = float(slid["offset"])
    headline(figure, subject.label, place(slid["direction"].item(), offset))
    left = claim(atlas, name, "no_correlation_is_left", why="" if known else _TOO_SMALL)
    words = {"offset": offset, "opening": float(slid["rigid_dilatancy"]), "left": left}
    return Drawing(figure, rows(profile, *profile.data_vars), caption(__name__, **words))


def _way(slid):
    """Axis along which the upper block slides, and the sign of its way there."""
    return axis_and_sign(slid["direction"].item())


def _profile(specimen, slid):
    """Heights of both faces along the line of sliding through the first touch.

    They go over the windows before and after, and a little beyond.
    """
    axis, sign = _way(slid)
    along = "yx".index(axis)
    across = "yx"[1 - along]
    (line,) = np.flatnonzero(specimen[across] == slid[f"first_touch_{across}"])
    lower, upper = (np.take(face, line, axis=1 - along) for face in faces(specimen))
    window, cells = window_slices(specimen)[along], sign * int(slid["offset_cells"])
    after = slice(window.start + cells, window.stop + cells)
    # Lifted so far, the upper face touches the lower one in one node.
    lift = np.max(lower[after] - upper[window])
    lifted = np.full((2, lower.size), np.nan)
    lifted[0, window] = upper[window] + lift - float(slid["rigid_dilatancy"])
    lifted[1, after] = upper[window] + lift
    heights = {"lower": lower, "upper_before": lifted[0], "upper_after": lifted[1]}
    table = {face: (axis, "mm", f"height, {face.replace('_', ' ')}") for face in heights}
    first, last = min(window.start, after.start), max(window.stop, after.stop)
    margin = (last - first) // 20
    whole = labelled_dataset(table, heights, coords={axis: specimen[axis]})
    return whole.isel({axis: slice(max(first - margin, 0), last + margin)})


def _draw_heights(figure, axes, heights, sides, label, cmap):
    """A map of heights with its colours; how many mm the unit of its axes is."""
    unit, size = length_unit(np.nanmax(heights) - np.nanmin(heights))
    image = draw_map(axes, heights / size, sides, cmap=cmap)
    figure.colorbar(image, ax=axes, shrink=0.8, label=f"{label} ({unit})")
    return length_unit(max(sides))[1]


def _draw_plan(figure, axes, specimen, slid):
    """The scan and the window twice; entries of a legend."""
    heights = specimen["lower"].values
    size = _draw_heights(figure, axes, heights, scan_extent(specimen), "height", "Greys_r")
    axis, sign = _way(slid)
    moved = tuple(sign * float(slid["offset"]) * (axis == one) for one in "yx")
    dashed = {"edgecolor": COLOURS[1], "ls": "--", "label": "window before"}
    whole = {"edgecolor": COLOURS[4], "label": "window after"}
    outlines = [
        axes.add_patch(window_outline(specimen, size, way, lw=1.5, **style))
        for way, style in (((0.0, 0.0), dashed), (moved, whole))
    ]
    return outlines + ([missing_patch()] if np.isnan(heights).any() else [])


def _draw_composite(figure, axes, specimen, slid):
    """Composite topography with the node that touches first."""
    heights = slid["composite"].values
    size = _draw_heights(figure, axes, heights, window_sides(specimen), "$h$", "cividis")
    corner = {"x": slid["window_x"][0], "y": slid["window_y"][0]}  # centre of its cell
    x, y = (
        float(slid[f"first_touch_{axis}"] - at + specimen.attrs[f"spacing_{axis}"] / 2) / size
        for axis, at in corner.items()
    )
    axes.plot(x, y, path_effects=HALO, **_TOUCH)


def _draw_profile(axes, profile, slid, *, before):
    """Both faces, offset and dilatancy."""
    axis, sign = _way(slid)
    offset, opening = float(slid["offset"]), float(slid["rigid_dilatancy"])
    x, lower = profile[axis].values, profile["lower"]
    unit, size = length_unit(x[-1])
    highest = max(float(face.max()) for face in profile.values())
    height_unit, height = length_unit(highest - float(lower.min()))
    axes.plot(x / size, lower / height, color=COLOURS[0], lw=0.9, label="lower face")
    if before:
        style = {"color": COLOURS[1], "lw": 0.7, "ls": "--"}
        label = "upper face at first touch, $v$ = 0"
        axes.plot(x / size, profile["upper_before"] / height, label=label, **style)
    label = r"upper face, slid by $v$ and lifted by $\delta_r$"
    axes.plot(x / size, profile["upper_after"] / height, color=COLOURS[4], lw=0.9, label=label)

    start = float(slid[f"first_touch_{axis}"])
    end = start + sign * offset
    top = float(profile["upper_after"].sel({axis: end}, method="nearest")) / height
    bottom = top - opening / height
    arrow = {"arrowstyle": "<->", "color": COLOURS[3], "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    corner = end / size, bottom
    for tip, tail in ((corner, (start / size, bottom)), ((end / size, top), corner)):
        axes.annotate("", tip, tail, arrowprops=arrow)
    # The numbers stand in the legend: on the profile they would hide it.
    label = rf"offset $v$ = {offset:.3g} mm, dilatancy $\delta_r$ = {opening:.3g} mm"
    axes.plot([], [], color=COLOURS[3], lw=1.2, label=label)
    axes.plot(end / size, top, label="first touch", **_TOUCH)
    axes.set_xlabel(f"${axis}$ ({unit})")
    axes.set_ylabel(f"height ({height_unit})")
    axes.margins(x=0, y=0.15)
    floor, ceiling = axes.get_ylim()
    floor = min(floor, bottom - 0.1 * (ceiling - bottom))  # the arrow stays clear of the axis
    axes.fill_between(x / size, lower / height, floor, color="0.9", lw=0, zorder=0)
    axes.set_ylim(floor, ceiling)
