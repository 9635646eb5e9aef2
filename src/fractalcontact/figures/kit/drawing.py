"""What the figures share: style, what a drawing is, how it is written, what the study asked for."""

import contextlib
import gc
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.style
import numpy as np
import pandas as pd
import xarray as xr
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure, FigureBase, SubFigure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter, NullLocator, StrMethodFormatter
from numpy.typing import ArrayLike
from xarray import DataTree

from ...core.atomic import atomic_write
from ...core.labels import printable
from ...core.tables import write_table
from .caption import Caption
from .layout import lay_out
from .line_breaks import in_lines
from .remembered import layouts_remembered
from .ticks import keep_labels
from .words import force_unit, formulas

#: Okabe and Ito's colours, distinguished by colour-blind readers; black first.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442")
#: Markers go with the colours, so that a print in grey can be read too.
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
LINES = ("-", "--", "-.", ":")

#: A line whose slope is undetermined: thin and faint beside those that are determined.
WEAK: dict[str, Any] = {"linewidth": 0.6, "alpha": 0.5}

#: Width of a figure across two columns of a journal, inches.
WIDTH = 7.2
#: Pixels of an inch, in the PNG and of the maps inside the SVG.
DPI = 200
#: Of the PNG: a third less time than by default, for files larger by a fiftieth.
COMPRESSION = 3
#: Points of the letters of a figure's title, and inches that a line of it is high.
TITLE_SIZE, LINE = 9, 0.15
#: Inches between the edge of a figure and its title.
_EDGE = 0.05
#: Letters of a specimen's label that are shown.
LONGEST_LABEL = 300

_STYLE: dict[str, Any] = {
    "figure.dpi": DPI,
    "font.size": 8,
    "axes.titlesize": 8,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "lines.markersize": 4,
    "axes.prop_cycle": cycler(color=COLOURS),
    "image.origin": "lower",
    "figure.constrained_layout.use": True,
    # Titles stand on their axes. To find out what may be in their way, every tick would be measured
    # each time; `lay_out` knows the one thing that can be.
    "axes.titley": 1.0,
    # The same figure twice is the same file twice.
    "svg.hashsalt": "fractalcontact",
    "svg.fonttype": "none",
}


@dataclass(frozen=True)
class Drawing:
    """A figure, the numbers drawn in it, and its caption.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
    data : pd.DataFrame
        One row a point drawn; column names carry the units.
    caption : str
        With the paper's figure number, and plain words where a claim of the paper does not hold.
    """

    figure: Figure
    data: pd.DataFrame
    caption: Caption | str


@contextlib.contextmanager
def print_style() -> Iterator[None]:
    """Style of every figure, whatever a user has set for his own."""
    with matplotlib.style.context(["default", _STYLE]):
        yield


def keep_style(figure: Figure) -> None:
    """Draw a figure in the style of print wherever that is done: some settings count only then."""
    draw = figure.draw

    def in_style(renderer: RendererBase) -> None:
        with print_style():
            draw(renderer)

    vars(figure)["draw"] = in_style


