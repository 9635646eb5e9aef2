"""How the figures put numbers, units and places into words."""

import textwrap

import numpy as np
import xarray as xr

from ...core.determined import NO_WIDTH, determined
from ...core.fitting import LineFit
from ...core.labels import plain
from ...domain.box_dimension import WIDEST

PAPER = "Borri-Brunetto et al. (1999)"

#: Names and symbols of the two pressures wherever a figure has them (docs/conventions.md).
NOMINAL_PRESSURE = r"nominal pressure $\sigma_0$"
REAL_PRESSURE = r"real mean pressure $\sigma_n$"

TOWARDS = {"E": "East", "N": "North", "W": "West", "S": "South"}

#: Stands before a number whose interval leaves nearly everything open.
UNDETERMINED = "undetermined"
#: Ends of an interval that differ from even ones by less than this part of it are called even.
_EVEN = 0.02

#: Below and above these a number has an exponent.
_PLAIN = (1e-4, 1e6)

#: Intervals up to this wide are narrow whatever the value: exponents and slopes, and angles.
_SPANS = {"": 1.0, "mm/mm": 1.0, "degrees": 30.0}

#: Units of force and how many N they are, the largest first.
_FORCE_UNITS = (("GN", 1e9), ("MN", 1e6), ("kN", 1e3), ("N", 1.0), ("mN", 1e-3), ("µN", 1e-6))


#: First words of the caption of a figure that the paper does not have.
SUPPLEMENTARY = "Supplementary figure."

#: Symbols of titles, as the captions write them and as formulas.
_FORMULAS = {
    "Delta_sigma": r"$\Delta_\sigma$",
    "Delta_g": r"$\Delta_g$",
    "sigma*": r"$\sigma^*$",
    "sigma_0": r"$\sigma_0$",
    "A_r": "$A_r$",
}


def opening(figures: str) -> str:
    """First words of a caption after "Fig. 2"; specimen and place stand in the figure's title."""
    return f"After {figures} of {PAPER}."


def formulas(text: str) -> str:
    """Text with its symbols as formulas: "Delta_g" as a Greek letter with an index."""
    for symbol, formula in _FORMULAS.items():
        text = text.replace(symbol, formula)
    return text


def place(direction: str, offset: float | None = None) -> str:
    """Where the contact is, at one ``offset`` in mm or at any."""
    if direction == "none":
        return "against a rigid plane"
    if offset is None:
        return f"sliding towards {TOWARDS[direction]}"
    return f"slid {short(offset)} mm towards {TOWARDS[direction]}"


def number(value: float, digits: int = 2) -> str:
    """A number to some decimals, never a negative zero."""
    return f"{round(float(value), digits) + 0.0:.{digits}f}"


def short(value: float, digits: int = 3, sign: str = "") -> str:
    """Some digits of a number, without an exponent up to a million; "+" as ``sign`` shows that."""
    return plain(value, digits, limits=_PLAIN, sign=sign)


def percent(share: float, sign: str = "") -> str:
    """A share in per cent: two digits, three of what is nearly all."""
    return f"{short(100 * share, 3 if 0.99 < abs(share) < 1 else 2, sign)} %"


def area_label(state: xr.Dataset) -> str:
    """A_r/A_0 of one state in per cent: corrected where enough nodes touch, else said to be raw."""
    if bool(state["area_corrected_resolved"]):
        return percent(float(state["area_corrected_share"]))
    return f"{percent(float(state['area_share']))} (raw)"


def interval(value: float, low: float, high: float) -> str:
    """A dimension, or its like, with its 95 % interval: two decimals; or :func:`undetermined`."""
    if not determined(value, low, high, span=1.0, widest=WIDEST, exact=(0.0, 2.0)):
        return undetermined(value, low, high)
    return f"{number(value)} [{number(low)}, {number(high)}]"


def undetermined(value: float, low: float, high: float, unit: str = "") -> str:
    """What the data do not determine: the word, then the value and its error in brackets.

    The error is half of an even 95 % interval; of an uneven one both ends are given.
    """
    if not np.isfinite(value):
        return UNDETERMINED
    up, down, half = high - value, value - low, (high - low) / 2
    if not half > NO_WIDTH * max(abs(value), 1e-300) or not np.isfinite(half):
        words = f"{short(value)}, error not known"
    else:
        # Two digits of the error, and two decimals where it is of the order of one.
        digits = max(1 - int(np.floor(np.log10(half))), 2 if half < 10 else 0)
        shown, least, most, error = (number(x, digits) for x in (value, low, high, half))
        even = abs(up - down) <= _EVEN * (high - low)
        words = f"{shown} ± {error}" if even else f"{shown} [{least}, {most}]"
    return f"{UNDETERMINED} ({words}{f' {unit}' if unit else ''})"


def estimate(value: float, low: float, high: float, unit: str = "") -> str:
    """A quantity of any size with its 95 % interval: three digits.

    "no fit" if it is NaN, :func:`undetermined` where the interval leaves nearly everything open.
    """
    if not np.isfinite(value):
        return "no fit"
    if not determined(value, low, high, span=_SPANS.get(unit, 0.0)):
        return undetermined(value, low, high, unit)
    return f"{value:.3g} [{low:.3g}, {high:.3g}] {unit}".rstrip()


def slope_text(line: LineFit, unit: str = "") -> str:
    """Slope of a :class:`core.fitting.LineFit` with its interval."""
    return estimate(*line.slope.ends, unit)


def length_unit(span: float) -> tuple[str, float]:
    """Unit that suits lengths up to ``span`` mm: its name, and how many mm it is."""
    if span >= 2000:
        return "m", 1000.0
    return ("mm", 1.0) if span >= 0.1 else ("µm", 1e-3)


def force_unit(largest: float) -> tuple[str, float]:
    """Unit that suits forces up to ``largest`` N: its name, and how many N it is."""
    rounded = float(f"{largest:.3g}")
    return next((unit for unit in _FORCE_UNITS if rounded >= unit[1]), _FORCE_UNITS[-1])


def force_label(force: float) -> str:
    """A force in N in the unit that suits it: three digits, no exponent."""
    name, size = force_unit(force)
    return f"{short(force / size)} {name}"


def pressure_label(pressure: float) -> str:
    """A pressure in MPa, or in GPa from one on: three digits."""
    giga = float(f"{pressure:.3g}") >= 1000
    return f"{short(pressure / 1000)} GPa" if giga else f"{short(pressure)} MPa"


def wrapped(text: str) -> str:
    """Text broken into lines that fit under one panel of three."""
    return textwrap.fill(text, 34)
