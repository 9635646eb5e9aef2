"""Style of the figures, a drawing, and the files it is saved as."""

import contextlib
import gc
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib.style
import numpy as np
import pandas as pd
import xarray as xr
from cycler import cycler
from matplotlib.backend_bases import FigureCanvasBase, RendererBase
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.atomic import atomic_write
from ...core.tables import write_table
from .caption import Caption
from .formulas import formulas_read_once
from .layout import lay_out
from .remembered import layouts_remembered
from .ticks import keep_labels

#: Okabe and Ito's colours, distinguished by colour-blind readers; black first.
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442")
#: Each colour has a marker, so that a print in grey can be read.
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
LINES = ("-", "--", "-.", ":")

#: A line whose slope is undetermined: thin and faint beside those that are determined.
WEAK: dict[str, Any] = {"linewidth": 0.6, "alpha": 0.5}

#: Width of a figure across two columns of a journal, inches.
WIDTH = 7.2
#: Pixels per inch of the PNG and of the maps inside the SVG.
DPI = 200

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
    # Titles stand directly on their axes. Matplotlib would measure every tick each time to find
    # what lies in their way; only the offset text can, and `lay_out` moves the title above it.
    "axes.titley": 1.0,
    # The salt makes the identifiers, and so the file, the same in every run.
    "svg.hashsalt": "fractalcontact",
    "svg.fonttype": "none",
}


@dataclass(frozen=True)
class Drawing:
    """A figure, the table of the points drawn (columns end in their units), and its caption."""

    figure: Figure
    data: pd.DataFrame
    caption: Caption | str


@contextlib.contextmanager
def print_style(own: Mapping[str, Any] | None = None) -> Iterator[None]:
    """Style of every figure, independent of matplotlib's settings except those given."""
    with matplotlib.style.context(["default", _STYLE, dict(own or {})]), formulas_read_once():
        yield


def keep_style(figure: Figure, own: Mapping[str, Any] | None = None) -> None:
    """Draw a figure in the style of print whenever it is drawn: some settings count only then."""
    draw = figure.draw

    def in_style(renderer: RendererBase) -> None:
        with print_style(own):
            draw(renderer)

    vars(figure)["draw"] = in_style


@contextlib.contextmanager
def garbage_collection_paused() -> Iterator[None]:
    """Pause garbage collection within the block.

    A figure is some 100 000 objects that live as long as it does. Collections while it is drawn
    find nothing and take a tenth of the time; the 6 MB of cycles that it leaves wait for the end.
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
    # The layout is found once and each file is drawn once. `savefig` would draw everything once
    # more per file to find the layout; this canvas keeps what the layout has measured.
    with layouts_remembered():
        canvas = lay_out(figure)
        with atomic_write(folder / f"{name}.png") as path:
            canvas.write_png(path)
        keep_labels(figure)
        with atomic_write(folder / f"{name}.svg") as path:
            canvas.write_svg(path)
    with atomic_write(folder / f"{name}.txt") as path:
        words = drawing.caption
        path.write_text((words.text if isinstance(words, Caption) else words) + "\n", "utf-8")
    write_table(folder / f"{name}.csv", drawing.data)


def let_go(figure: Figure) -> None:
    """Drop the picture and the maps of a saved figure, which are most of its memory."""
    figure.set_canvas(FigureCanvasBase(figure))
    for axes in figure.axes:
        for image in axes.images:
            image.remove()


def group(atlas: DataTree, stage: str, specimen: str) -> xr.Dataset:
    """Dataset of one stage of a specimen, in memory."""
    return atlas[f"{stage}/{specimen}"].to_dataset().load()


def spread(n: int, most: int) -> np.ndarray:
    """Indices of up to ``most`` of n things, the first and the last among them."""
    return np.unique(np.round(np.linspace(0, n - 1, min(n, most))).astype(int))


def colour_of(i: int) -> str:
    """The i-th colour that can be seen as a line on white: all but the yellow."""
    return COLOURS[i % (len(COLOURS) - 1)]
