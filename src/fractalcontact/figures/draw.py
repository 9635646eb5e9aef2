"""The figures: one module each, drawn from an atlas and nothing else.

A module states what it is (:mod:`study.figure_list`) and has ``draw(atlas, subject)``, which gives
a :class:`figures.kit.drawing.Drawing`; the subject is a specimen's name, or the names of all
specimens for a figure of a study.
"""

import importlib
import textwrap
import traceback
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ..core.errors import InputError, OutputError
from ..core.labels import printable
from ..study.atlas import read_atlas
from ..study.figure_list import all_figures
from .kit.drawing import (
    COLOURS,
    WIDTH,
    Drawing,
    garbage_collection_paused,
    keep_style,
    let_go,
    print_style,
    save,
)
from .kit.layout import lay_out
from .kit.remembered import layouts_remembered
from .kit.titles import entitle
from .kit.verdicts import statements_quoted
from .sources import read_sources, source_of, write_sources

#: Errors that fail every figure: a full disk, no memory, an atlas that cannot be read.
_NOT_OF_THE_FIGURE = (InputError, OutputError, OSError, MemoryError)

#: Endings of the files of a figure: two pictures, the numbers drawn, the caption.
ENDINGS = ("png", "svg", "csv", "txt")


@dataclass(frozen=True)
class Drawn:
    """Captions by figure, and tracebacks of the figures that an error of the program prevented.

    ``unchanged`` are the figures whose files were kept, ``quoted`` the statements
    that each of the others quotes.
    """

    captions: dict[str, str] = field(default_factory=dict)
    failures: dict[str, str] = field(default_factory=dict)
    unchanged: list[str] = field(default_factory=list)
    quoted: dict[str, set[str]] = field(default_factory=dict)


def drawer_of(name: str) -> Callable[..., Drawing]:
    """Function ``draw(atlas, subject)`` that draws a figure under its title.

    Raises
    ------
    KeyError
        If no figure has this name.
    """
    figure = all_figures()[name]
    draw = importlib.import_module(figure.module.replace("/", ".")).draw

    def entitled(atlas: DataTree, subject: str | list[str]) -> Drawing:
        drawing = draw(atlas, subject)
        entitle(drawing.figure, figure.title)
        return drawing

    return entitled


def draw_figure(
    atlas: DataTree,
    name: str,
    subject: str | list[str],
    style: Mapping[str, Any] | None = None,
) -> Drawing:
    """Drawing of a figure in the style of print, laid out: ``.figure.savefig`` gives the picture.

    Parameters
    ----------
    atlas : xr.DataTree
        With the stages that the figure reads.
    name : str
        Of the figure.
    subject : str or list of str
        The specimen; of a figure of a study the names of all its specimens.
    style : mapping of str to value, optional
        Settings of matplotlib over the style of print, such as ``{"font.family": "serif"}``.

    Returns
    -------
    figures.kit.drawing.Drawing
        The same whatever settings matplotlib has.

    Raises
    ------
    KeyError
        If no figure has this name.
    """
    _read_stages(atlas, all_figures()[name].needs, subject)
    with print_style(style):
        drawing = drawer_of(name)(atlas, subject)
        lay_out(drawing.figure)
    keep_style(drawing.figure, style)
    return drawing


def _read_stages(atlas, needs, subject):
    """Load the stages that a figure draws: xarray cannot transpose words of an open file."""
    for stage in needs:
        for name, node in atlas[stage].children.items() if stage in atlas.children else ():
            if name == subject or not isinstance(subject, str):
                node.load()


def draw_figures(
    atlas_path: Path | str,
    specimen: str,
    folder: Path | str,
    names: Sequence[str],
    drawn_from: Path | str | None = None,
    code: str = "",
) -> Drawn:
    """Draw figures of one specimen and write each as PNG, SVG, CSV and caption.

    A figure that fails does not keep the others from being drawn; the caller looks at the failures.
    Files of a figure are kept if they were drawn from the same numbers, settings and ``code``, as
    the file ``drawn_from`` of the drawing before states; it is written anew.
    """
    atlas, kept = read_atlas(atlas_path), read_sources(drawn_from)
    for name in kept.keys() & set(names):
        found = all((Path(folder) / f"{name}.{ending}").is_file() for ending in ENDINGS)
        if not found or kept[name] != source_of(atlas, name, specimen, kept[name].statements, code):
            del kept[name]
    drawn = _draw(atlas, specimen, folder, [name for name in names if name not in kept])
    drawn.unchanged.extend(name for name in names if name in kept)
    if drawn_from is not None:
        for name in drawn.captions.keys() - drawn.failures.keys():
            quoted = drawn.quoted[name]
            kept[name] = source_of(atlas, name, specimen, quoted, code)
        write_sources([(name, kept[name]) for name in names if name in kept], drawn_from)
    return drawn


def draw_study_figures(
    atlas_path: Path | str, specimens: Sequence[str], folder: Path | str, names: Sequence[str]
) -> Drawn:
    """Draw figures of a whole study, as :func:`draw_figures` does those of one specimen."""
    # Other stages are not read, which would take long.
    needs = {stage for name in names for stage in all_figures()[name].needs}
    atlas = read_atlas(atlas_path, only=needs)
    return _draw(atlas, list(specimens), folder, names)


def _draw(atlas, subject, folder, names):
    drawn = Drawn()
    with print_style(), garbage_collection_paused():
        for name in names:
            with layouts_remembered():
                try:
                    with statements_quoted() as quoted:
                        drawing = draw_figure(atlas, name, subject)
                    drawn.quoted[name] = quoted
                    save(drawing, folder, name)
                except _NOT_OF_THE_FIGURE:
                    raise
                except Exception as error:
                    drawn.failures[name] = traceback.format_exc()
                    drawing = _undrawn(all_figures()[name].title, subject, error)
                    save(drawing, folder, name)
            drawn.captions[name] = drawing.caption
            let_go(drawing.figure)
    return drawn


def _undrawn(title: str, subject: str | list[str], error: BaseException) -> Drawing:
    """Drawing that states the error of the program in place of a figure."""
    reason = printable(f"{type(error).__name__}: {error}", 300)
    of = "" if isinstance(subject, list) else f" of {subject}"
    words = f"Not drawn: {title}{of}, because of an error of the program ({reason})."
    figure = Figure(figsize=(WIDTH, 1.6))
    figure.set_layout_engine("none")  # there are no axes to lay out
    style: dict[str, Any] = {"ha": "center", "va": "center", "color": COLOURS[2]}
    figure.text(0.5, 0.5, textwrap.fill(words, 90), parse_math=False, **style)
    return Drawing(figure, pd.DataFrame({"figure": [title], "not_drawn_because": [reason]}), words)
