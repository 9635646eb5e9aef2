"""Attributes of atlas variables, and display of untrusted text."""

import math
import re
from collections.abc import Iterable

#: Members of an ensemble: realisations of an embedded specimen, or twins of a scan.
REALISATIONS, TWINS = "realisations", "twins of the scan"
#: Sources of the error of a number as a property of this surface; others are of its population.
OF_SURFACE = ("solver", "numerical", "secant")


def cf_attrs(units: str, long_name: str) -> dict[str, str]:
    """Attributes of a variable, named as the CF conventions have them."""
    return {"units": units, "long_name": long_name}


def printable(text: object, longest: int | None = None) -> str:
    """Untrusted text on one line: control characters escaped, the middle left out if it is long.

    Parameters
    ----------
    text : str
    longest : int, optional
        Characters.
    """
    text = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in str(text))
    if longest is None or len(text) <= longest:
        return text
    half = (longest - 1) // 2
    return f"{text[:half]}…{text[-half:]}"


def on_one_line(text: object, longest: int = 200) -> str:
    """Untrusted text on one line, cut to whole words with "…"."""
    text = " ".join(printable(text).split())
    if len(text) <= longest:
        return text
    end = text.rfind(" ", longest // 2, longest)
    return f"{text[: end if end > 0 else longest]} …"


def natural_key(name: str) -> list[tuple[int, int, str]]:
    """Sort key of names that orders their numbers by value: 3, 12, 24, 120."""
    parts = re.findall(r"[0-9]+|[^0-9]+", name)
    return [(0, int(part), "") if part[0] in "0123456789" else (1, 0, part) for part in parts]


def listed(names: Iterable[object], most: int = 15) -> str:
    """Names in a sentence; a long list ends with the number of further names."""
    shown = [printable(name, 60) for name in names]
    more = len(shown) - most
    return ", ".join(shown[:most]) + (f" and {more} more" if more > 0 else "")


def percent(fraction: float) -> str:
    """Fraction in per cent with sensible digits: 0.05 %, 3.2 %, 62 %, 99.4 %, 100 %."""
    value = 100 * float(fraction)
    if value == 0 or abs(value) >= 99.995:
        return f"{value:.0f} %"
    if abs(value) < 0.005:
        return "<0.01 %" if value > 0 else f"{value:.0e} %"
    near = min(abs(value), abs(100 - value))
    return f"{value:.{2 if near < 0.95 else 1 if near < 9.5 else 0}f} %"


def plain(
    value: float,
    digits: int = 3,
    *,
    limits: tuple[float, float] = (1e-6, 1e9),
    zeros: bool = False,
    sign: str = "",
) -> str:
    """A number to some digits, without a power of ten where its size is within ``limits``.

    Zeros at its end stay with ``zeros``; "+" as ``sign`` shows that of positive numbers, too.
    """
    rounded = float(f"{float(value):.{digits}g}")
    size = abs(rounded)
    if not limits[0] <= size < limits[1]:
        return f"{rounded:{sign}.{digits - 1}e}" if zeros and size else f"{rounded:{sign}g}"
    decimals = max(digits - 1 - math.floor(math.log10(size)), 0)
    text = f"{rounded:{sign}.{decimals}f}"
    return text.rstrip("0").rstrip(".") if decimals and not zeros else text


def loads_of(some: int, total: int) -> str:
    """Loads at which something is so, in words: "no load", "3 of 7 loads", "every load"."""
    if some in (0, total):
        return "every load" if some else "no load"
    return f"{some} of {total} loads"


#: Lengths from here on, mm, are said in metres.
_METRES = 1e4


def length_words(length: float) -> str:
    """A length in mm in the unit that suits it: three digits, no power of ten."""
    unit, size = height_unit(abs(length))
    return f"{plain(float(length) / size)} {unit}"


def height_unit(height: float) -> tuple[str, float]:
    """Unit that suits a height in mm: its name, and how many mm it is."""
    units = (("mm", 1.0), ("µm", 1e-3), ("nm", 1e-6), ("pm", 1e-9), ("fm", 1e-12))
    if height >= _METRES:
        return "m", 1e3
    return next((unit for unit in units if height >= 0.1 * unit[1] or height == 0), units[2])
