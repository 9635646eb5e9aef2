"""What keeps a figure from being read in print: small letters, words over words or cut off."""

import json
from itertools import combinations, pairwise

from matplotlib.axis import Axis
from matplotlib.legend import Legend
from matplotlib.text import Annotation, Text

from fractalcontact.figures.draw import draw_figure
from fractalcontact.figures.kit.drawing import WIDTH
from fractalcontact.figures.kit.layout import lay_out
from fractalcontact.figures.kit.ticks import axes_of
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.figure_list import all_figures, figures_of, study_figures_of

#: Points that letters have at least, at the width that the figure is printed at.
MIN_SIZE = 6.0
#: Pixels that boxes around words may share: they are a little larger than the letters.
_SLACK = 3.0
#: Empty space between two numbers of an axis, at least, in sizes of their letters: "3.253.5" is one
#: number to a reader.
_APART = 0.25


def faults_of_study(path):
    """Faults of every figure of an atlas, by subject and figure; those without any are left out."""
    atlas = read_atlas(path)
    configuration = json.loads(atlas.attrs["configuration"])
    names = sorted(atlas["specimens"].children)
    of_study = study_figures_of([*configuration["study"], "defaults", "comparison"])
    subjects = [(figure, names) for figure in of_study if _has(atlas, figure)]
    for name in names:
        opposite = configuration["settings"][name]["opposite"]
        subjects += [(figure, name) for figure in figures_of(opposite)]
    assert len(subjects) > 20
    found = {
        f"{subject} {figure}": faults(draw_figure(atlas, figure, subject).figure)
        for figure, subject in subjects
    }
    return {figure: words for figure, words in found.items() if words}


def _has(atlas, figure):
    """Whether an atlas has the stages of a figure."""
    return all(stage in atlas.children for stage in all_figures()[figure].needs)


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


def _tick_labels(axis, *sides):
    """Numbers within the ends of an axis, on both sides of it or on one."""
    along = axis.get_transform().transform
    low, high = sorted(along(axis.get_view_interval()))
    slack = 1e-6 * (high - low)
    return [
        label
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks())
        for label in (getattr(tick, side) for side in sides or ("label1", "label2"))
        if low - slack <= along(tick.get_loc()) <= high + slack
    ]


def faults(figure):
    """What cannot be read of a figure, in words."""
    canvas = lay_out(figure)
    canvas.draw()  # legends have their places only then
    found = [] if figure.get_figwidth() <= WIDTH else [f"{figure.get_figwidth():g} inches wide"]
    renderer = canvas.get_renderer()
    texts = shown_texts(figure)
    boxes = {
        text: Text.get_window_extent(text, renderer)
        if isinstance(text, Annotation)
        else text.get_window_extent(renderer)
        for text in texts
    }
    for text, box in boxes.items():
        words = text.get_text().replace("\n", " ")[:40]
        if text.get_fontsize() < MIN_SIZE:
            found.append(f"{text.get_fontsize():g} pt: {words!r}")
        if not _inside(box, figure):
            found.append(f"cut off: {words!r}")
    # Lines and markers of a legend stand beside its words.
    for legend in figure.findobj(Legend):
        empty = renderer.points_to_pixels(legend.borderpad * legend.prop.get_size_in_points())
        if not _inside(legend.get_window_extent(renderer).padded(-empty), figure):
            found.append("a legend is cut off")
    for (one, a), (other, b) in combinations(boxes.items(), 2):
        width = min(a.x1, b.x1) - max(a.x0, b.x0)
        height = min(a.y1, b.y1) - max(a.y0, b.y0)
        if width > _SLACK and height > _SLACK:
            found.append(f"overlap: {one.get_text()[:30]!r} and {other.get_text()[:30]!r}")
    return found + _run_together(figure, boxes)


def _run_together(figure, boxes):
    """Numbers along one side of an axis that a reader takes for one, in words."""
    found = []
    for _, axis in axes_of(figure):
        low, high = f"{axis.axis_name}0", f"{axis.axis_name}1"
        for side in ("label1", "label2"):
            row = [label for label in _tick_labels(axis, side) if label in boxes]
            row.sort(key=lambda label: getattr(boxes[label], low))
            for one, other in pairwise(row):
                gap = getattr(boxes[other], low) - getattr(boxes[one], high)
                if gap < _APART * one.get_fontsize() * figure.dpi / 72:
                    found.append(f"run together: {one.get_text()!r} and {other.get_text()!r}")
    return found


def _inside(box, figure):
    return (
        box.x0 >= -_SLACK
        and box.y0 >= -_SLACK
        and box.x1 <= figure.bbox.x1 + _SLACK
        and box.y1 <= figure.bbox.y1 + _SLACK
    )
