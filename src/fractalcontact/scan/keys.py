"""Keys of a sidecar that determine how a scan file is read."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from ..core.keys import Label, Load, Natural, PositiveLength, Section, key, schema_of, wrong

#: Most lines of words in front of the numbers of a text.
MAX_HEADER_LINES = 10_000
#: Kinds under the names that they had before.
OLD_KINDS = {"surface": "face", "contact_map": "contact-map"}

_Text = Annotated[str, Field(min_length=1)]
_TwoSteps = Annotated[list[float | str], Field(min_length=2, max_length=2)]
_Mark = Annotated[str, Field(max_length=40)]
_Marks = Annotated[list[float | _Mark], Field(min_length=1, max_length=20)]
_Point = Annotated[list[float | str], key("a place [x, y] in mm", min_length=2, max_length=2)]


class ConfirmedKeys(Section):
    """Shape and relief that the owner of a file looked at."""

    shape: Annotated[
        list[Natural], key("two whole numbers [rows, columns]", min_length=2, max_length=2)
    ] = []
    points: Natural = 1
    relief: Annotated[float, key("a number from 0", ge=0)] = 0.0


class FaceKeys(Section):
    """Keys that may differ between the two faces of a joint."""

    delimiter: Annotated[
        Literal["comma", "semicolon", "tab", "blank"],
        key(
            "comma, semicolon, tab or blank (white space of any length): what parts the "
            "numbers of a text",
            fill="comma, semicolon, tab or blank",
        ),
    ] = "comma"
    decimal: Annotated[
        Literal[".", ","], key("the decimal mark of a text, '.' or ','", fill="'.' or ','")
    ] = "."
    thousands: Annotated[
        Literal[".", ",", "'"],
        key(
            "the mark between groups of three digits, where a text has one: '.', ',' or an "
            "apostrophe",
            fill="the mark between groups of three digits",
        ),
    ] = "'"
    header: Annotated[
        int,
        key(
            "number of lines above the numbers of a text",
            fill="lines above the first number",
            ge=0,
            le=MAX_HEADER_LINES,
        ),
    ] = 0
    layout: Annotated[
        Literal["matrix", "points"],
        key("matrix or points", fill="matrix (rows of heights) or points (x, y, z in columns)"),
    ] = "matrix"
    variable: Annotated[
        str,
        key("the array, channel, layer or page of the heights", fill="the array of the heights"),
    ] = ""
    columns: Annotated[
        list[str | Annotated[int, Field(ge=0)]],
        key(
            "the columns of x, y, z, as names or counted from 0",
            fill="those of x, y and z, counted from 0",
            only="heights",
            min_length=3,
            max_length=3,
        ),
    ] = []
    axes: Annotated[
        Literal["none", "both", "row", "column"],
        key(
            "none, both, row or column: which of the first row and column of a matrix hold "
            "coordinates or counts instead of heights; of both, without spacing, they are "
            "the coordinates",
            fill="none, both, row or column: where coordinates stand instead of heights",
        ),
    ] = "none"
    unit: Annotated[
        str,
        key(
            "the unit of x, y and z, such as mm",
            fill="of x, y and z: m, mm, um, ...; or unit_xy and unit_z",
        ),
    ] = ""
    unit_xy: Annotated[
        str, key("the unit of x and y, such as mm", fill="of x and y: m, mm, um, ...")
    ] = ""
    unit_z: Annotated[
        str,
        key(
            "the unit of the heights, such as um, or what one count is, 0.01 um",
            fill="of the heights: m, mm, um, or of one count, 0.01 um",
            only="heights",
        ),
    ] = ""
    spacing: Annotated[
        Annotated[float, Field(gt=0)] | _Text | _TwoSteps,
        key(
            "the spacing of neighbouring cells: a number in the file's unit, a length such "
            "as 0.1 mm, or a pair [dx, dy]",
            fill="between neighbouring cells, 0.1 mm, or [dx, dy]",
        ),
    ] = ""
    first_row: Annotated[
        Literal["bottom", "top"],
        key(
            "bottom or top: whether the first row lies at the smallest y or the largest",
            fill="bottom or top: where the first row lies",
        ),
    ] = "bottom"
    heights: Annotated[
        Literal["up", "down"],
        key(
            "up or down: whether larger numbers are higher, or deeper",
            fill="up or down: which way the numbers grow",
            only="heights",
        ),
    ] = "up"
    missing: Annotated[
        float | _Mark | _Marks,
        key(
            'the number or word that marks missing cells ("" for empty ones), a list of them, '
            "or none",
            fill="the number or word of cells without a height, or none",
        ),
    ] = "none"
    confirmed: Annotated[
        ConfirmedKeys,
        key(
            "what was read when the owner looked at it, {shape: [rows, columns], relief: "
            "number} or {points: number, relief: number}"
        ),
    ] = ConfirmedKeys()


class DiscKeys(Section):
    """A disc."""

    centre: _Point = []
    diameter: Annotated[float | str, key("a length, in mm where it is a number")] = 0.0


class OutlineKeys(Section):
    """An outline; one of its keys."""

    disc: Annotated[DiscKeys, key("a mapping with centre and diameter")] = DiscKeys()
    polygon: Annotated[
        list[_Point], key("three or more places [x, y]", min_length=3, max_length=1000)
    ] = []
    mask: Annotated[float, key("the number of the cells outside")] = 0.0

    @model_validator(mode="after")
    def _is_one(self) -> "OutlineKeys":
        if len(self.model_fields_set) != 1:
            raise wrong()
        return self


_Thresholds = Annotated[list[float], Field(min_length=1, max_length=20)]
_FileName = Annotated[str, Field(max_length=255)]


class ScanKeys(FaceKeys):
    """Keys that determine how a scan file is read."""

    kind: Annotated[
        Literal["face", "contact-map", "aperture", "profile", "surface", "contact_map"],
        key(
            "face, contact-map, aperture (the opening between two faces) or profile (which "
            "has a card alone, by profile_card)",
            fill="face, aperture or contact-map",
        ),
    ] = "face"
    lower: Annotated[
        FaceKeys, key("keys that hold for this face of two alone, {header: 0}", only="pair")
    ] = FaceKeys()
    upper: Annotated[
        FaceKeys, key("keys that hold for this face of two alone, {header: 0}", only="pair")
    ] = FaceKeys()
    threshold: Annotated[
        float | _Thresholds,
        key(
            "the number above which a cell of a contact map is in contact, or a list of "
            "such numbers",
            only="contact map",
        ),
    ] = 0.0
    outline: Annotated[
        Literal["disc", "rectangle"] | OutlineKeys,
        key(
            "disc, rectangle, or one of {disc: {centre: [x, y], diameter: d}}, {polygon: "
            "[[x, y], ...]}, {mask: number}",
            only="map",
        ),
    ] = "disc"
    series: Annotated[Label, key(only="contact map")] = ""
    x: Annotated[
        _FileName,
        key("the plain name of the file of x beside that of a contact map", only="contact map"),
    ] = ""
    y: Annotated[
        _FileName,
        key("the plain name of the file of y beside that of a contact map", only="contact map"),
    ] = ""
    cells: Annotated[
        Literal["any contact", "contact at the centre"],
        key("any contact or contact at the centre", only="contact map"),
    ] = "any contact"
    load: Annotated[
        Load,
        key("the force or the nominal pressure on the map, such as 85 MPa", only="contact map"),
    ] = (
        0.0,
        "",
    )
    grid: Annotated[
        PositiveLength,
        key("the spacing to grid points at, 0.3 mm; unsaid, their own", only="heights"),
    ] = 0.0
    registration: Annotated[
        Literal["rigid", "translation", "none"], key("rigid, translation or none", only="pair")
    ] = "rigid"
    mirror_upper: Annotated[
        Literal["x", "y"],
        key("x or y, the direction that runs the other way in the upper face", only="pair"),
    ] = "x"


def words_to_fill() -> dict[str, str]:
    """Words for the keys that a draft asks its owner to fill in, in the order of a draft."""
    keys = schema_of(ScanKeys)["properties"]
    order = ("kind", *FaceKeys.model_fields)
    return {name: keys[name]["x-fill"] for name in order if "x-fill" in keys[name]}
