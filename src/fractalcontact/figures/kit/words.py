"""How the figures put numbers, units and places into words."""

import textwrap

import numpy as np

from ...core.fitting import LineFit

PAPER = "Borri-Brunetto et al. (1999)"

TOWARDS = {"E": "East", "N": "North", "W": "West", "S": "South"}

#: Units of force and how many N they are, the largest first.
_FORCE_UNITS = (("GN", 1e9), ("MN", 1e6), ("kN", 1e3), ("N", 1.0), ("mN", 1e-3), ("µN", 1e-6))


def opening(figures: str, label: str, where: str = "") -> str:
    """First words of a caption: "Fig. 2", a specimen's label, the place of its contact."""
    return f"After {figures} of {PAPER}: {', '.join(filter(None, (label, where)))}."


def supplementary(*subject: str) -> str:
    """First words of the caption of a figure that the paper does not have, and its subject."""
    words = ", ".join(filter(None, subject))
    return f"Supplementary figure: {words}." if words else "Supplementary figure."


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
    return f"{float(f'{float(value):.{digits}g}'):{sign}g}"


def percent(share: float, sign: str = "") -> str:
    """A share in per cent: two digits, three of what is nearly all."""
    return f"{short(100 * share, 3 if 0.99 < abs(share) < 1 else 2, sign)} %"


def interval(value: float, low: float, high: float) -> str:
    """A dimension, or a slope, with its 95 % interval: two decimals."""
    return f"{number(value)} [{number(low)}, {number(high)}]"


def estimate(value: float, low: float, high: float, unit: str = "") -> str:
    """A quantity of any size with its 95 % interval: three digits; "no fit" if it is NaN."""
    if not np.isfinite(value):
        return "no fit"
    return f"{value:.3g} [{low:.3g}, {high:.3g}] {unit}".rstrip()


def slope_text(line: LineFit, unit: str = "") -> str:
    """Slope of a :class:`core.fitting.LineFit` with its interval."""
    return estimate(line.slope, line.slope_low, line.slope_high, unit)


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


def wrapped(text: str) -> str:
    """Text broken into lines that fit under one panel of three."""
    return textwrap.fill(text, 34)
