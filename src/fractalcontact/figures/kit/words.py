"""Numbers, units and places in the words of the figures."""

import textwrap

import xarray as xr

from ...core.labels import plain

PAPER = "Borri-Brunetto et al. (1999)"

#: Names and symbols of the two pressures wherever a figure has them (docs/conventions.md).
NOMINAL_PRESSURE = r"nominal pressure $\sigma_0$"
REAL_PRESSURE = r"real mean pressure $\sigma_n$"

TOWARDS = {"E": "East", "N": "North", "W": "West", "S": "South"}

#: Below and above these a number has an exponent.
_PLAIN = (1e-4, 1e6)

#: Units of force and how many N they are, the largest first.
_FORCE_UNITS = (("GN", 1e9), ("MN", 1e6), ("kN", 1e3), ("N", 1.0), ("mN", 1e-3), ("µN", 1e-6))


#: Symbols of titles, as the captions write them and as formulas.
_FORMULAS = {
    "Delta_sigma": r"$\Delta_\sigma$",
    "Delta_g": r"$\Delta_g$",
    "sigma*": r"$\sigma^*$",
    "sigma_0": r"$\sigma_0$",
    "A_r": "$A_r$",
    "A_0": "$A_0$",
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
    """Place of the contact in words, at one ``offset`` in mm or at any."""
    if direction == "none":
        return "without sliding"
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
    """Fraction in per cent: two digits, three near 100 %."""
    return f"{short(100 * share, 3 if 0.99 < abs(share) < 1 else 2, sign)} %"


def area_label(state: xr.Dataset) -> str:
    """A_r/A_0 of one state in per cent: corrected where enough nodes touch, else said to be raw."""
    if bool(state["area_corrected_resolved"]):
        return percent(float(state["area_corrected_share"]))
    return f"{percent(float(state['area_share']))} (raw)"


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
