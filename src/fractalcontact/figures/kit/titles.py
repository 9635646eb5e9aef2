"""Titles of figures and letters of their panels."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ...core.labels import printable
from .line_breaks import in_lines
from .words import formulas

#: Points of the letters of a figure's title, and inches that a line of it is high.
TITLE_SIZE, LINE = 9, 0.15
#: Inches between the edge of a figure and its title.
_EDGE = 0.05
#: Letters of a specimen's label that are shown.
MAX_LABEL = 300


def letter(axes: Axes, which: str, title: str) -> None:
    """Letter of a panel at its upper left, before a title."""
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
    """Write the title above the headline of a figure and make the figure higher for it.

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
    """Label and further words of :func:`headline`, in lines of ``width`` inches."""
    # Dollar signs of a label make no formula.
    label = printable(label, MAX_LABEL).replace("$", r"\$")
    return in_lines(", ".join((label, *where)), TITLE_SIZE, width - 2 * _EDGE)
