"""What keeps a figure from being read in print: small letters, words over words or cut off."""

from itertools import combinations

from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Annotation, Text

from fractalcontact.figures.kit.drawing import DPI, _lay_out
from fractalcontact.figures.kit.empty import settle_empty_axes
from fractalcontact.figures.kit.ticks import plain_ticks

#: Points that letters have at least, at the width that the figure is printed at.
LEAST_SIZE = 6.0
#: Pixels that boxes around words may share: they are a little larger than the letters.
_SLACK = 3.0


def laid_out(figure):
    """The figure drawn as it is saved, without its files: legends have their places only then."""
    figure.set_dpi(DPI)
    settle_empty_axes(figure)
    canvas = FigureCanvasAgg(figure)
    plain_ticks(figure)
    _lay_out(figure)
    canvas.draw()
    return figure


def shown_texts(figure):
    """Every text that is drawn: of ticks those on the axis."""
    found = []
    for axes in figure.axes:
        for panel in (axes, *axes.child_axes):
            if panel.axison and panel.get_visible():
                found += _tick_labels(panel.xaxis) + _tick_labels(panel.yaxis)
    of_ticks = set()
    for axis in figure.findobj(Axis):
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
            of_ticks |= {tick.label1, tick.label2}
    hidden = {
        text
        for axes in figure.axes
        if not axes.axison
        for text in (axes.xaxis.label, axes.yaxis.label)
    }
    found += [text for text in figure.findobj(Text) if text not in of_ticks | hidden]
    return [text for text in dict.fromkeys(found) if text.get_visible() and text.get_text().strip()]


def _tick_labels(axis):
    low, high = sorted(axis.get_view_interval())
    slack = 1e-6 * (high - low)
    return [
        label
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks())
        for label in (tick.label1, tick.label2)
        if low - slack <= tick.get_loc() <= high + slack
    ]


def faults(figure):
    """What cannot be read of a figure that is laid out, in words."""
    found = []
    renderer = figure.canvas.get_renderer()
    texts = shown_texts(figure)
    boxes = {
        text: Text.get_window_extent(text, renderer)
        if isinstance(text, Annotation)
        else text.get_window_extent(renderer)
        for text in texts
    }
    for text, box in boxes.items():
        words = text.get_text().replace("\n", " ")[:40]
        if text.get_fontsize() < LEAST_SIZE:
            found.append(f"{text.get_fontsize():g} pt: {words!r}")
        inside = (
            box.x0 >= -_SLACK
            and box.y0 >= -_SLACK
            and box.x1 <= figure.bbox.x1 + _SLACK
            and box.y1 <= figure.bbox.y1 + _SLACK
        )
        if not inside:
            found.append(f"cut off: {words!r}")
    for (one, a), (other, b) in combinations(boxes.items(), 2):
        width = min(a.x1, b.x1) - max(a.x0, b.x0)
        height = min(a.y1, b.y1) - max(a.y0, b.y0)
        if width > _SLACK and height > _SLACK:
            found.append(f"overlap: {one.get_text()[:30]!r} and {other.get_text()[:30]!r}")
    return found
