"""Dialects whose words mean something else than they seem to, and files cut off or packed."""

import io
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from dialects import DIALECTS, Pen, Sheet, dialect, restyle, whole
from foreign_words import foreign_lines

#: Lines that were once taken for a spacing, a unit, an orientation or a mark.
_LINES = {
    "joint spacing": "joint spacing: 20 mm",
    "load step": "load step: 5",
    "sampling length": "sampling length: 0.8 mm",
    "angular increment": "angular increment: 2 deg",
    "calibration interval": "calibration interval: 12 months",
    "bolt spacing without unit": "bolt spacing = 3",
    "pixel size of the camera": "pixel size of the camera: 3.45 um",
    "step height of the standard": "step height of the standard: 1.8 um",
    "number of missing points": "missing: 0",
    "missing counted": "invalid = 12",
    "positive down of another thing": "water table, positive: down 4 m",
    "upper austria": "origin: Upper Austria",
    "top of a quarry": "first row of blast holes at the top of the bench",
    "unit weight": "unit weight: 26 kN/m3",
    "unit of the report": "report in inch",
    "scale of a map": "scale: 0.001",
    "heights of the building": "height factor: 2",
    "decimal comma in a date": "date: 12,5,2024",
    "axes described": "x axis in mm, z axis in um",
    "ranges": "x from 0 to 12 cm, y from 0 to 3 m",
}


def _under_a_line(text: str):
    def draw(pen: Pen) -> Sheet:
        line = pen.remark(text)
        if pen.rng.random() < 0.5:
            points = [[pen.place(x), pen.place(y), pen.number(z)] for x, y, z in pen.points()]
            return Sheet(points, [line], is_points=True)
        return Sheet(pen.matrix(), [line])

    return draw


for _name, _text in _LINES.items():
    DIALECTS[_name] = _under_a_line(_text)


@dialect
def _foreign_words_over_a_matrix(pen: Pen) -> Sheet:
    lines = [pen.remark(line) for line in foreign_lines(pen.rng, 8)]
    return Sheet(pen.matrix(), lines)


@dialect
def _foreign_words_over_points(pen: Pen) -> Sheet:
    lines = [pen.remark(line) for line in foreign_lines(pen.rng, 8)]
    points = [[pen.place(x), pen.place(y), pen.number(z)] for x, y, z in pen.points()]
    return Sheet(points, lines, is_points=True)


@dialect
def _foreign_words_without_comment_marks(pen: Pen) -> Sheet:
    return Sheet(pen.matrix(), [f"note: {line}" for line in foreign_lines(pen.rng, 5)])


@dialect
def _depths(pen: Pen) -> Sheet:
    lines = [pen.remark("Depth, positive downwards")]
    return Sheet(pen.matrix(-pen.heights), lines, {"heights": "down"})


@dialect
def _depths_in_columns(pen: Pen) -> Sheet:
    restyle(pen, delimiter=";")
    points = [[pen.place(x), pen.place(y), pen.number(-z)] for x, y, z in pen.points()]
    names = ["x", "y", "depth"]
    return Sheet([names, *points], [], {"heights": "down"}, words=1, is_points=True)


