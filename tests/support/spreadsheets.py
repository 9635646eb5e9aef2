"""What a spreadsheet would run of a table: cells that it takes for formulas."""

import csv
import io
import re

#: A group, label or name that would start a program.
FORMULA = "=cmd|' /C calc'!A0"
#: One for each beginning that makes a formula, and some that a reader of CSV may take apart.
FORMULAS = [f"{first}1+1" for first in ("=", "+", "-", "@", "\t", "\r", " =")]
FORMULAS += [FORMULA, '=HYPERLINK("x.example","a, b")', "rock\r=1+1", "rock\n=1+1", "\r1"]


def formulas_in(text):
    """Cells of a CSV, or lines of them, that begin as a formula does, numbers left out."""
    cells = [cell for row in csv.reader(io.StringIO(text, newline="")) for cell in row]
    lines = [line for cell in cells for line in re.split(r"[\r\n]", cell)]
    return [line for line in lines if re.match(r" *[=+\-@\t]", line) and not _is_number(line)]


def _is_number(cell):
    try:
        float(cell)
    except ValueError:
        return False
    return True
