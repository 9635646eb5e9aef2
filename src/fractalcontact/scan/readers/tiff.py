"""Height maps in TIFF files of one channel: floating point or 16 and more bits."""

import math
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, foreign_units, reading, refuse_larger, stated_unit
from ..tables import choose_array

PARK_TAG = 50432  # Park Systems keep the heights of their microscopes in tags of their own
_PIXEL_SCALE, _NODATA = 33550, 42113  # GeoTIFF's and GDAL's tags
_UPRIGHT = 1


def read_tiff(path: Path, options: ScanOptions) -> RawScan:
    """Read a page of a TIFF file as heights; its first row is the top.

    ImageJ's unit, GeoTIFF's pixel size and GDAL's number for missing cells are used. Dots per inch
    are not: most programs write them without meaning anything.

    Raises
    ------
    InputError
        If the file is damaged, a colour image, or grey in 8 bits; the last is read if the sidecar
        says ``unit_z``, so that somebody has thought of what a grey level means.
    """
    import tifffile

    with reading(path, "TIFF file"), tifffile.TiffFile(path) as file:
        names = [f"page {number}" for number in range(1, len(file.pages) + 1)]
        name = choose_array(names, options.variable, path)
        page = file.pages[names.index(name)]
        _refuse_images(page, options, path)
        refuse_larger(math.prod(page.shape) * 8, path)
        values = page.asarray().astype(np.float64)
        if values.shape != page.shape:
            raise ValueError(f"pixels of shape {values.shape}, its header promises {page.shape}")
        stated = _imagej(file, page) or _geotiff(page)
        missing = _nodata(page)
    notes: tuple[str, ...] = (f"{name} of {len(names)}",) if len(names) > 1 else ()
    if page.dtype is not None and page.dtype.itemsize == 1:
        notes += ("8 bits: heights in 256 steps at most",)
    return RawScan(
        values,
        "matrix",
        reader=f"tifffile {tifffile.__version__} / tiff",
        first_row="top",
        missing=missing,
        notes=notes,
        **stated,
    )


def is_plain_tiff(path: Path) -> bool:
    """Tell plain TIFF from the files of Park Systems' microscopes."""
    import tifffile

    with reading(path, "TIFF file"), tifffile.TiffFile(path) as file:
        return PARK_TAG not in file.pages[0].tags  # type: ignore[union-attr]  # no frame


def _refuse_images(page, options: ScanOptions, path: Path) -> None:
    """Refuse what is a picture and no map of heights."""
    if page.samplesperpixel != 1 or page.colormap is not None or len(page.shape) != 2:
        raise InputError(
            f"{path}: a colour image, no heights; export the heights themselves, for example as "
            "32-bit TIFF"
        )
    if page.dtype is None or page.dtype.kind not in "fiu" or page.bitspersample < 8:
        raise InputError(
            f"{path}: pixels of {page.bitspersample} bits are no heights; export 32-bit"
        )
    if page.bitspersample == 8 and options.unit_z is None:
        raise InputError(
            f"{path}: a grey image of 8 bits, a picture rather than heights; export 32-bit TIFF, "
            "or write what a grey level is in the sidecar: 'unit_z: um'"
        )
    orientation = page.tags.valueof("Orientation", _UPRIGHT)
    if orientation != _UPRIGHT:
        raise InputError(f"{path}: the image is stored turned ({orientation}); save it upright")


def _imagej(file, page) -> dict | None:
    """Pixel size and unit as ImageJ writes them: pixels in a unit of its own description."""
    said = (file.imagej_metadata or {}).get("unit")
    if foreign := foreign_units(x=said):
        return {"unread": foreign}
    unit = stated_unit(said)
    pixels = [page.tags.valueof(f"{axis}Resolution") for axis in "XY"]
    if unit is None or None in pixels or 0 in (n for pair in pixels for n in pair):
        return None
    dx, dy = (denominator / numerator for numerator, denominator in pixels)
    return {"spacing": (dx, dy), "unit_xy": unit}


def _geotiff(page) -> dict:
    """Pixel size of a GeoTIFF, in a unit the sidecar has to say."""
    scale = page.tags.valueof(_PIXEL_SCALE)
    return {} if scale is None else {"spacing": (float(scale[0]), float(scale[1]))}


def _nodata(page) -> float | None:
    text = page.tags.valueof(_NODATA)
    return None if text is None else float(str(text).strip("\0 "))


FORMAT = Format(read_tiff, endings=(".tif", ".tiff"), takes=is_plain_tiff, libraries=("tifffile",))
