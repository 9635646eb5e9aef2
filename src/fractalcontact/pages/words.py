"""Numbers in words, as the pages print them."""

import math

from ..core.labels import plain

#: Below and above these a number has an exponent.
_PLAIN = (1e-4, 1e6)
#: Smaller units of lengths: from where on, its name, how many mm it is.
_LENGTHS = ((1.0, "mm", 1.0), (1e-3, "µm", 1e-3), (0.0, "nm", 1e-6))
_STIFFNESS = ((1e3, "GPa/mm", 1e3), (0.0, "MPa/mm", 1.0))
_FORCES = ((1e6, "MN", 1e6), (1e3, "kN", 1e3), (0.0, "N", 1.0))
_PRESSURES = ((1e3, "GPa", 1e3), (0.0, "MPa", 1.0))
_SCALED = {"mm": _LENGTHS, "MPa/mm": _STIFFNESS, "N": _FORCES, "MPa": _PRESSURES}
MISSING = "–"
#: What stands for the other face, by the attribute ``opposite`` of the specimen.
OPPOSITE = {
    "scanned": "both faces scanned",
    "match": "one face given, the other taken as its perfect match",
    "flat": "one face given, against a rigid plane",
    "aperture": "aperture map: the opening between both faces",
}
#: Ends of an interval that differ from even ones by less than this part of it are called even.
_EVEN = 0.02


def short(value: float, digits: int = 3) -> str:
    """Some digits of a number, without zeros at its end; a dash where it is missing."""
    return _number(value, digits, False)


def measured(value: float, digits: int = 3) -> str:
    """Number with a fixed count of digits, 2.20; a dash if it is missing."""
    return _number(value, digits, True)


def _number(value, digits, zeros):
    if not math.isfinite(value):
        return MISSING
    return plain(value + 0.0, digits, limits=_PLAIN, zeros=zeros).replace("-", "−")


def with_unit(value: float, unit: str, digits: int = 3) -> str:
    """A number in the unit that suits it: 12.3 µm for 0.0123 mm."""
    if not math.isfinite(value):
        return MISSING
    rounded = abs(float(f"{value:.{digits}g}"))
    for least, name, size in _SCALED.get(unit, ()):
        if rounded >= least:
            return f"{short(value / size, digits)} {name}"
    number = short(value, digits)
    return number if unit == "1" else f"{number} {unit.replace('mm2', 'mm²')}"


def percent(fraction: float, digits: int = 2) -> str:
    """A fraction in per cent."""
    if not math.isfinite(fraction):
        return MISSING
    return f"{short(100 * fraction, digits)} %"


def interval(value: float, low: float, high: float) -> str:
    """A value and its error: "0.96 ± 0.94", or its ends in brackets where they lie unevenly."""
    if not math.isfinite(high - low):
        return f"{measured(value)}, error not known" if math.isfinite(value) else MISSING
    up, down = high - value, value - low
    if abs(up - down) <= _EVEN * (high - low):
        return f"{measured(value)} ± {measured((up + down) / 2, 2)}"
    return f"{measured(value)} [{measured(low)}, {measured(high)}]"


def plus_minus(error: float, words: str) -> str:
    """An error, said in words, behind its sign; where it is not finite, that it is not known."""
    return f"± {words}" if math.isfinite(error) else "error not known"


def undetermined(value: str) -> str:
    """Undetermined number: the word, with the value and its error in brackets."""
    return f"undetermined ({value})"


def duration(seconds: float) -> str:
    """Seconds as "47 s", "3 min 12 s" or "2 h 5 min"."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
