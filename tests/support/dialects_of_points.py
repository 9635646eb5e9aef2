"""Dialects of lists of points: columns in any order, named or not, with units and company."""

import numpy as np
from dialects import Pen, Sheet, dialect, restyle, whole

SYNONYMS = [("x", "y", "z"), ("X", "Y", "Z"), ("Easting", "Northing", "Elevation"),
            ("x_pos", "y_pos", "height"), ("X coordinate", "Y coordinate", "Z coordinate"),
            ("PosX", "PosY", "Height")]  # fmt: skip


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
    return Sheet(_rows(pen, pen.points()), sidecar=pen.unit_sidecar(), ending=ending)


@dialect
def _points_without_missing_rows(pen: Pen) -> Sheet:
    points = pen.points()
    return Sheet(_rows(pen, points[np.isfinite(points[:, 2])]), sidecar=pen.unit_sidecar())


@dialect
def _named_points(pen: Pen) -> Sheet:
    return Sheet([_names(pen), *_rows(pen, pen.points())], sidecar=pen.unit_sidecar())


@dialect
def _named_points_in_any_order(pen: Pen) -> Sheet:
    rows = _permuted(pen, [_names(pen), *_rows(pen, pen.points())])
    return Sheet(rows, sidecar=pen.unit_sidecar())


@dialect
def _names_in_a_comment(pen: Pen) -> Sheet:
    front = [pen.remark(pen.join(["x", "y", "z"]))]
    return Sheet(_rows(pen, pen.points()), front, pen.unit_sidecar())


def _with_units(pen: Pen, form: str) -> list[str]:
    units = [pen.style.unit_xy, pen.style.unit_xy, pen.style.unit_z]
    return [form.format(name, unit) for name, unit in zip("XYZ", units, strict=True)]


@dialect
def _units_with_the_names(pen: Pen) -> Sheet:
    form = str(pen.rng.choice(["{} [{}]", "{} ({})", "{}[{}]", "{}_{}", "{}/{}"]))
    rows = _permuted(pen, [_with_units(pen, form), *_rows(pen, pen.points())])
    return Sheet(rows, states_units=True)


@dialect
def _units_of_x_and_y_differ(pen: Pen) -> Sheet:
    restyle(pen, unit_xy="mm")
    points = pen.points()
    points[:, 1] *= 1e3
    names = ["X[mm]", "Y[um]", f"Z[{pen.style.unit_z}]"]
    return Sheet([names, *_rows(pen, points)], states_units=True)


@dialect
def _units_in_a_line_below_the_names(pen: Pen) -> Sheet:
    style = pen.style
    form = str(pen.rng.choice(["{}", "[{}]", "({})"]))
    units = [form.format(unit) for unit in (style.unit_xy, style.unit_xy, style.unit_z)]
    return Sheet([_names(pen), units, *_rows(pen, pen.points())], states_units=True)


@dialect
def _cells_counted_without_names(pen: Pen) -> Sheet:
    return Sheet(_by_cells(pen), sidecar=pen.matrix_sidecar())


@dialect
def _unit_of_z_that_is_no_length(pen: Pen) -> Sheet:
    names = ["x", "y", f"z[{pen.rng.choice(['V', 'px', 'point', 'counts', 'deg'])}]"]
    return Sheet([names, *_rows(pen, pen.points())], sidecar=pen.unit_sidecar())


@dialect
def _units_in_comments_before_points(pen: Pen) -> Sheet:
    style = pen.style
    lines = [pen.remark(f"x, y in {style.unit_xy}"), pen.remark(f"z in {style.unit_z}")]
    return Sheet(_rows(pen, pen.points()), lines, states_units=True)


def _by_cells(pen: Pen) -> list[list[str]]:
    """Number of column, number of row, height."""
    rows, columns = np.indices(pen.heights.shape)
    table = zip(columns.ravel(), rows.ravel(), pen.heights.ravel(), strict=True)
    return [[str(x), str(y), pen.number(z)] for x, y, z in table]


@dialect
def _columns_and_rows(pen: Pen) -> Sheet:
    names = [["Col", "Row", "Height"], ["column", "row", "z"]][pen.rng.integers(2)]
    rows = _permuted(pen, [names, *_by_cells(pen)])
    return Sheet(rows, sidecar=pen.matrix_sidecar())


@dialect
def _x_and_y_in_pixels(pen: Pen) -> Sheet:
    names = ["x[px]", "y[px]", f"z[{pen.style.unit_z}]"]
    sidecar = pen.matrix_sidecar()
    sidecar.pop("unit_z")
    return Sheet([names, *_by_cells(pen)], sidecar=sidecar)


