"""Quantities as people write them ("20 GPa", "80 um") to the program's own mm, N and MPa."""

import contextlib
import math
import re
from functools import cache, lru_cache
from typing import Any

from roughcontact.limits import MAX_INPUT, MIN_INPUT

from .errors import InputError

#: The program's unit for each kind of quantity.
PROGRAM_UNITS = {"length": "mm", "force": "N", "pressure": "MPa", "angle": "degree"}

_EXAMPLES = {"length": "20 mm", "force": "10 kN", "pressure": "25 MPa", "angle": "30 deg"}
#: Dimension of an angle in pint, which has no name for it.
_DIMENSIONS = {"angle": "[]"}
#: Patterns of a number and a unit. The library would evaluate any sum, 9**9**9 mm without end.
_WORD = r"[^\W\d_]+(?:(?:\^|\*\*)?-?\d)?"
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_UNITS = rf"{_WORD}(?:(?:\s*[*/·]\s*|\s+){_WORD})*"
_QUANTITY = re.compile(rf"\s*{_NUMBER}\s*(?:°|{_UNITS})?\s*")
_LONGEST = 60  # characters
#: Units of length of instruments, by symbol as written and by name in any case and number. They
#: are listed because the library of units also has points, picas, pixels and light years.
_LENGTH_SYMBOLS = {
    **{
        symbol: symbol
        for symbol in ("fm", "pm", "nm", "um", "mm", "cm", "dm", "m", "km", "in", "ft")
    },
    **{"µm": "um", "\u03bcm": "um", "Å": "angstrom", "\u212b": "angstrom"},
    # Programs that know capitals alone write MM; a megametre measures no rock.
    **{"NM": "nm", "UM": "um", "MM": "mm", "CM": "cm"},
}
_METRE = re.compile(
    r"(femto|pico|nano|micro|milli|centi|deci|kilo|)(?:metre|meter)s?", re.IGNORECASE
)
_LENGTH_NAMES = {
    **{"micron": "micrometer", "microns": "micrometer", "angstrom": "angstrom"},
    **{"angstroms": "angstrom", "ångström": "angstrom", "ångstrom": "angstrom"},
    **{"inch": "inch", "inches": "inch", "foot": "foot", "feet": "foot"},
}
#: Common units: kind, and factor to the program's unit. Factors equal those of the library of units
#: to the last bit. With them alone a study is read without that library, whose import and tables
#: take a fourth of the time in which Snakemake starts.
_COMMON = {
    **{unit: ("length", by) for unit, by in (("um", 1e-3), ("mm", 1.0), ("cm", 10.0), ("m", 1e3))},
    **{unit: ("force", by) for unit, by in (("N", 1.0), ("kN", 1e3), ("MN", 1e6))},
    **{
        unit: ("pressure", by)
        for unit, by in (("Pa", 1e-6), ("kPa", 1e-3), ("MPa", 1.0), ("GPa", 1e3))
    },
    **dict.fromkeys(("deg", "degree", "degrees"), ("angle", 1.0)),
}
_COMMON_QUANTITY = re.compile(
    rf"\s*((?:0|[1-9]\d*)(?:\.\d*)?(?:[eE][-+]?\d+)?)\s*({'|'.join(_COMMON)})\s*", re.ASCII
)
_KNOWN_LENGTHS = "nm, um, mm, cm, m, inch or foot"


class _OutOfRange(InputError):
    """Error of a quantity of the right kind whose value is out of range."""


@cache
def _registry() -> Any:
    import pint  # imports numpy, which reading the settings of a stage does not need

    return pint.UnitRegistry(cache_folder=None)


def quantity(text: Any, kind: str, where: str) -> float:
    """Value of one quantity with its unit, in mm, N, MPa or degrees.

    Parameters
    ----------
    text : str
        A number and a unit, such as ``"0.1 mm"``.
    kind : {"length", "force", "pressure", "angle"}
    where : str
        The file and key it stands under, for the error.

    Raises
    ------
    InputError
        If the unit is missing, unknown, or of another kind, or the value too small or too large.
    """
    if not isinstance(text, str):
        raise InputError(f"{where}: {text!r} has no unit; {_wanted(kind)}")
    try:
        return magnitude(text, kind)
    except InputError as error:
        raise type(error)(f"{where}: {error}") from None


