"""Transmissivity along and across the sliding, and mean gap, against the offset."""

from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ..kit.axes import label_short_span, offset_axis
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing, colour_of
from ..kit.empty import say_empty
from ..kit.legends import entries, legends_below
from ..kit.panel import Panel, table_of
from ..kit.titles import headline
from ..kit.words import place, pressure_label
from ._flow_ways import WAYS, open_states

TITLE = "Transmissivity against the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "closure", "flow")
ORDER = 47
SECTION = "flow"


def draw(atlas: DataTree, name: str) -> Drawing:
    """Both transmissivities and the mean gap of every offset, under the reference load."""
    subject = Subject.of(atlas, name)
    flow = subject["flow"]
    figure = Figure(figsize=(WIDTH, 3.6))
    titles = ("transmissivity", "mean gap")
    a, b = (Panel(*one) for one in zip(figure.subplots(1, 2), "ab", titles, strict=True))
    for way, style in WAYS.items():
        variable = f"offset_transmissivity_{way}"
        a.curve(
            open_states(flow, variable),
            "offset",
            variable,
            label=f"{way} the sliding",
            ls="-",
            **style,
        )
    b.curve(
        flow, "offset", "offset_mean_gap", label="mean gap", color=colour_of(2), marker="^", ls="-"
    )
    if not (flow["offset_transmissivity_along"] > 0).any():
        say_empty(a.axes, "no offset has a path of open gap from side to side")
    a.axes.set(yscale="log", ylabel="transmissivity $T$ (mm³)")
    label_short_span(a.axes.yaxis)
    b.axes.set_ylabel(r"mean gap $\langle g\rangle$ (mm)")
    for panel in (a, b):
        offset_axis(panel.axes, flow["offset"].values)
    legends_below(figure, entries(a.axes))
    at = float(flow["nominal_pressure"][subject.reported.reference])
    headline(figure, subject.label, place(subject.direction), pressure_label(at))
    along, across = (flow[f"offset_transmissivity_{way}"].values for way in WAYS)
    words = {
        "pressure": at,
        "offsets": int(flow.sizes["offset"]),
        "larger": int((along > across).sum()),
        "closed": int((along == 0).sum()),
        "first": float(along[0]),
        "last": float(along[-1]),
        "last_offset": float(flow["offset"][-1]),
    }
    return Drawing(figure, table_of(a, b), caption(__name__, **words))
