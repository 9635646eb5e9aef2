"""Clusters of the contact domain against the offset: number, size and localisation."""

from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import LARGEST_DISTANCE, RESOLVED_NODES
from ...core.subject import Subject
from ...core.text import force_label
from .. import kit
from ._cluster_sizes import draw_sizes, size_laws

TITLE = "Figs. 6 and 7: clusters of the contact domains, and their localisation with the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "closure", "domains", "statements")
ORDER = 120

#: Number of offsets whose size distribution is drawn: the first, the middle and the last.
DISTRIBUTIONS = 3
#: Opacity of the bands of random nodes.
_FAINT = 0.15
#: Marker and words of the null models, which are known at the reported offset.
_NULLS = {"random": ("+", "as many random nodes"), "cut": ("x", "as many nodes: bearing-area cut")}

#: Variables of panels (a) to (c), each with the other variables of its rows.
_DRAWN = {
    "clusters": ("nodes", "cluster_area_mean", "clusters_random", "clusters_cut"),
    "largest_share": (),
    "morisita": (
        *("morisita_by_chance_low", "morisita_by_chance_high", "morisita_cut", "morisita_used"),
        *("morisita_exponent", "morisita_scatter"),
    ),
}


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Number of clusters, largest one, localisation and sizes, at the finest resolution."""
    subject = Subject.of(atlas, name)
    reported, domains = subject.reported, subject.curves("domains")
    states = domains.assign(subject.curves()[["nodes", "resolved"]].data_vars)
    states = states.isel(normal_force=list(reported.loads))
    sizes = domains.isel(
        normal_force=reported.reference, offset=kit.spread(domains.sizes["offset"], DISTRIBUTIONS)
    )
    figure = Figure(figsize=(kit.WIDTH, 6.5))
    titles = ("number of clusters", "largest cluster", "localisation (1: as random nodes)")
    axes = figure.subplots(2, 2).ravel()
    panels = kit.panels_of(axes, (*titles, "sizes of clusters"))
    for panel, quantity in zip(panels, _DRAWN, strict=False):
        _draw_states(panel, states, quantity)
    _finish(axes[:3], states)
    draw_sizes(panels[3], sizes)
    by_load = [
        kit.heading(r"(a) to (c): Morisita's index $I \sim v^x$ [95 %]"),
        *kit.entries(axes[0]),
    ]
    force = force_label(reported.force)
    by_offset = [kit.heading(rf"(d) at $F$ = {force}: number $\sim a^{{-\beta}}$ [95 %]")]
    kit.legends_below(figure, by_load, [*by_offset, *kit.entries(axes[3])])
    kit.headline(figure, subject.label, kit.place(subject.direction))
    why = f"Morisita's index ~ v^x over all v at {force}"
    text = kit.caption(
        __name__,
        clustered=kit.claim(atlas, name, "domains_cluster", why=why),
        verdict=kit.claim(atlas, name, "domains_cluster", numbers=False),
        limit=LARGEST_DISTANCE,
        **size_laws(sizes),
    )
    return kit.Drawing(figure, kit.table_of(*panels), text)


def _draw_states(panel, states, quantity):
    """Quantity of the domains over the offsets, one curve per load, with its null models."""
    # Zeros are left out: without contact there is no number, and a logarithmic axis has no 0.
    positive = states[quantity].where(states[quantity] > 0)
    exponents = Estimate.read(states, "morisita_exponent", scale=EXPONENT)
    labels = [
        rf"$F$ = {force_label(force)}: $x$ = {exponents[n].text()}"
        for n, force in enumerate(states["normal_force"].values)
    ]
    style = {"hue": "normal_force", "labels": labels, "filled": "resolved", "ls": "-", "lw": 0.8}
    kept = [name for name in _DRAWN[quantity] if name in states]
    panel.curves(states.assign({quantity: positive}), "offset", quantity, keep=kept, **style)
    if not states["resolved"].all():
        kit.hollow_entry(panel.axes, f"hollow: fewer than {RESOLVED_NODES} nodes touch")
    for null, (marker, words) in _NULLS.items():
        name = f"{quantity}_{null}"
        if name not in kept or not states[name].notnull().any():
            continue
        for n in range(states.sizes["normal_force"]):
            values = states[name].isel(normal_force=n)
            panel.axes.plot(states["offset"], values, marker, color=kit.colour_of(n))
        panel.axes.plot([], [], marker, color="0.4", label=words)


def _finish(panels, states):
    """Axes over the offsets, and the bands of random nodes."""
    number, share, localised = panels
    ends = (states[f"morisita_by_chance_{end}"] for end in ("low", "high"))
    low, high = (one.transpose("normal_force", "offset").values for one in ends)
    for n in range(states.sizes["normal_force"]):
        band = {"color": kit.colour_of(n), "alpha": _FAINT, "lw": 0}
        localised.fill_between(states["offset"], low[n].clip(min=0.1), high[n], **band)
    if states.sizes["offset"] > 1:
        grey = {"color": "0.5", "alpha": _FAINT, "lw": 0}
        number.fill_between([], [], label="(c) bands: as many random nodes, 95 %", **grey)
    localised.axhline(1, color="0.4", lw=0.8)
    for axes in panels:
        kit.offset_axis(axes, states["offset"].values)
    number.set(yscale="log", ylabel="contact clusters (1)")
    share.set(ylabel="largest cluster / contact area (1)")
    share.set_ylim(bottom=0)
    localised.set(yscale="log", ylabel="Morisita's index $I$ (1)")
    index = states["morisita"]
    localised.set_ylim(bottom=min(0.7, 0.8 * float(index.where(index > 0).min())))
