"""Matrices and point clouds as people export them to text."""

import codecs
import io
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.strips import stacked
from ..format import Format
from ..headings import read_statements
from ..options import ScanOptions
from ..raw import SMALLEST_SIDE, RawScan
from ..tables import TextLayout, table_to_raw
from ..text_headers import esri_header, gwyddion_header, refuse_known_programs
from ..text_style import (
    COMMENT_MARKS,
    Style,
    column_names,
    counts_agree,
    find_style,
    numbers_above,
    numbers_of,
    split_cells,
)

_EXTRA_MISSING = ["BAD", "bad", "none", "NONE", "---", "--", "-", "*", "?"]
#: Numbers in front of a table: of rows, of columns, of points.
_MOST_COUNTS = 3
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
    header, where = reading.header, str(path)
    refuse_known_programs(header, where)
    stated = gwyddion_header(header, table.shape, where) or esri_header(header, table.shape, where)
    if stated:
        return RawScan(table, "matrix", reader=_reader(), notes=notes, **stated)
    above, header = numbers_above(header, style, where)
    names, sure, number = column_names(header, style)
    if sure and number is not None:
        header = header[:number] + header[number + 1 :]
    layout = TextLayout(sure, above, reading.breaks)
    said = read_statements(header, style.decimal)
    return table_to_raw(table, names, options, where, layout, reader=_reader(), notes=notes, **said)


def is_text(path: Path) -> bool:
    """Tell a text file from a binary one by its first bytes."""
    with open(path, "rb") as stream:
        head = stream.read(4096)
    return (
        head.startswith((b"\xff\xfe", b"\xfe\xff")) or b"\0" not in head or _wide(head) is not None
    )


def _wide(head: bytes) -> str | None:
    """UTF-16 without its mark: every other byte of plain text is zero."""
    if len(head) < 8 or head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return None
    even, odd = head[0::2], head[1::2]
    for zeros, others, name in ((odd, even, "utf-16-le"), (even, odd, "utf-16-be")):
        if zeros.count(0) > 0.8 * len(zeros) and b"\0" not in others:  # signs beyond Latin-1
            return name
    return None


def _encoding(path: Path) -> str:
    """UTF-16 by its mark; else UTF-8 if all of the file is, else Latin-1."""
    with open(path, "rb") as stream:
        head = stream.read(64)
        if head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return "utf-16"
        if wide := _wide(head[:64]):
            return wide
        stream.seek(0)
        decoder = codecs.getincrementaldecoder("utf-8")()
        try:
            while content := stream.read(_BLOCK):
                decoder.decode(content)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError:  # instruments in Europe still write this one
            return "latin-1"
    return "utf-8-sig"


