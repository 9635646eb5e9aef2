"""Matrices and point clouds as people export them to text."""

import codecs
import io
import re
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.strips import stacked
from ...core.units import length_factor
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan
from ..tables import table_to_raw

_COMMENT_MARKS = ("#", "%", "//", "!")
_WORD = re.compile(r"[A-Za-z_]+")
_NUMBER_WORDS = {"e", "d", "nan", "inf", "infinity", "na", "n", "a", "null", "none", "bad"}
_EXTRA_MISSING = ["BAD", "bad", "none", "NONE", "---", "--", "-", "*", "?"]
_NUMBER = r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?"  # for headers: no missing cells there
_DECIMAL_COMMA = re.compile(r"^[-+]?\d+,\d+([eE][-+]?\d+)?$")
_SAMPLE = 200  # lines that decide about delimiter and decimal mark
_BLOCK = 2**24  # characters read at once
_PLAIN = b"0123456789+-.,;eE \t\n"


def read_text(path: Path, options: ScanOptions) -> RawScan:
    """Read a text file of heights or of points, block by block: only the numbers are kept.

    Delimiter and decimal mark are found from the content. Lines of words in front are the header;
    comments and repeats of a header line are passed over wherever they stand; a line cut short at
    the very end of the file is dropped with a note. Headers of Gwyddion text exports and of ESRI
    ASCII grids give size and unit.

    Raises
    ------
    InputError
        If a line in between cannot be read, or there are no numbers at all.
    """
    reading = _Reading(path)
    with open(path, encoding=_encoding(path), errors="replace") as stream:
        while block := stream.read(_BLOCK) + stream.readline():
            reading.add(block)
    table, style, notes = reading.finish()
    header = reading.header
    stated = _gwyddion_header(header, table.shape, str(path)) or _esri_header(header)
    names = _column_names(header, style.delimiter, style.width)
    if stated:
        return RawScan(table, "matrix", reader=_reader(), notes=notes, **stated)
    return table_to_raw(table, names, options, str(path), reader=_reader(), notes=notes)


def is_text(path: Path) -> bool:
    """Tell a text file from a binary one by its first bytes."""
    with open(path, "rb") as stream:
        head = stream.read(4096)
    return head.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" not in head


def _encoding(path: Path) -> str:
    """UTF-16 by its mark; else UTF-8 if all of the file is, else Latin-1."""
    with open(path, "rb") as stream:
        if stream.read(2) in (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE):
            return "utf-16"
        stream.seek(0)
        decoder = codecs.getincrementaldecoder("utf-8")()
        try:
            while content := stream.read(_BLOCK):
                decoder.decode(content)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError:  # instruments in Europe still write this one
            return "latin-1"
    return "utf-8-sig"


@dataclass(frozen=True)
class _Style:
    """How the lines of numbers are written."""

    delimiter: str  # " " is white space of any length
    decimal: str
    width: int  # numbers in a line
    trailing: bool  # lines end with a delimiter that parts nothing


