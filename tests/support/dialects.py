"""One known surface in the text that programs and people write: tables, headers, units, marks.

A dialect is a way to lay out numbers and words. How numbers are written, what parts them, line ends
and encoding are drawn for each file besides.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

FACTORS = {"mm": 1.0, "um": 1e-3, "µm": 1e-3, "nm": 1e-6, "m": 1e3, "cm": 10.0, "inch": 25.4}
DELIMITERS = {"tab": "\t", "semicolon": ";", "comma": ",", "blank": " ", "blanks": "   ",
              "comma and blank": ", "}  # fmt: skip
COMMENTS = ["# ", "#", "% ", "// ", "! "]
MARKS = ["nan", "NaN", "NA", "N/A", "#N/A", "No Data", "NoData", "BAD", "---", "-nan", "null",
         "1.#QNAN", "", "-9999"]  # fmt: skip
NOISE = ["made by hand", "operator: M. Muster", "date: 2024-05-17 10:11:12", "temperature: 20.5 C",
         "objective 50x", "version 2.1", "sample no. 12", "maximum height: 12.5 um",
         "filter cut-off 0.8 mm", "points: 300"]  # fmt: skip


@dataclass(frozen=True)
class Surface:
    """Heights (ny, nx) in mm, first row at the smallest y, NaN where missing; cells in mm."""

    heights: np.ndarray
    dx: float
    dy: float


@dataclass(frozen=True)
class Style:
    """How numbers and lines are written."""

    delimiter: str
    decimal: str
    exponent: str  # "" for plain decimals
    end: str
    encoding: str
    mark: str  # of missing cells
    comment: str
    unit_xy: str
    unit_z: str
    trailing: bool
    final_end: bool


@dataclass(frozen=True)
class Written:
    """A file, its true sidecar, and what must become of it.

    Attributes
    ----------
    expected : {"read", "either", "refused"}
        Whether it must be read, may be refused, or must be refused; never is it read wrong.
    describes_itself : bool
        Whether it needs no sidecar.
    """

    dialect: str
    ending: str
    content: bytes
    sidecar: dict
    surface: Surface
    expected: str
    describes_itself: bool


@dataclass
class Sheet:
    """The cells of a file and the lines in front of them, as a dialect fills them."""

    rows: list[list[str]]
    front: list[str] = field(default_factory=list)
    #: Of the true sidecar what the pen does not know.
    sidecar: dict = field(default_factory=dict)
    between: dict[int, str] = field(default_factory=dict)  # lines before rows
    expected: str = "read"
    describes_itself: bool = False
    words: int = 0  # of the rows, the first that hold names and units
    is_points: bool = False
    content: bytes | None = None  # of a binary file, whose sidecar is whole
    ending: str | None = None
    surface: Surface | None = None  # where another than the one given


class Pen:
    """Writes numbers of one file in its style."""

    def __init__(self, surface: Surface, style: Style, rng: np.random.Generator):
        self.surface, self.style, self.rng = surface, style, rng
        ny, nx = surface.heights.shape
        self.xy, self.z = FACTORS[style.unit_xy], FACTORS[style.unit_z]
        self.x = surface.dx * np.arange(nx) / self.xy
        self.y = surface.dy * np.arange(ny) / self.xy
        self.heights = surface.heights / self.z

    def place(self, value: float) -> str:
        """One coordinate, in as many decimals as its step needs."""
        step = min(self.surface.dx, self.surface.dy) / self.xy
        return self.number(value, max(0, 4 - math.floor(math.log10(step))))

    def number(self, value: float, decimals: int | None = None) -> str:
        """One number; ``decimals`` of a coordinate."""
        if np.isnan(value):
            return self.style.mark
        text = f"{value:.{decimals}f}" if decimals is not None else f"{value:.9g}"
        if self.style.exponent and decimals is None:
            text = f"{value:.8e}".replace("e", self.style.exponent)
        return text.replace(".", self.style.decimal)

    def numbers(self, values) -> list[str]:
        """Cells of a row."""
        return [self.number(value) for value in values]

    def matrix(self, heights=None) -> list[list[str]]:
        """Cells of all heights, first row first."""
        return [self.numbers(row) for row in (self.heights if heights is None else heights)]

    def points(self, order: str | None = None) -> np.ndarray:
        """x, y, z (n, 3) of all cells, as they are visited."""
        rows, columns = np.indices(self.heights.shape)
        order = order or self.rng.choice(["rows", "columns", "random", "to and fro"])
        if order == "columns":
            rows, columns = rows.T, columns.T
        elif order == "to and fro":
            columns = columns.copy()
            columns[1::2] = columns[1::2, ::-1]
        rows, columns = rows.ravel(), columns.ravel()
        if order == "random":
            shuffled = self.rng.permutation(rows.size)
            rows, columns = rows[shuffled], columns[shuffled]
        return np.column_stack([self.x[columns], self.y[rows], self.heights[rows, columns]])

    def remark(self, text: str) -> str:
        """A comment line."""
        return self.style.comment + text

    def join(self, cells: list[str]) -> str:
        """One line of cells."""
        return self.style.delimiter.join(cells)

    def unit_sidecar(self) -> dict:
        """Units as a user would state them."""
        return {"unit_xy": plain_unit(self.style.unit_xy), "unit_z": plain_unit(self.style.unit_z)}

    def matrix_sidecar(self) -> dict:
        """Units and spacing as a user would state them."""
        return {**self.unit_sidecar(), "spacing": self.steps()}

    def steps(self) -> list[float]:
        """Spacing in the file's unit."""
        return [float(f"{step / self.xy:.9g}") for step in (self.surface.dx, self.surface.dy)]


