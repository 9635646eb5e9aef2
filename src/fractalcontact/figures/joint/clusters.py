"""Clusters of the contact domain against the offset: number, size and localisation."""

from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.determined import follows_law
from ...core.estimate import EXPONENT, Estimate, names_of
from ...core.fitting import fit_line
from ...core.limits import LARGEST_DISTANCE, RESOLVED_NODES
from ...core.window import cell_side
from ..kit.drawing import (
    COLOURS,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    dilatancy_loads,
    entries,
    finest_curves,
    group,
    heading,
    headline,
    label_short_span,
    legends_below,
    letter,
    nearest_load,
    offset_axis,
    settings_of,
    spread,
)
from ..kit.points import draw_points
from ..kit.verdicts import claim, sentences
from ..kit.words import force_label, opening, place, short

TITLE = "Figs. 6 and 7: clusters of the contact domains, and their localisation with the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "closure", "domains", "statements")
ORDER = 120

#: Offsets whose size distribution is drawn: the first, the middle and the last.
DISTRIBUTIONS = 3
#: Colours and markers of these; the loads have the others.
_OFFSET_COLOURS = (COLOURS[3], COLOURS[4], COLOURS[5])
_OFFSET_MARKERS = ("D", "v", "P")
#: Symbol of the test whether sizes follow their law: largest distance, number of clusters fitted.
_TEST = r"$D\sqrt{n}$"
#: Opacity of the bands of random nodes.
_FAINT = 0.15

#: Numbers of a domain that are drawn and kept, with the names of their columns.
COLUMNS = {
    "clusters": "clusters",
    "largest_share": "largest_share",
    "cluster_area_mean": "cluster_area_mean_mm2",
    "morisita": "morisita",
    "morisita_scatter": "morisita_scatter",
    "half_share": "half_share",
    "half_share_random": "half_share_random",
    "clusters_random": "clusters_random",
    "clusters_cut": "clusters_cut",
    "morisita_cut": "morisita_cut",
}

