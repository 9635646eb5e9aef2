"""Area slope kappa of synthetic surfaces at light load, beside the theories."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of, group
from fractalcontact.figures.kit.kappa import kappa_lines
from fractalcontact.figures.kit.legends import entries, heading, legends_below
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.titles import letter

TITLE = "Real contact area of synthetic surfaces at light load, with and without a roll-off"
SUBJECT = "study"
NEEDS = ("area_slope",)
KEY = "area_slope"
ORDER = 20

_TITLES = {
    "with_roll_off": "with a roll-off at {share} of the side",
    "without_roll_off": "without a roll-off",
}
#: Estimates of kappa and their words.
_KAPPAS = {"corrected_kappa": "corrected for the perimeter", "kappa": "raw: every node counted"}
#: Theories between which kappa is expected, the lower first.
_THEORIES = ("persson", "bush_gibson_thomas")


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """kappa of every synthetic surface against load, with and without a roll-off."""
    slopes = group(atlas, "area_slope", "surfaces")
    figure = Figure(figsize=(WIDTH, 4.2))
    panels = figure.subplots(1, len(slopes["surface"]), sharey=True)
    for which, axes, kind in zip("ab", panels, slopes["surface"].values, strict=True):
        chosen = slopes.sel(surface=kind)
        _draw_surfaces(axes, chosen)
        kappa_lines(axes, slopes)
        share = f"1/{1 / slopes.attrs['roll_off_share']:.3g}"
        letter(axes, which, _TITLES[kind].format(share=share))
        axes.set_xlabel(r"reduced pressure $p/(E^* h′_\mathrm{rms})$ (1)")
    panels[0].set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h′_\mathrm{rms}/p$ (1)")
    shown, count = entries(panels[0]), len(_KAPPAS)
    of_lines = heading(f"a line for each of {slopes.sizes['seed']} surfaces; no intervals")
    legends_below(figure, [of_lines, *shown[:count]], shown[count:])
    nodes, dimension = slopes.attrs["nodes"], slopes.attrs["dimension"]
    figure.suptitle(
        rf"synthetic surfaces of {nodes} $\times$ {nodes} nodes, $\Delta_g$ = {dimension:g}",
        fontsize=9,
    )
    table = rows(slopes, *_KAPPAS, "area_share", "corrected_share", "rms_slope")
    return Drawing(figure, table, caption(__name__, kinds=list(_TITLES), **_counts(slopes)))


def _draw_surfaces(axes, chosen):
    """Draw two lines for each surface: kappa of corrected areas filled, of raw areas open."""
    styles = (
        {"color": colour_of(1), "marker": MARKERS[0]},
        {"color": colour_of(2), "marker": MARKERS[1], "mfc": "white", "ls": "--"},
    )
    for seed in chosen["seed"].values:
        surface = chosen.sel(seed=seed)
        first = seed == chosen["seed"].values[0]
        for (name, words), style in zip(_KAPPAS.items(), styles, strict=True):
            label = words if first else None
            axes.plot(
                surface["reduced_pressure"], surface[name], label=label, lw=0.7, ms=3, **style
            )
    axes.margins(y=0.12)


def _counts(slopes):
    """Ranges of the corrected kappa, and counts between theories and in the literature."""
    corrected_kappas = {"ranges": {}, "between": {}}
    for kind in _TITLES:
        chosen = slopes.sel(surface=kind)
        low, high = (chosen.attrs[f"{name}_kappa"] for name in _THEORIES)
        corrected = chosen["corrected_kappa"].values
        corrected_kappas["ranges"][kind] = float(corrected.min()), float(corrected.max())
        within, n = int(np.sum((corrected >= low) & (corrected <= high))), corrected.size
        corrected_kappas["between"][kind] = "all" if within == n else f"{within} of {n}"
    corrected, (low, high) = slopes["corrected_kappa"].values, slopes.attrs["computed_kappa"]
    below, above = int((corrected < low).sum()), int((corrected > high).sum())
    counts = {"below": below, "above": above, "within": corrected.size - below - above}
    return corrected_kappas | counts | {"computed": (low, high)}
