"""Dialects of matrices: axes beside them, headers and comments before them, programs' own text."""

from dataclasses import replace

import numpy as np
from dialects import FACTORS, NOISE, UNSTATABLE, Pen, Sheet, dialect, plain_unit, restyle, whole


@dialect
def _plain_matrix(pen: Pen) -> Sheet:
    return Sheet(pen.matrix())


@dialect
def _matrix_from_the_top(pen: Pen) -> Sheet:
    return Sheet(pen.matrix()[::-1], sidecar={"first_row": "top"})


def _framed(pen: Pen, corner: str | None, above: list[str], beside: list[str]) -> list[list[str]]:
    """A matrix between a row and a column; no corner at all if it is None."""
    head = above if corner is None else [corner, *above]
    return [head, *([side, *row] for side, row in zip(beside, pen.matrix(), strict=True))]


def _counts(values, start: int = 0) -> list[str]:
    return [str(number + start) for number in range(len(values))]


def _places(pen: Pen, values, offset: float = 0.0) -> list[str]:
    return [pen.place(value + offset) for value in values]


def _frame_of_counts(pen: Pen) -> dict:
    """A frame that counts rows and columns: the spacing is not in it."""
    return {"axes": "both", "spacing": pen.steps()}


@dialect
def _frame_with_indices(pen: Pen) -> Sheet:
    corner = "" if pen.style.delimiter.strip(" ") else "0"
    rows = _framed(pen, corner, _counts(pen.x), _counts(pen.y))
    return Sheet(rows, sidecar=_frame_of_counts(pen))


@dialect
def _frame_with_indices_from_1(pen: Pen) -> Sheet:
    corner = "" if pen.style.delimiter.strip(" ") else "0"
    rows = _framed(pen, corner, _counts(pen.x, 1), _counts(pen.y, 1))
    return Sheet(rows, sidecar=_frame_of_counts(pen))


@dialect
def _index_of_rows_alone(pen: Pen) -> Sheet:
    rows = [[str(n), *row] for n, row in enumerate(pen.matrix())]
    return Sheet(rows, sidecar={"axes": "column"})


@dialect
def _index_of_columns_alone(pen: Pen) -> Sheet:
    return Sheet([_counts(pen.x), *pen.matrix()], sidecar={"axes": "row"})


def _coordinates(pen: Pen, corner: str | None, **more) -> Sheet:
    """Coordinates on both sides, which say the spacing."""
    restyle(pen, trailing=False)
    offsets = pen.rng.choice([0.0, 10.0, -3.5], 2)
    rows = _framed(pen, corner, _places(pen, pen.x, offsets[0]), _places(pen, pen.y, offsets[1]))
    return Sheet(rows, sidecar={"axes": "both"}, **more)


@dialect
def _coordinates_without_corner(pen: Pen) -> Sheet:
    return _coordinates(pen, None)


@dialect
def _coordinates_with_empty_corner(pen: Pen) -> Sheet:
    return _coordinates(pen, "" if pen.style.delimiter.strip(" ") else "nan")


@dialect
def _coordinates_with_corner_0(pen: Pen) -> Sheet:
    return _coordinates(pen, "0")


@dialect
def _coordinates_with_words_in_the_corner(pen: Pen) -> Sheet:
    return _coordinates(pen, str(pen.rng.choice(["y\\x", "y/x", "Y|X", "pos"])))


@dialect
def _coordinates_with_unit_in_the_corner(pen: Pen) -> Sheet:
    unit = pen.style.unit_xy
    return _coordinates(pen, f"y/x[{unit}]")


@dialect
def _coordinates_with_units(pen: Pen) -> Sheet:
    if not pen.style.delimiter.strip(" "):
        restyle(pen, delimiter=";")
    sheet = _coordinates(pen, "y")
    sheet.rows[0][1:] = [f"{cell} {pen.style.unit_xy}" for cell in sheet.rows[0][1:]]
    return replace(sheet, expected="refused")


@dialect
def _coordinates_from_the_top(pen: Pen) -> Sheet:
    sheet = _coordinates(pen, "0")
    sheet.rows[1:] = sheet.rows[:0:-1]
    return sheet


@dialect
def _coordinates_from_the_right(pen: Pen) -> Sheet:
    sheet = _coordinates(pen, "0")
    sheet.rows = [[row[0], *row[:0:-1]] for row in sheet.rows]
    return sheet