#: Null models that are drawn where they are known, at the offset of the maps: column, marker.
NULLS = {"random": "+", "cut": "x"}
EXPONENTS = {
    **{name: name for name in names_of("cluster_exponent")},
    "cluster_fit_min": "fit_min_mm2",
    "cluster_fit_max": "fit_max_mm2",
    "cluster_fit_n": "fit_clusters",
    "cluster_fit_distance": "fit_distance",
}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Number of clusters, largest one, localisation and sizes, at the finest resolution.

    Its data are the numbers of every domain ("domain") and, for the map load, how many
    clusters have some area or more ("sizes").
    """
    settings = settings_of(atlas, name)
    specimen = group(atlas, "specimens", name)
    curves = finest_curves(atlas, name)
    direction, finest = str(curves["direction"].values), int(curves["resolution"])
    domains = group(atlas, "domains", name).sel(direction=direction, resolution=finest)
    cell = (finest * cell_side(specimen)) ** 2
    loads = curves["normal_force"].values
    shown = dilatancy_loads(loads, settings, specimen)
    mapped = nearest_load(loads, settings["map_load"], specimen)
    table = _domain_table(domains, curves["area"] / cell, shown)
    sizes = _size_table(domains.isel(normal_force=mapped), cell)

    figure = Figure(figsize=(WIDTH, 6.5))
    number, share, localised, distribution = figure.subplots(2, 2).ravel()
    _draw_domains((number, share, localised), table)
    _draw_sizes(distribution, sizes)
    by_load = [heading(r"(a) to (c): Morisita's index $I \sim v^x$ [95 %]"), *entries(number)]
    by_load += _other_entries(table)
    by_offset = [*_size_heading(sizes, force_label(loads[mapped])), *entries(distribution)]
    legends_below(figure, by_load, by_offset + _band_entries(table))
    headline(figure, settings["label"], place(direction))
    clustered = claim(
        atlas,
        name,
        "domains_cluster",
        why=f"I ~ v^x over all v at {force_label(loads[mapped])}",
    )
    # One letter for the exponent here and in the key; e is the table's.
    caption = _caption(clustered.replace("(e = ", "(x = "), sizes)
    data = pd.concat([table.assign(kind="domain"), sizes.assign(kind="sizes")], ignore_index=True)
    return Drawing(figure, data, caption)


def _other_entries(table):
    """Entries for what the panels of loads have beside curves."""
    style = {"ls": "none", "color": "0.4"}
    found = []
    if (table["nodes"] < RESOLVED_NODES).any():
        label = f"hollow: fewer than {RESOLVED_NODES} nodes touch"
        found.append(Line2D([], [], marker="o", mfc="white", label=label, **style))
    words = {"random": "as many random nodes", "cut": "as many nodes: bearing-area cut"}
    for null, marker in NULLS.items():
        if table[f"clusters_{null}"].notna().any():
            found.append(Line2D([], [], marker=marker, label=words[null], **style))
    return found


def _band_entries(table):
    """The bands of random nodes in (c), in the colours of their loads; none of a single offset."""
    if table["offset_mm"].nunique() < 2:
        return []
    return [
        Patch(
            color=colour_of(n),
            alpha=_FAINT,
            lw=0,
            label=f"(c) as many random nodes, 95 %: $F$ = {force_label(force)}",
        )
        for n, force in enumerate(table["force_N"].unique())
    ]


def _size_heading(sizes, force):
    """What the numbers and lines of (d) are: fitted laws, and when sizes follow them."""
    at = f"(d) at $F$ = {force}"
    fitted = sizes[np.isfinite(sizes["cluster_exponent"])]
    if fitted.empty:
        return [heading(at)]
    low, high = (short(end) for end in (fitted["fit_min_mm2"].min(), fitted["fit_max_mm2"].max()))
    rule = rf"followed if {_TEST} $\leq$ {LARGEST_DISTANCE:g}; $D$: largest distance from it"
    return [
        heading(rf"{at}: number $\sim a^{{-\beta}}$ [95 %]"),
        heading(rule),
        Line2D([], [], color="0.4", lw=0.8, label=f"lines: fits, $a$ = {low} to {high} mm$^2$"),
    ]


def _distance(law):
    """Largest distance of the sizes from their law, times the root of the number fitted."""
    return law["fit_distance"] * np.sqrt(law["fit_clusters"])


def _domain_table(domains, nodes, shown):
    """A row for each domain drawn, offset by offset under each load."""
    rows = []
    for j in shown:
        row = {
            "force_N": float(domains["normal_force"][j]),
            "offset_mm": domains["offset"].values,
            "nodes": np.round(nodes.isel(normal_force=j).values),
        }
        row |= {column: domains[key].isel(normal_force=j).values for key, column in COLUMNS.items()}
        rows.append(pd.DataFrame(row))
    table = pd.concat(rows, ignore_index=True)
    return table.assign(in_trend=(table["nodes"] >= RESOLVED_NODES) & (table["offset_mm"] > 0))


def _size_table(domains, cell):
    """Clusters of 2^k nodes or more at some offsets, with their law."""
    rows = []
    for i in spread(domains.sizes["offset"], DISTRIBUTIONS):
        domain = domains.isel(offset=i)
        counts = domain["cluster_octaves"].values
        larger = np.cumsum(counts[::-1])[::-1]
        row = {
            "force_N": float(domain["normal_force"]),
            "offset_mm": float(domain["offset"]),
            "cluster_area_mm2": 2.0 ** np.arange(len(counts)) * cell,
            "clusters_at_least": larger,
        }
        row |= {column: float(domain[key]) for key, column in EXPONENTS.items()}
        rows.append(pd.DataFrame(row)[larger > 0])
    return pd.concat(rows, ignore_index=True)


def _draw_domains(panels, table):
    number, share, localised = panels
    for n, (force, points) in enumerate(table.groupby("force_N")):
        v, many = points["offset_mm"], (points["nodes"] >= RESOLVED_NODES).values
        style = {"color": colour_of(n), "marker": MARKERS[n % len(MARKERS)]}
        for axes, column in (
            (number, "clusters"),
            (share, "largest_share"),
            (localised, "morisita"),
        ):
            # No contact is no number, and an index of 0 has no place on a logarithmic axis.
            y = points[column].where(points[column] > 0)
            axes.plot(v, y, lw=0.8, color=colour_of(n))
            draw_points(axes, v, y, many, **style)
        exponent = replace(_trend(points, "morisita").slope, scale=EXPONENT).text()
        name = rf"$F$ = {force_label(force)}: $x$ = {exponent}"
        number.plot([], [], lw=0.8, label=name, **style)
        above = 1 + 1.96 * points["morisita_scatter"]
        below = (1 - 1.96 * points["morisita_scatter"]).clip(lower=0.1)
        localised.fill_between(v, below, above, color=colour_of(n), alpha=_FAINT, lw=0)
        for axes, column in ((number, "clusters"), (localised, "morisita")):
            for null, marker in NULLS.items():
                if f"{column}_{null}" in points:
                    axes.plot(v, points[f"{column}_{null}"], marker, color=colour_of(n))
    localised.axhline(1, color="0.4", lw=0.8)
    for axes in panels:
        offset_axis(axes, table["offset_mm"].values)
    number.set_yscale("log")
    number.set_ylabel("contact clusters (1)")
    share.set_ylim(bottom=0)
    share.set_ylabel("largest cluster / contact area (1)")
    localised.set_yscale("log")
    lowest = table["morisita"].where(table["morisita"] > 0).min()
    localised.set_ylim(bottom=min(0.7, 0.8 * lowest))
    localised.set_ylabel("Morisita's index $I$ (1)")
    letter(number, "a", "number of clusters")
    letter(share, "b", "largest cluster")
    letter(localised, "c", "localisation (1: as random nodes)")


def _draw_sizes(axes, sizes):
    """Clusters of some area or more, with the laws fitted to them."""
    for n, (offset, points) in enumerate(sizes.groupby("offset_mm")):
        law = points.iloc[0]
        exponent = Estimate.read(law, "cluster_exponent", scale=EXPONENT).text()
        area, at_least = points["cluster_area_mm2"], points["clusters_at_least"]
        colour = _OFFSET_COLOURS[n]
        style = {"color": colour, "marker": _OFFSET_MARKERS[n], "ls": "none"}
        fits = np.isfinite(law["cluster_exponent"])
        words = rf"$\beta$ = {exponent}" if fits else "too few for a law"
        if fits:
            words += f", {_TEST} = {_distance(law):.2f}"
            words += (
                "" if follows_law(law["fit_clusters"], law["fit_distance"]) else ": not followed"
            )
        name = f"$v$ = {short(offset)} mm: {words}"
        axes.plot(area, at_least, label=name, **style)
        if fits:
            # From the octave that holds the smallest cluster fitted.
            first = area[area <= law["fit_min_mm2"] * (1 + 1e-9)].max()
            ends = np.array([first, law["fit_max_mm2"]])
            fitted = law["fit_clusters"] * (ends / first) ** -law["cluster_exponent"]
            axes.plot(ends, fitted, color=colour, lw=0.8)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.7)
    axes.set_xlabel("cluster area $a$ (mm$^2$)")
    axes.set_ylabel(r"number of clusters of area $\geq a$ (1)")
    label_short_span(axes.xaxis)
    letter(axes, "d", "sizes of clusters")


def _trend(points, column):
    """Line of a logarithm against that of the offset."""
    used = points[points["in_trend"] & (points[column] > 0)]
    return fit_line(np.log(used["offset_mm"]), np.log(used[column]))


def _caption(clustered, sizes):
    return sentences(
        f"{opening('Figs. 6 and 7')} Clusters of contact: number, largest, localisation (random "
        "nodes: 1) and sizes.",
        clustered,
        _size_words(sizes),
    )


def _size_words(sizes):
    """The exponents of the sizes of clusters, and whether the sizes follow the law."""
    laws = sizes.drop_duplicates("offset_mm")
    fitted = laws[np.isfinite(laws["cluster_exponent"])]
    if fitted.empty:
        return "Too few clusters for a law of sizes."
    if len(fitted) == 1:
        law = fitted.iloc[0]
        values = Estimate.read(law, "cluster_exponent", scale=EXPONENT).text()
    else:
        exponents = fitted["cluster_exponent"]
        values = f"{short(exponents.min())} to {short(exponents.max())}"
    broken = [
        law
        for _, law in fitted.iterrows()
        if not follows_law(law["fit_clusters"], law["fit_distance"])
    ]
    words = f"Their number falls as a^-beta, beta {values}"
    if not broken:
        return f"{words}."
    places = " and ".join(short(law["offset_mm"]) for law in broken)
    return (
        f"{words}; not followed at v = {places} mm, where the largest distance D of n sizes from "
        f"it exceeds {LARGEST_DISTANCE:g}/sqrt(n)."
    )
