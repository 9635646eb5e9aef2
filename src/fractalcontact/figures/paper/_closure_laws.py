"""Closure curves with their laws, panels (a) and (b) of the closure figure."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from ...core.estimate import EXPONENT, Estimate
from ...core.subject import Subject
from ...core.text import compact, percent
from .. import kit

#: Style, words and variable of the line of each law, the same for all curves and panels.
LINES: dict[str, tuple[Any, str, str]] = {
    "semi_logarithmic": ("-", "logarithmic law", "semi_logarithmic_misfit"),
    "hyperbola": ((0, (4, 2)), "hyperbola", "hyperbola_misfit"),
    "beyond": (":", "(b): hyperbola below the loads fitted, slope $k_{ni}$", "hyperbola_k_ni"),
    "area": ("-.", "power law", "corrected_exponent"),
}
#: Marker of states with too few nodes: open, and smaller than the others.
OPEN = {"mfc": "none", "ms": 3, "mew": 0.6}


def each_curve(drawn: xr.Dataset) -> Iterator[tuple[xr.Dataset, dict[str, Any]]]:
    """Every curve that is drawn, with its colour and marker."""
    for n in range(drawn.sizes["offset"]):
        yield drawn.isel(offset=n), {"color": kit.colour_of(n), "marker": kit.MARKERS[n]}


def is_known(data: xr.Dataset, name: str) -> bool:
    """True if any value of a variable is finite."""
    return bool(np.isfinite(data[name]).any())


def draw_closure(axes: Axes, drawn: xr.Dataset, subject: Subject) -> None:
    """Closure curves with both laws over the loads that they were fitted to."""
    size = kit.force_axis(axes.yaxis, drawn["normal_force"])
    for curve, style in each_curve(drawn):
        label = f"{offset_words(subject, float(curve['offset']))}: {_law_words(curve)}"
        points = curve["interface_closure"], curve["normal_force"] / size, curve["resolved"]
        kit.draw_points(axes, *points, OPEN, label=label, **style)
        _draw_laws(
            axes, curve, ("hyperbola", "semi_logarithmic"), subject.area, subject.area / size
        )
    if is_known(drawn, "interface_closure"):
        # All closures of flush faces are 0.
        limit = float(drawn["interface_closure"].max())
        axes.set_xlim(0, 1.05 * limit if limit > 0 else None)
        if 0 < limit < 1e-3:  # long numbers would stand one over the other
            axes.ticklabel_format(axis="x", scilimits=(0, 0))
    else:
        kit.say_empty(axes, kit.TOO_FULL)
    axes.set_ylim(0, 1.05 * float(drawn["normal_force"][-1]) / size)
    axes.set_xlabel(r"closure $w_\mathrm{int}$ from first touch (mm)")
    kit.second_axis(axes, size / subject.area, f"{kit.NOMINAL_PRESSURE} (MPa)")


def draw_light_loads(axes: Axes, drawn: xr.Dataset, subject: Subject) -> None:
    """The closure curves on logarithmic axes with their hyperbolas, down to k_ni at light load."""
    pressure = drawn["nominal_pressure"].values
    for curve, style in each_curve(drawn):
        kit.draw_points(
            axes, curve["interface_closure"], pressure, curve["resolved"], OPEN, **style
        )
        _draw_laws(axes, curve, ("hyperbola", "beyond"), subject.area)
    axes.set(xscale="log", yscale="log")
    drawable = drawn["interface_closure"].where(drawn["interface_closure"] > 0)
    if np.isfinite(drawable).any():
        axes.set_xlim(float(drawable.min()) / 1.5, float(drawable.max()) * 1.5)
        axes.set_ylim(pressure[0] / 1.5, pressure[-1] * 1.5)
    else:
        kit.say_empty(axes, kit.TOO_FULL)
    axes.set_xlabel(r"closure $w_\mathrm{int}$ from first touch (mm)")
    axes.set_ylabel(f"{kit.NOMINAL_PRESSURE} (MPa)")


def _draw_laws(axes, curve, lines, area, unit=1.0):
    """Fitted laws of the curve drawn last, over the loads fitted; pressures times ``unit``.

    Below these loads the hyperbola is an extrapolation with the slope k_ni.
    """
    first, last = (float(curve[f"closure_fit_{end}"]) / area for end in ("min", "max"))
    lightest, colour = float(curve["nominal_pressure"][0]), axes.lines[-1].get_color()
    for line in lines:
        style, _, needed = LINES[line]
        if is_known(curve, needed):
            ends = (lightest / 2, first) if line == "beyond" else (first, last)
            pressure = np.geomspace(*ends, 100)
            closure = _closure_by(line, curve, pressure)
            axes.plot(closure, unit * pressure, ls=style, lw=0.8, color=colour)


def _closure_by(law, curve, pressure):
    """Closure w_int in mm by the hyperbola, or by w = a + b ln(sigma_0 / 1 MPa)."""
    if law != "semi_logarithmic":
        return hyperbola(pressure, *(curve[f"hyperbola_{name}"] for name in ("k_ni", "w_m")))
    a, b = (float(curve[f"semi_logarithmic_{name}"]) for name in "ab")
    return a + b * np.log(pressure)


def hyperbola(pressure: np.ndarray, k_ni: xr.DataArray, largest: xr.DataArray) -> np.ndarray:
    """Closure w, mm, by sigma_0 = k_ni w / (1 - w / w_m), of k_ni in MPa/mm and w_m in mm."""
    k, w_m = float(k_ni), float(largest)
    return pressure * w_m / (k * w_m + pressure)


def _law_words(curve):
    """Legend text with the misfits of both laws and k_ni with its interval."""
    misfits = [float(curve[f"{law}_misfit"]) for law in ("semi_logarithmic", "hyperbola")]
    if not np.isfinite(misfits).any():
        return f"no fit: {no_law(curve)}"
    words = (percent(misfit) if np.isfinite(misfit) else "no fit" for misfit in misfits)
    k_ni = Estimate.read(curve, "hyperbola_k_ni", scale=EXPONENT)
    determined = bool(curve["hyperbola_k_ni_determined"]) or not k_ni.known
    return f"{', '.join(words)}; {k_ni.text() if determined else k_ni.undetermined()}"


def no_law(curve: xr.Dataset) -> str:
    """Reason why no law could be fitted to a curve, without the remedy."""
    return str(curve["closure_law_reason"].values).split(":")[0]


def offset_words(subject: Subject, offset: float) -> str:
    """State of a curve in a legend."""
    return "without sliding" if subject.direction == "none" else f"$v$ = {compact(offset)} mm"
