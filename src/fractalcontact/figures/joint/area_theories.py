"""Real contact area and its slope kappa beside the classical theories of the same surface."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.subject import Subject
from ..kit.axes import label_short_span
from ..kit.caption import caption
from ..kit.drawing import COLOURS, WIDTH, Drawing
from ..kit.legends import entries, legends_below
from ..kit.panel import rows
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ..kit.words import NOMINAL_PRESSURE, place
from ._area_slopes import draw_kappa, kappa_entries, mean_kappa

TITLE = "Real contact area compared with the classical theories of section 2"
SUBJECT = "specimen"
NEEDS = ("closure", "area", "statements")
ORDER = 60

#: Theories of panel (a): variable, name, colour, line; the full line first, lest it hide others.
THEORIES = (
    ("greenwood_williamson_share", "Greenwood and Williamson", COLOURS[3], "-"),
    ("bush_gibson_thomas_share", "Bush, Gibson and Thomas", COLOURS[1], "--"),
    ("persson_share", "Persson", COLOURS[2], "-."),
    ("majumdar_bhushan_share", "Majumdar and Bhushan", COLOURS[4], (0, (5, 1, 1, 1, 1, 1))),
)
#: Where the fan of Archard's slopes lies, in parts of the axes: left and right end, lower end.
_FAN = 0.52, 0.9, 0.05
_GREY = "0.45"
#: Columns of the table, which has those of the theories besides.
_COLUMNS = (
    "reduced_pressure",
    "area_share",
    "area_corrected_share",
    "kappa",
    "corrected_kappa",
    "fitted",
    "corrected_fitted",
    "corrected_light",
)


def draw(atlas: DataTree, name: str) -> Drawing:
    """Area against pressure with every theory, and kappa against reduced pressure."""
    subject = Subject.of(atlas, name)
    laws = subject.curves("area")
    law, states = (data.sel(offset=laws["area_offset"]) for data in (laws, subject.curves()))
    areas = ("area_share", "area_corrected_share", "area_corrected_resolved")
    law = law.assign({key: states[key] for key in areas})

    figure = Figure(figsize=(WIDTH, 4.6))
    left, right = figure.subplots(1, 2)
    _draw_area(left, law)
    draw_kappa(right, laws, law)
    letter(left, "a", "real contact area")
    letter(right, "b", r"area slope $\kappa$")
    legends_below(figure, entries(left), [*kappa_entries(law), *entries(right)])
    slides = subject.direction != "none"
    headline(
        figure, subject.label, place(subject.direction, float(law["offset"]) if slides else None)
    )
    return Drawing(
        figure,
        rows(law, *_COLUMNS, *(name for name, *_ in THEORIES)),
        caption(__name__, **_words(atlas, name, laws, law)),
    )


def _draw_area(axes, law):
    pressure = law["nominal_pressure"].values
    points = {"ls": "none", "marker": "o", "color": COLOURS[0], "zorder": 3}
    enough = law["area_corrected_resolved"].values
    corrected = 100 * law["area_corrected_share"].values
    words = "computed, corrected for the perimeter"
    axes.plot(pressure[enough], corrected[enough], label=words, **points)
    axes.plot(pressure, 100 * law["area_share"], mfc="none", label="computed, raw", **points)
    if not str(law["no_corrected_law"].values):
        exponent = Estimate.read(law, "corrected_exponent", scale=EXPONENT).text()
        axes.plot([], [], " ", label=f"corrected: $A_r \\sim F^m$, $m$ = {exponent}")
    for variable, words, colour, line in THEORIES:
        share = law[variable].values
        drawn = share <= 1  # nothing but Persson's saturates, and beyond A_0 there is no area
        if not drawn.any():
            words = f"{words}: not defined here"
        axes.plot(pressure[drawn], 100 * share[drawn], color=colour, ls=line, lw=1, label=words)
    axes.set(xscale="log", yscale="log")
    _draw_slopes(axes, law["archard_exponent"].values, law["archard_level"].values)
    for axis in (axes.xaxis, axes.yaxis):
        label_short_span(axis)
    axes.set_xlabel(f"{NOMINAL_PRESSURE} (MPa)")
    axes.set_ylabel("real contact area $A_r/A_0$ (%)")


def _draw_slopes(axes, exponents, levels):
    """Archard's exponents as slopes, from one point below the curves."""
    limits = axes.get_xlim(), axes.get_ylim()
    (x_low, x_high), (y_low, y_high) = np.log10(limits)
    left, right, bottom = _FAN
    start, end = (x_low + part * (x_high - x_low) for part in (left, right))
    base = y_low + bottom * (y_high - y_low)
    style = {"color": _GREY, "lw": 1, "label": "Archard, levels 1, 2, 3: slopes 2/3, 8/9, 26/27"}
    for exponent, level, va, shift in zip(
        exponents, levels, ("top", "center", "bottom"), (-2, -2, 2), strict=True
    ):
        ends = [base, base + exponent * (end - start)]
        axes.plot(10 ** np.array([start, end]), 10 ** np.array(ends), ":", **style)
        at, near = (10**end, 10 ** ends[1]), {"xytext": (3, shift), "textcoords": "offset points"}
        axes.annotate(f"{level}", at, va=va, fontsize=6, color=_GREY, **near)
        style["label"] = None
    axes.set(xlim=limits[0], ylim=limits[1])


def _words(atlas, name, laws, law):
    """Values of the caption: law of the area, kappa, the paper's claim."""
    reason, no_kappa = (str(law[f"no_corrected_{of}"].values) for of in ("law", "mean_kappa"))
    many = "at all offsets" if laws.sizes["offset"] > 1 else ""
    return {
        "reason": reason,
        "no_kappa": no_kappa,
        "exponent": Estimate.read(law, "corrected_exponent", scale=EXPONENT),
        "levels": law["archard_level"].values[law["archard_fits"].values].tolist(),
        "kappa": "" if no_kappa else mean_kappa(law, "corrected_"),
        "beside": str(law["kappa_beside_theories"].values),
        "theories": law.attrs,
        "linear": claim(atlas, name, "area_is_linear", why=many),
    }
