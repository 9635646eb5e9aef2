"""Line breaks where words have no room: titles of figures and panels, entries of legends.

The length of a title or an entry depends on its numbers: "undetermined (0.25 [-0.52, 1.02])" takes
the place of "0.25". Widths are measured on the letters as they are drawn.
"""

import itertools
import re
from collections.abc import Iterator

from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.legend import Legend
from matplotlib.text import Text
from matplotlib.transforms import BboxBase

from .canvas import Canvas

#: Smallest distance of words from the figure's edge, and of two titles from each other, points.
_EDGE, _GAP = 1, 4
#: Smallest distance of the columns of a legend, and smallest room of a title, points.
_MIN_SPACING, _MIN_ROOM = 6, 36
#: Blank at which a line may end, but not within "95 %" or "[0.20, 2.00]".
_BLANK = re.compile(r" (?!%)(?![^\[\]]*\])")
#: Dollar sign that begins or ends a formula.
_DOLLAR = re.compile(r"(?<!\\)\$")


def in_lines(words: str, size: float, width: float) -> str:
    """Words in lines of at most `width` inches, `size` points high; formulas stand in $."""
    figure = Figure(figsize=(1, 1))
    Canvas(figure)
    text = figure.text(0, 0, words, fontsize=size)
    _fill(text, width * figure.dpi)
    return text.get_text()


def break_lines(figure: Figure) -> bool:
    """Break titles of panels, and entries of legends, that leave the figure or meet another title.

    Returns True if any was broken: the panels, which have their places, then want other places.
    """
    broken = [*_break_panel_titles(figure)]
    broken += [_narrow(legend, figure) for legend in _legends(figure)]
    return any(broken)


def _legends(parent: FigureBase | Axes) -> Iterator[Legend]:
    """Legends in a figure; `findobj` would walk through all ticks, and create missing ones."""
    for child in parent.get_children():
        if isinstance(child, Legend):
            yield child
        elif isinstance(child, FigureBase | Axes):
            yield from _legends(child)


def _break_panel_titles(figure) -> Iterator[bool]:
    """Break left-aligned panel titles at the next title or the figure's edge.

    Yields for each title whether it was broken.
    """
    titles = [
        title
        for axes in figure.axes
        for title in (axes._left_title, axes.title, axes._right_title)
        if axes.get_visible() and title.get_text()
    ]
    boxes = {title: title.get_window_extent(_renderer(figure)) for title in titles}
    for title, box in boxes.items():
        edges = [
            other.x0 - _pixels(figure, _GAP)
            for other in boxes.values()
            if other.x0 > box.x0 and _side_by_side(other, box)
        ]
        right = min([figure.bbox.x1 - _pixels(figure, _EDGE), *edges])
        room = max(right - box.x0, _pixels(figure, _MIN_ROOM))
        yield title.get_horizontalalignment() == "left" and _fill(title, room)


def _side_by_side(one: BboxBase, other: BboxBase) -> bool:
    return one.y0 < other.y1 and other.y0 < one.y1


def _narrow(legend: Legend, figure: Figure) -> bool:
    """Narrow a legend that is wider than the figure: columns closer, longest entries broken."""
    excess = _excess(legend, figure)
    if excess <= 0:
        return False
    columns = vars(legend)["_legend_handle_box"]  # matplotlib has no other way to them
    gaps = max(len(columns.get_children()) - 1, 1)
    before = columns.sep
    columns.sep = min(before, max(before - excess / gaps * 72 / figure.dpi, _MIN_SPACING))
    narrowed = columns.sep < before
    entries = [*legend.get_texts(), legend.get_title()]
    while (excess := _excess(legend, figure)) > 0:
        longest = max(entries, key=lambda text: _width(text, text.get_text()))
        width = _width(longest, longest.get_text())
        # An entry keeps half of its width, so that no single one is broken into many lines.
        if not _fill(longest, width - min(excess, width / 2)):
            break
        narrowed = True
    return narrowed


def _excess(legend: Legend, figure: Figure) -> float:
    """Excess width of a legend over the figure, pixels; 0 below one pixel."""
    room = figure.bbox.width - 2 * _pixels(figure, _EDGE)
    excess = legend.get_window_extent(_renderer(figure)).width - room
    return excess if excess > 1 else 0.0


def _fill(text: Text, room: float) -> bool:
    """Break the lines of a text that are wider than ``room`` pixels; True if any was."""
    words = text.get_text()
    lines = itertools.chain.from_iterable(_lines(text, line, room) for line in words.split("\n"))
    filled = "\n".join(lines)
    text.set_text(filled)
    return filled != words


def _lines(text: Text, line: str, room: float) -> Iterator[str]:
    """A line in lines no wider than ``room`` pixels, broken at blanks outside formulas."""
    if _width(text, line) <= room:
        yield line
        return
    begun = ""
    for word in _words(line):
        longer = f"{begun} {word}" if begun else word
        if _width(text, longer) <= room:
            begun = longer
            continue
        if begun:
            yield begun
        *whole, begun = _parts(text, word, room)
        yield from whole
    yield begun


def _words(line: str) -> Iterator[str]:
    """Words of a line; a formula with the words it touches is one."""
    begun: list[str] = []
    for word in _BLANK.split(line):
        begun.append(word)
        if len(_DOLLAR.findall(" ".join(begun))) % 2 == 0:
            yield " ".join(begun)
            begun = []
    if begun:
        yield " ".join(begun)


def _parts(text: Text, word: str, room: float) -> list[str]:
    """A word too long for a line of its own, cut; a formula stays whole."""
    if len(word) < 2 or "$" in word or _width(text, word) <= room:
        return [word]
    letters = len(word) - 1
    while letters > 1 and _width(text, word[:letters]) > room:
        letters = min(letters - 1, int(letters * room / _width(text, word[:letters])) + 1)
    return [word[:letters], *_parts(text, word[letters:], room)]


def _width(text: Text, words: str) -> float:
    """Width in pixels of a text with other words."""
    text.set_text(words)
    return text.get_window_extent(_renderer(text.get_figure(root=True))).width


def _renderer(figure):
    """Renderer that measures the figure."""
    canvas: Canvas = figure.canvas
    return canvas.get_renderer()


def _pixels(figure, points):
    return points * figure.dpi / 72
