"""Area slope kappa of made surfaces at light load, beside the theories: one figure a study."""

import numpy as np
from matplotlib.figure import Figure

from ...mechanics.theory import persson_area
from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    heading,
    label_short_span,
    legends_below,
    letter,
)
from ..kit.words import number

_TITLES = {
    "with_roll_off": "with a roll-off at {share} of the side",
    "without_roll_off": "without a roll-off",
}


def draw(atlas, names):
    """kappa of every made surface against load, raw and corrected, with and without a roll-off.

    Parameters
    ----------
    atlas : xr.DataTree
    names : list of str
        Specimens of the study; the surfaces here are the study's own and none of them.

    Returns
    -------
    Drawing
    """
    slopes = group(atlas, "area_slope", "surfaces")
    figure = Figure(figsize=(WIDTH, 4.2))
    panels = figure.subplots(1, len(slopes["surface"]), sharey=True)
    for which, axes, kind in zip("ab", panels, slopes["surface"].values, strict=True):
        chosen = slopes.sel(surface=kind)
        _draw_surfaces(axes, chosen)
        kappa_lines(axes, slopes["load"].values, slopes.attrs)
        share = f"1/{1 / slopes.attrs['roll_off_share']:.3g}"
        label_short_span(axes.xaxis)
        letter(axes, which, _TITLES[kind].format(share=share))
        axes.set_xlabel(r"reduced pressure $p/(E^* h'_\mathrm{rms})$ (1)")
    panels[0].set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h'_\mathrm{rms}/p$ (1)")
    shown = entries(panels[0])
    seeds, theories = shown[: slopes.sizes["seed"]], shown[slopes.sizes["seed"] :]
    legends_below(figure, [heading("corrected for the perimeter (hollow: raw)"), *seeds], theories)
    nodes, dimension = slopes.attrs["nodes"], slopes.attrs["dimension"]
    figure.suptitle(
        rf"made surfaces of {nodes} $\times$ {nodes} nodes, $\Delta_g$ = {dimension:g}", fontsize=9
    )
    return Drawing(figure, _table(slopes), _caption(slopes))


def kappa_lines(axes, loads, attrs):
    """Persson's and Bush, Gibson and Thomas' kappa, and the literature's values as a band.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Its x is p / (E* h'_rms), on a logarithmic axis, its y kappa.
    loads : array_like
        Between the smallest and largest of these the lines are drawn.
    attrs : mapping
        ``persson_kappa``, ``bush_gibson_thomas_kappa`` and ``computed_kappa``.
    """
    ends = np.geomspace(np.min(loads), np.max(loads), 60)
    low, high = attrs["computed_kappa"]
    bush = attrs["bush_gibson_thomas_kappa"]
    axes.plot(
        ends,
        np.full(ends.shape, bush),
        "--",
        color="0.2",
        lw=1,
        label=rf"Bush, Gibson and Thomas: $\sqrt{{2\pi}}$ = {number(bush, 3)}",
    )
    axes.fill_between(
        ends,
        low,
        high,
        color="0.85",
        lw=0,
        zorder=0,
        label=f"computed values in the literature: {low:g} to {high:g}",
    )
    axes.plot(
        ends,
        persson_area(ends, 1.0, 1.0) / ends,
        "-.",
        color="0.2",
        lw=1,
        label=rf"Persson: $\sqrt{{8/\pi}}$ = {number(attrs['persson_kappa'], 3)} at light load",
    )
    axes.set_xscale("log")


def _draw_surfaces(axes, chosen):
    for n, seed in enumerate(chosen["seed"].values):
        one = chosen.sel(seed=seed)
        style = {"color": colour_of(n), "marker": MARKERS[n % len(MARKERS)], "lw": 0.7}
        axes.plot(one["load"], one["corrected_kappa"], label=f"seed {seed}", **style)
        axes.plot(one["load"], one["kappa"], mfc="none", ls=":", **style)


def _table(slopes):
    """One row a surface and load."""
    columns = ["kappa", "corrected_kappa", "area_share", "corrected_share", "rms_slope"]
    table = slopes[columns].to_dataframe().reset_index()
    table = table.rename(columns={"load": "reduced_pressure"})
    return table[["surface", "seed", "reduced_pressure", *columns]]


def _caption(slopes):
    many, few = (_range_words(slopes.sel(surface=kind)) for kind in _TITLES)
    loads = slopes["load"].values
    return (
        "In no figure of the paper: area slope kappa of A_r/A_0 = kappa p/(E* h'_rms) on "
        f"{slopes.sizes['seed']} made surfaces (by seed) of Delta_g = "
        f"{slopes.attrs['dimension']:g}, raw (hollow) and corrected for the perimeter of the "
        f"discretised contact (filled), p/(E* h'_rms) from {loads[0]:g} to {loads[-1]:g} with "
        f"h'_rms of differences between neighbouring nodes. With a roll-off {many}. Without one a "
        f"few hills carry the load: {few}. {_scatter_words(slopes)}"
    )


def _range_words(chosen):
    """Ranges of raw and corrected kappa, and whether the corrected lies between the theories."""
    low, high = chosen.attrs["persson_kappa"], chosen.attrs["bush_gibson_thomas_kappa"]
    raw, corrected = chosen["kappa"].values, chosen["corrected_kappa"].values
    within = int(np.sum((corrected >= low) & (corrected <= high)))
    verdict = "all" if within == corrected.size else f"{within} of {corrected.size} values"
    return (
        f"the corrected kappa is {number(corrected.min())} to {number(corrected.max())}, {verdict} "
        f"between Persson's {number(low, 3)} and Bush, Gibson and Thomas' {number(high, 3)}, and "
        f"the raw one {number(raw.min())} to {number(raw.max())}"
    )


def _scatter_words(slopes):
    """Standard deviation between seeds, of the corrected values."""
    deviation = slopes["corrected_mean_kappa_deviation"].max("load")
    with_one, without = (float(deviation.sel(surface=kind)) for kind in _TITLES)
    if not np.isfinite([with_one, without]).all():
        return "One seed tells nothing of the scatter between surfaces."
    return (
        "The standard deviation of the corrected kappa between surfaces is at most "
        f"{number(with_one)} with and {number(without)} without a roll-off."
    )