def plain_unit(unit: str) -> str:
    """A unit as a sidecar in ASCII has it."""
    return unit.replace("µ", "u")


#: Of every dialect: from a pen to its sheet.
DIALECTS: dict[str, Callable[[Pen], Sheet]] = {}


def dialect(function: Callable[[Pen], Sheet]) -> Callable[[Pen], Sheet]:
    """Enter a dialect under its function's name."""
    DIALECTS[function.__name__.strip("_").replace("_", " ")] = function
    return function


def draw_surface(rng: np.random.Generator) -> Surface:
    """Heights without any symmetry, rough, with cells missing inside."""
    ny, nx = rng.integers(11, 24, 2)
    nx += nx == ny
    dx = float(rng.choice([0.1, 0.25, 0.304, 0.02, 0.005]))
    dy = dx if rng.random() < 0.5 else float(f"{dx * rng.choice([0.5, 2, 1.25]):.6g}")
    y, x = np.indices((ny, nx))
    trend = rng.choice([0.0, 0.5, 3.0])
    relief = trend * (0.4 * x / nx + 0.9 * (y / ny) ** 2) + rng.uniform(-1, 1, (ny, nx))
    heights = 0.4 * min(dx, dy) * relief
    if rng.random() < 0.7:
        rows, columns = rng.integers(1, ny - 1, 3), rng.integers(1, nx - 1, 3)
        heights[rows, columns] = np.nan
    return Surface(heights, dx, dy)


