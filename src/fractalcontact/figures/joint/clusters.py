"""Clusters of the contact domain against the offset: number, size and localisation."""

from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import LARGEST_DISTANCE, RESOLVED_NODES
from ...core.subject import Subject
from ..kit.axes import label_short_span, offset_axis
from ..kit.caption import caption
from ..kit.drawing import COLOURS, WIDTH, Drawing, colour_of, spread
from ..kit.legends import entries, heading, legends_below
from ..kit.panel import Panel, table_of
from ..kit.points import hollow_entry
from ..kit.titles import headline
from ..kit.verdicts import claim
from ..kit.words import force_label, place, short

TITLE = "Figs. 6 and 7: clusters of the contact domains, and their localisation with the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "closure", "domains", "statements")
ORDER = 120

#: Offsets whose size distribution is drawn: the first, the middle and the last.
DISTRIBUTIONS = 3
#: Colours and markers of these; the loads have the others.
_OFFSET_COLOURS = (COLOURS[3], COLOURS[4], COLOURS[5])
_OFFSET_MARKERS = ("D", "v", "P")
#: Opacity of the bands of random nodes.
_FAINT = 0.15
#: Null models that are drawn where they are known, at the reported offset: marker, words.
_NULLS = {"random": ("+", "as many random nodes"), "cut": ("x", "as many nodes: bearing-area cut")}

#: What panels (a) to (c) draw, and what else their rows keep.
_DRAWN = {
    "clusters": ("nodes", "cluster_area_mean", "clusters_random", "clusters_cut"),
    "largest_share": (),
    "morisita": (
        *("morisita_by_chance_low", "morisita_by_chance_high", "morisita_cut", "morisita_used"),
        *("morisita_exponent", "morisita_scatter", "half_share", "half_share_random"),
    ),
}
_SIZES = ("cluster_area", "clusters_at_least", "cluster_law_count", "cluster_law_followed")
_FIT = ("cluster_exponent", *(f"cluster_fit_{key}" for key in ("min", "max", "n", "distance")))


def draw(atlas: DataTree, name: str) -> Drawing:
    """Number of clusters, largest one, localisation and sizes, at the finest resolution."""
    subject = Subject.of(atlas, name)
    reported, domains = subject.reported, subject.curves("domains")
    states = domains.assign(subject.curves()[["nodes", "resolved"]].data_vars)
    states = states.isel(normal_force=list(reported.loads))
    sizes = domains.isel(
        normal_force=reported.reference, offset=spread(domains.sizes["offset"], DISTRIBUTIONS)
    )
    figure = Figure(figsize=(WIDTH, 6.5))
    titles = ("number of clusters", "largest cluster", "localisation (1: as random nodes)")
    axes = figure.subplots(2, 2).ravel()
    panels = [Panel(*one) for one in zip(axes, "abcd", (*titles, "sizes of clusters"), strict=True)]
    for panel, quantity in zip(panels, _DRAWN, strict=False):
        _draw_states(panel, states, quantity)
    _finish(axes[:3], states)
    _draw_sizes(panels[3], sizes)
    by_load = [heading(r"(a) to (c): Morisita's index $I \sim v^x$ [95 %]"), *entries(axes[0])]
    force = force_label(reported.force)
    by_offset = [heading(rf"(d) at $F$ = {force}: number $\sim a^{{-\beta}}$ [95 %]")]
    legends_below(figure, by_load, [*by_offset, *entries(axes[3])])
    headline(figure, subject.label, place(subject.direction))
    why = f"I ~ v^x over all v at {force}"
    text = caption(
        __name__,
        clustered=claim(atlas, name, "domains_cluster", why=why),
        verdict=claim(atlas, name, "domains_cluster", numbers=False),
        limit=LARGEST_DISTANCE,
        **_laws(sizes),
    )
    return Drawing(figure, table_of(*panels), text)


