"""Dialects of lists of points: columns in any order, named or not, with units and company."""

import numpy as np
from dialects import UNSTATABLE, Pen, Sheet, dialect, restyle, whole

SYNONYMS = [("x", "y", "z"), ("X", "Y", "Z"), ("Easting", "Northing", "Elevation"),
            ("x_pos", "y_pos", "height"), ("X coordinate", "Y coordinate", "Z coordinate"),
            ("PosX", "PosY", "Height")]  # fmt: skip


def points_sheet(*args, **keys) -> Sheet:
    """A sheet of points."""
    return Sheet(*args, is_points=True, **keys)


def _rows(pen: Pen, points: np.ndarray) -> list[list[str]]:
    return [[pen.place(x), pen.place(y), pen.number(z)] for x, y, z in points]


def _names(pen: Pen) -> list[str]:
    """Names of x, y, z that one cell each holds."""
    single = [names for names in SYNONYMS if pen.style.delimiter.strip(" ") or " " not in names[0]]
    return list(single[pen.rng.integers(len(single))])


def _permuted(pen: Pen, rows: list[list[str]]) -> list[list[str]]:
    order = pen.rng.permutation(len(rows[0]))
    return [[row[n] for n in order] for row in rows]


@dialect
def _plain_points(pen: Pen) -> Sheet:
    ending = str(pen.rng.choice([".xyz", ".txt", ".csv"]))
    return points_sheet(_rows(pen, pen.points()), ending=ending)


@dialect
def _points_without_missing_rows(pen: Pen) -> Sheet:
    points = pen.points()
    return points_sheet(_rows(pen, points[np.isfinite(points[:, 2])]))


@dialect
def _named_points(pen: Pen) -> Sheet:
    return points_sheet([_names(pen), *_rows(pen, pen.points())], words=1)


@dialect
def _named_points_in_any_order(pen: Pen) -> Sheet:
    names = _names(pen)
    rows = _permuted(pen, [names, *_rows(pen, pen.points())])
    return points_sheet(rows, sidecar={"columns": names}, words=1)


@dialect
def _names_in_a_comment(pen: Pen) -> Sheet:
    front = [pen.remark(pen.join(["x", "y", "z"]))]
    return points_sheet(_rows(pen, pen.points()), front)


def _with_units(pen: Pen, form: str) -> list[str]:
    units = [pen.style.unit_xy, pen.style.unit_xy, pen.style.unit_z]
    return [form.format(name, unit) for name, unit in zip("XYZ", units, strict=True)]


@dialect
def _units_with_the_names(pen: Pen) -> Sheet:
    form = str(pen.rng.choice(["{} [{}]", "{} ({})", "{}[{}]", "{}_{}", "{}/{}"]))
    rows = _permuted(pen, [_with_units(pen, form), *_rows(pen, pen.points())])
    letters = [name.strip('"')[0] for name in rows[0]]
    sidecar = {"columns": [letters.index(axis) for axis in "XYZ"]}
    return points_sheet(rows, sidecar=sidecar, words=1, describes_itself=form[2] in " [(")


@dialect
def _units_of_x_and_y_differ(pen: Pen) -> Sheet:
    restyle(pen, unit_xy="mm")
    points = pen.points()
    points[:, 1] *= 1e3
    names = ["X[mm]", "Y[um]", f"Z[{pen.style.unit_z}]"]
    rows = [names, *_rows(pen, points)]
    return points_sheet(rows, sidecar=UNSTATABLE, words=1, expected="refused")


@dialect
def _units_in_a_line_below_the_names(pen: Pen) -> Sheet:
    style = pen.style
    form = str(pen.rng.choice(["{}", "[{}]", "({})"]))
    units = [form.format(unit) for unit in (style.unit_xy, style.unit_xy, style.unit_z)]
    return points_sheet([_names(pen), units, *_rows(pen, pen.points())], words=2)


@dialect
def _cells_counted_without_names(pen: Pen) -> Sheet:
    return points_sheet(_by_cells(pen), sidecar=_by_cell_keys(pen))


@dialect
def _unit_of_z_that_is_no_length(pen: Pen) -> Sheet:
    names = ["x", "y", f"z[{pen.rng.choice(['V', 'px', 'point', 'counts', 'deg'])}]"]
    return points_sheet([names, *_rows(pen, pen.points())], words=1)


@dialect
def _units_in_comments_before_points(pen: Pen) -> Sheet:
    style = pen.style
    lines = [pen.remark(f"x, y in {style.unit_xy}"), pen.remark(f"z in {style.unit_z}")]
    return points_sheet(_rows(pen, pen.points()), lines)


def _by_cells(pen: Pen) -> list[list[str]]:
    """Number of column, number of row, height."""
    rows, columns = np.indices(pen.heights.shape)
    table = zip(columns.ravel(), rows.ravel(), pen.heights.ravel(), strict=True)
    return [[str(x), str(y), pen.number(z)] for x, y, z in table]


