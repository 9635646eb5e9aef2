"""Height maps in TIFF files of one channel: floating point or 16 and more bits."""

import math
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..draft import Hints, image_hints
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger, stated_unit
from ..stated import Needs, require_stated
from ..tables import choose_array
from ..tiff_codecs import refuse_unknown_coding, use_codecs

PARK_TAG = 50432  # Park Systems keep the heights of their microscopes in tags of their own
_PIXEL_SCALE, _NODATA, _GDAL = 33550, 42113, 42112  # GeoTIFF's and GDAL's tags
_UPRIGHT = 1


def read_tiff(path: Path, options: ScanOptions) -> RawScan:
    """Heights in a page of a TIFF file, as its sidecar states.

    GDAL's scale, offset and number for missing cells are used. A pixel size that ImageJ or a
    GeoTIFF states is only compared with the sidecar's. Grey levels of 8 bits are read only with a
    stated ``unit_z``, so that somebody has thought of what a level means.
    """
    import tifffile

    use_codecs()
    with reading(path, "TIFF file"), tifffile.TiffFile(path) as file:
        names = [f"page {number}" for number in range(1, len(file.pages) + 1)]
        page = file.pages[0 if options.variable not in names else names.index(options.variable)]
        _refuse_images(page, options, path)
        # The draft below reads the picture, so its coding is checked first.
        refuse_larger(math.prod(page.shape) * 8, path)
        refuse_unknown_coding(page, path)
        stated = _imagej(file, page) or _geotiff(page)
        needs = Needs(arrays=names)
        require_stated(path, options, needs, lambda: _hints(names, stated, page))
        name = choose_array(names, options.variable, path)  # refused unless it is that of `page`
        values = page.asarray().astype(np.float64)
        if values.shape != page.shape:
            raise ValueError(f"pixels of shape {values.shape}, its header promises {page.shape}")
        missing = _nodata(page)
        if missing is not None:
            values[np.isclose(values, missing, rtol=1e-6, atol=0)] = np.nan
        scale, offset = _gdal_scale(page, path)
        values = values * scale + offset
    notes: tuple[str, ...] = (f"{name} of {len(names)}",) if len(names) > 1 else ()
    if page.dtype is not None and page.dtype.itemsize == 1:
        notes += ("8 bits: heights in 256 steps at most",)
    return RawScan(
        values,
        "matrix",
        reader=f"tifffile {tifffile.__version__} / tiff",
        notes=notes,
        **stated,
    )


def is_plain_tiff(path: Path) -> bool:
    """Distinguish plain TIFF from the files of Park Systems' microscopes."""
    import tifffile

    with reading(path, "TIFF file"), tifffile.TiffFile(path) as file:
        return PARK_TAG not in file.pages[0].tags  # type: ignore[union-attr]  # no frame


def _refuse_images(page, options: ScanOptions, path: Path) -> None:
    """Refuse pictures that are no map of heights."""
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
            "or write the height of a grey level into the sidecar: 'unit_z: um'"
        )
    orientation = page.tags.valueof("Orientation", _UPRIGHT)
    if orientation != _UPRIGHT:
        raise InputError(f"{path}: the image is stored turned ({orientation}); save it upright")


def _imagej(file, page) -> dict | None:
    """Pixel size and unit as ImageJ writes them: pixels in a unit of its own description."""
    said = (file.imagej_metadata or {}).get("unit")
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


def _gdal_scale(page, path: Path) -> tuple[float, float]:
    """Scale and offset that GDAL states for the numbers of a page, 1 and 0 if none."""
    from defusedxml import ElementTree

    text = page.tags.valueof(_GDAL)
    factors = {"scale": 1.0, "offset": 0.0}
    if text is not None:
        for item in ElementTree.fromstring(str(text).strip("\0 ")).iter("Item"):
            if item.get("sample", "0") == "0" and item.get("role") in factors:
                factors[str(item.get("role"))] = float(item.text or "nan")
    if not all(map(math.isfinite, factors.values())):
        raise InputError(f"{path}: GDAL's scale or offset is no number; export it again")
    return factors["scale"], factors["offset"]


def _hints(names: list[str], stated: dict, page) -> Hints:
    """Hints of an image on its cells."""
    refuse_larger(math.prod(page.shape) * 8, Path(page.parent.filename))
    hints = image_hints(page.asarray().astype(np.float64), _nodata(page))
    hints.add("variable", names[0], f"the first of {len(names)} pages")
    if "spacing" in stated:
        unit = stated.get("unit_xy")
        steps = [f"{step:.9g} {unit}" if unit else float(step) for step in stated["spacing"]]
        hints.add("spacing", steps, "the pixel size in the file")
    return hints


def _nodata(page) -> float | None:
    text = page.tags.valueof(_NODATA)
    return None if text is None else float(str(text).strip("\0 "))


FORMAT = Format(read_tiff, endings=(".tif", ".tiff"), takes=is_plain_tiff, libraries=("tifffile",))
