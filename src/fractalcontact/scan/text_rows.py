"""Rows of numbers in a text file, collected block by block; a line that holds none is named."""

import csv
import io
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.labels import printable
from .options import DELIMITERS, NO_MARK, ScanOptions
from .tables import TextParts, column_index
from .text_lines import (
    COMMENT_MARKS,
    DOUBTFUL_END,
    MAX_ROWS,
    ORDINARY,
    cells_of,
    cleaned,
    is_number,
    last_number_cut,
    value_of,
)

_NAN = ("", "nan", "NaN", "NAN", "-nan", "-NaN", "+nan")
_SAMPLE = 200  # lines that tell how many numbers stand in one
_PLAIN = b"0123456789+-.,;eE \t\n"

#: Number of a line, and its cells; None for a line without numbers.
_Line = tuple[int, list[str] | None]
_Row = tuple[int, list[str]]


class TextRows:
    """Numbers of a text file, collected by blocks of whole lines."""

    def __init__(self, path: Path, options: ScanOptions, header: list[str]):
        self.path, self.options, self.header = path, options, header
        self.delimiter = DELIMITERS[options.delimiter or "blank"]
        self._words = tuple(word for word in options.missing_words if word)
        self._no_height = (*_NAN, *options.missing_words)
        self._width = 0  # numbers in a line
        self._trailing = False  # lines end with a delimiter that parts nothing
        self._has_frame = options.layout != "points" and options.axes in ("both", "row")
        self._above: _Row | None = None  # the first row, of coordinates
        #: Row before which a line without numbers stands, and the number of that line.
        self._breaks: dict[int, int] = {}
        self._parts: list[np.ndarray] = []
        self._rows = 0  # taken up so far
        self._lines = len(header)  # before the next block
        self._latest: list[str] = []  # last lines of the blocks before
        #: A line of another count, with its fault: the last one may be cut short.
        self._odd: tuple[int, list[str], str] | None = None
        self._is_doubtful = False  # the last number is short, and no line end stands behind it

    def add(self, block: str) -> None:
        """Take up the next block."""
        if not self._width:
            self._measure(block)
        part = self._quickly(block)
        if part is None:
            part = self._by_lines(block)
        if len(part):
            self._parts.append(part)
            self._rows += len(part)
        self._lines += block.count("\n")
        ending = block.rstrip("\n").rsplit("\n", MAX_ROWS)
        self._latest = [*self._latest, *ending][-MAX_ROWS:]

    def finish(self) -> tuple[np.ndarray, TextParts, tuple[str, ...]]:
        """Table (rows, columns), the text around it, and the notes."""
        notes = (DOUBTFUL_END,) if self._is_doubtful else ()
        if self._odd:
            number, cells, fault = self._odd
            if self.options.layout != "points" or not self._rows:
                line = self.delimiter.join(cells)
                raise InputError(
                    f"{self.path}: its last line ({number}) {fault}, after {self._rows} rows of "
                    f"{self._width}: {line[-40:]!r}; the file is cut off, so export it again"
                )
            notes = (f"the last line ({number}) was cut short and is left out",)
        if not self._rows:
            raise InputError(
                f"{self.path}: no line of numbers after its header of {self.options.header} "
                "lines; write the number of lines above the first number, 'header: 1'"
            )
        self._refuse_numbers_above()
        table = np.concatenate(self._parts)
        self._parts.clear()
        breaks = {row: line for row, line in self._breaks.items() if 0 < row < len(table)}
        return table, TextParts(self._names(), self._coordinates(), breaks), notes

    def _measure(self, block: str) -> None:
        """Take the width from the first rows, and whether each ends with a delimiter."""
        numbers = (cells for _, cells in self._stream(block) if cells is not None)
        rows = list(islice(numbers, _SAMPLE + 1))
        if self._has_frame and self._above is None:
            rows = rows[1:]
        rows = rows[: max(1, len(rows) - 1)]  # the last may be cut
        if not rows:
            return
        empty = [not cells[-1].strip() for cells in rows]
        self._trailing = self.delimiter != " " and all(empty)
        widths = Counter(map(len, rows))
        if len(widths) > 1:  # a delimiter ends some lines, or a line is spoilt
            widths = Counter(len(cells) - end for cells, end in zip(rows, empty, strict=True))
            self._width = widths.most_common(1)[0][0]
        else:
            self._width = len(rows[0]) - self._trailing

    def _stream(self, block: str) -> Iterator[_Line]:
        """Number and cells of each line of a block; no cells of a line that holds no numbers."""
        header = set(self.header)
        for number, line in enumerate(block.removesuffix("\n").split("\n"), self._lines + 1):
            line = line.strip(" \r\x1a\f")
            is_comment = line.startswith(COMMENT_MARKS) and not line.startswith(self._words)
            # Between tabs, all cells of a row may be empty.
            tabs = self._width - 1 + self._trailing
            is_empty_row = self.delimiter == "\t" and self._width > 1 and line.count("\t") == tabs
            if (not line.strip() and not is_empty_row) or is_comment or line in header:
                yield number, None
            else:
                yield number, self._cells(line)

    def _cells(self, line: str) -> list[str]:
        line = cleaned(line, self.delimiter, self._words)
        if self.delimiter not in " \t":
            line = line.replace("\t", " ")
        return cells_of(line, self.delimiter)

    def _quickly(self, block: str) -> np.ndarray | None:
        """Numbers of a block of plain rows; None where each line must be looked at."""
        if not self._width or self._odd or (self._has_frame and self._above is None):
            return None
        content = _plain_block(block, self.delimiter, self._width, self._trailing)
        if content is None:
            return None
        try:
            part = self._parse(io.BytesIO(content), self._width + self._trailing)
        except ValueError:
            return None
        part = part[:, : self._width]
        return None if self._doubted(part).any() else part

    def _by_lines(self, block: str) -> np.ndarray:
        """Numbers of a block, line by line; a line of another count may only be the last."""
        rows: list[_Row] = []
        follows = False
        for number, cells in self._stream(block):
            if cells is None:
                self._breaks[self._rows + len(rows)] = number
            elif self._has_frame and self._above is None:
                self._above = number, cells
            elif self._odd:
                follows = True
                break
            else:
                if len(cells) == self._width + 1 and not cells[-1].strip():
                    cells.pop()
                if len(cells) == self._width:
                    rows.append((number, cells))
                else:
                    self._odd = number, cells, f"holds {len(cells)} numbers"
        if rows and not self._odd and not block.endswith("\n"):
            self._judge_end(rows)
        part = self._numbers(rows)
        if self._odd:
            number, cells, _ = self._odd
            if len(cells) <= self._width:
                self._refuse_words(number, cells[:-1])
            if follows or len(cells) > self._width:
                raise InputError(
                    f"{self.path}: line {number} has {len(cells)} values, earlier lines have "
                    f"{self._width}: is 'delimiter: {self.options.delimiter}' right, and is each "
                    "row in one line? Correct the line, or export the file again with a mark such "
                    "as nan in each missing cell"
                )
        return part

    def _judge_end(self, rows: list[_Row]) -> None:
        """Take off the last row of a file without a final line end if its number is cut."""
        width = self._width
        above = (self._cells(line.strip()) for line in self._latest)
        whole = [cells[:width] for cells in above
                 if len(cells) >= width and not any(map(str.strip, cells[width:]))]  # fmt: skip
        latest = [*whole, *(cells for _, cells in rows)][-MAX_ROWS:]
        first = -1 if self.options.layout == "points" else 0
        numbers = [cell for cells in latest for cell in cells[first:]]
        end = last_number_cut(numbers, self._is_mark)
        if end == "cut":
            self._odd = *rows.pop(), "breaks off within a number"
        self._is_doubtful = end == "doubtful"

    def _is_mark(self, cell: str) -> bool:
        """True for the number that marks missing cells, which has a form of its own."""
        return value_of(cell, self.options) in self.options.marks

    def _numbers(self, rows: list[_Row]) -> np.ndarray:
        """Numbers of rows; a cell that is empty or infinite, and no mark, is refused."""
        part = self._parsed(rows)
        for row, column in np.argwhere(self._doubted(part)):
            number, cells = rows[row]
            cell = cells[column].strip()
            if not cell or np.isinf(part[row, column]):
                mark = cell or '""'
                raise InputError(
                    f"{self.path}: line {number}, cell {column + 1} "
                    f"{f'is {cell[:40]!r}, no finite number' if cell else 'is empty'}, and its "
                    f"sidecar does not say that such cells are missing; write 'missing: {mark}' if "
                    "they are, else export the file again"
                )
        return part

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

    def _parsed(self, rows: list[_Row]) -> np.ndarray:
        """Numbers of rows of as many cells each; halved until the line is found that holds none."""
        if not rows:
            return np.empty((0, self._width))
        content = "\n".join(self.delimiter.join(cells) for _, cells in rows)
        try:
            return self._parse(io.StringIO(content), len(rows[0][1]))
        except ValueError:
            if len(rows) > 1:
                middle = len(rows) // 2
                return np.concatenate([self._parsed(rows[:middle]), self._parsed(rows[middle:])])
            self._refuse_words(*rows[0])
            raise self._no_number(rows[0][0], content) from None

    def _parse(self, source: io.StringIO | io.BytesIO, width: int) -> np.ndarray:
        import pandas as pd

        options = self.options
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
            na_values=self._no_height,
            keep_default_na=False,
            quoting=csv.QUOTE_NONE,
            dtype=np.float64,
        )
        return frame.to_numpy()

    def _refuse_words(self, number: int, cells: list[str]) -> None:
        """Refuse a line with a cell that is neither a number nor a mark of missing cells."""
        for cell in cells:
            if not self._holds_number(cell.strip()):
                raise self._no_number(number, cell.strip())

    def _holds_number(self, cell: str) -> bool:
        return cell in self._no_height or is_number(cell, self.options)

    def _no_number(self, number: int, cell: str) -> InputError:
        place = f"{self.path}: line {number} holds '{printable(cell, 40)}'"
        if ORDINARY.fullmatch(cell):
            return InputError(
                f"{place}, but its numbers do not fit its sidecar, delimiter "
                f"{self.options.delimiter} and decimal {self.options.decimal!r}; correct the "
                "sidecar, and write 'thousands' if digits are grouped"
            )
        return InputError(
            f"{place}, which is no number by its sidecar; write 'header: {number}' if the line "
            f"stands above the numbers, 'missing: {cell[:20]}' if the word marks a missing cell"
        )

    def _refuse_numbers_above(self) -> None:
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
        cells = [cell.strip() for cell in self._cells(line)]
        if len(cells) > self._width and not cells[-1]:
            cells.pop()
        empty = sum(cell in self._no_height for cell in cells)
        numbers = sum(is_number(cell, self.options) for cell in cells)
        widths = (self._width, self._width - 1) if self._has_frame else (self._width,)
        is_whole = len(cells) in widths and all(map(self._holds_number, cells))
        return is_whole and numbers >= max(2, empty)

    def _names(self) -> list[str] | None:
        """Cells of the last header line, which is above the numbers."""
        if not self.header:
            return None
        cells = cells_of(self.header[-1].lstrip("#%!/ "), self.delimiter)
        return [cell.strip().strip("\"'") for cell in cells]

    def _coordinates(self) -> np.ndarray | None:
        """Numbers of the first row, whose corner may be a word or empty."""
        if self._above is None:
            return None
        number, cells = self._above
        if len(cells) > self._width and not cells[-1].strip():
            cells = cells[:-1]
        if self.options.axes == "both" and len(cells) == self._width:
            cells = cells[1:]
        return self._parsed([(number, cells)]).ravel()


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
