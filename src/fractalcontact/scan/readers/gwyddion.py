"""Height channels of Gwyddion's own files.

SurfaceTopography takes the file apart, but offers only channels that state units of length; a file
without units is completed by its sidecar here.
"""

import math
import re
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger, stated_unit
from ..tables import refuse_unknown_channel

_FIELD, _UNIT = "GwyDataField", "GwySIUnit"
_COUNT = 4  # bytes in front of an array, its number of items


def read_gwyddion(path: Path, options: ScanOptions) -> RawScan:
    """Height channel that ``variable`` names, or the first.

    A channel's size is that of all pixels, its first row the top; masked pixels are missing.
    """
    import SurfaceTopography
    from SurfaceTopography.IO import GWYReader

    with reading(path, "Gwyddion file"):
        content = GWYReader(str(path))._metadata  # arrays are left in the file
        channels = _channels(content)
        if not channels:
            raise InputError(f"{path}: no channel of the file is in units of length, so no heights")
        refuse_unknown_channel(list(channels), options.variable, path)
        name = options.variable or next(iter(channels))
        number, field = channels[name]
        values = _array(path, field, field)
        mask = content.get(f"/{number}/mask")
        notes: tuple[str, ...] = (
            (f"channel {name!r} of {len(channels)}",) if len(channels) > 1 else ()
        )
        if mask is not None:
            values[_array(path, mask[_FIELD], field) > 0.5] = np.nan
            notes += ("pixels under the mask of the file are missing",)
        spacing = (abs(field["xreal"]) / field["xres"], abs(field["yreal"]) / field["yres"])
        unit_xy, unit_z = _units(field)
    return RawScan(
        values,
        "matrix",
        reader=f"SurfaceTopography {SurfaceTopography.__version__} / gwy",
        # A size without a unit is no length: new files state one unit per pixel.
        spacing=spacing if unit_xy else None,
        unit_xy=stated_unit(unit_xy),
        unit_z=stated_unit(unit_z),
        first_row="top",
        notes=notes,
    )


def _channels(content: dict) -> dict:
    """Number and field of the channels that can be heights, by title."""
    channels = {}
    for key, value in content.items():
        match = re.fullmatch(r"/(\d+)/data", key)
        if match and all(not unit or stated_unit(unit) for unit in _units(value[_FIELD])):
            title = str(content.get(f"{key}/title", f"channel {match[1]}"))
            name = title if title not in channels else f"{title} ({match[1]})"
            channels[name] = match[1], value[_FIELD]
    return channels


def _units(field: dict) -> list[str]:
    """Units of x and y, and of the values; "" where not stated."""
    stated = [field.get(f"si_unit_{axis}", {}) for axis in ("xy", "z")]
    return [unit.get(_UNIT, {}).get("unitstr", "") for unit in stated]


def _array(path: Path, field: dict, shaped_like: dict) -> np.ndarray:
    """Numbers of a field, read at the position found by SurfaceTopography."""
    shape = shaped_like["yres"], shaped_like["xres"]
    refuse_larger(math.prod(shape) * 8, path)
    values = np.fromfile(path, "<f8", math.prod(shape), offset=field["data"]["offset"] + _COUNT)
    return values.reshape(shape)


FORMAT = Format(read_gwyddion, endings=(".gwy",), libraries=("netCDF4", "SurfaceTopography.IO"))
