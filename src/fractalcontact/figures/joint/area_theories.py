"""Real contact area and its slope kappa beside the classical theories of the same surface."""

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import LIGHT_LOAD
from ...core.subject import Subject
from ..kit.axes import label_short_span
from ..kit.caption import caption
from ..kit.drawing import COLOURS, WIDTH, Drawing
from ..kit.empty import say_empty
from ..kit.kappa import kappa_lines
from ..kit.legends import entries, heading, legends_below, mark
from ..kit.panel import rows
from ..kit.points import reach
from ..kit.titles import headline, letter
from ..kit.verdicts import claim
from ..kit.words import NOMINAL_PRESSURE, place, short

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
#: Colour of a theory's kappa: that of its area.
_OF_KAPPA = {"bush": COLOURS[1], "persson": COLOURS[2]}
#: Where the fan of Archard's slopes lies, in parts of the axes: left and right end, lower end.
_FAN = 0.52, 0.9, 0.05
_GREY = "0.45"
#: Of the means of kappa, corrected and raw: prefix of the name, words, face, place at the edge.
_MEANS = (("corrected_", "corrected", COLOURS[0], 0.05), ("", "raw", "white", 0.02))
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
    _draw_kappa(right, laws, law)
    letter(left, "a", "real contact area")
    letter(right, "b", r"area slope $\kappa$")
    legends_below(figure, entries(left), [*_kappa_words(law), *entries(right)])
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


def _draw_kappa(axes, laws, law):
    """Loads of enough nodes: raw and corrected here, corrected at the other offsets."""
    others = laws.sel(offset=laws["offset"] != law["offset"])
    for i in range(others.sizes["offset"]):
        label = "corrected, other offsets" if i == 0 else None
        points = _touching(others.isel(offset=i), "corrected_")
        axes.plot(*points, color="0.75", lw=0.6, zorder=1, label=label)
    style = {"color": COLOURS[0], "marker": "o", "lw": 0.7, "zorder": 3}
    axes.plot(*_touching(law, "corrected_"), **style)
    axes.plot(*_touching(law, ""), mfc="none", **style | {"lw": 0})
    for prefix, _, face, at in _MEANS:
        if not str(law[f"no_{prefix}mean_kappa"].values):
            mean = Estimate.read(law, f"{prefix}mean_kappa")
            bar = {"fmt": "s", "color": COLOURS[0], "mfc": face, "capsize": 2, "elinewidth": 0.8}
            edge = axes.get_yaxis_transform()
            axes.errorbar([at], [mean.value], yerr=reach(*mean.ends), transform=edge, **bar)
    if laws["fitted"].any():
        kappa_lines(axes, laws, _OF_KAPPA)
        label_short_span(axes.xaxis)
    if laws["line_pressure"].max() > LIGHT_LOAD:
        axes.axvline(LIGHT_LOAD, color=_GREY, lw=0.6, label="end of light load")
    if not law["fitted"].any():
        why = str(law["no_mean_kappa"].values)
        say_empty(axes, why or "no load with enough nodes in contact")
    axes.set_ylim(bottom=0)
    axes.set_xlabel(r"reduced pressure $\sigma_0/(E^* h'_\mathrm{rms})$ (1)")
    axes.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h'_\mathrm{rms}/\sigma_0$ (1)")


def _touching(law, prefix):
    """Reduced pressure and one kappa at the loads whose contact has enough nodes."""
    fitted = law[f"{prefix}fitted"].values
    return law["reduced_pressure"].values[fitted], law[f"{prefix}kappa"].values[fitted]


def _kappa_words(law):
    """Entries of the legend that state the mean kappas."""
    words = [
        mark(ls="none", marker="s", color=COLOURS[0], mfc=face, label=label)
        for prefix, words, face, _ in _MEANS
        if (label := f"mean at light load, {words}: {_mean(law, prefix)}")
        and not str(law[f"no_{prefix}mean_kappa"].values)
    ]
    return words or [heading("no mean at light load")]


def _mean(law, prefix):
    """Mean kappa at light load with its interval, if it has one."""
    mean = Estimate.read(law, f"{prefix}mean_kappa", scale=EXPONENT)
    return mean.text() if np.isfinite(mean.low) else f"{short(mean.value)} (one load)"


def _words(atlas, name, laws, law):
    """Values of the caption: law of the area, kappa, the paper's claim."""
    reason, no_kappa = (str(law[f"no_corrected_{of}"].values) for of in ("law", "mean_kappa"))
    many = "over all offsets" if laws.sizes["offset"] > 1 else ""
    return {
        "reason": reason,
        "no_kappa": no_kappa,
        "exponent": Estimate.read(law, "corrected_exponent", scale=EXPONENT),
        "levels": law["archard_level"].values[law["archard_fits"].values].tolist(),
        "kappa": "" if no_kappa else _mean(law, "corrected_"),
        "beside": str(law["kappa_beside_theories"].values),
        "theories": law.attrs,
        "linear": claim(
            atlas, name, "area_is_linear", why="at other offsets" if many and reason else many
        ),
    }
