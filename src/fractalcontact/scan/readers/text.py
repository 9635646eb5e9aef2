"""Matrices and points in text files, read as their sidecar says they are written."""

import io
import re
from collections import Counter
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.labels import printable
from ..format import Format
from ..options import DELIMITERS, NO_MARK, ScanOptions
from ..raw import RawScan
from ..stated import Needs, require_stated
from ..tables import TextParts, column_index, table_to_raw
from ..text_hints import named_columns, text_hints
from ..text_lines import (
    COMMENT_MARKS,
    DOUBTFUL_END,
    MAX_ROWS,
    cells_of,
    cleaned,
    is_number,
    last_number_cut,
    open_text,
    refuse_other_counts,
    wide_encoding,
)
from ..wrapped_rows import refuse_wrapped

_NAN = ("", "nan", "NaN", "NAN", "-nan", "-NaN", "+nan")
#: Keys that say how a text is laid out; a table that describes itself needs none of them.
LAYOUT_KEYS = ("delimiter", "decimal", "thousands", "header", "layout", "axes", "columns")
_BLOCK = 2**24  # characters read at once
_SAMPLE = 200  # lines that tell how many numbers stand in one
_PLAIN = b"0123456789+-.,;eE \t\n"


def read_text(path: Path, options: ScanOptions) -> RawScan:
    """Read a text file of heights or of points, block by block: only the numbers are kept.

    Delimiter, decimal mark, header and what the columns hold are those of the sidecar; of a table
    whose columns are named x, y and z, each with a unit of length, those of that line. No other
    word of the file counts. Lines that begin with ``#``, ``%``, ``!`` or ``//``, and repeats of a
    header line, are passed over behind the header. A point cut short at the very end of the file is
    left out with a note.

    Raises
    ------
    InputError
        If the sidecar does not state all that is needed, a line is not as it says, or the numbers
        of rows, columns or points disagree with those that the header states.
    """
    units: dict[str, str] = {}
    if all(getattr(options, key) is None for key in LAYOUT_KEYS) and (found := named_columns(path)):
        keys, units = found
        options = options.but(**keys)
    else:
        needs = Needs(text=True, table=True)
        require_stated(path, options, needs, lambda: text_hints(path))
    reading = _Reading(path, options)
    with open_text(path) as stream:
        reading.header = [stream.readline().rstrip("\n") for _ in range(options.header or 0)]
        while block := stream.read(_BLOCK) + stream.readline():
            reading.add(block)
    table, parts, notes = reading.finish()
    reading.refuse_numbers_above()
    refuse_other_counts(reading.header, table.shape, options, str(path))
    refuse_wrapped(reading.header, table.shape, options, str(path))
    return table_to_raw(table, options, str(path), parts, reader=_reader(), notes=notes, **units)


def is_text(path: Path) -> bool:
    """Distinguish a text file from a binary one by its first bytes."""
    with open(path, "rb") as stream:
        head = stream.read(4096)
    is_marked = head.startswith((b"\xff\xfe", b"\xfe\xff"))
    return is_marked or b"\0" not in head or wide_encoding(head) is not None


