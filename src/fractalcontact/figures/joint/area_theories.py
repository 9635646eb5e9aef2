"""Real contact area against pressure beside the theories of the paper's section 2."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.limits import LIGHT_LOAD
from ...core.subject import Subject
from ...core.text import compact
from .. import kit

TITLE = "Real contact area compared with the classical theories of section 2"
SUBJECT = "specimen"
NEEDS = ("closure", "area", "statements")
ORDER = 60

#: Theories of panel (a): variable, name, colour, line. The full line comes first and hides none.
THEORIES = (
    ("greenwood_williamson_share", "Greenwood and Williamson", kit.COLOURS[3], "-"),
    ("bush_gibson_thomas_share", "Bush, Gibson and Thomas", kit.COLOURS[1], "--"),
    ("persson_share", "Persson", kit.COLOURS[2], "-."),
    ("majumdar_bhushan_share", "Majumdar and Bhushan", kit.COLOURS[4], (0, (5, 1, 1, 1, 1, 1))),
)
#: Colour of a theory's kappa: that of its area.
_OF_KAPPA = {"bush": kit.COLOURS[1], "persson": kit.COLOURS[2]}
#: Corrected and raw kappa: prefix of the name, words, face, place of the mean at the edge.
_KAPPAS = (("corrected_", "corrected", kit.COLOURS[0], 0.05), ("", "raw", "white", 0.02))
_COLUMNS = (
    *("reduced_pressure", "area_share", "area_corrected_share", "kappa", "corrected_kappa"),
    *("fitted", "corrected_fitted", "corrected_light", *(name for name, *_ in THEORIES)),
)


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Area against pressure with every theory, and kappa against reduced pressure."""
    subject = Subject.of(atlas, name)
    laws = subject.curves("area")
    law, states = (data.sel(offset=laws["area_offset"]) for data in (laws, subject.curves()))
    areas = ("area_share", "area_corrected_share", "area_corrected_resolved")
    law = law.assign({key: states[key] for key in areas})
    figure = Figure(figsize=(kit.WIDTH, 4.6))
    left, right = figure.subplots(1, 2)
    _draw_area(left, law)
    _draw_kappa(right, laws, law)
    kit.letter(left, "a", "real contact area")
    kit.letter(right, "b", r"area slope $\kappa$")
    kit.legends_below(figure, kit.entries(left), kit.entries(right))
    offset = float(law["offset"]) if subject.direction != "none" else None
    kit.headline(figure, subject.label, kit.place(subject.direction, offset))
    words = kit.caption(__name__, **_words(atlas, name, laws, law))
    return kit.Drawing(figure, kit.rows(law, *_COLUMNS), words)


def _draw_area(axes: Axes, law: xr.Dataset) -> None:
    pressure = law["nominal_pressure"].values
    points: dict[str, Any] = {"ls": "none", "marker": "o", "color": kit.COLOURS[0], "zorder": 3}
    corrected = 100 * law["area_corrected_share"].where(law["area_corrected_resolved"])
    axes.plot(pressure, corrected, label="computed, corrected for the perimeter", **points)
    axes.plot(pressure, 100 * law["area_share"], mfc="none", label="computed, raw", **points)
    for variable, words, colour, line in THEORIES:
        share = law[variable].values
        drawn = share <= 1  # nothing but Persson's saturates, and beyond A_0 there is no area
        if not drawn.any():
            words = f"{words}: not defined here"
        axes.plot(pressure[drawn], 100 * share[drawn], color=colour, ls=line, lw=1, label=words)
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel(f"{kit.NOMINAL_PRESSURE} (MPa)")
    axes.set_ylabel("real contact area $A_r/A_0$ (%)")


def _draw_kappa(axes: Axes, laws: xr.Dataset, law: xr.Dataset) -> None:
    """Loads of enough nodes: raw and corrected here, corrected at the other offsets."""
    others = laws.sel(offset=laws["offset"] != law["offset"])
    fitted_kappa = others["corrected_kappa"].where(others["corrected_fitted"])
    lines = axes.plot(
        others["reduced_pressure"].transpose(..., "offset"),
        fitted_kappa.transpose(..., "offset"),
        color="0.75",
        lw=0.6,
        zorder=1,
    )
    for line in lines[:1]:
        line.set_label("corrected, other offsets")
    for prefix, words, face, at in _KAPPAS:
        fitted = law[f"{prefix}fitted"].values
        style: dict[str, Any] = {"color": kit.COLOURS[0], "mfc": face, "marker": "o", "ls": "none"}
        kappa = law[f"{prefix}kappa"].values[fitted]
        axes.plot(law["reduced_pressure"].values[fitted], kappa, zorder=3, **style)
        if not str(law[f"no_{prefix}mean_kappa"].values):
            mean = Estimate.read(law, f"{prefix}mean_kappa")
            style |= {"marker": "s", "capsize": 2, "elinewidth": 0.8}
            style["label"] = f"mean at light load, {words}: {_mean_kappa(law, prefix)}"
            edge = axes.get_yaxis_transform()
            axes.errorbar([at], [mean.value], yerr=kit.reach(*mean.ends), transform=edge, **style)
    if laws["fitted"].any():
        kit.kappa_lines(axes, laws, _OF_KAPPA)
    if laws["line_pressure"].max() > LIGHT_LOAD:
        axes.axvline(LIGHT_LOAD, color="0.45", lw=0.6, label="end of light load")
    if not law["fitted"].any():
        why = str(law["no_mean_kappa"].values)
        kit.say_empty(axes, why or "no load with enough nodes in contact")
    axes.set_ylim(bottom=0)
    axes.set_xlabel(r"reduced pressure $\sigma_0/(E^* h′_\mathrm{rms})$ (1)")
    axes.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h′_\mathrm{rms}/\sigma_0$ (1)")


def _mean_kappa(law: xr.Dataset, prefix: str) -> str:
    """Mean kappa at light load with its interval, if it has one."""
    mean = Estimate.read(law, f"{prefix}mean_kappa", scale=EXPONENT)
    return mean.text() if np.isfinite(mean.low) else f"{compact(mean.value)} (one load)"


def _words(atlas: DataTree, name: str, laws: xr.Dataset, law: xr.Dataset) -> dict[str, Any]:
    """Values of the caption: law of the area, kappa, the paper's claim."""
    reason, no_kappa = (str(law[f"no_corrected_{of}"].values) for of in ("law", "mean_kappa"))
    many = "at all offsets" if laws.sizes["offset"] > 1 else ""
    return {
        "reason": reason,
        "no_kappa": no_kappa,
        "exponent": Estimate.read(law, "corrected_exponent", scale=EXPONENT),
        "levels": law["archard_level"].values[law["archard_fits"].values].tolist(),
        "kappa": "" if no_kappa else _mean_kappa(law, "corrected_"),
        "beside": str(law["kappa_beside_theories"].values),
        "theories": law.attrs,
        "linear": kit.claim(atlas, name, "area_is_linear", why=many),
    }
