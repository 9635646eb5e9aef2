"""Quantities as people write them ("20 GPa", "80 um") to the program's own mm, N and MPa.

Units are those of a list: "point", "px" or "yard" may mean another thing to an instrument.
"""

import math
import re
from typing import Any

from roughcontact.arguments import MAX_INPUT, MIN_INPUT

from .errors import InputError

#: The program's unit for each kind of quantity.
PROGRAM_UNITS = {"length": "mm", "force": "N", "pressure": "MPa", "angle": "degree"}

_EXAMPLES = {"length": "20 mm", "force": "10 kN", "pressure": "25 MPa", "angle": "30 deg"}
#: Units by kind, in m, N, Pa and degrees. A megametre, which "Mm" would be, measures no rock.
_UNITS = {
    "length": {
        **{"fm": 1e-15, "pm": 1e-12, "nm": 1e-9, "um": 1e-6, "mm": 1e-3, "cm": 1e-2, "dm": 0.1},
        **{"m": 1.0, "km": 1e3, "Å": 1e-10, "in": 0.0254, "ft": 0.3048},
    },
    "force": {"mN": 1e-3, "N": 1.0, "kN": 1e3, "MN": 1e6, "kgf": 9.80665, "lbf": 4.4482216152605},
    "pressure": {
        **{"Pa": 1.0, "hPa": 100.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "TPa": 1e12},
        **{"mbar": 100.0, "bar": 1e5, "kbar": 1e8, "atm": 101325.0},
        **{"psi": 6894.757293168361, "ksi": 6894757.293168361},
    },
    "angle": {"deg": 1.0, "rad": 180 / math.pi, "mrad": 0.18 / math.pi, "gon": 0.9, "grad": 0.9},
}
#: The program's unit of each kind, in those.
_PROGRAM = {"length": 1e3, "force": 1.0, "pressure": 1e-6, "angle": 1.0}
#: Powers of length, force and angle.
_DIMENSIONS = {"length": (1, 0, 0), "force": (0, 1, 0), "pressure": (-2, 1, 0), "angle": (0, 0, 1)}
_KNOWN = {
    symbol: (kind, of * _PROGRAM[kind])
    for kind, units in _UNITS.items()
    for symbol, of in units.items()
}
#: Other signs for a symbol: Greek mu, and as programs write them that know capitals alone.
_SIGNS = {
    **{"µm": "um", "\u03bcm": "um", "\u212b": "Å", "°": "deg"},
    **{"NM": "nm", "UM": "um", "MM": "mm", "CM": "cm"},
}
#: Names, in any case and number.
_NAMES = {
    **{"metre": "m", "meter": "m", "newton": "N", "pascal": "Pa", "micron": "um"},
    **{"angstrom": "Å", "ångström": "Å", "ångstrom": "Å", "inch": "in", "inche": "in"},
    **{"foot": "ft", "feet": "ft", "degree": "deg", "radian": "rad"},
}
_PREFIXES = {
    **{"femto": "f", "pico": "p", "nano": "n", "micro": "u", "milli": "m", "centi": "c"},
    **{"deci": "d", "hecto": "h", "kilo": "k", "mega": "M", "giga": "G", "": ""},
}
_SPELLED = re.compile(rf"({'|'.join(_PREFIXES)})({'|'.join(_NAMES)})s?")
_WORD = r"(?:[^\W\d_]+|°)(?:(?:\^|\*\*)?-?\d)?"
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*((?:{_WORD}(?:(?:\s*[*/·]\s*|\s+){_WORD})*)?)\s*")
_FACTOR = re.compile(r"([*/·]?)\s*([^\W\d_]+|°)(?:(?:\^|\*\*)?(-?\d))?\s*")
_LONGEST = 60  # characters


def quantity(text: Any, kind: str, where: str) -> float:
    """Read one quantity with its unit.

    Parameters
    ----------
    text : str
        A number and a unit, such as ``"0.1 mm"``.
    kind : {"length", "force", "pressure", "angle"}
        What it must be.
    where : str
        The file and key it stands under, for the error.

    Returns
    -------
    float
        The value in mm, N, MPa or degrees.

    Raises
    ------
    InputError
        If the unit is missing, unknown, or of another kind, or the value too small or too large.
    """
    wanted = f"expected {_article(kind)} {kind} with its unit, such as '{_EXAMPLES[kind]}'"
    try:
        value, dimension = _value(text)
    except InputError as error:
        raise InputError(f"{where}: {error}; {wanted}") from None
    if dimension != _DIMENSIONS[kind]:
        raise InputError(f"{where}: {text!r} is not {_article(kind)} {kind}; {wanted}")
    return _in_range(value, text, kind, where)


