"""The joint slid: window, profile with dilatancy, composite topography (Fig. 3)."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.window import faces, window_sides, window_slices
from ...mechanics.joint import DIRECTION_STEPS, composite_topography
from ..kit.drawing import COLOURS, WIDTH, Drawing, group, headline, letter, settings_of
from ..kit.maps import HALO, draw_map, missing_patch, node_position, scan_extent, window_outline
from ..kit.verdicts import claim, sentences
from ..kit.words import length_unit, opening, place

TITLE = "Fig. 3: the joint slid to its largest offset, dilatancy and composite topography"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "statements")
ORDER = 40

#: Why a correlation may decide nothing.
_TOO_SMALL = "window too small to separate it from chance"
_TOUCH = {"ms": 7, "mfc": "none", "mec": COLOURS[2], "mew": 1.5, "ls": "none"}


@dataclass(frozen=True)
class Slid:
    """The joint at its largest offset in the first direction whose contact is solved.

    Attributes
    ----------
    specimen : xr.Dataset
    direction : str
    offset : float
        v, mm.
    dilatancy : float
        delta_r, mm.
    composite : (ny, nx) ndarray
        h, mm.
    correlation : float
        Of the two faces under the window.
    chance : float
        The correlation that chance alone gives; NaN where the window is too small to say.
    """

    specimen: xr.Dataset
    direction: str
    offset: float
    dilatancy: float
    composite: np.ndarray
    correlation: float
    chance: float

    @classmethod
    def of(cls, atlas: DataTree, name: str) -> "Slid":
        """The slid joint of a specimen."""
        joint = group(atlas, "joints", name)
        direction = str(joint["contact_direction"].values[0])
        last = int(joint["offset"].values.argmax())
        cells = int(joint["offset_cells"].values[0, last])
        # The n-th rigid offset is n cells along the first contact direction.
        slid = joint.sel(direction=direction).isel(rigid_offset=cells)
        specimen = group(atlas, "specimens", name)
        return cls(
            specimen,
            direction,
            float(joint["offset"].values[last]),
            float(slid["rigid_dilatancy"]),
            # The atlas has it in steps; of the faces it is such that they touch in one node.
            composite_topography(specimen, direction, cells),
            float(slid["face_correlation"]),
            float(joint["correlation_limit"]),
        )

    @property
    def touch(self) -> tuple:
        """Node (y, x) of the window that touches first."""
        return np.unravel_index(self.composite.argmax(), self.composite.shape)

    @property
    def slid(self) -> tuple[float, ...]:
        """How far (y, x) the upper block has slid, mm."""
        return tuple(self.offset * step for step in DIRECTION_STEPS[self.direction])

    @property
    def axis(self) -> str:
        """Axis along which it slides."""
        return "y" if DIRECTION_STEPS[self.direction][0] else "x"

    def profiles(self) -> pd.DataFrame:
        """Both faces along the line of sliding through the point of first touch.

        Returns
        -------
        pd.DataFrame
            Heights at distances from the corner of the scan, over the windows before and after
            and a little beyond.
        """
        lower, upper = faces(self.specimen)
        window = window_slices(self.specimen)
        across, along = (1, 0) if self.axis == "y" else (0, 1)
        line = window[across].start + self.touch[across]
        lower, upper = (np.take(face, line, axis=across) for face in (lower, upper))
        spacing = self.specimen.attrs[f"spacing_{self.axis}"]
        cells = window[along]
        moved = round(self.slid[along] / spacing)
        lift = self.composite.max()
        table = pd.DataFrame({f"{self.axis}_mm": (np.arange(lower.size) + 0.5) * spacing})
        table["lower_mm"] = lower
        table["upper_before_mm"] = np.nan
        table["upper_after_mm"] = np.nan
        before, after = cells, slice(cells.start + moved, cells.stop + moved)
        table.loc[table.index[before], "upper_before_mm"] = upper[cells] + lift - self.dilatancy
        table.loc[table.index[after], "upper_after_mm"] = upper[cells] + lift
        first, last = min(before.start, after.start), max(before.stop, after.stop)
        margin = (last - first) // 20
        return table.iloc[max(first - margin, 0) : last + margin].reset_index(drop=True)


def draw(atlas: DataTree, name: str) -> Drawing:
    """Plan, profile and composite topography at the largest offset.

    Its data are the profiles.
    """
    slid = Slid.of(atlas, name)
    label = settings_of(atlas, name)["label"]
    profiles = slid.profiles()
    figure = Figure(figsize=(WIDTH, 5.6))
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.3, 1])  # type: ignore[misc]  # an array
    plan, composite = top.subplots(1, 2)
    profile = bottom.subplots()
    handles = _draw_plan(top, plan, slid) + _draw_profile(profile, slid, profiles)
    bottom.legend(handles=handles, loc="outside lower center", ncols=3)
    _draw_composite(top, composite, slid)
    letter(plan, "a", "lower face and window")
    letter(profile, "c", "profile through the point of first touch")
    letter(composite, "b", f"composite topography $h$\n{_correlation_words(slid)}")
    headline(figure, label, place(slid.direction, slid.offset))
    why = "" if np.isfinite(slid.chance) else _TOO_SMALL
    left = claim(atlas, name, "no_correlation_is_left", why=why)
    return Drawing(figure, profiles, _caption(slid, left))


def _draw_plan(figure, axes, slid):
    """The scan and the window twice; entries of a legend."""
    specimen = slid.specimen
    sides = scan_extent(specimen)
    _, size = length_unit(max(sides))
    heights = specimen["lower"].values
    height_unit = length_unit(np.nanmax(heights) - np.nanmin(heights))
    image = draw_map(axes, heights / height_unit[1], sides, cmap="Greys_r")
    figure.colorbar(image, ax=axes, shrink=0.8, label=f"height ({height_unit[0]})")
    outlines = [
        window_outline(
            specimen, size, edgecolor=COLOURS[1], lw=1.5, ls="--", label="window before"
        ),
        window_outline(
            specimen, size, slid.slid, edgecolor=COLOURS[4], lw=1.5, label="window after"
        ),
    ]
    for outline in outlines:
        axes.add_patch(outline)
    return outlines + ([missing_patch()] if np.isnan(heights).any() else [])


def _draw_profile(axes, slid, profiles):
    """Both faces, offset and dilatancy; entries of a legend."""
    along = profiles[f"{slid.axis}_mm"].values
    unit, size = length_unit(along[-1])
    height_unit, height_size = length_unit(
        np.nanmax(profiles.iloc[:, 1:]) - profiles["lower_mm"].min()
    )
    lower, before, after = (
        profiles[f"{key}_mm"] / height_size for key in ("lower", "upper_before", "upper_after")
    )
    x = along / size
    axes.plot(x, lower, color=COLOURS[0], lw=0.9, label="lower face")
    if slid.specimen.attrs["opposite"] == "scanned":
        axes.plot(
            x, before, color=COLOURS[1], lw=0.7, ls="--", label="upper face at first touch, $v$ = 0"
        )
    axes.plot(
        x,
        after,
        color=COLOURS[4],
        lw=0.9,
        label=r"upper face, slid by $v$ and lifted by $\delta_r$",
    )

    axis = "yx".index(slid.axis)
    spacing = slid.specimen.attrs[f"spacing_{slid.axis}"]
    start = (window_slices(slid.specimen)[axis].start + slid.touch[axis] + 0.5) * spacing
    end = start + slid.slid[axis]
    top = after[np.argmin(np.abs(along - end))]
    bottom = top - slid.dilatancy / height_size
    start, end = start / size, end / size
    arrow = {"arrowstyle": "<->", "color": COLOURS[3], "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    for tip, tail in (((end, bottom), (start, bottom)), ((end, top), (end, bottom))):
        axes.annotate("", tip, tail, arrowprops=arrow)
    # The numbers stand in the legend: on the profile they would hide it.
    moved = rf"offset $v$ = {slid.offset:.3g} mm, dilatancy $\delta_r$ = {slid.dilatancy:.3g} mm"
    axes.plot([], [], color=COLOURS[3], lw=1.2, label=moved)
    axes.plot(end, top, marker="o", label="first touch", **_TOUCH)
    axes.set_xlabel(f"${slid.axis}$ ({unit})")
    axes.set_ylabel(f"height ({height_unit})")
    axes.margins(x=0, y=0.15)
    floor, ceiling = axes.get_ylim()
    floor = min(floor, bottom - 0.1 * (ceiling - bottom))  # the arrow stays clear of the axis
    axes.fill_between(x, lower, floor, color="0.9", lw=0, zorder=0)
    axes.set_ylim(floor, ceiling)
    return axes.get_legend_handles_labels()[0]


def _draw_composite(figure, axes, slid):
    sides = window_sides(slid.specimen)
    height_unit, size = length_unit(np.ptp(slid.composite))
    image = draw_map(axes, slid.composite / size, sides, cmap="cividis")
    figure.colorbar(image, ax=axes, shrink=0.8, label=f"$h$ ({height_unit})")
    y, x = node_position(slid.touch, slid.composite.shape, sides)
    axes.plot(x, y, marker="o", path_effects=HALO, **_TOUCH)


def _correlation_words(slid):
    """Correlation of the faces in the window, and what chance alone would give."""
    chance = f", by chance up to {slid.chance:.2f}"
    if not np.isfinite(slid.chance):
        chance = f"\n{_TOO_SMALL}"
    return f"correlation of the faces {slid.correlation:+.2f}{chance}"


def _caption(slid, correlation_left):
    return sentences(
        f"{opening('Fig. 3')} Window before and after v = {slid.offset:.3g} mm, profile at first "
        f"touch, composite topography. The joint opens by delta_r = "
        f"{slid.dilatancy:.3g} mm.",
        correlation_left,
    )