class _Reading:
    """The numbers of a text file, taken up block by block; a block holds whole lines."""

    def __init__(self, path: Path):
        self.path = path
        self.header: list[str] = []
        self.style: _Style | None = None  # that of the first block with numbers
        self._parts: list[np.ndarray] = []
        self._lines = 0  # before the next block
        self._short: tuple[int, int] | None = None  # number and width of a line that ends too soon

    def add(self, block: str) -> None:
        """Take up the next block."""
        # The quick way passes no line it has not understood; what it refuses is read line by line.
        style = self.style
        plain = None if style is None or self._short else _parse_plain(block, style)
        if style is None or plain is None:
            self._add_lines(block.split("\n"))
        else:
            self._parts.append(_parse(plain, style, self.path))
        self._lines += block.count("\n")

    def finish(self) -> tuple[np.ndarray, _Style, tuple[str, ...]]:
        """The table (rows, columns), how it is written, and the notes."""
        if self.style is None:
            raise InputError(f"{self.path}: the file holds no line of numbers")
        notes: tuple[str, ...] = ()
        if self._short:
            notes = (f"the last line ({self._short[0]}) was cut short and is left out",)
        return stacked(self._parts), self.style, notes

    def _add_lines(self, lines: list[str]) -> None:
        data = self._data_lines(lines)
        if not data:
            return
        if self.style is None:
            self.style = _find_style([line for _, line in data])
        if rows := self._whole_rows(data, self.style):
            # Without the delimiter at the end, which is cut off here.
            style = replace(self.style, trailing=False)
            self._parts.append(_parse("\n".join(rows), style, self.path))

    def _data_lines(self, lines: list[str]) -> list[tuple[int, str]]:
        """Number and text of the lines of numbers; the header is kept, comments are passed over."""
        data, header = [], set(self.header)
        for number, line in enumerate(lines, self._lines + 1):
            line = line.strip(" \r\n\x1a\f")
            if not line.strip():
                continue
            if not (line.startswith(_COMMENT_MARKS) or _has_words(line)):
                data.append((number, line))
            elif not data and self.style is None:
                self.header.append(line)
                header.add(line)
            elif not (line.startswith(_COMMENT_MARKS) or line in header):
                raise InputError(f"{self.path}: line {number} is not numbers: {line[:60]!r}")
        return data

    def _whole_rows(self, data: list[tuple[int, str]], style: _Style) -> list[str]:
        """The lines, checked to have the same number of cells; one cut short may be the last."""
        delimiter, width = style.delimiter, style.width
        rows = []
        for number, line in data:
            if self._short:
                raise self._wrong_width(*self._short, width)
            if style.trailing:
                line = line.removesuffix(delimiter)
            found = len(_split(line, delimiter))
            if found == width + 1 and line.endswith(delimiter):
                line, found = line.removesuffix(delimiter), width
            if found > width:
                raise self._wrong_width(number, found, width)
            if found < width:
                self._short = (number, found)
            else:
                rows.append(line)
        return rows

    def _wrong_width(self, number: int, found: int, width: int) -> InputError:
        return InputError(f"{self.path}: line {number} has {found} values, the others have {width}")


def _find_style(lines: list[str]) -> _Style:
    """Find delimiter, decimal mark and width from the first lines of numbers."""
    delimiter, decimal = _sniff(lines[:_SAMPLE])
    ending = sum(line.endswith(delimiter) for line in lines)
    trailing = delimiter != " " and ending >= max(1, len(lines) - 1)
    if trailing:
        lines = [line.removesuffix(delimiter) for line in lines]
    widths = Counter(len(_split(line, delimiter)) for line in lines)
    return _Style(delimiter, decimal, widths.most_common(1)[0][0], trailing)


def _parse_plain(block: str, style: _Style) -> bytes | None:
    """The block as it is if it holds nothing but numbers, as many in each line; else None."""
    if not (block.isascii() and block.endswith("\n")):
        return None
    content = block.encode("ascii")
    if content.translate(None, _PLAIN):
        return None
    characters = np.frombuffer(content, dtype=np.uint8)
    ends = np.flatnonzero(characters == ord("\n"))
    starts = np.r_[0, ends[:-1] + 1]
    if style.delimiter == " ":
        solid = characters > ord(" ")
        solid[1:] &= ~solid[:-1]  # each number's first character
        counts, wanted = np.add.reduceat(solid, starts, dtype=np.int64), style.width
    else:
        delimiters = characters == ord(style.delimiter)
        counts = np.add.reduceat(delimiters, starts, dtype=np.int64)
        wanted = style.width - 1 + style.trailing
        if style.trailing and not delimiters[ends - 1].all():
            return None
    return content if (counts == wanted).all() else None


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


def _parse(content: str | bytes, style: _Style, path: Path) -> np.ndarray:
    import pandas as pd

    source = io.StringIO(content) if isinstance(content, str) else io.BytesIO(content)
    try:
        frame = pd.read_csv(
            source,
            sep=r"\s+" if style.delimiter == " " else style.delimiter,
            decimal=style.decimal,
            header=None,
            names=range(style.width + style.trailing),
            index_col=False,
            skipinitialspace=True,
            na_values=_EXTRA_MISSING,
            dtype=np.float64,
        )
    except (ValueError, pd.errors.ParserError) as error:
        raise InputError(f"{path}: cannot be read as numbers ({error})") from error
    return frame.to_numpy()[:, : style.width]


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


FORMAT = Format(
    read_text,
    endings=(".asc", ".csv", ".dat", ".tsv", ".txt", ".xyz"),
    takes=is_text,
    libraries=("pandas",),
    refusal="not a text file; damaged, or the wrong extension?",
)