@contextlib.contextmanager
def garbage_collection_paused() -> Iterator[None]:
    """Garbage collection paused meanwhile.

    A figure is some 100 000 objects that live as long as it does: to go through them while it is
    drawn finds nothing and takes a tenth of the time.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


def save(drawing: Drawing, folder: Path | str, name: str) -> None:
    """Write a drawing as NAME.png, .svg, .csv and its caption as .txt, each whole or not at all."""
    folder = Path(folder)
    figure = drawing.figure
    # The layout is found once and each file drawn once. `savefig` draws everything once more for
    # either file, to find the layout; and what the layout has measured, this canvas remembers.
    with layouts_remembered():
        canvas = lay_out(figure)
        with atomic_write(folder / f"{name}.png") as path:
            canvas.print_png(path, pil_kwargs={"compress_level": COMPRESSION})
        keep_labels(figure)
        with atomic_write(folder / f"{name}.svg") as path:
            FigureCanvasSVG(figure).print_svg(path, metadata={"Date": None})
    with atomic_write(folder / f"{name}.txt") as path:
        words = drawing.caption
        path.write_text((words.text if isinstance(words, Caption) else words) + "\n", "utf-8")
    write_table(folder / f"{name}.csv", drawing.data)


def group(atlas: DataTree, stage: str, specimen: str) -> xr.Dataset:
    """Dataset of one stage of a specimen, in memory."""
    return atlas[f"{stage}/{specimen}"].to_dataset().load()


def force_axis(axis: Axis, forces: ArrayLike) -> float:
    """Label an axis of normal forces, in the unit that suits the loads of the study.

    Parameters
    ----------
    axis : matplotlib.axis.Axis
    forces : (n,) array_like
        All loads of the study, N, so that every figure of a specimen has the same unit.

    Returns
    -------
    float
        How many N the unit is: forces are drawn divided by it.
    """
    unit, size = force_unit(float(np.max(forces)))
    axis.set_label_text(f"normal force $F$ ({unit})")
    return size


def offset_axis(axes: Axes, offsets: np.ndarray) -> None:
    """Offsets v along x: in decades where they span one, with v = 0 at their left if it is there.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    offsets : (n,) ndarray
        mm, those drawn.
    """
    slid = offsets[offsets > 0]
    if slid.size > 1 and slid.max() > 10 * slid.min():
        decades = np.arange(np.floor(np.log10(slid.min())), np.log10(slid.max()) + 1)
        # Powers of ten would be one or two on an axis shorter than two decades.
        parts = (1, 2, 5) if slid.max() < 100 * slid.min() else (1,)
        places = np.outer(10**decades, parts).ravel()
        within = (places >= slid.min() * (1 - 1e-9)) & (places <= slid.max() * (1 + 1e-9))
        ticks = list(places[within])
        if slid.size < len(offsets):
            axes.set_xscale("symlog", linthresh=slid.min(), linscale=0.3)
            axes.set_xlim(-0.15 * slid.min(), 1.2 * slid.max())
            axes.xaxis.set_minor_locator(NullLocator())
            ticks.insert(0, 0.0)
        else:
            axes.set_xscale("log", nonpositive="mask")
            axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xlabel("offset $v$ (mm)")


def label_short_span(axis: Axis, within: float = 100) -> None:
    """Plain labels at 1, 2 and 5 on a logarithmic axis whose ends are less than ``within`` apart.

    Powers of ten would be one there, or none. Labels between those lie over each other on any axis
    and are left out; on a short one so do these over more than a decade.
    To be called once everything is drawn.
    """
    low, high = axis.get_view_interval()
    axis.set_minor_formatter(NullFormatter())
    if high < within * low:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))


def spread(n: int, most: int) -> np.ndarray:
    """Indices of up to ``most`` of n things, the first and the last among them."""
    return np.unique(np.round(np.linspace(0, n - 1, min(n, most))).astype(int))


def colour_of(i: int) -> str:
    """The i-th colour that can be seen as a line on white: all but the yellow."""
    return COLOURS[i % (len(COLOURS) - 1)]


def letter(axes: Axes, which: str, title: str) -> None:
    """Letter of a panel as the paper has it, at its upper left, before a title."""
    axes.set_title(f"({which}) {title}", loc="left")


def headline(figure: Figure | SubFigure, label: str, *where: str, below: str = "") -> None:
    """Title of a figure, in lines that fit its width.

    Parameters
    ----------
    figure : matplotlib.figure.FigureBase
    label : str
        Of the specimen, as its user wrote it.
    *where : str
        What follows, after commas; formulas stand in dollar signs.
    below : str
        What stands in a line of its own.
    """
    text = label_in_lines(label, *where, width=figure.bbox.width / figure.dpi)
    if isinstance(figure, Figure):
        # What is below loses no height to a long label.
        figure.set_figheight(figure.get_figheight() + LINE * text.count("\n"))
    figure.suptitle("\n".join(filter(None, (text, below))), fontsize=TITLE_SIZE)


def entitle(figure: Figure, title: str) -> None:
    """Say above the headline of a figure what it shows; the figure becomes so much higher.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
    title : str
        Symbols as captions have them.
    """
    words = in_lines(formulas(title), TITLE_SIZE, figure.get_figwidth() - 2 * _EDGE)
    lines = words.split("\n")
    before = figure.get_figheight()
    figure.set_figheight(before + LINE * len(lines))
    laid_out = isinstance(figure.get_layout_engine(), ConstrainedLayoutEngine)
    if not laid_out:
        # Nothing moves the panels out of the title's way.
        for axes in figure.axes:
            x, y, width, height = axes.get_position().bounds
            part = before / figure.get_figheight()
            axes.set_position((x, y * part, width, height * part))
    everything = filter(None, (words, figure.get_suptitle()))
    shown = figure.suptitle("\n".join(everything), fontsize=TITLE_SIZE)
    if not laid_out:
        shown.set_y(1 - _EDGE / figure.get_figheight())


def label_in_lines(label: str, *where: str, width: float) -> str:
    """A label and what follows it, as :func:`headline` has it, in lines of ``width`` inches."""
    # Dollar signs of a label make no formula.
    label = printable(label, LONGEST_LABEL).replace("$", r"\$")
    return in_lines(", ".join((label, *where)), TITLE_SIZE, width - 2 * _EDGE)


def entries(axes: Axes) -> list[Artist]:
    """What stands in a legend of the axes."""
    return axes.get_legend_handles_labels()[0]


def legends_below(figure: FigureBase, *columns: list[Artist], columnspacing: float = 6) -> None:
    """Legends side by side under a figure, where they hide nothing.

    Parameters
    ----------
    figure : matplotlib.figure.FigureBase
    *columns : list of matplotlib.artist.Artist
        Entries of each legend.
    columnspacing : float, optional
        Between the columns, in letters.
    """
    rows = max(len(column) for column in columns)
    # One legend fills its columns one by one: the shorter ones need filling up.
    handles = [
        handle for column in columns for handle in column + [heading(" ")] * (rows - len(column))
    ]
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=len(columns),
        columnspacing=columnspacing,
        handlelength=3,
    )


def heading(text: str) -> Line2D:
    """Entry of a legend that is words alone."""
    return Line2D([], [], linestyle="none", label=text)