def _by_cell_keys(pen: Pen) -> dict:
    """Of points whose x and y count cells."""
    return {"spacing": pen.steps(), "first_row": "bottom"}


@dialect
def _columns_and_rows(pen: Pen) -> Sheet:
    names = [["Col", "Row", "Height"], ["column", "row", "z"]][pen.rng.integers(2)]
    rows = _permuted(pen, [names, *_by_cells(pen)])
    return points_sheet(rows, sidecar={**_by_cell_keys(pen), "columns": names}, words=1)


@dialect
def _x_and_y_in_pixels(pen: Pen) -> Sheet:
    names = ["x[px]", "y[px]", f"z[{pen.style.unit_z}]"]
    return points_sheet([names, *_by_cells(pen)], sidecar=_by_cell_keys(pen), words=1)


@dialect
def _pixels_of_a_stated_size(pen: Pen) -> Sheet:
    (dx, dy), unit = pen.steps(), pen.style.unit_xy
    line = f"pixel size: {dx} x {dy} {unit}".replace(".", pen.style.decimal)
    return points_sheet(_by_cells(pen), [pen.remark(line)], _by_cell_keys(pen))


@dialect
def _points_with_an_index(pen: Pen) -> Sheet:
    rows = [[str(n), *row] for n, row in enumerate(_rows(pen, pen.points()))]
    first = "" if pen.style.delimiter.strip(" ") else "n"
    return points_sheet([[first, "x", "y", "z"], *rows], sidecar={"columns": [1, 2, 3]}, words=1)


@dialect
def _points_with_colours(pen: Pen) -> Sheet:
    rows = [[*row, *map(str, pen.rng.integers(0, 255, 3))] for row in _rows(pen, pen.points())]
    return points_sheet([["x", "y", "z", "r", "g", "b"], *rows], words=1)


@dialect
def _columns_said_by_the_sidecar(pen: Pen) -> Sheet:
    rows = [[pen.number(7.5), *row[::-1], "1"] for row in _rows(pen, pen.points())]
    return points_sheet(rows, sidecar={"columns": [3, 2, 1]})


@dialect
def _further_columns_without_names(pen: Pen) -> Sheet:
    rows = [[*row, pen.number(7.5), str(n % 7)] for n, row in enumerate(_rows(pen, pen.points()))]
    return points_sheet(rows)


@dialect
def _points_with_normals_and_colours(pen: Pen) -> Sheet:
    whole(pen)
    rng = pen.rng
    company = [
        [*pen.numbers(rng.uniform(-1, 1, 3)), *map(str, rng.integers(0, 255, 3))]
        for _ in range(pen.heights.size)
    ]
    rows = [[*row, *more] for row, more in zip(_rows(pen, pen.points()), company, strict=True)]
    return points_sheet(rows, surface=pen.surface)


@dialect
def _heights_first(pen: Pen) -> Sheet:
    rows = [row[::-1] for row in _rows(pen, pen.points())]
    return points_sheet(rows, sidecar={"columns": [2, 1, 0]})


@dialect
def _gaps_between_scan_lines(pen: Pen) -> Sheet:
    between = dict.fromkeys(range(pen.x.size, pen.heights.size, pen.x.size), "")
    return points_sheet(_rows(pen, pen.points("rows")), between=between)


@dialect
def _count_of_points_in_front(pen: Pen) -> Sheet:
    return points_sheet(_rows(pen, pen.points()), [str(pen.heights.size)])


@dialect
def _two_clouds_under_one_another(pen: Pen) -> Sheet:
    whole(pen)
    points = pen.points()
    other = points * [1, 1, 0.5]
    rows = [*_rows(pen, points), *_rows(pen, other)]
    between = {len(points): pen.join(["x", "y", "z"])}
    front = [pen.join(["x", "y", "z"])]
    return points_sheet(rows, front, {}, between, expected="refused")


@dialect
def _record_of_a_test(pen: Pen) -> Sheet:
    names = [
        ["time", "load", "displacement"],
        ["t", "F", "s"],
        ["Time [s]", "Load [kN]", "Slip [mm]"],
    ]
    chosen = names[pen.rng.integers(3 if pen.style.delimiter.strip(" ") else 1)]
    rows = _rows(pen, pen.points("rows"))
    sidecar = {"kind": "profile"}
    return points_sheet([chosen, *rows], sidecar=sidecar, words=1, expected="refused")


@dialect
def _zygo_text(pen: Pen) -> Sheet:
    restyle(pen, delimiter=" ", decimal=".", mark="No Data", trailing=False)
    front = ["Zygo XYZ Data File - Format 2", '0 1 5 1 "Thu May 26 2005"', "0 0 0 0 0 0"]
    front += ['"granite"', "0 0.5 6.328e-07 0 1 0 1e-06 1117090800", "#"]
    return points_sheet(_by_cells(pen), front, _by_cell_keys(pen), expected="either")
