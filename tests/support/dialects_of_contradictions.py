"""Files that contradict their sidecar, to be refused, and sound arrays, meshes and images."""

import io
import struct
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from dialects import Pen, Sheet, dialect, restyle, whole
from dialects_of_meaning import array_keys, netcdf
from dialects_of_points import points_sheet


def _plain_rows(pen: Pen) -> list[list[str]]:
    restyle(pen, trailing=False, mark="nan")
    whole(pen)
    return pen.matrix()


# --- headers and tables -----------------------------------------------------------------------


@dialect
def _header_over_rows_of_heights(pen: Pen) -> Sheet:
    rows = _plain_rows(pen)
    lines = int(pen.rng.integers(1, 4))
    return Sheet(rows, sidecar={"header": lines}, expected="refused", surface=pen.surface)


@dialect
def _header_over_points(pen: Pen) -> Sheet:
    rows = [[pen.place(x), pen.place(y), pen.number(z)] for x, y, z in pen.points()]
    return points_sheet(rows, sidecar={"header": int(pen.rng.integers(1, 4))}, expected="refused")


def _parting_line(pen: Pen) -> str:
    return str(pen.rng.choice(["", pen.remark("summary"), pen.remark("---")]))


@dialect
def _row_of_means_below_a_line(pen: Pen) -> Sheet:
    rows = _plain_rows(pen)
    between = {len(rows): _parting_line(pen)}
    rows.append(pen.numbers(pen.heights.mean(axis=0)))
    return Sheet(rows, between=between, expected="refused")


@dialect
def _smaller_table_below_a_line(pen: Pen) -> Sheet:
    rows = _plain_rows(pen)
    between = {len(rows): _parting_line(pen)}
    rows += pen.numbers(pen.heights.std(axis=0)), *rows[2:5]
    return Sheet(rows, between=between, expected="refused")