def draw_style(rng: np.random.Generator, surface: Surface) -> Style:
    """A style that can hold the surface without doubt."""
    delimiter = DELIMITERS[str(rng.choice(list(DELIMITERS)))]
    decimal = "," if "," not in delimiter and rng.random() < 0.35 else "."
    marks = [m for m in MARKS if m or delimiter.strip(" ")]
    encoding = str(
        rng.choice(["utf-8", "utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "latin-1"])
    )
    unit_xy = str(rng.choice(["mm", "mm", "um", "µm", "cm", "m", "inch"]))
    unit_z = unit_xy if rng.random() < 0.4 else str(rng.choice(["mm", "um", "µm", "nm"]))
    return Style(
        delimiter,
        decimal,
        str(rng.choice(["", "", "", "e", "E", "D"])),
        str(rng.choice(["\n", "\n", "\r\n", "\r"])),
        encoding,
        str(rng.choice(marks)),
        str(rng.choice(COMMENTS)),
        unit_xy,
        unit_z,
        trailing=bool(delimiter.strip(" ") and rng.random() < 0.1),
        final_end=bool(rng.random() < 0.8),
    )


def make(seed: int, number: int, name: str | None = None) -> Written:
    """File ``number`` of a run: the dialects in turn, each time in another style."""
    rng = np.random.default_rng([seed, number])
    name = name or list(DIALECTS)[number % len(DIALECTS)]
    surface = draw_surface(rng)
    pen = Pen(surface, draw_style(rng, surface), rng)
    sheet = DIALECTS[name](pen)
    style = pen.style
    if sheet.content is not None:
        assert sheet.ending is not None
        truth = sheet.surface or surface
        outcome = sheet.expected, sheet.describes_itself
        return Written(name, sheet.ending, sheet.content, sheet.sidecar, truth, *outcome)
    lines = list(sheet.front)
    tail = style.delimiter.strip(" ") if style.trailing else ""
    for number_of_row, cells in enumerate(sheet.rows):
        if number_of_row in sheet.between:
            lines.append(sheet.between[number_of_row])
        lines.append(pen.join(cells) + tail)
    text = style.end.join(lines) + style.end * style.final_end
    encoding = style.encoding
    if encoding == "latin-1" and "\u2212" in text:
        encoding = "utf-8"
    ending = sheet.ending or str(rng.choice([".txt", ".csv", ".dat", ".tsv"]))
    return Written(
        name,
        ending,
        text.encode(encoding),
        true_sidecar(pen, sheet),
        sheet.surface or surface,
        sheet.expected,
        sheet.describes_itself,
    )


def true_sidecar(pen: Pen, sheet: Sheet) -> dict:
    """What the owner of a text knows of it."""
    style, own = pen.style, dict(sheet.sidecar)
    stated = {"kind": "face", "delimiter": delimiter_name(style.delimiter)}
    stated |= {"decimal": style.decimal, "header": len(sheet.front) + sheet.words}
    if sheet.is_points:
        stated |= {"layout": "points", "columns": [0, 1, 2], **pen.unit_sidecar()}
    else:
        stated |= {"layout": "matrix", "axes": "none", **pen.matrix_sidecar()}
        stated |= {"first_row": "bottom"}
        if own.get("axes") == "both" and "spacing" not in own:
            del stated["spacing"], stated["first_row"]
    is_marked = np.isnan(pen.heights).any() and style.mark not in ("nan", "NaN", "-nan")
    mark = -9999 if style.mark == "-9999" else style.mark  # "" for empty cells
    stated |= {"heights": "up", "missing": mark if is_marked else "none"} | own
    return {key: value for key, value in stated.items() if value is not None}


#: A file that no sidecar can describe: what it states is never complete.
UNSTATABLE = {"layout": None}


def delimiter_name(delimiter: str) -> str:
    """A delimiter as a sidecar has it."""
    return {",": "comma", ";": "semicolon", "\t": "tab"}.get(delimiter.strip(" "), "blank")


def restyle(pen: Pen, **changes) -> None:
    """Change the style of a file from within a dialect that only some styles suit."""
    style = replace(pen.style, **changes)
    pen.__init__(pen.surface, style, pen.rng)  # type: ignore[misc]


def whole(pen: Pen) -> None:
    """Fill the missing cells, for dialects that have none."""
    surface = replace(pen.surface, heights=np.nan_to_num(pen.surface.heights))
    pen.__init__(surface, pen.style, pen.rng)  # type: ignore[misc]