@dialect
def _coordinates_whose_corner_names_x(pen: Pen) -> Sheet:
    corner = str(pen.rng.choice(["x", "x\\y", "X/Y"]))
    return _coordinates(pen, corner)


@dialect
def _coordinates_and_a_pixel_size(pen: Pen) -> Sheet:
    sheet = _coordinates(pen, "0")
    unit = "um" if pen.style.unit_xy != "um" else "mm"
    dx, dy = (step / FACTORS[unit] for step in (pen.surface.dx, pen.surface.dy))
    line = pen.remark(f"dx = {dx:.9g} {unit}; dy = {dy:.9g} {unit}")
    return replace(sheet, front=[line.replace(".", pen.style.decimal)], expected="either")


@dialect
def _coordinates_behind(pen: Pen) -> Sheet:
    rows = [[*row, side] for row, side in zip(pen.matrix(), _places(pen, pen.y), strict=True)]
    restyle(pen, trailing=False)
    return Sheet(rows, sidecar={**UNSTATABLE, "axes": None}, expected="refused")


@dialect
def _coordinates_of_x_alone(pen: Pen) -> Sheet:
    return Sheet([_places(pen, pen.x), *pen.matrix()], sidecar={"axes": "row"})


@dialect
def _coordinates_of_y_alone(pen: Pen) -> Sheet:
    beside = _places(pen, pen.y, 5.0)
    rows = [[side, *row] for side, row in zip(beside, pen.matrix(), strict=True)]
    return Sheet(rows, sidecar={"axes": "column"})


@dialect
def _coordinates_in_a_comment(pen: Pen) -> Sheet:
    return Sheet(pen.matrix(), [pen.remark(pen.join(_places(pen, pen.x)))])


@dialect
def _uneven_coordinates(pen: Pen) -> Sheet:
    x, y = (values + 0.0 for values in (pen.x, pen.y))
    x[4:] += 3.3 * x[1]
    y[6:] += 7.7 * y[1]
    rows = _framed(pen, "0", _places(pen, x, 100.0), _places(pen, y, 100.0))
    return Sheet(rows, sidecar={"axes": "both"}, expected="refused")


@dialect
def _rows_numbered_with_gaps(pen: Pen) -> Sheet:
    rows = [[str(n + (n > 3) + 2 * (n > 7)), *row] for n, row in enumerate(pen.matrix())]
    return Sheet(rows, sidecar={"axes": "column"}, expected="refused")


@dialect
def _numbered_names(pen: Pen) -> Sheet:
    stem = str(pen.rng.choice(["V", "c", "X", "col_", "Column "]))
    if not pen.style.delimiter.strip(" "):
        stem = stem.strip()
    names = [f"{stem}{n + 1}" for n in range(pen.x.size)]
    return Sheet([names, *pen.matrix()], words=1)


@dialect
def _statisticians_table(pen: Pen) -> Sheet:
    restyle(pen, delimiter=",", decimal=".", mark="NA", trailing=False)
    names = ['""', *(f'"V{n + 1}"' for n in range(pen.x.size))]
    rows = [[f'"{n + 1}"', *row] for n, row in enumerate(pen.matrix())]
    return Sheet([names, *rows], sidecar={"axes": "column"}, words=1)


@dialect
def _spreadsheet_letters(pen: Pen) -> Sheet:
    names = [chr(ord("A") + n) for n in range(pen.x.size)]
    return Sheet([names, *pen.matrix()], words=1)


@dialect
def _quoted_numbers(pen: Pen) -> Sheet:
    restyle(pen, delimiter=";" if pen.style.decimal == "," else ",", mark="NaN", trailing=False)
    rows = [[f'"{cell}"' for cell in row] for row in pen.matrix()]
    return Sheet(rows)


@dialect
def _title(pen: Pen) -> Sheet:
    return Sheet(pen.matrix(), ["Surface of a granite crack", ""])


@dialect
def _comments_of_no_meaning(pen: Pen) -> Sheet:
    lines = pen.rng.permutation(NOISE)[:5]
    return Sheet(pen.matrix(), [pen.remark(line) for line in lines])


@dialect
def _comments_between_rows(pen: Pen) -> Sheet:
    between = {n: pen.remark(f"row {n}") for n in range(1, pen.y.size, 2)}
    return Sheet(pen.matrix(), between=between)


