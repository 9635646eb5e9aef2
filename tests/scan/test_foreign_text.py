"""Text as it comes, by kind: read right, or refused in a sentence that says what to write."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from stated import read_scan

from fractalcontact.core.errors import InputError
from fractalcontact.core.units import length_factor

NY, NX = 12, 10
DX, DY = 0.5, 0.25
Z = np.round(
    0.1 * np.random.default_rng(4).uniform(-1, 1, (NY, NX))
    + 0.02 * np.arange(NX)
    + 0.003 * np.arange(NY)[:, None] ** 2,
    5,
)
MM = {"unit": "mm"}
FULL = {"unit": "mm", "spacing": [DX, DY]}


@dataclass(frozen=True)
class Case:
    """A text; what reading it gives: the heights `Z` times ``times``, or a sentence."""

    kind: str
    text: str
    sidecar: dict = field(default_factory=dict)
    refusal: str = ""
    times: float = 1.0
    ending: str = ".csv"
    steps: tuple = (DX, DY)


def rows(cells, delimiter=",", form="{:.9g}"):
    """Lines of numbers."""
    return "".join(delimiter.join(form.format(v) for v in row) + "\n" for row in cells)


def points(order="xyz", x0=0.0):
    """Columns of x, y and z in any order."""
    y, x = np.indices(Z.shape)
    column = {"x": x0 + DX * x.ravel(), "y": DY * y.ravel(), "z": Z.ravel()}
    column |= {"c": x.ravel(), "r": y.ravel()}
    return np.column_stack([column[name] for name in order])


def framed(x, y, corner="", delimiter=","):
    """A matrix with x above and y beside it."""
    above = delimiter.join([corner, *(f"{v:.6g}" for v in x)]) + "\n"
    return above + rows(np.column_stack([y, Z]), delimiter)


X, Y = DX * np.arange(NX) + 3, DY * np.arange(NY) - 1
PLAIN = rows(Z)

AXES = [
    Case("axes", framed(range(NX), range(NY)), FULL),
    Case("axes", framed(X, Y), MM),
    Case("axes", framed(X, Y, "0"), MM),
    Case("axes", framed(X, Y, "y/x [mm]"), {"unit_z": "mm"}),
    Case("axes", framed(X, Y, "nan", "\t"), MM),
    Case("axes", framed(X, Y, "", ";").replace(".", ","), MM),
    Case("axes", rows(np.column_stack([range(NY), Z])), FULL),
    Case("axes", rows(np.vstack([range(NX), Z])), FULL),
    Case("axes", rows(np.vstack([X, Z])), MM, "states no spacing .*coordinates from 3 to 7.5"),
    Case("axes", framed(X, Y, "x\\y"), MM, "stands in the corner .* write 'y' there"),
    Case("axes", f"# dx = 100 um, dy = 100 um\n{framed(X, Y)}", MM, "header says 100 and 100 um"),
    Case("axes", rows(np.column_stack([Z, Y])), FULL, "last column runs in equal steps"),
    Case("axes", framed(X**2, Y), FULL, "first row rises as coordinates do.*'axes: none'"),
    Case("axes", framed(X, np.exp(Y)), FULL, "first column rises.*export x, y, z"),
]
UNITS = [
    Case(
        "units",
        PLAIN,
        {"unit": unit, "spacing": "1 mm"},
        f"{unit}.*no unit of length known here.*'20 mm'",
    )
    for unit in ("px", "point", "pica", "yard")
]
UNITS += [
    Case("units", f"# unit: {unit}\n{PLAIN}", {"spacing": "1 mm"}, f"says 'unit: {unit}'.*unit: mm")
    for unit in ("px", "point", "pica")
]
UNITS += [
    Case("units", PLAIN, FULL | {"unit_z": unit}, times=length_factor(unit, ""))
    for unit in ("µm", "Micrometer", "0.01 inch", "0.001 feet", "nm")
]
UNITS += [Case("units", PLAIN, FULL | {"unit_z": "-1 um"}, "'-1 um' is not above zero; write")]


def esri(n_rows, n_columns, cells, top=Z[::-1]):
    """An ESRI grid that says this many rows and columns."""
    head = f"ncols {n_columns}\nnrows {n_rows}\nxllcorner 0\nyllcorner 0\n{cells}\n"
    return head + "NODATA_value -9999\n" + rows(top, " ")


GRID = f"dx {DX}\ndy {DY}"
HEADERS = [
    Case("header", esri(NY, NX, GRID), MM, ending=".asc"),
    Case("header", esri(NX, NY, GRID), MM, "promises 10 rows of 12 numbers, it holds 12 of 10"),
    Case("header", esri(NY, NX, GRID, Z[:9]), MM, "promises 12 rows .*holds 9 of 10; export it"),
    Case("header", esri(10**9, 10**9, GRID), MM, "promises 1000000000 rows"),
    Case("header", f"DSAA\n{NX} {NY}\n0 4.5\n0 2.75\n-1 1\n{rows(Z, ' ')}", MM, ending=".grd"),
    Case("header", f"DSAA\n{NX} {NY + 1}\n0 4.5\n0 3\n-1 1\n{rows(Z, ' ')}", MM, "promises 13 rows",
         ending=".grd"),
]  # fmt: skip
UNITS_IN_HEADERS = [
    Case("units in headers", "X [mm],Y [mm],Z [um]\n" + rows(points()), times=1e-3),
    Case("units in headers", "Z_um;Y_mm;X_mm\n" + rows(points("zyx"), ";"), times=1e-3),
    Case("units in headers", "x (um)\ty (mm)\tz (mm)\n" + rows(points() * [1e3, 1, 1], "\t")),
    Case("units in headers", "x,y,z [V]\n" + rows(points()), {}, "it says \"z in 'V'\""),
    Case("units in headers", f"# dx = {DX} mm, dy = {DY} mm\n# heights in um\n{PLAIN}", times=1e-3),
    Case("units in headers", f"# pixel size: 500 x 250 um\n# z unit: mm\n{PLAIN}"),
    Case("units in headers", f"# pixel size: {DX} mm\n{PLAIN}", {"unit_z": "mm"}, steps=(DX, DX)),
    Case("units in headers", f"# unit: mm\n# height factor: 0.01\n{PLAIN}", {"spacing": [DX, DY]},
         times=0.01),
    Case("units in headers", f"# pixel size: 500 x 250 um\n{PLAIN}", MM, "write 'unit_z: mm' if"),
    Case("units in headers", "X [um],Y [um],Z [mm]\n" + rows(points()), MM, "heights in mm, its"),
    Case("units in headers", f"# height factor: 0.01\n{PLAIN}", FULL, "multiplied by 0.01; write"),
    Case("units in headers", f"# height factor: 0.01\n{PLAIN}", FULL | {"unit_z": "0.01 mm"},
         times=0.01),
    Case("units in headers", f"# optical resolution 2 um\n{PLAIN}", {}, "says 'optical resolution"),
    Case("units in headers", f"# maximum: 5 um\n# minimum: 2 um\n{PLAIN}", FULL),
    Case("units in headers", f"# NoData: {Z[3, 3]:.9g}\n{PLAIN}", FULL, "1 cell missing"),
]  # fmt: skip
NAMED = [
    Case("names", "Height,Row,Col\n" + rows(points("zrc")), FULL),
    Case("names", "Height,Row,Col\n" + rows(points("zrc")), MM, "states no spacing"),
    Case("names", "row;z;column\n" + rows(points("rzc"), ";"), FULL),
    Case("names", "Northing,Easting,Elevation\n" + rows(points("yxz")), MM),
    Case("names", "x [px],y [px],z [mm]\n" + rows(points("crz")),
         {"spacing": ["0.5 mm", "0.25 mm"]}),
    Case("names", "time,load,displacement\n" + rows(points()), MM, "time, load, displ.*'columns: "),
    Case("names", "t F s\n" + rows(points(), " "), MM, "are called t, F, s"),
    Case("names", "Slip [mm],Load [kN],Gap [mm]\n" + rows(points()), MM, "which are no x, y and z"),
    Case("names", rows(points("zxy")), MM, r"columns: \[1, 2, 0\]"),
    Case("names", ",".join(f"gauge {c}" for c in "ABCDEFGHIJ") + f"\n{PLAIN}", FULL,
         "different quantities .*'layout: matrix'"),
    Case("names", ",".join(f"V{n}" for n in range(NX)) + f"\n{PLAIN}", FULL),
]  # fmt: skip
SPOILT = PLAIN.splitlines()
TABS = [
    Case("a single tab", "\n".join([SPOILT[0].replace(",", ",\t", 1), *SPOILT[1:]]), FULL),
    Case("a single tab", rows(Z, " ").replace(" ", "\t", 1), FULL),
    Case("a single tab", rows(Z, ";").replace(";", "\t;", 1), FULL),
]
FRONT = [
    Case("counts in front", f"{NY} {NX}\n{rows(Z, ' ')}", FULL),
    Case("counts in front", f"{NX},{NY}\n{PLAIN}", FULL),
    Case("counts in front", f"{Z.size}\n{rows(points(), ' ')}", MM),
    Case("counts in front", f"{NY + 1} {NX}\n{rows(Z, ' ')}", FULL, "first line holds 13 10"),
    Case("counts in front", f"{Z.size + 5}\n{rows(points(), ' ')}", MM, "first line holds 125"),
]
PROGRAMS = [
    Case("programs", "Zygo XYZ Data File - Format 2\n0 1 5\n#\n" + rows(points(), " "), MM,
         r"Zygo instrument; save it as \.datx"),
    Case("programs", '"XY Calibration","0.5","mm/pixel"\n"Z Unit","mm"\n' + PLAIN, steps=(DX, DX)),
    Case("programs", "# Channel: Z\n# Width: 5 mm\n# Height: 3 mm\n# Value units: mm\n"
         + rows(Z[::-1])),
    Case("programs", "# Channel: Z\n# Width: 10 px\n# Height: 12 px\n# Value units: mm\n"
         + rows(Z[::-1]), {"spacing": ["0.5 mm", "0.25 mm"]}),
    Case("programs", "# Channel: Z\n# Width: 10\n# Height: 12\n# Value units: \n" + rows(Z[::-1]),
         FULL),
    Case("programs", "# columns: 10\n# rows: 12\n# unit: mm\n" + PLAIN, {"spacing": [DX, DY]}),
    Case("programs", f"# Channel: U\n# Width: 5 mm\n# Height: 3 mm\n# Value units: V\n{PLAIN}", {},
         "says 'Value units: V'.*unit_z"),
]  # fmt: skip
HOLED = [row.split(",") for row in SPOILT]
HOLED[4][0], HOLED[6][5] = "MARK", "MARK"
HOLED_TEXT = "\n".join(",".join(row) for row in HOLED)
WORDS = [
    Case("marks", HOLED_TEXT.replace("MARK", mark), FULL, "2 cells missing")
    for mark in ("No Data", "#N/A", "1.#QNAN", "void", "")
]
PROFILES = [
    Case("profiles", rows(Z.reshape(-1, 1)), MM, "one column of 120 numbers, a profile"),
    Case("profiles", rows(Z.reshape(1, -1)), MM, "one row of 120 numbers, a profile"),
    Case("profiles", rows(points("xz")), MM, "120 rows of 2 numbers are a profile, distance and"),
    Case("profiles", rows(points("xz").T), MM, "2 rows of 120 numbers are a profile"),
]
STACKED = [
    Case("stacked", f"{PLAIN}\n{PLAIN}", FULL, "2 tables of 12 rows .*NAME.lower and NAME.upper"),
    Case("stacked", f"{PLAIN}# upper\n{rows(Z + 0.1)}", FULL, "2 tables of 12 rows"),
    Case("stacked", PLAIN + rows(Z + 40), FULL, "2 tables of 12 rows"),
    Case("stacked", framed(X, Y) * 2, MM, "2 tables of 12 rows"),
    Case("stacked", rows(np.column_stack([range(NY), Z])) * 3, FULL, "3 tables of 12 rows"),
    Case("stacked", f"x,y,z\n{rows(points())}x,y,z\n{rows(points() * [1, 1, 2])}", MM,
         "2 tables of 120 rows"),
    Case("stacked", f"{PLAIN}Upper face:\n{PLAIN}", FULL,
         "line 13 is not numbers.*files of their own"),
]  # fmt: skip
CASES = [*AXES, *UNITS, *HEADERS, *UNITS_IN_HEADERS, *NAMED, *TABS, *FRONT, *PROGRAMS, *WORDS]
CASES += [*PROFILES, *STACKED]


@pytest.mark.parametrize("case", CASES, ids=[f"{c.kind} {n}" for n, c in enumerate(CASES)])
def test_foreign_text_is_read_right_or_refused(tmp_path, case):
    path = tmp_path / f"rock{case.ending}"
    path.write_text(case.text, encoding="utf-8")
    missing = int(case.refusal.split()[0]) if case.refusal.endswith("missing") else 0
    if case.refusal and not missing:
        with pytest.raises(InputError, match=rf"(?s)rock\{case.ending}.*{case.refusal}"):
            read_scan(path, case.sidecar)
        return
    heights = read_scan(path, case.sidecar)
    spacing = heights.attrs["spacing_x"], heights.attrs["spacing_y"]
    assert spacing == pytest.approx(case.steps, rel=1e-6)
    assert int(heights.isnull().sum()) == missing
    present = heights.notnull().values
    np.testing.assert_allclose(heights.values[present], case.times * Z[present], rtol=1e-6)


def test_heights_that_look_like_coordinates_are_kept_if_the_sidecar_says_so(tmp_path):
    path = tmp_path / "rock.csv"
    path.write_text(rows(np.vstack([0.1 * np.arange(NX), Z])))
    heights = read_scan(path, FULL | {"axes": "none"})
    assert heights.shape == (NY + 1, NX)
    with pytest.raises(InputError, match="key 'axes' is 'yes'; expected none"):
        read_scan(path, FULL | {"axes": "yes"})


@pytest.mark.parametrize("tilt", [(0.3, 0.0), (0.0, -0.2), (0.5, 0.25)])
@pytest.mark.parametrize("roughness", [0.0, 1e-7, 1e-3, 0.1])
def test_no_row_of_a_tilted_surface_is_taken_for_coordinates(tmp_path, tilt, roughness):
    rough = np.random.default_rng(1).uniform(-1, 1, (20, 30))
    heights = tilt[0] * np.arange(30) + tilt[1] * np.arange(20)[:, None] + roughness * rough
    path = tmp_path / "rock.npy"
    np.save(path, heights)
    options = {"unit": "mm", "spacing": 1}
    if roughness == 0 and 0 in tilt:  # nothing but one axis, and no surface
        with pytest.raises(InputError, match="these are coordinates or a bare slope"):
            read_scan(path, options)
    else:
        assert read_scan(path, options).shape == (20, 30)


def test_axes_of_an_array_are_found_whatever_the_format(tmp_path):
    table = np.block([[np.zeros((1, 1)), X[None]], [Y[:, None], Z]])
    np.save(tmp_path / "rock.npy", table)
    heights = read_scan(tmp_path / "rock.npy", MM)
    np.testing.assert_array_equal(heights.values, Z)
    assert (heights.attrs["spacing_x"], heights.attrs["spacing_y"]) == (DX, DY)
    assert "coordinates from 3 to 7.5 of its columns" in heights.attrs["notes"]


@pytest.mark.parametrize("unit", ["px", "point", "pica"])
def test_parts_of_an_inch_are_no_lengths_in_any_format(tmp_path, unit):
    import h5py
    import netCDF4
    import tifffile

    tifffile.imwrite(
        tmp_path / "rock.tif",
        Z.astype("f4"),
        imagej=True,
        resolution=(2, 4),
        metadata={"unit": unit},
    )
    with netCDF4.Dataset(tmp_path / "rock.nc", "w") as file:
        file.createDimension("y", NY)
        file.createDimension("x", NX)
        file.createVariable("z", "f8", ("y", "x"))[:] = Z
        file["z"].units = unit
    with h5py.File(tmp_path / "rock.h5", "w") as file:
        file["z"] = Z
        file["z"].attrs["unit"] = unit
    for ending, said in ((".tif", "x"), (".nc", "z"), (".h5", "z")):
        path = tmp_path / f"rock{ending}"
        with pytest.raises(InputError, match=rf"no unit.*it says \"{said} in '{unit}'\""):
            read_scan(path)
        heights = read_scan(path, FULL)
        assert heights.attrs["spacing_x"] == DX
        assert f"{said} in '{unit}'" in heights.attrs["notes"]