@dialect
def _rows_wrapped_at_ten_numbers(pen: Pen) -> Sheet:
    heights = pen.surface.heights[:, : 10 * (pen.surface.heights.shape[1] // 10)]
    heights = np.hstack([heights, heights[:, ::-1] * 0.7])
    pen.__init__(replace(pen.surface, heights=heights), pen.style, pen.rng)  # type: ignore[misc]
    cells = [cell for row in pen.matrix() for cell in row]
    rows = [cells[n : n + 10] for n in range(0, len(cells), 10)]
    front = [pen.remark(f"nx: {heights.shape[1]}"), pen.remark(f"ny: {heights.shape[0]}")]
    return replace(Sheet(rows, front, expected="refused"), surface=pen.surface)


@dialect
def _thousands(pen: Pen) -> Sheet:
    mark = {",": ".", ".": ","}[pen.style.decimal]
    restyle(pen, delimiter=";", exponent="")
    quantum = 1e-5 * min(pen.surface.dx, pen.surface.dy)
    levels = np.round(pen.surface.heights / quantum) + 5e5
    heights = levels * quantum
    pen.__init__(replace(pen.surface, heights=heights), pen.style, pen.rng)  # type: ignore[misc]
    rows = [[pen.style.mark if np.isnan(n) else f"{n:,.0f}".replace(",", mark) for n in row]
            for row in levels]  # fmt: skip
    stated = {"unit_z": f"{quantum:.12g} mm", "thousands": mark}
    return replace(Sheet(rows, sidecar=stated), surface=pen.surface)


def _cut(pen: Pen, **more) -> Sheet:
    """A matrix of numbers in a fixed form, its last number cut off."""
    restyle(pen, trailing=False, final_end=False, mark="nan")
    whole(pen)
    rows = [[f"{z:.6e}".replace(".", pen.style.decimal) for z in row] for row in pen.heights]
    rows[-1][-1] = rows[-1][-1][: -int(pen.rng.integers(1, 4))]
    return Sheet(rows, expected="refused", **more)


@dialect
def _last_number_cut_off(pen: Pen) -> Sheet:
    return _cut(pen)


@dialect
def _last_decimals_cut_off(pen: Pen) -> Sheet:
    restyle(pen, trailing=False, final_end=False, mark="nan", exponent="")
    whole(pen)
    rows = [[f"{z:.9f}".replace(".", pen.style.decimal) for z in row] for row in pen.heights]
    rows[-1][-1] = rows[-1][-1][:-4]
    return Sheet(rows, expected="refused")


@dialect
def _last_row_cut_off(pen: Pen) -> Sheet:
    sheet = Sheet(pen.matrix(), expected="refused")
    sheet.rows[-1] = sheet.rows[-1][:-3]
    restyle(pen, trailing=False)
    return sheet


# --- files that are no text -----------------------------------------------------------------------

_ARRAY = {"kind": "face", "layout": "matrix", "axes": "none", "first_row": "bottom",
          "heights": "up", "missing": "none"}  # fmt: skip


def array_keys(pen: Pen, **more) -> dict:
    return {**_ARRAY, **pen.matrix_sidecar(), **more}


@dialect
def _array(pen: Pen) -> Sheet:
    stream = io.BytesIO()
    np.save(stream, pen.heights)
    return Sheet([], content=stream.getvalue(), ending=".npy", sidecar=array_keys(pen))


@dialect
def _arrays_in_an_archive(pen: Pen) -> Sheet:
    stream = io.BytesIO()
    np.savez(stream, depth=pen.heights[::-1], Z=pen.heights, x=pen.x, dx=3.0)
    keys = array_keys(pen, variable="Z")
    return Sheet([], content=stream.getvalue(), ending=".npz", sidecar=keys)


@dialect
def _matlab_file_with_another_dx(pen: Pen) -> Sheet:
    from scipy.io import savemat

    stream = io.BytesIO()
    savemat(stream, {"Z": pen.heights, "dx": 7.0})
    return Sheet([], content=stream.getvalue(), ending=".mat", sidecar=array_keys(pen))


def netcdf(write) -> bytes:
    """Bytes of a netCDF file that a function fills."""
    import netCDF4

    with TemporaryDirectory() as folder:
        path = Path(folder) / "rock.nc"
        with netCDF4.Dataset(path, "w") as file:
            write(file)
        return path.read_bytes()


def _labelled(pen: Pen, *, packed=False, **attributes) -> Sheet:
    """A CF-conforming file; ``packed``: of heights and coordinates as integers."""
    surface = pen.surface
    ny, nx = surface.heights.shape

    def write(file):
        for name, n, step in (("y", ny, surface.dy), ("x", nx, surface.dx)):
            file.createDimension(name, n)
            axis = file.createVariable(name, "i2" if packed else "f8", (name,))
            axis.units = "mm"
            if packed:
                axis.scale_factor = step / 7
            axis[:] = step * np.arange(n)
        kind = "i4" if packed else "f8"
        fill = -(2**31) if packed else np.nan
        z = file.createVariable("z", kind, ("y", "x"), fill_value=fill)
        z.units = "mm"
        if packed:
            z.scale_factor, z.add_offset = 1e-9, 0.25
        z.setncatts(attributes)
        z.set_auto_mask(False)
        sign = -1 if attributes.get("positive") == "down" else 1
        z[:] = np.ma.masked_invalid(sign * surface.heights)

    content = netcdf(write)
    return Sheet([], content=content, ending=".nc", describes_itself=True)


@dialect
def _netcdf_plain(pen: Pen) -> Sheet:
    return _labelled(pen)


@dialect
def _netcdf_packed_coordinates(pen: Pen) -> Sheet:
    return _labelled(pen, packed=True)


@dialect
def _netcdf_positive_down(pen: Pen) -> Sheet:
    return _labelled(pen, positive="down")


@dialect
def _netcdf_valid_range_of_unpacked_numbers(pen: Pen) -> Sheet:
    top = 2 * float(np.nanmax(np.abs(pen.surface.heights)))
    return _labelled(pen, packed=True, valid_range=np.array([-top, top]))


@dialect
def _netcdf_unsigned(pen: Pen) -> Sheet:
    quantum = 1e-4 * min(pen.surface.dx, pen.surface.dy)
    levels = np.round(pen.surface.heights / quantum) + 30_000
    heights = (levels - 30_000) * quantum
    pen.__init__(replace(pen.surface, heights=heights), pen.style, pen.rng)  # type: ignore[misc]
    ny, nx = heights.shape

    def write(file):
        for name, n, step in (("y", ny, pen.surface.dy), ("x", nx, pen.surface.dx)):
            file.createDimension(name, n)
            axis = file.createVariable(name, "f8", (name,))
            axis.units = "mm"
            axis[:] = step * np.arange(n)
        z = file.createVariable("z", "i2", ("y", "x"), fill_value=-1)
        z.set_auto_maskandscale(False)
        z.setncatts({"units": "mm", "_Unsigned": "true", "scale_factor": quantum,
                     "add_offset": -30_000 * quantum})  # fmt: skip
        stored = np.nan_to_num(levels, nan=65535).astype(np.uint16).view(np.int16)
        z[:] = stored

    sheet = Sheet([], content=netcdf(write), ending=".nc", describes_itself=True)
    return replace(sheet, surface=pen.surface)


@dialect
def _netcdf_without_units(pen: Pen) -> Sheet:
    def write(file):
        for name, n in zip(("y", "x"), pen.heights.shape, strict=True):
            file.createDimension(name, n)
            file.createVariable(name, "f8", (name,))[:] = np.arange(n)
        file.createVariable("z", "f8", ("y", "x"), fill_value=np.nan)[:] = pen.heights

    return Sheet([], content=netcdf(write), ending=".nc", sidecar=array_keys(pen))


def _tiff(pen: Pen, tags: list, stored: np.ndarray, **keys) -> Sheet:
    import tifffile

    stream = io.BytesIO()
    tifffile.imwrite(stream, stored, extratags=tags)
    stated = {key: value for key, value in array_keys(pen, **keys).items()
              if key not in ("layout", "axes")}  # fmt: skip
    return Sheet([], content=stream.getvalue(), ending=".tif", sidecar=stated)


@dialect
def _tiff_from_the_top(pen: Pen) -> Sheet:
    return _tiff(pen, [], pen.heights[::-1].astype(np.float64), first_row="top")


@dialect
def _tiff_with_gdals_scale_and_offset(pen: Pen) -> Sheet:
    scale, offset = 0.01, float(np.round(np.nanmean(pen.heights), 2))
    metadata = (
        f'<GDALMetadata><Item name="OFFSET" sample="0" role="offset">{offset}</Item>'
        f'<Item name="SCALE" sample="0" role="scale">{scale}</Item></GDALMetadata>'
    )
    stored = (pen.heights - offset) / scale
    stored = np.where(np.isnan(stored), -9999, stored)
    tags = [(42112, "s", 0, metadata, True), (42113, "s", 0, "-9999", True)]
    return _tiff(pen, tags, stored)


@dialect
def _png_of_grey_levels(pen: Pen) -> Sheet:
    from PIL import Image

    whole(pen)
    quantum = float(f"{np.ptp(pen.surface.heights) / 60_000:.3g}")
    low = pen.surface.heights.min()
    levels = np.round((pen.surface.heights - low) / quantum)
    surface = replace(pen.surface, heights=levels * quantum)
    stream = io.BytesIO()
    Image.fromarray(levels.astype(np.uint16)).save(stream, format="png")
    keys = array_keys(pen, unit_z=f"{quantum:.12g} mm")
    stated = {key: value for key, value in keys.items() if key not in ("layout", "axes")}
    sheet = Sheet([], content=stream.getvalue(), ending=".png", sidecar=stated)
    return replace(sheet, surface=surface)
