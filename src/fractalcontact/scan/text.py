"""Matrices and point clouds as people export them to text."""

import io
import re
from collections import Counter
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..units import length_factor
from .options import ScanOptions
from .raw import RawScan, table_to_raw

_COMMENT_MARKS = ("#", "%", "//", "!")
_WORD = re.compile(r"[A-Za-z_]+")
_NUMBER_WORDS = {"e", "d", "nan", "inf", "infinity", "na", "n", "a", "null", "none", "bad"}
_EXTRA_MISSING = ["BAD", "bad", "none", "NONE", "---", "--", "-", "*", "?"]
_NUMBER = r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?"  # for headers: no missing cells there
_DECIMAL_COMMA = re.compile(r"^[-+]?\d+,\d+([eE][-+]?\d+)?$")
_SAMPLE = 200  # lines that decide about delimiter and decimal mark


def read_text(path: Path, options: ScanOptions) -> RawScan:
    """Read a text file of heights or of points.

    Delimiter and decimal mark are found from the content. Lines of words in front are the header;
    comments and repeats of a header line are passed over wherever they stand; a line cut short at
    the very end of the file is dropped with a note. Headers of Gwyddion text exports and of ESRI
    ASCII grids give size and unit.

    Raises
    ------
    InputError
        If a line in between cannot be read, or there are no numbers at all.
    """
    lines = _decode(path).splitlines()
    header, data = _split_header(lines, path)
    if not data:
        raise InputError(f"{path}: the file holds no line of numbers")
    delimiter, decimal = _sniff([line for _, line in data[:_SAMPLE]])
    data, width, notes = _uniform(data, delimiter, path)
    table = _parse([line for _, line in data], delimiter, decimal, width, path)
    stated = _gwyddion_header(header, table.shape, str(path)) or _esri_header(header)
    names = _column_names(header, delimiter, width)
    if stated:
        return RawScan(table, "matrix", reader=_reader(), notes=notes, **stated)
    return table_to_raw(table, names, options, str(path), reader=_reader(), notes=notes)


def is_text(path: Path) -> bool:
    """Tell a text file from a binary one by its first bytes."""
    with open(path, "rb") as stream:
        head = stream.read(4096)
    return head.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" not in head


def _decode(path: Path) -> str:
    content = path.read_bytes()
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return content.decode("utf-16", errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:  # instruments in Europe still write this one
        return content.decode("latin-1")


def _split_header(lines: list[str], path: Path):
    """Part the lines into header (text) and data (line number, text)."""
    header, data = [], []
    for number, line in enumerate(lines, 1):
        line = line.strip(" \r\n\x1a\f")
        if not line.strip():
            continue
        if not (line.startswith(_COMMENT_MARKS) or _has_words(line)):
            data.append((number, line))
        elif not data:
            header.append(line)
        elif not (line.startswith(_COMMENT_MARKS) or line in header):
            raise InputError(f"{path}: line {number} is not numbers: {line[:60]!r}")
    return header, data


def _has_words(line: str) -> bool:
    return any(word.lower() not in _NUMBER_WORDS for word in _WORD.findall(line))


def _sniff(sample: list[str]) -> tuple[str, str]:
    """Find delimiter and decimal mark; white space of any length is the delimiter ``" "``."""
    text = "\n".join(sample)
    if "\t" in text:
        delimiter = "\t"
    elif ";" in text:
        delimiter = ";"
    elif "," not in text:
        delimiter = " "
    else:
        # "1,5 2,5" is blanks and decimal commas; "1, 2" and "1.5,2.5" are commas.
        decimal_commas = re.search(r"\d +[-+]?\d", text) and not re.search(r",\s|\.\d", text)
        delimiter = " " if decimal_commas else ","
    if delimiter == ",":
        return delimiter, "."
    cells = [cell.strip() for line in sample for cell in _split(line, delimiter)]
    return delimiter, "," if any(_DECIMAL_COMMA.match(cell) for cell in cells) else "."


def _split(line: str, delimiter: str) -> list[str]:
    return line.split() if delimiter == " " else line.split(delimiter)


def _uniform(data, delimiter: str, path: Path):
    """Check that all lines have the same number of cells; drop one cut short at the end."""
    if delimiter != " " and sum(line.endswith(delimiter) for _, line in data) >= len(data) - 1:
        data = [(number, line.removesuffix(delimiter)) for number, line in data]
    widths = [len(_split(line, delimiter)) for _, line in data]
    width = Counter(widths).most_common(1)[0][0]
    for i, (number, line) in enumerate(data):
        if widths[i] == width + 1 and line.endswith(delimiter):
            data[i], widths[i] = (number, line.removesuffix(delimiter)), width
    notes = ()
    if len(data) > 1 and widths[-1] < width:
        notes = (f"the last line ({data[-1][0]}) was cut short and is left out",)
        data, widths = data[:-1], widths[:-1]
    for (number, _), found in zip(data, widths, strict=True):
        if found != width:
            raise InputError(f"{path}: line {number} has {found} values, the others have {width}")
    return data, width, notes


def _parse(lines: list[str], delimiter: str, decimal: str, width: int, path: Path) -> np.ndarray:
    import pandas as pd

    try:
        frame = pd.read_csv(
            io.StringIO("\n".join(lines)),
            sep=r"\s+" if delimiter == " " else delimiter,
            decimal=decimal,
            header=None,
            names=range(width),
            index_col=False,
            skipinitialspace=True,
            na_values=_EXTRA_MISSING,
            dtype=np.float64,
        )
    except (ValueError, pd.errors.ParserError) as error:
        raise InputError(f"{path}: cannot be read as numbers ({error})") from error
    return frame.to_numpy()


def _column_names(header: list[str], delimiter: str, width: int) -> list[str] | None:
    """Take the last header line with one word a column as the columns' names."""
    for line in reversed(header):
        text = line.lstrip("#%!/ ").removesuffix(delimiter)
        for separator in (delimiter, ",", " "):
            names = [name.strip().strip("\"'") for name in _split(text, separator)]
            if len(names) == width:
                return names
    return None


def _gwyddion_header(header: list[str], shape: tuple[int, int], where: str) -> dict | None:
    """Size and unit from '# Width: 10.0 µm', '# Height: ...', '# Value units: m'.

    Gwyddion translates the keys, so the order of the lines tells, not their words.
    """
    stated = [line.lstrip("# ").partition(":")[2].strip() for line in header if "#" in line]
    sizes = [m for s in stated if (m := re.fullmatch(rf"({_NUMBER})\s*([^\W\d]+)", s))]
    if len(sizes) != 2:
        return None
    width, height = (float(m[1].replace(",", ".")) * length_factor(m[2], where) for m in sizes)
    rows, columns = shape
    unit_z = stated[-1] if re.fullmatch(r"[^\W\d]+", stated[-1]) else None
    return {
        "unit_xy": "mm",
        "unit_z": unit_z,
        "spacing": (width / columns, height / rows),
        "first_row": "top",
    }


def _esri_header(header: list[str]) -> dict | None:
    """Cell size and missing number from the header of an ESRI ASCII grid."""
    matches = [re.fullmatch(rf"([a-z_]+)\s+({_NUMBER})", line.lower()) for line in header]
    numbers = {m[1]: float(m[2]) for m in matches if m and "," not in m[2]}
    if "cellsize" not in numbers:
        return None
    cell = numbers["cellsize"]
    return {
        "spacing": (cell, cell),
        "missing": numbers.get("nodata_value"),
        "first_row": "top",
    }


def _reader() -> str:
    import pandas as pd

    return f"pandas {pd.__version__} / text"
