"""Plateau of rigid dilatancy: synthetic joints with and without a roll-off, and the study's."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.labels import printable
from ...core.subject import Subject, configuration_of
from ...core.units import quantity
from ..kit.caption import caption
from ..kit.drawing import LINES, WIDTH, Drawing, colour_of
from ..kit.legends import entries, heading, legends_below, mark
from ..kit.panel import rows
from ..kit.sizes import plain_decades
from ..kit.titles import LINE, label_in_lines, letter
from ..kit.verdicts import CIRCULAR_SHORT, row_of
from ..kit.words import short

TITLE = "Rigid dilatancy of all joints: does a plateau need a roll-off of the spectrum?"
SUBJECT = "study"
NEEDS = ("specimens", "joints", "roll_off", "statements")
KEY = "roll_off"
ORDER = 10

#: What the paper says of rock and of concrete (:mod:`statements.sliding`).
PLATEAUS = ("dilatancy_flattens", "dilatancy_flattens_in_two")

#: Specimens that the caption names, and letters of the label of each.
MOST_NAMED, LONGEST_IN_CAPTION = 3, 40

#: Specimens whose largest offsets differ by more than this are drawn in decades.
WIDE = 5

#: Inches that a label's lines are broken for, so that a column of the legend holds them.
COLUMN = 4

#: Kind of the synthetic joints whose spectrum is flat above a wavelength.
WITH_ROLL_OFF = "with_roll_off"

#: The second half of the offsets, over which slopes are taken.
_SECOND_HALF = {"lw": 3}
_ROLL_OFF, _UNCORRELATED = "v", "o"
_MARK = {"mfc": "white", "ms": 6, "zorder": 3}


#: Variables of a specimen, and those of the synthetic joints that correspond.
_DRAWN = {
    "rigid_dilatancy": "joint_dilatancy",
    "composite_rms": "joint_rms",
    "composite_rms_expected": "joint_rms_expected",
    "dilatancy_over_rms": "joint_dilatancy_over_rms",
}


@dataclass(frozen=True)
class Slide:
    """Dilatancy of one specimen, or of many synthetic joints, as they slide.

    Attributes
    ----------
    label : str
    data : xr.Dataset
        Variables of :data:`_DRAWN` over (direction_or_seed, rigid_offset): means and bands are
        over the first.
    roll_off : float or None
        Wavelength above which the spectrum is flat; NaN for a scan, None where there is none.
    uncorrelated : float
        Offset where the faces lose all correlation; NaN if not reached.
    matched : bool
        Whether the upper face is the match of the lower one, so that sliding begins flush.
    slope : Estimate or None
        Of many synthetic joints: slope of delta_r from ``since`` on.
    since : float
    trend : str
        Of many synthetic joints, as the stage ``roll_off`` has it.
    """

    label: str
    data: xr.Dataset
    roll_off: float | None
    uncorrelated: float = np.nan
    matched: bool = True
    slope: Estimate | None = None
    since: float = np.inf
    trend: str = ""

    @classmethod
    def of(cls, atlas: DataTree, name: str) -> "Slide":
        """The slide of a specimen of the atlas."""
        subject = Subject.of(atlas, name)
        joint = subject["joints"]
        return cls(
            label=subject.label,
            data=_over_rows(joint[list(_DRAWN)], "direction"),
            roll_off=_roll_off(atlas, name),
            uncorrelated=float(joint["mean_uncorrelated_offset"]),
            matched=subject["specimens"].attrs["opposite"] == "match",
        )

    @classmethod
    def synthetic(cls, joints: xr.Dataset) -> "Slide":
        """Slides of synthetic joints with, or without, a roll-off; means of their directions."""
        rolled = joints["surface"].item() == WITH_ROLL_OFF
        roll_off = float(joints.attrs["roll_off"]) if rolled else None
        words = f"with a roll-off at {short(roll_off)} mm" if roll_off else "without a roll-off"
        data = joints[list(_DRAWN.values())].rename({new: old for old, new in _DRAWN.items()})
        data = data.drop_vars("surface").assign_coords(
            seed=[f"seed {n}" for n in data["seed"].values]
        )
        return cls(
            label=f"{joints.sizes['seed']} synthetic joints {words}",
            data=_over_rows(data, "seed"),
            roll_off=roll_off,
            slope=Estimate.read(joints, "slope", scale=EXPONENT),
            since=float(joints["slope_offset_min"]),
            trend=joints["trend"].item(),
        )

    @property
    def v(self) -> np.ndarray:
        """Offsets (n,), mm."""
        return self.data["rigid_offset"].values

    @property
    def ratios(self) -> np.ndarray:
        """delta_r / sigma_z (n,), mean of directions or seeds; none where faces are flush."""
        means = self.data["dilatancy_over_rms"].mean("direction_or_seed", skipna=False).values
        return means[(self.v > 0) & np.isfinite(means)]


def _over_rows(data, rows):
    data = data.rename({rows: "direction_or_seed"})
    return data.transpose("direction_or_seed", "rigid_offset")


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Dilatancy, and its ratio to the spread of the composite topography, for all that slides."""
    joints = atlas["roll_off/surfaces"].to_dataset()
    synthetic = [Slide.synthetic(joints.sel(surface=s)) for s in joints["surface"].values]
    settings = configuration_of(atlas)["settings"]
    sliding = [name for name in names if settings[name]["opposite"] != "flat"]
    slides = synthetic + [Slide.of(atlas, name) for name in sliding]
    figure = Figure(figsize=(WIDTH, 3.6 + 0.15 * len(slides)))
    panels = figure.subplots(1, 2, sharex=True)
    _prepare(panels, slides)
    drawn = _without_repeats(slides)
    for n, slide in enumerate(drawn):
        _draw_slide(panels, n, slide)
    _mark_ends(panels[1], slides)
    _start_at_zero(panels)
    # What is below loses no height to long labels.
    lines = sum(
        str(entry.get_label()).count("\n") for entry in entries(panels[0])[len(synthetic) :]
    )
    figure.set_figheight(figure.get_figheight() + LINE * lines)
    legends_below(figure, entries(panels[0]), _marks())
    table = pd.concat([_table(slide) for slide in slides], ignore_index=True)
    return Drawing(figure, table, caption(__name__, **_words(atlas, sliding, slides)))


