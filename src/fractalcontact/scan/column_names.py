"""Names of the columns of a table: which are x, y and z, in what units, and which are none."""

import re
from dataclasses import dataclass

from ..core.units import length_unit

#: Words for each axis, after their unit, in lower case and without blanks.
_POSITIONS = ("{0}", "{0}pos", "{0}position", "pos{0}", "position{0}", "{0}coord", "{0}coordinate",
              "{0}axis", "coord{0}", "points{0}", "point{0}", "{0}value")  # fmt: skip
_WORDS = {
    "x": {*(form.format("x") for form in _POSITIONS), "east", "easting", "points0"},
    "y": {*(form.format("y") for form in _POSITIONS), "north", "northing", "points1"},
    "z": {
        *(form.format("z") for form in _POSITIONS),
        *("height", "heights", "zheight", "surfaceheight", "heightvalue", "höhe", "hoehe"),
        *("elevation", "altitude", "topography", "points2"),
    },
    "column": {
        *("col", "column", "columnindex", "colindex", "columnnumber", "i", "ix", "xindex"),
        *("xpixel", "pixelx", "xpx"),
    },
    "row": {
        *("row", "rowindex", "rownumber", "line", "j", "iy", "yindex", "ypixel", "pixely", "ypx"),
    },
}
#: What records of tests and of time call their columns: no surface, whatever stands beside it.
_RECORD = {
    *("time", "t", "load", "force", "displacement", "disp", "stress", "strain", "temperature"),
    *("frequency", "voltage", "current", "pressure", "date", "cycle", "extension", "stroke"),
    *("distance", "profile", "length", "speed", "velocity", "id", "sample", "specimen"),
    *("aperture", "count", "weight", "mass", "angle", "mean", "std", "slip", "friction"),
}
_BRACKETS = re.compile(r"^(.*?)\s*[\[(]\s*([^\])]*)\s*[\])]\s*$")
_PIXELS = {"px", "pixel", "pixels", "pix", "idx", "index"}


@dataclass(frozen=True)
class Column:
    """A column by its name: the word for it in lower case, and the unit that stands with it."""

    word: str
    unit: str | None


@dataclass(frozen=True)
class NamedAxes:
    """Columns that hold x, y and z.

    Attributes
    ----------
    columns : (int, int, int)
        Of x, y, z.
    units : tuple of (str or None)
        Theirs, as the file writes them.
    counted : bool
        Whether x and y count cells: columns and rows, or pixels.
    """

    columns: tuple[int, int, int]
    units: tuple[str | None, str | None, str | None]
    counted: bool


def parse_name(name: str) -> Column:
    """Take apart "X [mm]", "Height (um)", "z_um", "x / mm" or "y mm"."""
    text, unit = name.strip().strip("\"'").strip(), None
    if match := _BRACKETS.match(text):
        text, unit = match[1], match[2]
    else:
        *parts, last = re.split(r"\s*[/_ ]\s*", text)
        if parts and (length_unit(last) or last.lower() in _PIXELS):
            text, unit = " ".join(parts), last
    word = re.sub(r"[^\w]|_", "", text.lower())
    return Column(word, unit.strip().removeprefix("in ") or None if unit is not None else None)


def named_axes(names: list[str] | None) -> NamedAxes | None:
    """The columns that are x, y and z by their names, None where the names do not say.

    Parameters
    ----------
    names : list of str or None
    """
    columns = [parse_name(name) for name in names or ()]
    for across, upward in (("x", "y"), ("column", "row")):
        found = []
        for axis in (across, upward, "z"):
            alike = [n for n, column in enumerate(columns) if column.word in _WORDS[axis]]
            exact = [n for n in alike if columns[n].word == axis]
            found.append((exact or alike)[:1] if len(exact) == 1 or len(alike) == 1 else [])
        if all(found):
            x, y, z = (group[0] for group in found)
            units = columns[x].unit, columns[y].unit, columns[z].unit
            in_pixels = any((unit or "").lower() in _PIXELS for unit in units[:2])
            return NamedAxes((x, y, z), units, across == "column" or in_pixels)
    return None


def has_record_names(names: list[str] | None) -> bool:
    """Whether a column is called what a record of a test calls it: time, load, displacement."""
    return any(parse_name(name).word in _RECORD for name in names or ())


def numbers_columns(names: list[str]) -> bool:
    """Whether names only distinguish columns: X1, X2, ..., A, B, C, ..., or all the same word.

    Such are the columns of a matrix; names of different stems are different quantities.
    """
    words = [parse_name(name).word for name in names]
    stems = {re.sub(r"\d+", "", word) for word in words[1:]}
    if len(stems) <= 1:
        return True
    letters = [name.strip().strip("\"'") for name in names]
    return any(letters[1:] == _spreadsheet(start, len(names) - 1) for start in (0, 1))


def _spreadsheet(start: int, count: int) -> list[str]:
    """Columns as a spreadsheet calls them: A, B, ..., Z, AA, AB."""
    found = []
    for number in range(start + 1, start + count + 1):
        name = ""
        while number:
            number, digit = divmod(number - 1, 26)
            name = chr(ord("A") + digit) + name
        found.append(name)
    return found
