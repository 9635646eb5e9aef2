"""Titles of figures and letters of their panels."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ...core.labels import printable
from .line_breaks import in_lines
from .words import formulas

#: Size of the letters of a figure's title, points, and height of a line, inches.
TITLE_SIZE, LINE = 9, 0.15
#: Distance between the edge of a figure and its title, inches.
_EDGE = 0.05
#: Maximum length of a specimen's label, letters.
MAX_LABEL = 300


def letter(axes: Axes, which: str, title: str) -> None:
    """Letter of a panel at its upper left, before a title."""
    axes.set_title(f"({which}) {title}", loc="left")


def headline(figure: Figure | SubFigure, label: str, *where: str, below: str = "") -> None:
    """Headline of a figure: label of the specimen and further words, in lines that fit.

    Formulas in `where` stand in dollar signs; the label has none. `below` is a line of its own.
    """
    text = label_in_lines(label, *where, width=figure.bbox.width / figure.dpi)
    if isinstance(figure, Figure):
        # The figure grows with the label, so that the panels below keep their height.
        figure.set_figheight(figure.get_figheight() + LINE * text.count("\n"))
    figure.suptitle("\n".join(filter(None, (text, below))), fontsize=TITLE_SIZE)


def entitle(figure: Figure, title: str) -> None:
    """Write the title above the headline of a figure and make the figure higher for it.

    Symbols of the title are written as captions have them.
    """
    words = in_lines(formulas(title), TITLE_SIZE, figure.get_figwidth() - 2 * _EDGE)
    lines = words.split("\n")
    before = figure.get_figheight()
    figure.set_figheight(before + LINE * len(lines))
    laid_out = isinstance(figure.get_layout_engine(), ConstrainedLayoutEngine)
    if not laid_out:
        # Without a layout engine the panels are moved here, out of the title's way.
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
    # Dollar signs of a label are escaped: they begin no formula.
    label = printable(label, MAX_LABEL).replace("$", r"\$")
    return in_lines(", ".join((label, *where)), TITLE_SIZE, width - 2 * _EDGE)