def _draw_states(panel, states, quantity):
    """A quantity of the domains over the offsets, a curve a load, beside its null models."""
    # No contact is no number, and an index of 0 has no place on a logarithmic axis.
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
        hollow_entry(panel.axes, f"hollow: fewer than {RESOLVED_NODES} nodes touch")
    for null, (marker, words) in _NULLS.items():
        name = f"{quantity}_{null}"
        if name not in kept or not states[name].notnull().any():
            continue
        for n in range(states.sizes["normal_force"]):
            values = states[name].isel(normal_force=n)
            panel.axes.plot(states["offset"], values, marker, color=colour_of(n))
        panel.axes.plot([], [], marker, color="0.4", label=words)


def _finish(panels, states):
    """Axes of what is drawn over the offsets, and the bands of random nodes."""
    number, share, localised = panels
    ends = (states[f"morisita_by_chance_{end}"] for end in ("low", "high"))
    low, high = (one.transpose("normal_force", "offset").values for one in ends)
    for n in range(states.sizes["normal_force"]):
        band = {"color": colour_of(n), "alpha": _FAINT, "lw": 0}
        localised.fill_between(states["offset"], low[n].clip(min=0.1), high[n], **band)
    if states.sizes["offset"] > 1:
        grey = {"color": "0.5", "alpha": _FAINT, "lw": 0}
        number.fill_between([], [], label="(c) bands: as many random nodes, 95 %", **grey)
    localised.axhline(1, color="0.4", lw=0.8)
    for axes in panels:
        offset_axis(axes, states["offset"].values)
    number.set(yscale="log", ylabel="contact clusters (1)")
    share.set(ylabel="largest cluster / contact area (1)")
    share.set_ylim(bottom=0)
    localised.set(yscale="log", ylabel="Morisita's index $I$ (1)")
    index = states["morisita"]
    localised.set_ylim(bottom=min(0.7, 0.8 * float(index.where(index > 0).min())))


def _draw_sizes(panel, sizes):
    """Clusters of some area or more, with the laws fitted to them."""
    axes = panel.axes
    for n, offset in enumerate(sizes["offset"].values):
        domain = sizes.isel(offset=n)
        domain = domain.isel(octave=(domain["clusters_at_least"] > 0).values)
        panel.keep(domain, *_SIZES, *_FIT)
        exponent = Estimate.read(domain, "cluster_exponent", scale=EXPONENT)
        words = rf"$\beta$ = {exponent.text()}" if exponent.known else "too few for a law"
        if exponent.known and not bool(domain["cluster_law_followed"]):
            words += ", not followed"
        style = {"color": _OFFSET_COLOURS[n], "marker": _OFFSET_MARKERS[n], "ls": "none"}
        area, label = domain["cluster_area"], f"$v$ = {short(offset)} mm: {words}"
        axes.plot(area, domain["clusters_at_least"], label=label, **style)
        axes.plot(area, domain["cluster_law_count"], color=style["color"], lw=0.8)
    axes.set(xscale="log", yscale="log", xlabel="cluster area $a$ (mm$^2$)")
    axes.set_ylim(bottom=0.7)
    axes.set_ylabel(r"number of clusters of area $\geq a$ (1)")
    label_short_span(axes.xaxis)
    if sizes["cluster_exponent"].notnull().any():
        axes.plot([], [], color="0.4", lw=0.8, label="lines: laws over the areas fitted")


def _laws(sizes):
    """Exponents of the sizes of clusters in words, and the offsets where sizes follow no law."""
    fitted = sizes.isel(offset=sizes["cluster_exponent"].notnull().values)
    exponents = Estimate.read(fitted, "cluster_exponent", scale=EXPONENT)
    if exponents.value.size < 2:
        words = exponents[0].text() if exponents.value.size else ""
    else:
        words = f"{short(exponents.value.min())} to {short(exponents.value.max())}"
    broken = fitted["offset"].values[~fitted["cluster_law_followed"].values]
    return {"exponents": words, "broken": [short(v) for v in broken]}
