"""Keys of laboratory tests, a class for each kind of test."""

import re
from typing import Annotated, Any, Literal, TypeVar

from pydantic import AfterValidator, Field, PlainValidator, WithJsonSchema

from ..core.errors import InputError
from ..core.keys import Direction, PositiveLength, Pressure, Section, key, wrong
from ..core.units import length_factor

_MAX_GAUGE = 100  # characters
_STRETCH = re.compile(r"\s*(?P<number>[-+.\deE]+)\s*(?P<unit>\S+)\s*/\s*MPa\s*")
_GAUGE = (
    "what the displacement contains: joint, or the rock between the gauge points such as 4 um/MPa "
    "or {length: 100 mm, modulus: 60 GPa}"
)


class GaugeKeys(Section):
    """The rock between the gauge points."""

    length: Annotated[PositiveLength, key(f"a length; {_GAUGE}")]
    modulus: Annotated[Pressure, key(f"a pressure; {_GAUGE}")]


def _stretch(text: Any) -> float:
    """Displacement of the rock between the gauge points, mm per MPa."""
    if not isinstance(text, str):
        raise wrong()
    if text == "joint":
        return 0.0
    parts = _STRETCH.fullmatch(text[:_MAX_GAUGE])
    if parts is None:
        raise wrong(_GAUGE)
    found = float(parts["number"]) * length_factor(parts["unit"], repr(text))
    if found < 0:
        raise InputError("rock does not stretch under pressure; write it above 0")
    return found


def _compliance(gauge: Any) -> float:
    return gauge.length / gauge.modulus if isinstance(gauge, GaugeKeys) else gauge


# Sidecars are untrusted input: nothing outside the folder of the scans is read.
_File = Annotated[
    str,
    Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]{0,219}$"),
    key(
        "the plain name of a file beside the scan, such as closure_test.csv",
        doc=(
            "plain name of a text table beside the scan; of an embedded specimen, in the "
            "study's folder of scans, or where `make` is run if it has none"
        ),
    ),
]
_Columns = Annotated[
    dict[str, Annotated[str, Field(max_length=100)]],
    key(
        "headings of the file by column, such as {pressure: 'sn [MPa]'}",
        doc='headings of the file with their units by column, `{pressure: "sn [kPa]"}`',
        unsaid="the column's own name",
    ),
]
_Stretch = Annotated[float, PlainValidator(_stretch), WithJsonSchema({"type": "string"})]
_Gauge = Annotated[
    _Stretch | GaugeKeys,
    AfterValidator(_compliance),
    key(
        _GAUGE,
        doc=(
            "what the displacement contains: `joint`, or the rock between the gauge points,"
            " `4 um/MPa` or its `length` and `modulus`, `{length: 100 mm, modulus: 60 GPa}`"
        ),
    ),
]
_Seat = Annotated[
    Pressure,
    key(
        "the pressure that the displacement counts from, such as 0.25 MPa",
        doc="pressure that the displacement counts from",
    ),
]
_Branch = Annotated[
    Literal["load", "unload", "reload"],
    key("load, unload or reload", doc="`load`, `unload` or `reload`"),
]
_Cycle = Annotated[
    int,
    Field(ge=1, le=1000),
    key(
        "a whole number from 1: 1 for the first loading and unloading",
        doc="its number; `load` is of cycle 1 alone, `reload` of any later one",
    ),
]
_Largest = Annotated[
    Pressure,
    key(
        "a pressure with its unit, such as 25 MPa",
        doc="that the joint has carried before; unsaid, the largest reading",
    ),
]
_Way = Annotated[
    Literal["along", "across"], key("along or across", doc="`along` or `across` the sliding")
]
_Held = Annotated[
    Pressure,
    key(
        "the normal pressure that is held, such as 5 MPa",
        doc="nominal pressure that is held",
    ),
]
_Direction = Annotated[
    Direction, key("the direction of sliding, E, N, W or S", doc="of sliding: `E`, `N`, `W` or `S`")
]
_LengthError = Annotated[
    PositiveLength,
    key(
        "a length with its unit, such as 2 um",
        doc="half-width at 95 % of a reading; unsaid, from the scatter",
    ),
]
_PressureError = Annotated[
    Pressure,
    key(
        "a pressure with its unit, such as 0.1 MPa",
        doc="half-width at 95 % of a reading; unsaid, from the scatter",
    ),
]
_Calibrate = Annotated[
    Literal["modulus", "hardness"],
    key(
        "modulus or hardness",
        doc="`hardness` or `modulus`: fit that constant to this test, one of all",
    ),
]
_NAN = float("nan")


class ClosureTest(Section):
    """A closure test."""

    file: _File
    columns: _Columns = {}
    gauge: _Gauge
    seat: _Seat
    branch: _Branch
    cycle: _Cycle
    largest_pressure: _Largest = _NAN
    error: _LengthError = _NAN
    calibrate: _Calibrate = ""  # type: ignore[assignment]


class FlowTest(Section):
    """A flow test."""

    file: _File
    columns: _Columns = {}
    branch: _Branch
    cycle: _Cycle
    largest_pressure: _Largest = _NAN
    way: _Way


class DilatancyTest(Section):
    """A record of dilation over sliding."""

    file: _File
    columns: _Columns = {}
    pressure: _Held
    direction: _Direction
    error: _LengthError = _NAN


class ShearTest(Section):
    """A record of shear stress over sliding."""

    file: _File
    columns: _Columns = {}
    pressure: _Held
    direction: _Direction
    error: _PressureError = _NAN


class StrengthTest(Section):
    """Peak strengths over pressure."""

    file: _File
    columns: _Columns = {}
    direction: _Direction
    error: _PressureError = _NAN


#: Class of each kind of test.
KINDS = {
    "closure": ClosureTest,
    "flow": FlowTest,
    "dilatancy": DilatancyTest,
    "shear": ShearTest,
    "strength": StrengthTest,
}
T = TypeVar("T")
_TESTS = "a test as a mapping with its file, or a list of such mappings"
_as_list = AfterValidator(lambda tests: tests if isinstance(tests, list) else [tests])
_Many = Annotated[T | Annotated[list[T], Field(min_length=1, max_length=20)], _as_list, key(_TESTS)]


class Tests(Section):
    """Laboratory tests of a specimen, by kind."""

    closure: _Many[ClosureTest] = []
    flow: _Many[FlowTest] = []
    dilatancy: _Many[DilatancyTest] = []
    shear: _Many[ShearTest] = []
    strength: _Many[StrengthTest] = []