def _value(text: Any) -> tuple[float, tuple[int, ...]]:
    """A quantity in the program's units, and its powers of length, force and angle."""
    parts = _QUANTITY.fullmatch(text) if isinstance(text, str) and len(text) <= _LONGEST else None
    if parts is None and isinstance(text, str):
        raise InputError(f"{text[:_LONGEST]!r} is not a number with a unit")
    if parts is None or not parts[2]:
        raise InputError(f"{text!r} has no unit")
    size, dimension = 1.0, [0, 0, 0]
    for operator, name, power in _FACTOR.findall(parts[2]):
        symbol = _symbol(name)
        if symbol is None:
            known = ", ".join(_KNOWN)
            raise InputError(f"{text!r} has the unit {name!r}, which is none of {known}")
        kind, of = _KNOWN[symbol]
        times = int(power or 1) * (-1 if operator == "/" else 1)
        size *= of**times
        dimension = [d + times * p for d, p in zip(dimension, _DIMENSIONS[kind], strict=True)]
    return float(parts[1]) * size, tuple(dimension)


def _in_range(value: float, text: str, kind: str, where: str) -> float:
    """The value, unless it is not finite, too small or too large."""
    if value and not MIN_INPUT <= abs(value) <= MAX_INPUT:
        raise InputError(
            f"{where}: {text!r} is out of range, {MIN_INPUT:g} to {MAX_INPUT:g} "
            f"{PROGRAM_UNITS[kind]}; write {_article(kind)} {kind} such as '{_EXAMPLES[kind]}'"
        )
    return value


def _symbol(name: str) -> str | None:
    """Symbol of a unit, as written or spelled in any case; None if it is unknown."""
    symbol = _SIGNS.get(name, name)
    if symbol not in _KNOWN and (spelled := _SPELLED.fullmatch(name.lower())):
        symbol = _PREFIXES[spelled[1]] + _NAMES[spelled[2]]
    return symbol if symbol in _KNOWN else None


def length_unit(text: str) -> str | None:
    """Symbol of a unit of length; None if it is none.

    Only lengths of the SI and their usual multiples, angstrom, inch and foot.
    """
    symbol = _symbol(text)
    return symbol if symbol in _UNITS["length"] else None


def _article(noun):
    return "an" if noun[0] in "aeiou" else "a"


def load(text: Any, where: str) -> tuple[float, str]:
    """Read a load given as a force or as a nominal pressure.

    Returns
    -------
    value : float
        In N or MPa.
    kind : {"force", "pressure"}

    Raises
    ------
    InputError
        If it is neither.
    """
    try:
        value, dimension = _value(text)
    except InputError:
        dimension = ()
    for kind in ("force", "pressure"):
        if dimension == _DIMENSIONS[kind]:
            return _in_range(value, text, kind, where), kind
    raise InputError(
        f"{where}: {text!r} is neither a force nor a nominal pressure; "
        "write for example '10 kN' or '25 MPa'"
    )


def share(value: Any, where: str) -> float:
    """A share between 0 and 1, as a number or in per cent: 0.01 or "1 %".

    Raises
    ------
    InputError
        If it is neither.
    """
    text = str(value).strip()
    number = text.removesuffix("%").strip()
    if not isinstance(value, bool) and len(text) <= _LONGEST and re.fullmatch(_NUMBER, number):
        found = float(number) / (100 if text.endswith("%") else 1)
        if 0 < found < 1:
            return found
    raise InputError(f"{where}: {text[:_LONGEST]!r} is no share; write for example '1 %' or 0.01")


def length_factor(unit: str, where: str) -> float:
    """Millimetres in one ``unit`` of length: "um", "m", or "0.1 um" where numbers are counts.

    Raises
    ------
    InputError
        If ``unit`` is no unit of length, or a number of them that is not above zero.
    """
    counts = re.match(_NUMBER, unit)
    factor = quantity(unit if counts else f"1 {unit}", "length", where)
    if factor <= 0:
        raise InputError(
            f"{where}: {unit!r} is not above zero; write the unit alone, such as 'um', or the "
            "height of one count, such as '0.1 um' (an upper face that was scanned on its back "
            "has the key 'mirror_upper')"
        )
    return factor
