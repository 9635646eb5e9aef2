"""Dialects of which the file itself cannot tell a key: only its owner knows what is meant."""

import io
from dataclasses import replace

import numpy as np
from dialects import DIALECTS, Pen, Sheet, dialect, restyle, whole
from dialects_of_meaning import array_keys, netcdf
from dialects_of_points import points_sheet


def _of_heights(pen: Pen, heights: np.ndarray) -> None:
    """Let the file hold other heights (mm)."""
    pen.__init__(replace(pen.surface, heights=heights), pen.style, pen.rng)  # type: ignore[misc]


def _holed(pen: Pen, cells: int = 9) -> None:
    """Cells without a height, in two blocks inside."""
    heights = pen.surface.heights.copy()
    ny, nx = heights.shape
    for _ in range(2):
        row, column = pen.rng.integers(1, ny - 3), pen.rng.integers(1, nx - 4)
        heights[row : row + 2, column : column + cells // 4 + 1] = np.nan
    _of_heights(pen, heights)


def _marked(pen: Pen, mark: str, value: float) -> dict:
    """A word for missing cells that is a number of ordinary size, and its key."""
    _holed(pen)
    restyle(pen, mark=mark.replace(".", pen.style.decimal))
    return {"missing": value}


def _rows(points: np.ndarray, pen: Pen, order=(0, 1, 2)) -> list[list[str]]:
    cells = [[pen.place(x), pen.place(y), pen.number(z)] for x, y, z in points]
    return [[row[n] for n in order] for row in cells]


# --- columns ----------------------------------------------------------------------------------


@dialect
def _y_before_x(pen: Pen) -> Sheet:
    return points_sheet(_rows(pen.points(), pen, (1, 0, 2)), sidecar={"columns": [1, 0, 2]})


@dialect
def _heights_between_coordinates(pen: Pen) -> Sheet:
    return points_sheet(_rows(pen.points(), pen, (0, 2, 1)), sidecar={"columns": [0, 2, 1]})


@dialect
def _named_y_before_x(pen: Pen) -> Sheet:
    rows = [["Y", "X", "Z"], *_rows(pen.points(), pen, (1, 0, 2))]
    return points_sheet(rows, sidecar={"columns": ["X", "Y", "Z"]}, words=1)


@dialect
def _two_heights_named(pen: Pen) -> Sheet:
    """A raw and a filtered height beside x and y."""
    rows = [[*row, pen.number(pen.rng.normal())] for row in _rows(pen.points(), pen)]
    for row in rows:
        row[2], row[3] = row[3], row[2]
    names = ["x", "y", "height", "z"]
    return points_sheet([names, *rows], sidecar={"columns": ["x", "y", "z"]}, words=1)


@dialect
def _cells_counted_from_1(pen: Pen) -> Sheet:
    rows, columns = np.indices(pen.heights.shape)
    table = zip(columns.ravel(), rows.ravel(), pen.heights.ravel(), strict=True)
    cells = [[str(x + 1), str(y + 1), pen.number(z)] for x, y, z in table]
    return points_sheet(cells, sidecar={"spacing": pen.steps(), "first_row": "bottom"})


# --- marks of missing cells -------------------------------------------------------------------


@dialect
def _missing_zeros(pen: Pen) -> Sheet:
    keys = _marked(pen, str(pen.rng.choice(["0", "0.0"])), 0)
    return Sheet(pen.matrix(), sidecar=keys, surface=pen.surface)


@dialect
def _missing_minus_one(pen: Pen) -> Sheet:
    keys = _marked(pen, "-1", -1)
    return Sheet(pen.matrix(), sidecar=keys, surface=pen.surface)


@dialect
def _missing_near_the_relief(pen: Pen) -> Sheet:
    value = float(f"{1.3 * np.nanmax(pen.heights):.2g}")
    keys = _marked(pen, f"{value:.9g}", value)
    return Sheet(pen.matrix(), sidecar=keys, surface=pen.surface)


@dialect
def _missing_zeros_of_points(pen: Pen) -> Sheet:
    keys = _marked(pen, "0", 0)
    return points_sheet(_rows(pen.points(), pen), sidecar=keys, surface=pen.surface)


@dialect
def _missing_minus_one_of_counts(pen: Pen) -> Sheet:
    _holed(pen)
    quantum = 1e-3 * min(pen.surface.dx, pen.surface.dy)
    levels = np.round(pen.surface.heights / quantum) + 700
    _of_heights(pen, levels * quantum)
    rows = [["-1" if np.isnan(n) else f"{n:.0f}" for n in row] for row in levels]
    stated = {"unit_z": f"{quantum:.9g} mm", "missing": -1}
    return replace(Sheet(rows, sidecar=stated), surface=pen.surface)


def _saved(pen: Pen, mark: float, **more) -> Sheet:
    _holed(pen)
    stream = io.BytesIO()
    np.save(stream, np.where(np.isnan(pen.heights), mark, pen.heights))
    keys = array_keys(pen, missing=mark, **more)
    return Sheet([], content=stream.getvalue(), ending=".npy", sidecar=keys, surface=pen.surface)


@dialect
def _array_with_zeros_for_missing(pen: Pen) -> Sheet:
    return _saved(pen, 0)


@dialect
def _array_with_a_usual_mark_among_the_heights(pen: Pen) -> Sheet:
    restyle(pen, unit_z="nm")
    return _saved(pen, -999)


@dialect
def _image_with_zeros_for_missing(pen: Pen) -> Sheet:
    from PIL import Image

    _holed(pen)
    low, high = np.nanmin(pen.surface.heights), np.nanmax(pen.surface.heights)
    quantum = float(f"{(high - low) / 50_000:.3g}")
    levels = np.round((pen.surface.heights - low) / quantum) + 2000
    _of_heights(pen, levels * quantum)
    stream = io.BytesIO()
    image = Image.fromarray(np.nan_to_num(levels)[::-1].astype(np.uint16))
    image.save(stream, format="png")
    keys = array_keys(pen, unit_z=f"{quantum:.12g} mm", missing=0, first_row="top")
    stated = {key: value for key, value in keys.items() if key not in ("layout", "axes")}
    sheet = Sheet([], content=stream.getvalue(), ending=".png", sidecar=stated)
    return replace(sheet, surface=pen.surface)


# --- openings ---------------------------------------------------------------------------------


def _apertures(pen: Pen) -> None:
    """Openings, zero where the faces touch; what is read is their negative."""
    heights = np.nan_to_num(pen.surface.heights)
    opening = np.maximum(heights - np.quantile(heights, 0.15), 0)
    rim = np.ones(opening.shape, bool)
    rim[2:-2, 2:-2] = False
    opening[rim] += 0.1 * np.ptp(heights)  # zeros from corner to corner would be outside
    _of_heights(pen, -opening)


@dialect
def _apertures_with_contact(pen: Pen) -> Sheet:
    _apertures(pen)
    front = [pen.remark("aperture map")]
    keys = {"kind": "aperture", "heights": None}
    rows = pen.matrix(0 - pen.heights)
    return Sheet(rows, front, keys, surface=pen.surface)


@dialect
def _apertures_without_a_word(pen: Pen) -> Sheet:
    _apertures(pen)
    keys = {"kind": "aperture", "heights": None}
    return Sheet(pen.matrix(0 - pen.heights), sidecar=keys, surface=pen.surface)


# --- axes -------------------------------------------------------------------------------------


@dialect
def _heights_that_ascend_in_the_first_column(pen: Pen) -> Sheet:
    heights = pen.surface.heights.copy()
    n = np.arange(len(heights))
    heights[:, 0] = np.nanmean(heights) + 0.31 * pen.surface.dx * n
    _of_heights(pen, heights)
    return Sheet(pen.matrix(), surface=pen.surface)


@dialect
def _heights_that_ascend_in_the_first_row(pen: Pen) -> Sheet:
    heights = pen.surface.heights.copy()
    heights[0] = np.nanmean(heights) + 0.27 * pen.surface.dx * np.arange(heights.shape[1])
    _of_heights(pen, heights)
    return Sheet(pen.matrix(), surface=pen.surface)


# --- lengths and units ------------------------------------------------------------------------


def _stated_length(pen: Pen, less: int) -> Sheet:
    unit, (ny, nx) = pen.style.unit_xy, pen.heights.shape
    lengths = [f"{(n - less) * step:.9g}" for n, step in zip((nx, ny), pen.steps(), strict=True)]
    forms = [
        [f"scan length X: {lengths[0]} {unit}", f"scan length Y: {lengths[1]} {unit}"],
        [f"Width: {lengths[0]} {unit}", f"Height: {lengths[1]} {unit}"],
        [f"field: {lengths[0]} x {lengths[1]} {unit}"],
    ]
    lines = [*forms[pen.rng.integers(3)], f"points X: {nx}", f"points Y: {ny}"]
    return Sheet(pen.matrix(), [pen.remark(line) for line in lines])


@dialect
def _length_from_the_first_point_to_the_last(pen: Pen) -> Sheet:
    return _stated_length(pen, 1)


@dialect
def _length_over_whole_cells(pen: Pen) -> Sheet:
    return _stated_length(pen, 0)


@dialect
def _step_of_x_alone(pen: Pen) -> Sheet:
    return Sheet(pen.matrix(), [pen.remark(f"dx = {pen.steps()[0]:.9g} {pen.style.unit_xy}")])


@dialect
def _step_of_another_axis(pen: Pen) -> Sheet:
    lines = ["z step: 0.05 um", "step size of the stage motor: 0.4 um"]
    return Sheet(pen.matrix(), [pen.remark(line) for line in lines])


for _name, _text in {
    "unit in prose": "the stage was calibrated in um before the scan",
    "unit of a spot": "spot size in um: see the certificate",
    "unit of a report": "all results in the report are in inch",
    "unit of a tolerance": "flatness (um) of the table: certificate 12",
    "gap in prose": "gap between scan lines: none",
    "depth of focus": "depth of focus 12 um",
    "origin of coordinates": "origin: lower left",
    "size of a sensor": "pixel size (sensor): 3.45 um",
    "count that looks like a mark": "no data: 0",
    "lines looked down upon": "objective looks down on the sample",
}.items():

    def _draw(pen: Pen, text: str = _text) -> Sheet:
        sheet = Sheet(pen.matrix()[::-1], [pen.remark(text)], {"first_row": "top"})
        return sheet

    DIALECTS[_name] = _draw


# --- digits -----------------------------------------------------------------------------------


def _in_thousands(pen: Pen, mark: str, decimals: int) -> Sheet:
    """Counts of a fine quantum, their digits in groups of three."""
    delimiter = pen.style.delimiter if pen.style.delimiter.strip() in ("", ";") else ";"
    restyle(pen, delimiter=delimiter, exponent="", decimal="," if mark == "." else ".", mark="nan")
    quantum = 1e-5 * min(pen.surface.dx, pen.surface.dy)
    levels = np.round(pen.surface.heights / quantum, decimals) + 5e5
    _of_heights(pen, levels * quantum)
    rows = [
        [
            pen.style.mark
            if np.isnan(n)
            else f"{n:,.{decimals}f}".translate(str.maketrans({",": mark, ".": pen.style.decimal}))
            for n in row
        ]
        for row in levels
    ]
    stated = {"unit_z": f"{quantum:.12g} mm", "thousands": mark}
    return Sheet(rows, sidecar=stated, surface=pen.surface)


@dialect
def _thousands_by_comma(pen: Pen) -> Sheet:
    return _in_thousands(pen, ",", 0)


@dialect
def _thousands_by_point(pen: Pen) -> Sheet:
    return _in_thousands(pen, ".", 0)


@dialect
def _thousands_by_apostrophe(pen: Pen) -> Sheet:
    return _in_thousands(pen, "'", 0)


@dialect
def _thousands_with_decimals(pen: Pen) -> Sheet:
    return _in_thousands(pen, str(pen.rng.choice([",", "."])), 2)


@dialect
def _three_decimals(pen: Pen) -> Sheet:
    """Numbers that could be grouped digits, and are not."""
    delimiter = pen.style.delimiter if pen.style.delimiter.strip() in ("", ";") else ";"
    restyle(pen, delimiter=delimiter, exponent="", mark="nan")
    quantum = 1e-5 * min(pen.surface.dx, pen.surface.dy)
    levels = np.round(pen.surface.heights / quantum) / 1e3 + 200
    _of_heights(pen, levels * quantum)
    rows = [
        ["nan" if np.isnan(n) else f"{n:.3f}".replace(".", pen.style.decimal) for n in row]
        for row in levels
    ]
    return Sheet(rows, sidecar={"unit_z": f"{quantum:.12g} mm"}, surface=pen.surface)


# --- arrays -----------------------------------------------------------------------------------


@dialect
def _raw_and_levelled_heights(pen: Pen) -> Sheet:
    stream = io.BytesIO()
    tilted = pen.heights + pen.x[None, :]
    names = ["height_raw", "height_levelled"]
    chosen = str(pen.rng.choice(names))
    arrays = {name: pen.heights if name == chosen else tilted for name in names}
    np.savez(stream, **arrays)
    keys = array_keys(pen, variable=chosen)
    return Sheet([], content=stream.getvalue(), ending=".npz", sidecar=keys)


@dialect
def _depths_in_an_archive(pen: Pen) -> Sheet:
    stream = io.BytesIO()
    np.savez(stream, depth=-pen.heights)
    keys = array_keys(pen, heights="down")
    return Sheet([], content=stream.getvalue(), ending=".npz", sidecar=keys)


@dialect
def _points_in_an_array(pen: Pen) -> Sheet:
    whole(pen)
    order = [0, 1, 2] if pen.rng.random() < 0.5 else [1, 0, 2]
    stream = io.BytesIO()
    np.save(stream, pen.points()[:, order])
    stated = {"kind": "face", "layout": "points", "columns": order, **pen.unit_sidecar()}
    stated |= {"heights": "up", "missing": "none"}
    return Sheet([], content=stream.getvalue(), ending=".npy", sidecar=stated, surface=pen.surface)


@dialect
def _units_of_coordinates_alone(pen: Pen) -> Sheet:
    """netCDF whose coordinates have a unit and whose heights have none."""

    def write(file):
        for name, values in (("y", pen.y), ("x", pen.x)):
            file.createDimension(name, len(values))
            axis = file.createVariable(name, "f8", (name,))
            axis.units = pen.style.unit_xy.replace("µ", "u")
            axis[:] = values
        file.createVariable("z", "f8", ("y", "x"), fill_value=np.nan)[:] = pen.heights

    return Sheet([], content=netcdf(write), ending=".nc", sidecar=array_keys(pen))