def _roll_off(atlas, name):
    """Roll-off of an embedded surface, mm: None if it has none, NaN for a scan."""
    embedded = configuration_of(atlas)["study"].get("embedded", {})
    if name not in embedded:
        return np.nan
    stated = embedded[name].get("roll_off")
    return None if stated is None else quantity(stated, "length", f"embedded.{name}.roll_off")


def _without_repeats(slides):
    """Slides that differ; one whose faces are another's, of another material, is named with it."""
    found: list[Slide] = []
    for slide in slides:
        for n, other in enumerate(found):
            if _alike(slide, other):
                longer, shorter = sorted((other, slide), key=lambda one: -one.v.size)
                found[n] = replace(longer, label=f"{longer.label}; the same: {shorter.label}")
                break
        else:
            found.append(slide)
    return found


def _alike(slide, other):
    """Whether one slide is the other, or begins as it does."""
    n = min(slide.v.size, other.v.size)
    names = ["rigid_dilatancy", "composite_rms"]
    one, two = (each.data[names].isel(rigid_offset=slice(n)) for each in (slide, other))
    return one.equals(two)


def _draw_slide(panels, n, slide):
    colour, line = colour_of(n), LINES[n % 4]
    # In decades flush faces have no place, and what rounding leaves of their spread would be shown.
    shown = slide.v > 0 if panels[1].get_xscale() == "log" else np.full(slide.v.shape, True)
    v = slide.v[shown]
    label = label_in_lines(slide.label, width=COLUMN)
    if slide.slope is not None:
        words = f"{slide.slope.text()} mm/mm" if slide.slope.known else "too few offsets"
        label += f"\nslope {words}"
    for axes, name in zip(panels, ("rigid_dilatancy", "dilatancy_over_rms"), strict=True):
        if axes is panels[1] and not slide.matched:
            continue  # its dilatancy counts from faces that were apart already
        values = slide.data[name].values[:, shown]
        mean, low, high = values.mean(axis=0), values.min(axis=0), values.max(axis=0)
        if axes.get_yscale() == "log":
            mean, low, high = (np.where(y > 0, y, np.nan) for y in (mean, low, high))
        axes.fill_between(v, low, high, color=colour, alpha=0.15, lw=0)
        axes.plot(v, mean, color=colour, ls=line, label=label)
    opened = slide.data["rigid_dilatancy"].mean("direction_or_seed").values
    half = slide.v >= slide.since
    panels[0].plot(slide.v[half], opened[half], color=colour, **_SECOND_HALF)
    for at, marker in ((slide.roll_off, _ROLL_OFF), (slide.uncorrelated, _UNCORRELATED)):
        if at is not None and slide.v[0] <= at <= slide.v[-1]:
            height = np.interp(at, slide.v, opened)
            panels[0].plot(at, height, marker, color=colour, **_MARK)


