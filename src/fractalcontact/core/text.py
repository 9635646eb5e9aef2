"""Numbers, intervals, units, percentages and ranges as text for pages, cards, captions and tables.

Pages and cards have the typographic minus sign; captions, tables, messages and verdicts, which are
searched and parsed, the hyphen.
"""

import math
from collections.abc import Iterable
from typing import Any

MISSING = "–"
#: Minus sign of pages and cards.
_MINUS = "−"
#: Range of the numbers without an exponent.
_PLAIN = (1e-4, 1e6)
#: Largest difference of the two halves of an even interval, as a fraction of it.
_EVEN = 0.02
#: Least width of an interval, as a fraction of its value; a narrower one has left out its errors.
_NO_WIDTH = 1e-6
#: Units of length: smallest length, name, mm in one unit.
_LENGTHS = ((1.0, "mm", 1.0), (1e-3, "µm", 1e-3), (0.0, "nm", 1e-6))
_STIFFNESS = ((1e3, "GPa/mm", 1e3), (0.0, "MPa/mm", 1.0))
_FORCES = ((1e6, "MN", 1e6), (1e3, "kN", 1e3), (0.0, "N", 1.0))
_PRESSURES = ((1e3, "GPa", 1e3), (0.0, "MPa", 1.0))
_SCALED = {"mm": _LENGTHS, "MPa/mm": _STIFFNESS, "N": _FORCES, "MPa": _PRESSURES}
#: Units of force of figures and N in one unit, the largest first.
_FORCE_UNITS = (("GN", 1e9), ("MN", 1e6), ("kN", 1e3), ("N", 1.0), ("mN", 1e-3), ("µN", 1e-6))
#: Least length, mm, that is stated in metres.
_METRES = 1e4


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


def compact(value: Any, digits: int = 3, sign: str = "") -> str:
    """Some digits of a number for captions and tables, without an exponent up to a million.

    An :class:`core.estimate.Estimate` has its interval behind it, as "0.96 [0.91, 1.02]".
    """
    if hasattr(value, "ends"):
        return _with_ends(compact(end, digits, sign) for end in value.ends)
    return plain(value, digits, limits=_PLAIN, sign=sign)


def number(value: Any, decimals: int = 2, sign: str = "") -> str:
    """A number, or an estimate with its interval, to some decimals, never a negative zero.

    An end of an interval that is NaN is "not known".
    """
    if hasattr(value, "ends"):
        middle, *ends = (number(end, decimals, sign) for end in value.ends)
        return _with_ends([middle, *("not known" if end.endswith("nan") else end for end in ends)])
    return f"{round(float(value), decimals) + 0.0:{sign}.{decimals}f}"


def _with_ends(words: Iterable[str]) -> str:
    return "{} [{}, {}]".format(*words)


def rounded(value: float, digits: int) -> float:
    """Number rounded to some significant digits."""
    return float(f"{float(value):.{digits}g}")


def exact(value: float, digits: int = 6) -> str:
    """A number for a program to read, with an exponent where that is shorter."""
    return f"{value:.{digits}g}"


def short(value: float, digits: int = 3) -> str:
    """Some digits of a number for pages, without zeros at its end; a dash where it is missing."""
    return _typeset(value, digits, zeros=False)


def measured(value: float, digits: int = 3) -> str:
    """Number for pages with a fixed count of digits, 2.20; a dash if it is missing."""
    return _typeset(value, digits, zeros=True)


def _typeset(value: float, digits: int, zeros: bool) -> str:
    if not math.isfinite(value):
        return MISSING
    return plain(value + 0.0, digits, limits=_PLAIN, zeros=zeros).replace("-", _MINUS)


def percent(fraction: float, digits: int = 2, *, sign: str = "") -> str:
    """A fraction in per cent: two digits, three near 100 %: 0.051 %, 3.2 %, 62 %, 99.4 %, 100 %."""
    if not math.isfinite(fraction):
        return MISSING
    if 0.99 < abs(fraction) < 1:
        digits = max(digits, 3)
    if 0 < abs(fraction) < 1e-6:
        return f"{_MINUS if fraction < 0 else ''}<0.0001 %"
    return f"{compact(100 * fraction + 0.0, digits, sign)} %".replace("-", _MINUS)


# -- units -----------------------------------------------------------------------------------------


def with_unit(value: float, unit: str, digits: int = 3) -> str:
    """A number in the unit that suits it: 12.3 µm for 0.0123 mm."""
    if not math.isfinite(value):
        return MISSING
    rounded = abs(float(f"{value:.{digits}g}"))
    for least, name, size in _SCALED.get(unit, ()):
        if rounded >= least:
            return f"{short(value / size, digits)} {name}"
    shown = short(value, digits)
    return shown if unit == "1" else f"{shown} {unit.replace('mm2', 'mm²')}"


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


def length_unit(span: float) -> tuple[str, float]:
    """Unit that suits an axis of lengths up to ``span`` mm: its name, and how many mm it is."""
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
    return f"{compact(force / size)} {name}"


def pressure_label(pressure: float) -> str:
    """A pressure in MPa, or in GPa from one on: three digits."""
    giga = float(f"{pressure:.3g}") >= 1000
    return f"{compact(pressure / 1000)} GPa" if giga else f"{compact(pressure)} MPa"


# -- intervals -------------------------------------------------------------------------------------


def interval(value: float, low: float, high: float) -> str:
    """A value and its error: "0.96 ± 0.94", or its ends in brackets where they lie unevenly."""
    if not math.isfinite(high - low):
        return f"{measured(value)}, error not known" if math.isfinite(value) else MISSING
    up, down = high - value, value - low
    if abs(up - down) <= _EVEN * (high - low):
        return f"{measured(value)} ± {measured((up + down) / 2, 2)}"
    return f"{measured(value)} [{measured(low)}, {measured(high)}]"


def plus_minus(error: float, words: str) -> str:
    """Error in words, behind its sign; "not known" where it is not finite."""
    return f"± {words}" if math.isfinite(error) else "error not known"


def undetermined(value: str) -> str:
    """Undetermined number: the word, with the value and its error in brackets."""
    return f"undetermined ({value})"


def with_error(
    value: float, low: float, high: float, decimals: int | None = None, unit: str = ""
) -> str:
    """Value and error to two digits of it, "0.96 ± 0.94", or both ends of an uneven interval."""
    half = (high - low) / 2
    if not half > _NO_WIDTH * max(abs(value), 1e-300) or not math.isfinite(half):
        # A slope of 0 is 1e-16 by rounding.
        shown = plain(value, limits=_PLAIN) if decimals is None else number(value, decimals)
        words = f"{shown}, error not known"
    else:
        # The error has two digits, and two decimals if it is of the order of one.
        digits = max(1 - math.floor(math.log10(half)), 2 if half < 10 else 0)
        shown, least, most, error = (number(x, digits) for x in (value, low, high, half))
        even = abs(high - value - (value - low)) <= _EVEN * (high - low)
        words = f"{shown} ± {error}" if even else f"{shown} [{least}, {most}]"
    return f"{words}{f' {unit}' if unit else ''}"


# -- counts and times ------------------------------------------------------------------------------


def loads_of(some: int, total: int) -> str:
    """Number of loads that meet a condition, in words: "no load", "3 of 7 loads", "every load"."""
    if some in (0, total):
        return "every load" if some else "no load"
    return f"{some} of {total} loads"


def duration(seconds: float) -> str:
    """Seconds as "47 s", "3 min 12 s" or "2 h 5 min"."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