@dialect
def _double_spaced(pen: Pen) -> Sheet:
    between = dict.fromkeys(range(1, pen.y.size), "")
    return Sheet(pen.matrix(), between=between)


def _stated(pen: Pen, lines: list[str], sidecar: dict | None = None) -> Sheet:
    """A matrix under lines that state something."""
    lines = [pen.remark(line.replace(".", pen.style.decimal)) for line in lines]
    return Sheet(pen.matrix(), lines, sidecar or {})


def _square(pen: Pen) -> None:
    pen.__init__(replace(pen.surface, dy=pen.surface.dx), pen.style, pen.rng)  # type: ignore[misc]


@dialect
def _pixel_size(pen: Pen) -> Sheet:
    _square(pen)
    key = pen.rng.choice(["pixel size", "Pixelsize", "spacing", "Step size", "pitch", "cell size"])
    line = f"{key}{pen.rng.choice([': ', ' = ', ' '])}{pen.steps()[0]} {pen.style.unit_xy}"
    return replace(_stated(pen, [line]), surface=pen.surface)


@dialect
def _pixel_size_of_two(pen: Pen) -> Sheet:
    dx, dy = pen.steps()
    return _stated(pen, [f"Pixel size: {dx} x {dy} {pen.style.unit_xy}"])


@dialect
def _steps_in_one_line(pen: Pen) -> Sheet:
    (dx, dy), unit = pen.steps(), pen.style.unit_xy
    return _stated(pen, [f"dx = {dx} {unit}; dy = {dy} {unit}"])


@dialect
def _steps_in_two_lines(pen: Pen) -> Sheet:
    (dx, dy), unit = pen.steps(), pen.style.unit_xy
    lines = [f"x step: {dx} {unit}", f"y step: {dy} {unit}", f"z unit: {pen.style.unit_z}"]
    return _stated(pen, lines)


@dialect
def _keys_of_a_program(pen: Pen) -> Sheet:
    (dx, dy), unit = pen.steps(), pen.style.unit_xy
    lines = [
        f"PixelSizeX [{unit}]: {dx}",
        f"PixelSizeY [{unit}]: {dy}",
        f"Height [{pen.style.unit_z}]",
    ]
    return _stated(pen, lines)


@dialect
def _steps_without_unit(pen: Pen) -> Sheet:
    dx, dy = pen.steps()
    return _stated(pen, [f"dx: {dx}", f"dy: {dy}"])


@dialect
def _unit_line(pen: Pen) -> Sheet:
    restyle(pen, unit_z=pen.style.unit_xy)
    return _stated(pen, [f"unit: {pen.style.unit_xy}"])


@dialect
def _units_in_a_sentence(pen: Pen) -> Sheet:
    style = pen.style
    line = f"x, y in {style.unit_xy}, heights in {style.unit_z}"
    return _stated(pen, ["export of the profilometer", line])


@dialect
def _factor_with_unit(pen: Pen) -> Sheet:
    (dx, dy), factor = pen.steps(), float(pen.rng.choice([0.001, 0.5, 2.0]))
    lines = [f"dx: {dx} {pen.style.unit_xy}", f"dy: {dy} {pen.style.unit_xy}"]
    lines.append(f"{pen.rng.choice(['z scale', 'height factor'])}: {factor} {pen.style.unit_z}")
    sheet = _stated(pen, lines, {"unit_z": f"{factor} {plain_unit(pen.style.unit_z)}"})
    sheet.rows = pen.matrix(pen.heights / factor)
    return sheet


@dialect
def _factor_without_unit(pen: Pen) -> Sheet:
    sidecar = {"unit_z": f"0.01 {plain_unit(pen.style.unit_z)}"}
    sheet = _stated(pen, ["scale factor: 0.01"], sidecar)
    sheet.rows = pen.matrix(pen.heights / 0.01)
    return sheet


@dialect
def _missing_stated(pen: Pen) -> Sheet:
    restyle(pen, mark="-9999")
    key = pen.rng.choice(["NoData: ", "missing value = ", "no data value: ", "fill value "])
    return _stated(pen, [f"{key}-9999"])


@dialect
def _first_row_stated(pen: Pen) -> Sheet:
    sheet = _stated(pen, ["first row: top"], {"first_row": "top"})
    sheet.rows = sheet.rows[::-1]
    return sheet


