"""Headers that known programs write in front of a matrix: Gwyddion's text export, ESRI's grid."""

import re
from typing import Any

from ..core.errors import InputError
from ..core.units import length_factor, length_unit

_NUMBER = r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?"
_SIZE = re.compile(rf"#?\s*([^:=]+):\s*({_NUMBER})\s*([^\W\d]*)")
_CHANNEL = re.compile(r"#\s*Channel:")
_UNIT = re.compile(r"#?\s*[^:=]+:\s*(\S*)")
_ESRI = re.compile(rf"([a-z_]+)[\s:=]+({_NUMBER})")
#: Programs whose text says neither size nor unit in a way that is read here, and what to do.
_ADVICE = {
    "zygo": "a text export of a Zygo instrument; save it as .datx or binary .dat, or as plain text "
    "x, y, z",
}


def gwyddion_header(header: list[str], shape: tuple[int, int], where: str) -> dict | None:
    """Size and unit of Gwyddion's text export: "# Width: 10.0 um", "# Value units: m".

    Gwyddion translates the keys, so the order of the lines decides, not their words: two sizes and
    the unit of the values right behind.

    Parameters
    ----------
    header : list of str
    shape : (int, int)
        Rows and columns of the numbers.
    where : str
        The file, for errors.
    """
    for first, second, third in zip(header, header[1:], [*header[2:], ""], strict=False):
        sizes = [_SIZE.fullmatch(line.strip()) for line in (first, second)]
        if None in sizes or not all(_is_total(m[1]) for m in sizes if m):
            continue
        if third and not _UNIT.fullmatch(third.strip()):
            continue
        stated: dict[str, Any] = {"first_row": "top"}
        unread = []
        if all(length_unit(m[3]) for m in sizes if m):
            width, height = (
                float(m[2].replace(",", ".")) * length_factor(m[3], where) for m in sizes if m
            )
            rows, columns = shape
            stated |= {"unit_xy": "mm", "spacing": (width / columns, height / rows)}
        elif _CHANNEL.match(header[0]):  # in pixels, or without a unit
            unread = [first.lstrip("# ")]
        else:
            continue
        unit = (_UNIT.fullmatch(third.strip()) or [""] * 2)[1]
        if unit and length_unit(unit):
            stated["unit_z"] = unit
        elif unit:
            unread.append(third.lstrip("# "))
        return stated | {"unread": tuple(line[:80] for line in unread)}
    return None


def _is_total(key: str) -> bool:
    """Whether a key may name the size of the whole field rather than of a cell."""
    return not re.search(
        r"pixel|spacing|step|pitch|cell|\b(d|delta)?[xyz]\b|mean|max|min", key.lower()
    )


def esri_header(header: list[str], shape: tuple[int, int], where: str) -> dict | None:
    """Cell size and missing number from the header of an ESRI ASCII grid.

    Raises
    ------
    InputError
        If the file holds other numbers of rows and columns than the header says.
    """
    matches = [_ESRI.fullmatch(line.lower().strip(" \t\r,;")) for line in header]
    numbers = {m[1]: float(m[2]) for m in matches if m and "," not in m[2]}
    promised = numbers.get("nrows"), numbers.get("ncols")
    if None not in promised and promised != shape:
        rows, columns = promised
        raise InputError(
            f"{where}: its header promises {rows:.10g} rows of {columns:.10g} numbers, it holds "
            f"{shape[0]} of {shape[1]}; export it again, or mend nrows and ncols"
        )
    steps = numbers.get("dx", numbers.get("cellsize")), numbers.get("dy", numbers.get("cellsize"))
    if None in promised or None in steps:
        return None
    return {"spacing": steps, "missing": numbers.get("nodata_value"), "first_row": "top"}


def refuse_known_programs(header: list[str], where: str) -> None:
    """Refuse the text of programs whose header alone says what the numbers mean.

    Raises
    ------
    InputError
        With what to save instead.
    """
    first = header[0].lstrip("#\"' ").lower() if header else ""
    for name, advice in _ADVICE.items():
        if first.startswith(name):
            raise InputError(f"{where}: {advice}")
