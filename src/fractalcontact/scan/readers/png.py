"""Grey PNG images; the sidecar states the height of a grey level."""

from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..draft import image_hints
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger
from ..stated import Needs, require_stated

_GREY = ("I;16", "I;16B", "I", "L")


def read_png(path: Path, options: ScanOptions) -> RawScan:
    """Heights in a grey PNG image, as its sidecar states: ``unit_z: 0.01 um`` is one grey level."""
    import PIL
    from PIL import Image

    with reading(path, "PNG image"), Image.open(path, formats=("PNG",)) as image:
        refuse_larger(8 * image.width * image.height, path)
        if image.mode not in _GREY:
            raise InputError(f"{path}: a colour image, no heights; export the heights themselves")
        values = np.asarray(image, dtype=np.float64)
        require_stated(path, options, Needs(), lambda: image_hints(values))
    notes = ("8 bits: heights in 256 steps at most",) if image.mode == "L" else ()
    return RawScan(values, "matrix", reader=f"Pillow {PIL.__version__} / png", notes=notes)


FORMAT = Format(read_png, endings=(".png",), libraries=("PIL.Image",))