class _Reading:
    """Numbers of a text file, collected by blocks of whole lines."""

    def __init__(self, path: Path, options: ScanOptions):
        self.path, self.options = path, options
        self.delimiter = DELIMITERS[options.delimiter or "blank"]
        self.header: list[str] = []
        self._width = 0  # numbers in a line
        self._trailing = False  # lines end with a delimiter that parts nothing
        #: By row before which something else than numbers stands, the number of that line.
        self._breaks: dict[int, int] = {}
        self._parts: list[np.ndarray] = []
        self._rows = 0  # taken up so far
        self._lines = options.header or 0  # before the next block
        self._short: tuple[int, str, str] | None = None  # number, text and fault of a cut line
        self._latest: list[str] = []  # lines of the blocks before
        self._is_doubtful = False  # the last number is short, and no line end stands behind it
        self._above: list[str] | None = None  # cells of a first row of coordinates
        self._has_frame = options.layout != "points" and options.axes in ("both", "row")

    def add(self, block: str) -> None:
        """Take up the next block."""
        # The quick way passes no line it has not understood; what it refuses is read line by line.
        plain = None
        if not self._width and not self._has_frame:
            breaks = dict(self._breaks)
            if first := self._data_lines(block.split("\n", _SAMPLE)[:_SAMPLE]):
                self._measure([line for _, line in first])
            self._breaks = breaks
        if self._width and not self._short:
            plain = _plain_block(block, self.delimiter, self._width, self._trailing)
        if plain is None:
            self._add_lines(block)
        else:
            part = self._parse(plain, self._width + self._trailing)
            if self._doubted(part).any():
                self._add_lines(block)
            else:
                self._take(part)
        self._lines += block.count("\n")
        self._latest = [*self._latest, *block.rstrip("\n").rsplit("\n", MAX_ROWS)[-MAX_ROWS:]][
            -MAX_ROWS:
        ]

    def finish(self) -> tuple[np.ndarray, TextParts, tuple[str, ...]]:
        """Table (rows, columns), the text around it, and the notes."""
        notes: tuple[str, ...] = ()
        if self._short:
            number, line, fault = self._short
            if self.options.layout != "points" or not self._rows:
                raise InputError(
                    f"{self.path}: its last line ({number}) {fault}, after {self._rows} rows of "
                    f"{self._width}: {line[-40:]!r}; the file is cut off, so export it again"
                )
            notes = (f"the last line ({number}) was cut short and is left out",)
        if self._is_doubtful:
            notes = (DOUBTFUL_END,)
        if not self._parts:
            raise InputError(
                f"{self.path}: no line of numbers after its header of {self.options.header} "
                "lines; write the number of lines above the first number, 'header: 1'"
            )
        table = np.concatenate(self._parts)
        self._parts.clear()
        breaks = {row: line for row, line in self._breaks.items() if 0 < row < len(table)}
        above = None if self._above is None else self._coordinates(self._above)
        return table, TextParts(self._names(), above, breaks), notes

    def refuse_numbers_above(self) -> None:
        """Refuse a header that ends in rows of numbers, as the sidecar of two files may say."""
        last, first = 0, len(self.header) + 1
        for number in range(len(self.header), 0, -1):
            line = self.header[number - 1].strip()
            if line and not line.startswith(COMMENT_MARKS):
                if not self._is_row(line):
                    break
                last, first = max(last, number), number
        if last:
            raise InputError(
                f"{self.path}: line {last}, the last of its header, already holds as many numbers "
                f"as the lines below; write a smaller number, 'header: {first - 1}' (for one of "
                "two faces below 'upper:'), or # in front of that line if it holds no heights"
            )

    def _is_row(self, line: str) -> bool:
        """True if a line holds as many numbers as those that were read, or coordinates above."""
        words = self.options.missing_words
        line = cleaned(line, self.delimiter, words)
        cells = [cell.strip() for cell in cells_of(line, self.delimiter)]
        if len(cells) > self._width and not cells[-1]:
            cells.pop()
        empty = sum(cell in (*_NAN, *words) for cell in cells)
        numbers = sum(is_number(cell, self.options) for cell in cells)
        widths = (self._width, self._width - 1) if self._has_frame else (self._width,)
        is_whole = all(cell in (*_NAN, *words) or is_number(cell, self.options) for cell in cells)
        return is_whole and len(cells) in widths and numbers >= max(2, empty)

    def _take(self, part: np.ndarray) -> None:
        self._parts.append(part)
        self._rows += len(part)

    def _names(self) -> list[str] | None:
        """Cells of the last header line, which is above the numbers."""
        if not self.header:
            return None
        cells = cells_of(self.header[-1].lstrip("#%!/ "), self.delimiter)
        return [cell.strip().strip("\"'") for cell in cells]

    def _coordinates(self, cells: list[str]) -> np.ndarray:
        """Numbers of the first row, whose corner may be a word or empty."""
        if len(cells) > self._width and not cells[-1].strip():
            cells = cells[:-1]
        if self.options.axes == "both" and len(cells) == self._width:
            cells = cells[1:]
        return self._parse(self.delimiter.join(cells), len(cells)).ravel()

    def _add_lines(self, block: str) -> None:
        data = self._data_lines(block.split("\n"))
        if not data:
            return
        if self._has_frame and self._above is None:
            self._above = cells_of(data.pop(0)[1], self.delimiter)
            self._breaks = {max(row - 1, 0): line for row, line in self._breaks.items()}
        if not self._width and data:
            self._measure([line for _, line in data])
        rows = self._whole_rows(data, block.endswith("\n"))
        if rows:
            part = self._parse("\n".join(rows), self._width)
            self._refuse_no_height(part, rows, [number for number, _ in data])
            self._take(part)

    def _doubted(self, part: np.ndarray) -> np.ndarray:
        """Cells (rows, columns) that are infinite, or without a number though none is missing."""
        doubted = np.isinf(part)
        if self.options.missing == NO_MARK and self.delimiter != " ":
            doubted |= np.isnan(part)
        if doubted.any() and self.options.layout == "points":
            chosen, names = self.options.columns or (0, 1, 2), self._names()
            used = [column_index(c, names, part.shape[1], str(self.path)) for c in chosen]
            doubted[:, np.setdiff1d(range(part.shape[1]), used)] = False
        return doubted

    def _refuse_no_height(self, part: np.ndarray, rows: list[str], numbers: list[int]) -> None:
        """Refuse a cell that is empty or infinite, and no mark of missing cells."""
        for row, column in np.argwhere(self._doubted(part)):
            cell = cells_of(rows[row], self.delimiter)[column].strip()
            if not cell or np.isinf(part[row, column]):
                mark = cell or '""'
                raise InputError(
                    f"{self.path}: line {numbers[row]}, cell {column + 1} "
                    f"{f'is {cell[:40]!r}, no finite number' if cell else 'is empty'}, and its "
                    f"sidecar does not say that such cells are missing; write 'missing: {mark}' if "
                    "they are, else export the file again"
                )

    def _measure(self, lines: list[str]) -> None:
        """Take the width from the first lines, and whether each ends with a delimiter."""
        sample = lines[: max(1, min(len(lines) - 1, _SAMPLE))]
        self._trailing = self.delimiter != " " and all(
            line.rstrip(" ").endswith(self.delimiter) for line in sample
        )
        cells = [cells_of(line, self.delimiter) for line in sample]
        widths = Counter(len(row) for row in cells)
        if len(widths) > 1:  # a delimiter ends some lines, or a line is spoilt
            widths = Counter(len(row) - (not row[-1].strip()) for row in cells)
            self._width = widths.most_common(1)[0][0]
        else:
            self._width = len(cells[0]) - self._trailing

    def _data_lines(self, lines: list[str]) -> list[tuple[int, str]]:
        """Number and text of the lines of numbers; the places of all other lines are kept."""
        data: list[tuple[int, str]] = []
        words = tuple(word for word in self.options.missing_words if word)
        header = set(self.header)
        for number, line in enumerate(lines, self._lines + 1):
            line = line.strip(" \r\x1a\f")
            is_mark = bool(words) and line.startswith(words)
            is_comment = line.startswith(COMMENT_MARKS) and not is_mark
            tabs = self.delimiter == "\t" and self._width > 1
            is_empty_row = tabs and line.count("\t") == self._width - 1 + self._trailing
            if (not line.strip() and not is_empty_row) or is_comment or line in header:
                self._breaks[self._rows + len(data)] = number
                continue
            data.append((number, cleaned(line, self.delimiter, words)))
        return data

    def _whole_rows(self, data: list[tuple[int, str]], is_ended: bool) -> list[str]:
        """Lines of as many numbers each; one cut short may be the last."""
        rows: list[str] = []
        for number, line in data:
            if self._short:
                raise self._wrong_width(*self._short[:2])
            if self.delimiter not in " \t":
                line = line.replace("\t", " ")
            cells = cells_of(line, self.delimiter)
            if len(cells) == self._width + 1 and not cells[-1].strip():
                cells = cells[:-1]
            if len(cells) > self._width:
                raise self._wrong_width(number, line)
            if len(cells) < self._width:
                self._refuse_words(number, line, cells[:-1])
                self._short = (number, line, f"holds {len(cells)} numbers")
                continue
            rows.append(self.delimiter.join(cells))
            self._refuse_words(number, line, cells)
        if rows and not is_ended and not self._short:
            above = (cells_of(line.strip(), self.delimiter) for line in self._latest)
            whole = [
                self.delimiter.join(cells[: self._width])
                for cells in above
                if len(cells) >= self._width and not any(map(str.strip, cells[self._width :]))
            ]
            layout = self.options.layout
            cut = last_number_cut([*whole, *rows], self.delimiter, layout, self._is_mark)
            if cut == "cut":
                self._short = (data[-1][0], rows.pop(), "breaks off within a number")
            self._is_doubtful = cut == "doubtful"
        return rows

    def _is_mark(self, cell: str) -> bool:
        """True for the number that marks missing cells, which has a form of its own."""
        if not self.options.marks or not is_number(cell, self.options):
            return False
        plain = cell.replace(self.options.thousands or "", "").replace(
            self.options.decimal or ".", "."
        )
        return float(plain) in self.options.marks

    def _refuse_words(self, number: int, line: str, cells: list[str]) -> None:
        if not re.search(r"[^-+0-9.,;eE \t]", line):
            return
        known = (*_NAN, *self.options.missing_words)
        for cell in cells:
            cell = cell.strip()
            if cell not in known and not is_number(cell, self.options):
                raise InputError(
                    f"{self.path}: line {number} holds {cell[:40]!r}, which is no number by its "
                    f"sidecar; write 'header: {number}' if the line stands above the numbers, "
                    f"'missing: {cell[:20]}' if the word marks a missing cell"
                )

    def _wrong_width(self, number: int, line: str) -> InputError:
        found = len(cells_of(line, self.delimiter))
        return InputError(
            f"{self.path}: line {number} has {found} values, earlier lines have {self._width}: "
            f"is 'delimiter: {self.options.delimiter}' right, and is each row in one line? "
            "Correct the line, or export the file again with a mark such as nan in each missing "
            "cell"
        )

    def _parse(self, content: str | bytes, width: int) -> np.ndarray:
        import pandas as pd

        options = self.options
        source = io.StringIO(content) if isinstance(content, str) else io.BytesIO(content)
        try:
            frame = pd.read_csv(
                source,
                sep=r"\s+" if self.delimiter == " " else self.delimiter,
                decimal=options.decimal or ".",
                thousands=options.thousands,
                header=None,
                names=range(width),
                index_col=False,
                skipinitialspace=True,
                skip_blank_lines=self.delimiter != "\t",
                na_values=[*_NAN, *options.missing_words],
                keep_default_na=False,
                dtype=np.float64,
            )
        except (ValueError, pd.errors.ParserError) as error:
            raise InputError(
                f"{self.path}: its numbers do not fit its sidecar, delimiter {options.delimiter} "
                f"and decimal {options.decimal!r} ({printable(error, 80)}); correct the sidecar, "
                "and write 'thousands' if digits are grouped"
            ) from error
        return frame.to_numpy()[:, : self._width or width]