@dialect
def _unit_that_is_none(pen: Pen) -> Sheet:
    unit = pen.rng.choice(["px", "point", "pica", "V", "a.u.", "counts"])
    return _stated(pen, [f"unit: {unit}"])


def _gwyddion(pen: Pen, words: tuple[str, str, str, str]) -> Sheet:
    restyle(pen, delimiter="\t", trailing=False)
    width, height = (
        n * step for n, step in zip((pen.x.size, pen.y.size), pen.steps(), strict=True)
    )
    unit, decimal = pen.style.unit_xy, pen.style.decimal
    lines = [f"# {words[0]}: a 1", f"# {words[1]}: {width:.9f} {unit}".replace(".", decimal)]
    lines += [f"# {words[2]}: {height:.9f} {unit}".replace(".", decimal)]
    lines += [f"# {words[3]}: {pen.style.unit_z}"]
    return Sheet(pen.matrix()[::-1], lines, {"first_row": "top"})


@dialect
def _gwyddion_in_english(pen: Pen) -> Sheet:
    return _gwyddion(pen, ("Channel", "Width", "Height", "Value units"))


@dialect
def _gwyddion_in_german(pen: Pen) -> Sheet:
    return _gwyddion(pen, ("Kanal", "Breite", "Höhe", "Werteinheiten"))


@dialect
def _gwyddion_in_french(pen: Pen) -> Sheet:
    return _gwyddion(pen, ("Canal", "Largeur", "Hauteur", "Unités"))


def _esri(pen: Pen, rows: int, columns: int, cells: list[str], **more) -> Sheet:
    mark = "-9999"
    restyle(pen, delimiter=" ", mark=mark, exponent="", decimal=".", trailing=False)
    front = [f"ncols {columns}", f"nrows {rows}", "xllcorner 0.0", "yllcorner 0.0", *cells]
    front.append(f"NODATA_value {mark}")
    sidecar = {"first_row": "top", "missing": -9999}
    return Sheet(pen.matrix()[::-1], front, sidecar, ending=".asc", **more)


@dialect
def _esri_grid(pen: Pen) -> Sheet:
    _square(pen)
    sheet = _esri(pen, pen.y.size, pen.x.size, [f"cellsize {pen.steps()[0]}"])
    return replace(sheet, surface=pen.surface)


@dialect
def _esri_grid_of_oblong_cells(pen: Pen) -> Sheet:
    dx, dy = pen.steps()
    return _esri(pen, pen.y.size, pen.x.size, [f"dx {dx}", f"dy {dy}"])


@dialect
def _esri_grid_that_contradicts_itself(pen: Pen) -> Sheet:
    rows, columns = pen.y.size, pen.x.size
    wrong = [(columns, rows), (rows + 1, columns), (rows, 2 * columns), (10**9, 10**9)]
    rows, columns = wrong[pen.rng.integers(len(wrong))]
    return _esri(pen, rows, columns, [f"cellsize {pen.steps()[0]}"], expected="refused")


@dialect
def _surfer_grid(pen: Pen) -> Sheet:
    restyle(pen, delimiter=" ", mark="1.70141e+38", exponent="", decimal=".", trailing=False)
    front = ["DSAA", f"{pen.x.size} {pen.y.size}", f"{pen.x[0]:.9g} {pen.x[-1]:.9g}"]
    front += [f"{pen.y[0]:.9g} {pen.y[-1]:.9g}", "-1 1"]
    ending = str(pen.rng.choice([".grd", ".txt", ".asc"]))
    restyle(pen, encoding="latin-1")
    of_format = ("delimiter", "decimal", "header", "layout", "axes", "spacing", "first_row")
    return Sheet(pen.matrix(), front, dict.fromkeys((*of_format, "missing")), ending=ending)


@dialect
def _counts_in_front(pen: Pen) -> Sheet:
    counts = [f"{pen.y.size} {pen.x.size}", f"{pen.x.size} {pen.y.size}", str(pen.y.size)]
    counts.append(pen.join([str(pen.y.size), str(pen.x.size)]))
    return Sheet(pen.matrix(), [counts[pen.rng.integers(4)]])


