"""Matrices and points in text files, read as their sidecar says they are written."""

from pathlib import Path

from ..format import Format
from ..header_sizes import refuse_other_size
from ..options import ScanOptions
from ..raw import RawScan
from ..stated import Needs, require_stated
from ..tables import table_to_raw
from ..text_hints import named_columns, text_hints
from ..text_lines import open_text, wide_encoding
from ..text_rows import TextRows

#: Keys that say how a text is laid out; a table that describes itself needs none of them.
LAYOUT_KEYS = ("delimiter", "decimal", "thousands", "header", "layout", "axes", "columns")
_BLOCK = 2**24  # characters read at once


def read_text(path: Path, options: ScanOptions) -> RawScan:
    """Heights or points in a text file, read block by block: only the numbers are kept.

    Delimiter, decimal mark, header and columns are those of the sidecar; of a table whose columns
    are named x, y and z, each with a unit of length, those of that line. No other word of the file
    counts. Behind the header, lines that begin with ``#``, ``%``, ``!`` or ``//`` and repeats of a
    header line are passed over. A point cut short at the very end of the file is left out with a
    note.
    """
    units: dict[str, str] = {}
    is_laid_out = any(getattr(options, key) is not None for key in LAYOUT_KEYS)
    if not is_laid_out and (names := named_columns(path)):
        keys, units = names
        options = options.but(**keys)
    else:
        needs = Needs(text=True, table=True)
        require_stated(path, options, needs, lambda: text_hints(path))
    with open_text(path) as stream:
        header = [stream.readline().rstrip("\n") for _ in range(options.header or 0)]
        rows = TextRows(path, options, header)
        while block := stream.read(_BLOCK) + stream.readline():
            rows.add(block)
    table, parts, notes = rows.finish()
    refuse_other_size(header, table.shape, options, str(path))
    return table_to_raw(table, options, str(path), parts, reader=_reader(), notes=notes, **units)


def is_text(path: Path) -> bool:
    """Distinguish a text file from a binary one by its first bytes."""
    with open(path, "rb") as stream:
        head = stream.read(4096)
    is_marked = head.startswith((b"\xff\xfe", b"\xfe\xff"))
    return is_marked or b"\0" not in head or wide_encoding(head) is not None


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
