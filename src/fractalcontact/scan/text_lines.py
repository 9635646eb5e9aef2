"""Lines of a text file: encoding, cells, numbers, and a last number that may be cut off."""

import codecs
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TextIO

from ..core.errors import InputError
from ..gridding.ungridded import NOTE
from .options import ScanOptions

COMMENT_MARKS = ("#", "%", "//", "!")
_TYPOGRAPHY = str.maketrans("\u2212\u2012\u2013\u00a0\u2009\u202f", "---   ")
_FORTRAN_EXPONENT = re.compile(r"(?<=[\d.,])[dD](?=[-+]?\d)")
_QUOTED = re.compile(r'"[^"]*"')
ORDINARY = re.compile(r"[-+0-9.,;eE \t]*")
_ENDING = re.compile(r"(?:[.,](?P<decimals>\d*))?(?:[eEdD](?P<exponent>[-+]?\d*))?$")
#: Pattern of a number or its beginning; a cut character of UTF-16 is the last sign.
_BEGUN = re.compile(r"(?=.)[-+\d.,']*(?:[eEdD][-+]?\d*)?\ufffd?")
_BLOCK = 2**24  # bytes
MAX_ROWS = 60  # last rows whose numbers tell how the last one is written
DOUBTFUL_END = (
    f"{NOTE}the last line has no line end, and its last number fewer characters than most: the "
    "file may be cut off there; compare it with its source"
)
#: Characters of a line of words that are looked at: patterns take the square of them, at worst.
MAX_WORDS = 200


def open_text(path: Path) -> TextIO:
    """A text file open for reading: UTF-16 by its mark or zeros; UTF-8 if all is, else Latin-1."""
    return open(path, encoding=_encoding(path), errors="replace")


def wide_encoding(head: bytes) -> str | None:
    """UTF-16 without its mark: every other byte of plain text is zero."""
    if len(head) < 8 or head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return None
    even, odd = head[0::2], head[1::2]
    for zeros, others, name in ((odd, even, "utf-16-le"), (even, odd, "utf-16-be")):
        if zeros.count(0) > 0.8 * len(zeros) and b"\0" not in others:  # signs beyond Latin-1
            return name
    return None


def _encoding(path: Path) -> str:
    with open(path, "rb") as stream:
        head = stream.read(64)
        if head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return "utf-16"
        if wide := wide_encoding(head[:64]):
            return wide
        stream.seek(0)
        decoder = codecs.getincrementaldecoder("utf-8")()
        try:
            while content := stream.read(_BLOCK):
                decoder.decode(content)
            decoder.decode(b"", final=True)
        except UnicodeDecodeError:  # instruments in Europe still write this encoding
            return "latin-1"
    return "utf-8-sig"


def words_of(line: str) -> str:
    """The beginning of a line of words, with one blank for white space of any length."""
    return " ".join(line[: 4 * MAX_WORDS].split())[:MAX_WORDS]


def cells_of(line: str, delimiter: str) -> list[str]:
    """Cells of a line; the delimiter ``" "`` is white space of any length."""
    return line.split() if delimiter == " " else line.split(delimiter)


def cleaned(line: str, delimiter: str, missing_words: Sequence[str] = ()) -> str:
    """A line with typographers' signs, Fortran's exponents and quotes as numbers have them."""
    if ORDINARY.fullmatch(line):
        return line
    for word in missing_words:
        if delimiter == " " and " " in word:
            line = line.replace(word, "nan")
    line = _FORTRAN_EXPONENT.sub("e", line.translate(_TYPOGRAPHY))
    if all(delimiter not in quoted for quoted in _QUOTED.findall(line)):
        line = line.replace('"', "")
    return line


def value_of(cell: str, options: ScanOptions) -> float | None:
    """Number in a cell, as the sidecar says numbers are written; None without one."""
    text = cell.replace(options.thousands, "") if options.thousands else cell
    try:
        return float(text.replace(options.decimal or ".", "."))
    except ValueError:
        return None


def is_number(cell: str, options: ScanOptions) -> bool:
    """True if a cell is a number as the sidecar says numbers are written."""
    return value_of(cell, options) is not None


def last_number_cut(
    numbers: Sequence[str], is_mark: Callable[[str], bool] = lambda cell: False
) -> str:
    """Judgement of the last number of a file without a final line end: cut, doubtful or "".

    It is cut if it breaks off the form of the numbers above: as many decimals each, exponents of
    two digits, or fewer characters than any of them. It is doubtful if it has fewer characters than
    most. Marks of missing cells do not count.
    """
    *others, last = map(str.strip, numbers)
    others = [other for other in others if re.search(r"\d", other) and not is_mark(other)]
    if len(others) < 3 or is_mark(last) or not _BEGUN.fullmatch(last):
        return ""
    if last[-1] not in "0123456789.,":
        return "cut"
    if not re.search(r"\d", last):
        return ""
    last, others = last.lstrip("+-"), [other.lstrip("+-") for other in others]
    lengths = sorted(map(len, others))
    if _breaks_form(_form(last), [_form(other) for other in others]) or len(last) < lengths[0]:
        return "cut"
    return "doubtful" if len(last) < lengths[len(lengths) // 2] else ""


def notes_on_end(rows: Sequence[str], content: str, path: Path) -> tuple[str, ...]:
    """Notes on the last number of a text, compared with the last ones of the rows.

    A number that is cut off is refused.
    """
    if content.endswith("\n") or not rows:
        return ()
    end = last_number_cut([row.split()[-1] for row in rows[-MAX_ROWS:]])
    if end == "cut":
        raise InputError(
            f"{path}: its last line breaks off within a number: {rows[-1][-40:]!r}; the file is "
            "cut off, so export it again; if it is whole, end its last line with a line break"
        )
    return (DOUBTFUL_END,) if end else ()


def _breaks_form(last: tuple[int, int | None], forms: list[tuple[int, int | None]]) -> bool:
    """True if a number lacks decimals or exponent digits that all others have."""
    decimals, digits = last
    of_exponents = [d for _, d in forms if d is not None]
    if digits is not None and digits < min(of_exponents, default=0):
        return True
    if digits is None and len(of_exponents) == len(forms):
        return True
    least = min(decimal for decimal, _ in forms)
    is_fixed = least == max(decimal for decimal, _ in forms) and least > 0
    return is_fixed and decimals < least


def _form(number: str) -> tuple[int, int | None]:
    """Decimals of a number, and digits of its exponent if it has one."""
    match = _ENDING.search(number)
    assert match is not None  # the pattern also matches an empty text
    exponent = match["exponent"]
    digits = None if exponent is None else len(exponent.lstrip("+-"))
    return len(match["decimals"] or ""), digits