@dialect
def _pixels_of_a_stated_size(pen: Pen) -> Sheet:
    (dx, dy), unit = pen.steps(), pen.style.unit_xy
    line = f"pixel size: {dx} x {dy} {unit}".replace(".", pen.style.decimal)
    sidecar = {"unit_z": pen.unit_sidecar()["unit_z"]}
    return Sheet(_by_cells(pen), [pen.remark(line)], sidecar)


@dialect
def _points_with_an_index(pen: Pen) -> Sheet:
    rows = [[str(n), *row] for n, row in enumerate(_rows(pen, pen.points()))]
    first = "" if pen.style.delimiter.strip(" ") else "n"
    return Sheet([[first, "x", "y", "z"], *rows], sidecar=pen.unit_sidecar())


@dialect
def _points_with_colours(pen: Pen) -> Sheet:
    rows = [[*row, *map(str, pen.rng.integers(0, 255, 3))] for row in _rows(pen, pen.points())]
    return Sheet([["x", "y", "z", "r", "g", "b"], *rows], sidecar=pen.unit_sidecar())


@dialect
def _columns_said_by_the_sidecar(pen: Pen) -> Sheet:
    rows = [[pen.number(7.5), *row[::-1], "1"] for row in _rows(pen, pen.points())]
    return Sheet(rows, sidecar={**pen.unit_sidecar(), "columns": [3, 2, 1]})


@dialect
def _further_columns_without_names(pen: Pen) -> Sheet:
    rows = [[*row, pen.number(7.5), str(n % 7)] for n, row in enumerate(_rows(pen, pen.points()))]
    return Sheet(rows, sidecar=pen.unit_sidecar(), expected="refused")


@dialect
def _points_with_normals_and_colours(pen: Pen) -> Sheet:
    whole(pen)
    rng = pen.rng
    company = [
        [*pen.numbers(rng.uniform(-1, 1, 3)), *map(str, rng.integers(0, 255, 3))]
        for _ in range(pen.heights.size)
    ]
    rows = [[*row, *more] for row, more in zip(_rows(pen, pen.points()), company, strict=True)]
    return Sheet(rows, sidecar=pen.matrix_sidecar(), expected="refused")


@dialect
def _heights_first(pen: Pen) -> Sheet:
    rows = [row[::-1] for row in _rows(pen, pen.points())]
    return Sheet(rows, sidecar=pen.unit_sidecar(), expected="refused")


@dialect
def _gaps_between_scan_lines(pen: Pen) -> Sheet:
    between = dict.fromkeys(range(pen.x.size, pen.heights.size, pen.x.size), "")
    return Sheet(_rows(pen, pen.points("rows")), sidecar=pen.unit_sidecar(), between=between)


@dialect
def _count_of_points_in_front(pen: Pen) -> Sheet:
    return Sheet(_rows(pen, pen.points()), [str(pen.heights.size)], pen.unit_sidecar())


@dialect
def _two_clouds_under_one_another(pen: Pen) -> Sheet:
    whole(pen)
    points = pen.points()
    other = points * [1, 1, 0.5]
    rows = [*_rows(pen, points), *_rows(pen, other)]
    between = {len(points): pen.join(["x", "y", "z"])}
    front = [pen.join(["x", "y", "z"])]
    return Sheet(rows, front, pen.unit_sidecar(), between, expected="refused")


@dialect
def _record_of_a_test(pen: Pen) -> Sheet:
    names = [
        ["time", "load", "displacement"],
        ["t", "F", "s"],
        ["Time [s]", "Load [kN]", "Slip [mm]"],
    ]
    chosen = names[pen.rng.integers(3 if pen.style.delimiter.strip(" ") else 1)]
    rows = _rows(pen, pen.points("rows"))
    return Sheet([chosen, *rows], sidecar=pen.unit_sidecar(), expected="refused")


@dialect
def _zygo_text(pen: Pen) -> Sheet:
    restyle(pen, delimiter=" ", decimal=".", mark="No Data", trailing=False)
    front = ["Zygo XYZ Data File - Format 2", '0 1 5 1 "Thu May 26 2005"', "0 0 0 0 0 0"]
    front += ['"granite"', "0 0.5 6.328e-07 0 1 0 1e-06 1117090800", "#"]
    return Sheet(_by_cells(pen), front, pen.unit_sidecar(), expected="refused")