class _Reading:
    """The numbers of a text file, taken up block by block; a block holds whole lines."""

    def __init__(self, path: Path):
        self.path = path
        self.header: list[str] = []
        self.style: Style | None = None  # that of the first block with numbers
        self.breaks: list[int] = []  # rows before which something else than numbers stands
        self._parts: list[np.ndarray] = []
        self._rows = 0  # taken up so far
        self._counts: list[int] = []  # whole numbers in short lines in front
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
            self._take(_parse(plain, style, self.path))
        self._lines += block.count("\n")

    def finish(self) -> tuple[np.ndarray, Style, tuple[str, ...]]:
        """The table (rows, columns), how it is written, and the notes."""
        if self.style is None:
            raise InputError(
                f"{self.path}: the file holds no line of numbers; export the heights as numbers "
                "alone, without units or words in their lines"
            )
        notes: tuple[str, ...] = ()
        if self._short:
            notes = (f"the last line ({self._short[0]}) was cut short and is left out",)
        table = stacked(self._parts)
        self.breaks = [row for row in dict.fromkeys(self.breaks) if 0 < row < len(table)]
        if self._counts and not counts_agree(self._counts, table.shape):
            raise InputError(
                f"{self.path}: its first line holds {' '.join(map(str, self._counts))}, which is "
                f"neither numbers of the table nor its size: {table.shape[0]} lines of "
                f"{table.shape[1]} numbers follow; export it again, or remove the line"
            )
        return table, self.style, notes

    def _take(self, part: np.ndarray) -> None:
        self._parts.append(part)
        self._rows += len(part)

    def _add_lines(self, lines: list[str]) -> None:
        data, gaps = self._data_lines(lines)
        if not data:
            return
        if self.style is None:
            self.style = find_style([line for _, line in data], self.path)
            in_front = self._lines_in_front(data, self.style)
            gaps = [gap - in_front for gap in gaps]
        if self.style.delimiter == "\t":
            cells = self.style.width - 1 + self.style.trailing
            data = [(n, line) for n, line in data if line.strip() or line.count("\t") == cells]
        else:
            data = [(n, line) for n, line in data if line.strip()]
        self.breaks += [self._rows + gap for gap in gaps]
        if rows := self._whole_rows(data, self.style):
            # Without the delimiter at the end, which is cut off here.
            style = replace(self.style, trailing=False)
            self._take(_parse("\n".join(rows), style, self.path))

    def _lines_in_front(self, data: list[tuple[int, str]], style: Style) -> int:
        """Take counts off the front of the lines; complete a row of coordinates without corner."""
        taken = 0
        while data and taken < _MOST_COUNTS:
            cells = [cell.strip() for cell in split_cells(data[0][1].strip(), style.delimiter)]
            if len(cells) == 1:  # counts may be parted otherwise than the numbers
                cells = data[0][1].split()
            if len(cells) >= min(style.width, _MOST_COUNTS) or not all(map(str.isdecimal, cells)):
                break
            self._counts += [int(cell) for cell in cells]
            del data[0]
            taken += 1
        if data and style.width > SMALLEST_SIDE and not style.trailing:
            number, line = data[0]
            if len(split_cells(line, style.delimiter)) == style.width - 1:
                delimiter = style.delimiter
                data[0] = (number, f"nan{delimiter}{line}")
        return taken

    def _data_lines(self, lines: list[str]) -> tuple[list[tuple[int, str]], list[int]]:
        """Number and text of the lines of numbers, and before which of them other lines stand.

        The header is kept, comments are passed over.
        """
        data: list[tuple[int, str]] = []
        gaps, header = [], set(self.header)
        for number, line in enumerate(lines, self._lines + 1):
            line = line.strip(" \r\n\x1a\f")
            if not line or not (line.strip() or data):
                gaps.append(len(data))
                continue
            numbers = numbers_of(line, in_front=not data and self.style is None)
            if numbers is not None:
                data.append((number, numbers))
            elif not data and self.style is None:
                self.header.append(line)
                header.add(line)
            elif line.startswith(COMMENT_MARKS) or line in header:
                gaps.append(len(data))
            else:
                raise InputError(
                    f"{self.path}: line {number} is not numbers: {line[:60]!r}; remove it, or put "
                    "'#' in front of a comment; tables under one another belong in files of their "
                    "own"
                )
        return data, gaps

    def _whole_rows(self, data: list[tuple[int, str]], style: Style) -> list[str]:
        """The lines, checked to have the same number of cells; one cut short may be the last."""
        delimiter, width = style.delimiter, style.width
        rows = []
        for number, line in data:
            if self._short:
                raise self._wrong_width(*self._short, width)
            if style.trailing:
                line = line.removesuffix(delimiter)
            if delimiter not in " \t":
                line = line.replace("\t", " ")
            found = len(split_cells(line, delimiter))
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
        return InputError(
            f"{self.path}: line {number} has {found} values, the others have {width}; mend the "
            "line, or export the file again with a mark such as nan in each missing cell"
        )


def _parse_plain(block: str, style: Style) -> bytes | None:
    """The block as it is if it holds nothing but numbers, as many in each line; else None."""
    if not (block.isascii() and block.endswith("\n")):
        return None
    content = block.encode("ascii")
    if content.translate(None, _PLAIN):
        return None
    if style.delimiter not in " \t" and b"\t" in content:
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


def _parse(content: str | bytes, style: Style, path: Path) -> np.ndarray:
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
        raise InputError(
            f"{path}: cannot be read as numbers ({error}); export it with one delimiter and "
            "decimal points, and a mark such as nan in missing cells"
        ) from error
    return frame.to_numpy()[:, : style.width]


def _reader() -> str:
    import pandas as pd

    return f"pandas {pd.__version__} / text"


FORMAT = Format(
    read_text,
    endings=(".asc", ".csv", ".dat", ".tsv", ".txt", ".xyz"),
    takes=is_text,
    libraries=("pandas",),
    refusal="not a text file; export it again as text, or give it the extension of its format",
)
