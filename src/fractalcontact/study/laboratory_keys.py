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
    compliance = float(parts["number"]) * length_factor(parts["unit"], repr(text))
    if compliance < 0:
        raise InputError("rock does not stretch under pressure; write it above 0")
    return compliance


def _compliance(gauge: Any) -> float:
    return gauge.length / gauge.modulus if isinstance(gauge, GaugeKeys) else gauge


_Stretch = Annotated[float, PlainValidator(_stretch), WithJsonSchema({"type": "string"})]
_NAN = float("nan")


class _Test(Section):
    # Sidecars are untrusted input: no file outside the folder of the scans is read.
    file: Annotated[
        str,
        key(
            "the plain name of a file beside the scan, such as closure_test.csv",
            pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]{0,219}$",
        ),
    ]
    """plain name of a text table beside the scan; of an embedded specimen, in the study's folder
    of scans, or where `make` is run if it has none"""
    columns: Annotated[
        dict[str, Annotated[str, Field(max_length=100)]],
        key(
            "headings of the file by column, such as {pressure: 'sn [MPa]'}",
            unsaid="the column's own name",
        ),
    ] = {}
    """headings of the file with their units by column, `{pressure: "sn [kPa]"}`"""


class _Gauged(_Test):
    gauge: Annotated[_Stretch | GaugeKeys, AfterValidator(_compliance), key(_GAUGE)]
    """what the displacement contains: `joint`, or the rock between the gauge points, `4 um/MPa` or
    its `length` and `modulus`, `{length: 100 mm, modulus: 60 GPa}`"""
    seat: Annotated[
        Pressure, key("the pressure that the displacement counts from, such as 0.25 MPa")
    ]
    """pressure that the displacement counts from"""


class _Cyclic(_Test):
    branch: Annotated[Literal["load", "unload", "reload"], key("load, unload or reload")]
    """`load`, `unload` or `reload`"""
    cycle: Annotated[
        int, key("a whole number from 1: 1 for the first loading and unloading", ge=1, le=1000)
    ]
    """its number; `load` is of cycle 1 alone, `reload` of any later one"""
    largest_pressure: Pressure = _NAN
    """that the joint has carried before; unsaid, the largest reading"""


class _Sliding(_Test):
    direction: Annotated[Direction, key("the direction of sliding, E, N, W or S")]
    """of sliding: `E`, `N`, `W` or `S`"""


class _Held(_Test):
    pressure: Annotated[Pressure, key("the normal pressure that is held, such as 5 MPa")]
    """nominal pressure that is held"""


_PressureError = Annotated[Pressure, key("a pressure with its unit, such as 0.1 MPa")]
_LengthError = Annotated[PositiveLength, key("a length with its unit, such as 2 um")]


class ClosureTest(_Cyclic, _Gauged):
    """A closure test."""

    error: _LengthError = _NAN
    """half-width at 95 % of a reading; unsaid, from the scatter"""
    calibrate: Annotated[Literal["modulus", "hardness"], key("modulus or hardness")] = ""  # type: ignore[assignment]
    """`hardness` or `modulus`: fit that constant to this test, one of all"""


class FlowTest(_Cyclic):
    """A flow test."""

    way: Annotated[Literal["along", "across"], key("along or across")]
    """`along` or `across` the sliding"""
    datum_pressure: Annotated[
        Pressure,
        key("the pressure of the reading that sets the distance of the faces, such as 5 MPa"),
    ] = _NAN
    """pressure of one reading that sets the distance of the faces, which scans leave uncertain; T
    at other pressures is then predicted. In one flow test of all"""


class DilatancyTest(_Sliding, _Held):
    """A record of dilation over sliding."""

    error: _LengthError = _NAN
    """half-width at 95 % of a reading; unsaid, from the scatter"""


class ShearTest(_Sliding, _Held):
    """A record of shear stress over sliding."""

    error: _PressureError = _NAN
    """half-width at 95 % of a reading; unsaid, from the scatter"""


class StrengthTest(_Sliding):
    """Peak strengths over pressure."""

    error: _PressureError = _NAN
    """half-width at 95 % of a reading; unsaid, from the scatter"""


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