@dialect
def _counts_that_contradict(pen: Pen) -> Sheet:
    counts = f"{pen.y.size + 3} {pen.x.size + 5}"
    return Sheet(pen.matrix(), [counts], expected="refused")


@dialect
def _stray_tab(pen: Pen) -> Sheet:
    delimiter = {",": ",", ";": ";"}.get(pen.style.delimiter.strip(), " ")
    restyle(pen, delimiter=delimiter, mark="nan")
    rows = pen.matrix()
    place = pen.rng.integers(3)
    rows[place][4] = f"\t{rows[place][4]}" if delimiter != " " else rows[place][4]
    if delimiter == " ":
        rows[place][4:6] = [f"{rows[place][4]}\t{rows[place][5]}"]
    return Sheet(rows)


@dialect
def _typographers_minus(pen: Pen) -> Sheet:
    restyle(pen, mark="nan")
    rows = [[cell.replace("-", "\u2212") for cell in row] for row in pen.matrix()]
    return Sheet(rows)


@dialect
def _whole_numbers(pen: Pen) -> Sheet:
    quantum = 1e-3 * min(pen.surface.dx, pen.surface.dy)
    levels = np.round(pen.surface.heights / quantum)
    pen.__init__(replace(pen.surface, heights=levels * quantum), pen.style, pen.rng)  # type: ignore[misc]
    rows = [[pen.style.mark if np.isnan(n) else f"{n:.0f}" for n in row] for row in levels]
    sidecar = {"unit_z": f"{quantum:.9g} mm"}
    return replace(Sheet(rows, sidecar=sidecar), surface=pen.surface)


@dialect
def _row_without_any_height(pen: Pen) -> Sheet:
    heights = pen.surface.heights.copy()
    heights[5] = np.nan
    pen.__init__(replace(pen.surface, heights=heights), pen.style, pen.rng)  # type: ignore[misc]
    return replace(Sheet(pen.matrix()), surface=pen.surface)


@dialect
def _commas_for_everything(pen: Pen) -> Sheet:
    whole(pen)
    restyle(pen, delimiter=",", decimal=".", exponent="", trailing=False)
    rows = [[f"{cell / np.nanmax(np.abs(pen.heights)):.6f}" for cell in row] for row in pen.heights]
    rows = [[cell.replace(".", ",") for cell in row] for row in rows]
    return Sheet(rows, sidecar={"decimal": ","}, expected="refused")


@dialect
def _two_matrices_with_a_gap(pen: Pen) -> Sheet:
    rows = pen.matrix()
    line = str(pen.rng.choice(["", pen.remark("upper face")]))
    between = {len(rows): line}
    return Sheet(rows * 2, between=between, expected="refused")


@dialect
def _two_frames_under_one_another(pen: Pen) -> Sheet:
    restyle(pen, trailing=False)
    corner = "" if pen.style.delimiter.strip(" ") else "0"
    rows = _framed(pen, corner, _counts(pen.x), _counts(pen.y))
    return Sheet(rows * 2, sidecar=_frame_of_counts(pen), expected="refused")


@dialect
def _profile(pen: Pen) -> Sheet:
    heights = pen.heights.ravel()
    rows = [
        [[cell] for cell in pen.numbers(heights)],
        [[pen.number(0.1 * n, 3), cell] for n, cell in enumerate(pen.numbers(heights))],
        [pen.numbers(heights)],
    ][pen.rng.integers(3)]
    restyle(pen, mark="nan")
    return Sheet(rows, sidecar={"kind": "profile"}, expected="refused")


@dialect
def _keyence_header(pen: Pen) -> Sheet:
    _square(pen)
    restyle(pen, delimiter=",", decimal=".", trailing=False)
    unit = pen.style.unit_xy
    front = ['"Measured data"', f'"XY Calibration","{pen.steps()[0]}","{unit}/pixel"']
    front += [f'"Z Unit","{plain_unit(pen.style.unit_z)}"', '"Height"']
    sheet = Sheet(pen.matrix(), front)
    return replace(sheet, surface=pen.surface)


@dialect
def _wide_record(pen: Pen) -> Sheet:
    words = ["time", "load", "displacement", "strain", "temperature", "cycle"]
    names = [words[n] if n < len(words) else f"gauge{chr(97 + n)}" for n in range(pen.x.size)]
    return Sheet([names, *pen.matrix()], sidecar={"kind": "profile"}, words=1, expected="refused")