def _mark_ends(axes, slides):
    """Lines at the least and the largest ratio of a mean, which the caption states."""
    for end, va in zip(_least_and_largest(slides), ("top", "bottom"), strict=False):
        axes.axhline(end, color="0.4", lw=0.8, ls=(0, (1, 2)))
        axes.text(0.02, end, short(end), transform=axes.get_yaxis_transform(), va=va)


def _marks():
    """Entries of the legend for what is marked on every curve."""
    marks = ((_ROLL_OFF, "(a) roll-off length"), (_UNCORRELATED, "(a) faces uncorrelated"))
    return [
        heading(
            "lines: means; bands: from least to most of\nthe joints or directions, no intervals"
        ),
        mark(color="0.3", label="(a) half over which the slope is taken", **_SECOND_HALF),
        *(
            mark(ls="none", marker=marker, color="0.3", label=words, **_MARK)
            for marker, words in marks
        ),
        mark(color="0.4", lw=0.8, ls=(0, (1, 2)), label="(b) least and largest mean"),
    ]


def _prepare(panels, slides):
    """Scales, labels and letters; decades where one specimen slides much farther than another."""
    opened, ratio = panels
    farthest = [slide.v[-1] for slide in slides]
    decades = max(farthest) > WIDE * min(farthest)
    for axes in panels:
        axes.set_xlabel("offset $v$ (mm)")
        if decades:
            axes.set_xscale("log", nonpositive="mask")
    if decades:
        opened.set_yscale("log", nonpositive="mask")
        plain_decades(opened.yaxis)
    opened.set_ylabel(r"rigid dilatancy $\delta_r$ (mm)")
    ratio.set_ylabel(r"dilatancy over spread $\delta_r/\sigma_z$ (1)")
    titles = ("dilatancy", r"over the spread $\sigma_z$ of the composite topography")
    for axes, which, title in zip(panels, "ab", titles, strict=True):
        letter(axes, which, title)


def _start_at_zero(panels):
    """Axes that are not in decades begin at zero, or below it where dilatancy does."""
    for axes in panels:
        if axes.get_xscale() == "linear":
            axes.set_xlim(left=0)
        if axes.get_yscale() == "linear":
            lowest = axes.dataLim.y0
            axes.set_ylim(bottom=1.1 * lowest if lowest < 0 else 0)


def _table(slide):
    """Every direction of one specimen, or every synthetic joint."""
    table = rows(slide.data, *_DRAWN, specimen=slide.label)
    roll_off = np.nan if slide.roll_off is None else slide.roll_off
    return table.assign(roll_off_mm=roll_off, mean_uncorrelated_offset_mm=slide.uncorrelated)


def _least_and_largest(slides):
    """Ends of delta_r / sigma_z over all slides that begin flush; empty without one."""
    ratios = np.concatenate([slide.ratios for slide in slides if slide.matched])
    return [ratios.min(), ratios.max()] if ratios.size else []


def _words(atlas, names, slides):
    """Trends of the synthetic joints, and verdicts on the plateaus that the paper has."""
    said: dict[str, list[str]] = {}
    for name in names:
        for row in (row_of(atlas, "statements", name, statement) for statement in PLATEAUS):
            if row is not None:
                mark = f" ({CIRCULAR_SHORT})" if row["circular"] else ""
                label = printable(Subject.of(atlas, name).label, LONGEST_IN_CAPTION)
                said.setdefault(row["verdict"].item(), []).append(f"{label}{mark}")
    with_it, without = (slide.trend for slide in slides if slide.slope is not None)
    return {
        "with_it": with_it,
        "without": without,
        "ratios": dict.fromkeys(short(end) for end in _least_and_largest(slides)),
        "verdicts": said,
        "named": sum(map(len, said.values())) <= MOST_NAMED,
    }