def _plain_block(block: str, delimiter: str, width: int, trailing: bool) -> bytes | None:
    """Block of numbers with equal counts in each line, unchanged; else None."""
    if not (block.isascii() and block.endswith("\n")):
        return None
    content = block.encode("ascii")
    if content.translate(None, _PLAIN):
        return None
    if delimiter not in " \t" and b"\t" in content:
        return None
    characters = np.frombuffer(content, dtype=np.uint8)
    ends = np.flatnonzero(characters == ord("\n"))
    starts = np.r_[0, ends[:-1] + 1]
    if delimiter == " ":
        solid = characters > ord(" ")
        solid[1:] &= ~solid[:-1]  # each number's first character
        counts, wanted = np.add.reduceat(solid, starts, dtype=np.int64), width
    else:
        delimiters = characters == ord(delimiter)
        counts = np.add.reduceat(delimiters, starts, dtype=np.int64)
        wanted = width - 1 + trailing
        if trailing and not delimiters[ends - 1].all():
            return None
    return content if (counts == wanted).all() else None


def _reader() -> str:
    import pandas as pd

    return f"pandas {pd.__version__} / text"


FORMAT = Format(
    read_text,
    endings=(".asc", ".csv", ".dat", ".tsv", ".txt", ".xyz"),
    keys=(*LAYOUT_KEYS,),
    takes=is_text,
    libraries=("pandas",),
    refusal="not a text file; export it again as text, or give it the extension of its format",
)