@dialect
def _cloud_of_another_size_below_a_line(pen: Pen) -> Sheet:
    whole(pen)
    points = pen.points("rows")
    rows = [[pen.place(x), pen.place(y), pen.number(z)]
            for x, y, z in [*points, *(points[5 : len(points) // 2] * [1, 1, 0.5])]]  # fmt: skip
    between = {len(points): _parting_line(pen)}
    return points_sheet(rows, between=between, expected="refused")


def _wrapped(pen: Pen, form: str) -> Sheet:
    """Rows of an even number of columns, each in two lines, below a line of the size."""
    heights = np.nan_to_num(pen.surface.heights)
    heights = np.hstack([heights, 0.7 * heights[:, ::-1]])
    pen.__init__(replace(pen.surface, heights=heights), pen.style, pen.rng)  # type: ignore[misc]
    restyle(pen, trailing=False)
    ny, nx = heights.shape
    half = nx // 2
    rows = [part for row in pen.matrix() for part in (row[:half], row[half:])]
    front = [pen.remark(line) for line in form.format(nx=nx, ny=ny).split("\n")]
    return Sheet(rows, front, expected="refused", surface=pen.surface)


@dialect
def _wrapped_under_dimensions(pen: Pen) -> Sheet:
    return _wrapped(pen, "DIMENSIONS {nx} {ny} 1")


@dialect
def _wrapped_under_a_product(pen: Pen) -> Sheet:
    forms = ["{nx} x {ny}", "size: {nx} x {ny} points", "{nx}×{ny}", "matrix ({nx} * {ny})"]
    return _wrapped(pen, str(pen.rng.choice(forms)))


@dialect
def _wrapped_under_width_and_height(pen: Pen) -> Sheet:
    forms = ["width={nx} height={ny}", "width: {nx}\nheight: {ny}", "xsize {nx}; ysize {ny}",
             "points X: {nx}\npoints Y: {ny}", "cols = {nx}, rows = {ny}"]  # fmt: skip
    return _wrapped(pen, str(pen.rng.choice(forms)))


def _with_cell(pen: Pen, cell: str) -> Sheet:
    """One cell of a whole matrix that holds no height, and is not stated."""
    rows = _plain_rows(pen)
    row, column = pen.rng.integers(len(rows)), pen.rng.integers(1, len(rows[0]) - 1)
    rows[row][column] = cell
    heights = pen.surface.heights.copy()
    heights[row, column] = np.nan
    surface = replace(pen.surface, heights=heights)
    return Sheet(rows, sidecar={"missing": "none"}, expected="refused", surface=surface)


@dialect
def _infinite_cell(pen: Pen) -> Sheet:
    return _with_cell(pen, str(pen.rng.choice(["inf", "-inf", "Inf", "INF", "Infinity"])))


@dialect
def _number_beyond_all_numbers(pen: Pen) -> Sheet:
    return _with_cell(pen, str(pen.rng.choice(["1e400", "-1E+999", "9e308000"])))


@dialect
def _empty_cell_unstated(pen: Pen) -> Sheet:
    if not pen.style.delimiter.strip(" "):
        restyle(pen, delimiter=";")
    return _with_cell(pen, "")


# --- netCDF -----------------------------------------------------------------------------------


def _cf(pen: Pen, x: dict, y: dict, z: dict, order="yx", flip=False, **more) -> Sheet:
    """A CF-conforming file with these attributes of its coordinates and heights."""
    surface = pen.surface
    down = str(z.get("positive", "")).strip().lower().startswith("down")
    heights = -surface.heights if down else surface.heights
    heights = heights[::-1] if flip else heights
    ny, nx = surface.heights.shape
    places = {"x": surface.dx * np.arange(nx), "y": surface.dy * np.arange(ny)}
    places["y"] = places["y"][::-1] if flip else places["y"]

    def write(file):
        for name, attributes in (("y", y), ("x", x)):
            file.createDimension(name, len(places[name]))
            axis = file.createVariable(name, "f8", (name,))
            axis.setncatts({"units": "mm", **attributes})
            axis[:] = places[name]
        variable = file.createVariable("z", "f8", tuple(order), fill_value=np.nan)
        variable.setncatts({"units": "mm", **z})
        variable[:] = heights if order == "yx" else heights.T

    return Sheet([], content=netcdf(write), ending=".nc", describes_itself=True, **more)


@dialect
def _netcdf_positive_in_other_words(pen: Pen) -> Sheet:
    words = ["DOWN ", "downward", "Downwards", " down", "Down", "DOWNWARD"]
    return _cf(pen, {}, {}, {"positive": str(pen.rng.choice(words))})


@dialect
def _netcdf_positive_up_in_other_words(pen: Pen) -> Sheet:
    words = ["UP ", "upward", "Upwards", " up", "Up"]
    return _cf(pen, {}, {}, {"positive": str(pen.rng.choice(words))})


@dialect
def _netcdf_positive_of_no_meaning(pen: Pen) -> Sheet:
    word = str(pen.rng.choice(["below", "unten", "-z", "south"]))
    sheet = _cf(pen, {}, {}, {"positive": word}, expected="refused")
    return replace(sheet, describes_itself=False)


@dialect
def _netcdf_axes_that_contradict(pen: Pen) -> Sheet:
    x = {"axis": "X", "standard_name": "projection_y_coordinate"}
    y = {"axis": "Y", "standard_name": "projection_x_coordinate"}
    sheet = _cf(pen, x, y, {}, expected="refused")
    return replace(sheet, describes_itself=False)


@dialect
def _netcdf_axes_in_other_letters(pen: Pen) -> Sheet:
    x = {"axis": "x ", "standard_name": "Projection_X_Coordinate "}
    return _cf(pen, x, {"axis": " Y"}, {})


@dialect
def _netcdf_columns_first(pen: Pen) -> Sheet:
    return _cf(pen, {}, {}, {}, order="xy")


@dialect
def _netcdf_from_the_top(pen: Pen) -> Sheet:
    return _cf(pen, {"axis": "X"}, {"axis": "Y"}, {}, flip=True)


# --- arrays -----------------------------------------------------------------------------------


@dialect
def _array_in_the_order_of_fortran(pen: Pen) -> Sheet:
    stream = io.BytesIO()
    kind = str(pen.rng.choice([">f8", "<f4", ">f4", "<f8"]))
    np.save(stream, np.asfortranarray(pen.heights.astype(kind)))
    return Sheet([], content=stream.getvalue(), ending=".npy", sidecar=array_keys(pen))


@dialect
def _array_of_integers(pen: Pen) -> Sheet:
    _whole_levels(pen)
    stream = io.BytesIO()
    levels = np.round(pen.surface.heights / _QUANTUM)
    np.save(stream, levels.astype(str(pen.rng.choice(["<i4", ">i4", "<i8"]))))
    keys = array_keys(pen, unit_z=f"{_QUANTUM} mm")
    return Sheet([], content=stream.getvalue(), ending=".npy", sidecar=keys, surface=pen.surface)


@dialect
def _matlab_file_of_version_4(pen: Pen) -> Sheet:
    from scipy.io import savemat

    stream = io.BytesIO()
    savemat(stream, {"Z": pen.heights}, format="4")
    return Sheet([], content=stream.getvalue(), ending=".mat", sidecar=array_keys(pen))


@dialect
def _dataset_in_a_group(pen: Pen) -> Sheet:
    import h5py

    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        file.create_dataset("scan/z", data=pen.heights, compression="gzip", shuffle=True)
        file["scan/time"] = np.arange(5.0)
    return Sheet([], content=stream.getvalue(), ending=".h5", sidecar=array_keys(pen))


# --- meshes -----------------------------------------------------------------------------------


def _mesh(pen: Pen) -> tuple[np.ndarray, np.ndarray]:
    """Vertices in the file's unit, and triangles, of whole heights in one unit."""
    restyle(pen, unit_z=pen.style.unit_xy)
    whole(pen)
    ny, nx = pen.heights.shape
    number = np.arange(ny * nx).reshape(ny, nx)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    faces = [np.stack(corners, -1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))]
    y, x = np.indices((ny, nx))
    vertices = np.column_stack([pen.x[x.ravel()], pen.y[y.ravel()], pen.heights.ravel()])
    return vertices, np.concatenate(faces)


def _mesh_sheet(pen: Pen, content: bytes, ending: str) -> Sheet:
    unit = {"unit": pen.style.unit_xy.replace("µ", "u")}
    return Sheet([], content=content, ending=ending, sidecar=unit, surface=pen.surface)


def _text_of(lines: list[str]) -> bytes:
    return ("\n".join(lines) + "\n").encode()


def _line(numbers, form=".9g") -> str:
    return " ".join(f"{number:{form}}" for number in numbers)


@dialect
def _ply_in_text_with_normals(pen: Pen) -> Sheet:
    vertices, faces = _mesh(pen)
    front = ["ply", "format ascii 1.0", "comment made by hand", f"element vertex {len(vertices)}"]
    front += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz")]
    front += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    rows = [f"{_line(vertex)} 0 0 1" for vertex in vertices]
    rows += [f"3 {_line(face, 'd')}" for face in faces]
    return _mesh_sheet(pen, _text_of(front + rows), ".ply")


@dialect
def _ply_in_bytes(pen: Pen) -> Sheet:
    vertices, faces = _mesh(pen)
    order, name = [("<", "little"), (">", "big")][pen.rng.integers(2)]
    front = ["ply", f"format binary_{name}_endian 1.0", f"element vertex {len(vertices)}"]
    front += [f"property double {axis}" for axis in "xyz"]
    front += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    content = _text_of(front) + vertices.astype(f"{order}f8").tobytes()
    content += b"".join(struct.pack(f"{order}B3i", 3, *face) for face in faces)
    return _mesh_sheet(pen, content, ".ply")


@dialect
def _ply_cloud(pen: Pen) -> Sheet:
    vertices, _ = _mesh(pen)
    front = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    front += [*(f"property float {axis}" for axis in "xyz"), "end_header"]
    return _mesh_sheet(pen, _text_of(front + [_line(vertex) for vertex in vertices]), ".ply")


@dialect
def _obj_with_normals(pen: Pen) -> Sheet:
    vertices, faces = _mesh(pen)
    form = ["{0}//1", "{0}", "{0}/1", "{0}/1/1"][pen.rng.integers(4)]
    lines = ["# made by hand", "o rock", *(f"v {_line(vertex)}" for vertex in vertices)]
    lines += ["vt 0 0", "vn 0 0 1", "s off"]
    lines += ["f " + " ".join(form.format(n + 1) for n in face) for face in faces]
    return _mesh_sheet(pen, _text_of(lines), ".obj")


@dialect
def _stl_in_text(pen: Pen) -> Sheet:
    vertices, faces = _mesh(pen)
    lines = ["solid rock"]
    for face in faces:
        lines += ["facet normal 0 0 1", " outer loop"]
        lines += [f"  vertex {_line(vertices[n], '.9e')}" for n in face]
        lines += [" endloop", "endfacet"]
    return _mesh_sheet(pen, _text_of([*lines, "endsolid rock"]), ".stl")


@dialect
def _stl_in_bytes(pen: Pen) -> Sheet:
    vertices, faces = _mesh(pen)
    content = b"made by hand".ljust(80) + struct.pack("<I", len(faces))
    for face in faces:
        content += struct.pack("<12fH", 0, 0, 1, *vertices[face].ravel(), 0)
    return _mesh_sheet(pen, content, ".stl")


# --- images -----------------------------------------------------------------------------------

_QUANTUM = 1e-4  # mm


def _whole_levels(pen: Pen) -> None:
    """Heights in whole multiples of a quantum, without missing cells."""
    whole(pen)
    heights = np.round(pen.surface.heights / _QUANTUM) * _QUANTUM
    pen.__init__(replace(pen.surface, heights=heights), pen.style, pen.rng)  # type: ignore[misc]


def _image_keys(pen: Pen, **more) -> dict:
    keys = array_keys(pen, **more)
    return {key: value for key, value in keys.items() if key not in ("layout", "axes")}


def _tiff(pen: Pen, stored: np.ndarray, keys: dict, **options) -> Sheet:
    import tifffile

    with TemporaryDirectory() as folder:
        path = Path(folder) / "rock.tif"
        tifffile.imwrite(path, stored, **options)
        content = path.read_bytes()
    return Sheet([], content=content, ending=".tif", sidecar=keys, surface=pen.surface)


@dialect
def _tiff_of_another_byte_order(pen: Pen) -> Sheet:
    stored = pen.heights[::-1].astype(np.float32)
    options = [{"byteorder": ">"}, {"rowsperstrip": 3}, {"tile": (16, 16)}, {"bigtiff": True}]
    return _tiff(pen, stored, _image_keys(pen, first_row="top"), **options[pen.rng.integers(4)])


@dialect
def _tiff_deflated(pen: Pen) -> Sheet:
    stored = pen.heights[::-1].astype(np.float32)
    return _tiff(pen, stored, _image_keys(pen, first_row="top"), compression="zlib")


@dialect
def _tiff_of_signed_counts(pen: Pen) -> Sheet:
    _whole_levels(pen)
    stored = np.round(pen.surface.heights / _QUANTUM).astype(np.int16)
    return _tiff(pen, stored, _image_keys(pen, unit_z=f"{_QUANTUM} mm"))


@dialect
def _png_from_the_top(pen: Pen) -> Sheet:
    from PIL import Image

    _whole_levels(pen)
    levels = np.round(pen.surface.heights / _QUANTUM)
    levels -= levels.min() - 7
    pen.__init__(replace(pen.surface, heights=levels * _QUANTUM), pen.style, pen.rng)  # type: ignore[misc]
    stream = io.BytesIO()
    Image.fromarray(levels[::-1].astype(np.uint16)).save(stream, format="png")
    keys = _image_keys(pen, unit_z=f"{_QUANTUM} mm", first_row="top")
    return Sheet([], content=stream.getvalue(), ending=".png", sidecar=keys, surface=pen.surface)