@lru_cache(maxsize=4096)
def magnitude(text: str, kind: str) -> float:
    """Value of a quantity, with errors that name no place.

    Values are cached: a campaign states the same few hundreds of times over.
    """
    unit, wanted = PROGRAM_UNITS[kind], _wanted(kind)
    if len(text) > _LONGEST or not _QUANTITY.fullmatch(text):
        raise InputError(f"{text[:_LONGEST]!r} is not a number with a unit; {wanted}")
    if kind == "length":
        text = _with_known_length(text, wanted)
    common = _COMMON_QUANTITY.fullmatch(text)
    if common and _COMMON[common[2]][0] == kind:
        magnitude = float(common[1]) * _COMMON[common[2]][1]
    elif common:
        raise InputError(f"{text!r} is not {_article(kind)} {kind}; {wanted}")
    else:
        magnitude = _by_library(text, kind, wanted)
    if not math.isfinite(magnitude):
        raise _OutOfRange(f"{text!r} is not finite; {wanted}")
    if magnitude and not MIN_INPUT <= abs(magnitude) <= MAX_INPUT:
        raise _OutOfRange(
            f"{text!r} is out of range, {MIN_INPUT:g} to {MAX_INPUT:g} {unit}; {wanted}"
        )
    return magnitude


def _by_library(text: str, kind: str, wanted: str) -> float:
    """Value by the library of units, in the program's unit; InputError if it is of another kind."""
    try:
        value = _registry()(text)
    except Exception as error:  # pint raises many unrelated types for malformed text
        raise InputError(f"cannot read {text!r} ({error}); {wanted}") from None
    if not isinstance(value, _registry().Quantity) or value.unitless:
        raise InputError(f"{text!r} has no unit; {wanted}")
    if not value.check(_DIMENSIONS.get(kind, f"[{kind}]")):
        raise InputError(f"{text!r} is not {_article(kind)} {kind}; {wanted}")
    return float(value.to(PROGRAM_UNITS[kind]).magnitude)


def _wanted(kind: str) -> str:
    return f"expected {_article(kind)} {kind} with its unit, such as '{_EXAMPLES[kind]}'"


def length_unit(text: str) -> str | None:
    """Name of a unit of length for the library of units; None if unknown.

    Only lengths of the SI and their usual multiples, angstrom, inch and foot: names of other units
    may mean another thing, as "point" and "px" do.
    """
    if text in _LENGTH_SYMBOLS:
        return _LENGTH_SYMBOLS[text]
    if match := _METRE.fullmatch(text):
        return f"{match[1].lower()}meter"
    return _LENGTH_NAMES.get(text.lower())


def _with_known_length(text: str, wanted: str) -> str:
    """Quantity whose unit, if it is one word and a length, has the name of the library of units.

    InputError if only the library of units takes its unit for a length.
    """
    match = re.fullmatch(rf"\s*({_NUMBER})\s*({_WORD})\s*", text)
    if not match:
        return text
    if name := length_unit(match[2]):
        return f"{match[1]} {name}"
    is_length = False
    with contextlib.suppress(Exception):  # other faults of the text are refused further on
        is_length = _registry()(f"1 {match[2]}").check("[length]")
    if is_length:
        raise InputError(
            f"{text!r} is in {match[2]!r}, no unit of length known here; {wanted} "
            f"({_KNOWN_LENGTHS})"
        )
    return text


def _article(noun):
    return "an" if noun[0] in "aeiou" else "a"


def load(text: Any, where: str) -> tuple[float, str]:
    """Value and kind, "force" (N) or "pressure" (MPa), of a load; InputError if it is neither."""
    try:
        return load_of(text)
    except InputError as error:
        raise type(error)(f"{where}: {error}") from None


def load_of(text: Any) -> tuple[float, str]:
    """A force or a nominal pressure and its kind, with errors that name no place."""
    for kind in ("force", "pressure") if isinstance(text, str) else ():
        try:
            return magnitude(text, kind), kind
        except _OutOfRange:
            raise
        except InputError:
            continue
    raise InputError(
        f"{text!r} is neither a force nor a nominal pressure; write for example '10 kN' or '25 MPa'"
    )


def share_of(value: Any) -> float:
    """Share between 0 and 1, a number or in per cent: 0.01 or "1 %"; InputError if neither."""
    text = str(value).strip()
    number = text.removesuffix("%").strip()
    if not isinstance(value, bool) and len(text) <= _LONGEST and re.fullmatch(_NUMBER, number):
        share = float(number) / (100 if text.endswith("%") else 1)
        if 0 < share < 1:
            return share
    raise InputError(f"{text[:_LONGEST]!r} is no share; write for example '1 %' or 0.01")


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
