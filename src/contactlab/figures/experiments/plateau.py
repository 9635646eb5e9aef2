"""Plateau of rigid dilatancy: synthetic joints with and without a roll-off, and the study's."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core import directions
from fractalcontact.core.subject import configuration_of
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import LINES, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below, mark
from fractalcontact.figures.kit.sizes import plain_decades
from fractalcontact.figures.kit.titles import LINE, label_in_lines, letter
from fractalcontact.figures.kit.verdicts import labels_by_verdict
from fractalcontact.figures.kit.words import short

from ._slides import Slide, least_and_largest, without_repeats

TITLE = "Rigid dilatancy of all joints: does a plateau need a roll-off of the spectrum?"
SUBJECT = "study"
NEEDS = ("specimens", "joints", "roll_off", "statements")
KEY = "roll_off"
ORDER = 10

#: What the paper says of rock and of concrete (:mod:`statements.sliding`).
PLATEAUS = ("dilatancy_flattens", "dilatancy_flattens_in_two")

#: Specimens that the caption names, and letters of the label of each.
MAX_NAMED, MAX_IN_CAPTION = 3, 40

#: Largest offsets that differ by more than this are drawn in decades; inches of a legend's column.
WIDE, COLUMN = 5, 4

#: The second half of the offsets, over which slopes are taken.
_SECOND_HALF = {"lw": 3}
_ROLL_OFF, _UNCORRELATED = "v", "o"
_MARK = {"mfc": "white", "ms": 6, "zorder": 3}


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Dilatancy, and its ratio to the spread of the composite topography, for all that slides."""
    joints = atlas["roll_off/surfaces"].to_dataset()
    synthetic = [Slide.synthetic(joints.sel(surface=s)) for s in joints["surface"].values]
    settings = configuration_of(atlas)["settings"]
    sliding = [name for name in names if directions.slides(settings[name]["opposite"])]
    slides = synthetic + [Slide.of(atlas, name) for name in sliding]
    figure = Figure(figsize=(WIDTH, 3.6 + 0.15 * len(slides)))
    panels = figure.subplots(1, 2, sharex=True)
    _prepare(panels, slides)
    drawn = without_repeats(slides)
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
    table = pd.concat([slide.table() for slide in slides], ignore_index=True)
    return Drawing(figure, table, caption(__name__, **_words(atlas, sliding, slides)))


def _draw_slide(panels, n, slide):
    """Dilatancy of a slide and its ratio to the spread, the means with their bands; its marks."""
    colour, line = colour_of(n), LINES[n % 4]
    # In decades flush faces have no place, and what rounding leaves of their spread would be shown.
    shown = slide.v > 0 if panels[1].get_xscale() == "log" else np.full(slide.v.shape, True)
    v = slide.v[shown]
    label = label_in_lines(slide.label, width=COLUMN) + slide.slope_words
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
    for end, va in zip(least_and_largest(slides), ("top", "bottom"), strict=False):
        axes.axhline(end, color="0.4", lw=0.8, ls=(0, (1, 2)))
        axes.text(0.02, end, short(end), transform=axes.get_yaxis_transform(), va=va)


def _marks():
    """Entries of the legend for what is marked on every curve."""
    bands = "lines: means; bands: from least to most of\nthe joints or directions, no intervals"
    grey = {"color": "0.3", "ls": "none", **_MARK}
    return [
        heading(bands),
        mark(color="0.3", label="(a) half over which the slope is taken", **_SECOND_HALF),
        mark(marker=_ROLL_OFF, label="(a) roll-off length", **grey),
        mark(marker=_UNCORRELATED, label="(a) faces uncorrelated", **grey),
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


def _words(atlas, names, slides):
    """Trends of the synthetic joints, and verdicts on the plateaus that the paper has."""
    said = labels_by_verdict(atlas, names, PLATEAUS, MAX_IN_CAPTION)
    with_it, without = (slide.trend for slide in slides if slide.slope is not None)
    return {
        "with_it": with_it,
        "without": without,
        "ratios": dict.fromkeys(short(end) for end in least_and_largest(slides)),
        "verdicts": said,
        "named": sum(map(len, said.values())) <= MAX_NAMED,
    }
