"""Contact map beside the map of the gap and that of the flow, under the reference load."""

from typing import Any

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import pressure_label
from ...core.window import window_sides
from .. import kit

TITLE = "Contact, gap and flow"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "contact", "flow")
ORDER = 48
JOINT_STUDY = True
SECTION = "flow"

#: Ends of the colours of the flow per width, over its mean.
_LEAST, _MOST = 0.01, 10.0


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Contact domain, gap and flow along the sliding at the reported offset."""
    subject = Subject.of(atlas, name)
    flow, contact = subject.states("flow"), subject.states("contact")
    reference, sides = subject.reported.reference, window_sides(subject["specimens"])
    high = min(max(sides[0] / sides[1], 0.4), 2.0)
    figure = Figure(figsize=(kit.WIDTH, 1.3 + 2.1 * high))
    axes, bars = figure.subplots(2, 3, height_ratios=[1, 0.04])
    bars[0].remove()
    axis = subject["flow"].attrs["flow_axis_along"]
    titles = ("contact", "gap", f"flow along {axis}")
    a, b, c = kit.panels_of(axes, titles)
    kit.draw_domain(
        a.axes, kit.contact_domain(subject, subject.reported.resolution, reference), sides, ticks=3
    )
    gap = contact["map_gap"].isel(normal_force=reference).values
    flux = flow["flux_map_along"].values
    flows = bool((flux > 0).any())
    top = float(np.nanquantile(gap, 0.99)) or 1.0
    of_gap: dict[str, Any] = {"cmap": "viridis", "vmin": 0, "vmax": top}
    of_flux: dict[str, Any] = {"cmap": "cividis", "norm": LogNorm(_LEAST, _MOST)}
    for panel, bar, values, style, label, extend in (
        (b, bars[1], gap, of_gap, "gap $g$ (mm)", "max"),
        (c, bars[2], np.maximum(flux, _LEAST), of_flux, "flow per width over its mean (1)", "both"),
    ):
        drawn = kit.draw_map(panel.axes, values, sides, ticks=3, **style)
        figure.colorbar(drawn, cax=bar, label=label, extend=extend, orientation="horizontal")
        panel.axes.set_ylabel("")
    if not flows:
        kit.say_empty(c.axes, str(flow["flow_reason_along"].values[reference]), ticks=False)
    state = flow.isel(normal_force=reference)
    c.keep(
        state, "channel_fraction_along", "critical_gap_along", "transmissivity_along", "gap_slope"
    )
    pressure = pressure_label(float(state["nominal_pressure"]))
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset), pressure)
    words = {
        "axis": axis,
        "flows": flows,
        "channels": float(state["channel_fraction_along"]),
        "narrowest": float(state["critical_gap_along"]),
        "slope": float(state["gap_slope"]),
        "gradient": 1e6 * float(state["reynolds_gradient_along"]),
        "reason": str(state["flow_reason_along"].values),
    }
    return kit.Drawing(figure, kit.table_of(c), kit.caption(__name__, **words))
