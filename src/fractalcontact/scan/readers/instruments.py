"""Files of measuring instruments, through SurfaceTopography."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...core.labels import on_one_line
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, stated_unit
from ..tables import refuse_unknown_channel

#: Formats read elsewhere in this package, with stricter checks.
_OWN_FORMATS = {"xyz", "asc", "npy", "npz", "x3p", "mat", "h5", "nc", "gwy"}
#: Extensions in use that SurfaceTopography does not list.
_MORE_EXTENSIONS = {"di": "di"}

#: Endings that an instrument shares with other programs, and what to do with the files of those.
_ALSO_OTHERS = {
    ".xlsx": "a spreadsheet, but none of a Mitutoyo instrument; save the heights as CSV",
    ".zip": "an archive, but none of an SIOS instrument; put the scan file itself here",
}
#: Formats whose lateral size SurfaceTopography misreads: factor, and why it is known.
LATERAL_FAULTS = {
    "nms": (
        1e-6,
        "its header counts the spacing in nm, which SurfaceTopography takes for mm "
        "(a 160 um field came out as 160 m)",
    ),
}
#: Formats that state a length, not a spacing, which some programs count from the first point to
#: the last and others over all cells: MountainsMap (.bcrf) and TrueMap (.tmd) write (n - 1) dx,
#: GelSight (.tmd) writes n dx. Like SurfaceTopography and Gwyddion we take n dx.
LENGTH_UNCLEAR = ("bcr", "tmd")
#: Formats whose first row lies at the smallest y, as SurfaceTopography gives them; Gwyddion draws
#: it at the top, as that of an image.
FIRST_ROW_UNCLEAR = ("sur", "sdf", "bcr", "vk")


@cache
def instrument_formats() -> dict[str, tuple[str, ...]]:
    """SurfaceTopography's format names by file extension (without dot, lower case)."""
    from SurfaceTopography.IO import readers

    formats: dict[str, list[str]] = {ext: [name] for ext, name in _MORE_EXTENSIONS.items()}
    for reader in readers:
        if reader.format() not in _OWN_FORMATS:
            for extension in reader.file_extensions() or ():
                formats.setdefault(extension.lower(), []).append(reader.format())
    return {extension: tuple(names) for extension, names in formats.items()}


def read_instrument(path: Path, options: ScanOptions) -> RawScan:
    """Heights in an instrument's file, whose content must confirm the format of its extension.

    A size the file states is that of all cells, n dx, so the spacing is size / n. SurfaceTopography
    indexes heights [x, y] with both ascending, so they are transposed.
    """
    reasons = []
    for format_name in instrument_formats()[path.suffix.lstrip(".").lower()]:
        try:
            return _read_format(path, format_name, options.variable)
        except InputError:
            raise
        except Exception as error:  # a damaged file makes these readers raise anything
            reasons.append(f"as {format_name}: {type(error).__name__}: {on_one_line(error)}")
    if advice := _ALSO_OTHERS.get(path.suffix.lower()):
        raise InputError(f"{path}: {advice}")
    raise InputError(
        f"{path}: damaged, or not what its extension says ({'; '.join(reasons)}); export it again, "
        "or export x, y, z as text"
    )


def _read_format(path: Path, format_name: str, wanted: str | None) -> RawScan:
    """Read one height channel; ``wanted`` is its name."""
    import SurfaceTopography

    reader = SurfaceTopography.open_topography(str(path), format=format_name)
    try:
        channel, notes = _choose_channel(reader, wanted, path)
        states_size = channel.physical_sizes is not None
        # SurfaceTopography requires a size; where none is stated, this one is not used.
        given = {} if states_size else {"physical_sizes": channel.nb_grid_pts}
        topography = reader.topography(channel_index=channel.index, **given)
        heights = np.ma.filled(np.ma.array(topography.heights(), dtype=np.float64), np.nan)
    finally:
        reader.close()
    stated: dict[str, Any] = {"unit_z": _length(topography.unit, path)}
    if states_size:
        stated |= {"unit_xy": stated["unit_z"], "spacing": _spacing(topography)}
    if format_name in LATERAL_FAULTS and states_size:
        factor, reason = LATERAL_FAULTS[format_name]
        stated["spacing"] = tuple(factor * step for step in stated["spacing"])
        notes += (f"lateral size corrected by {factor:g}: {reason}",)
    if format_name in LENGTH_UNCLEAR:
        steps = " x ".join(f"{n / (n - 1):.6g}" for n in heights.shape)
        notes += (
            "the file states lengths, which are taken as those of all cells; if they are from the "
            f"first point to the last, the spacing is {steps} times as large",
        )
    if format_name in FIRST_ROW_UNCLEAR:
        notes += (
            "its first row lies at the smallest y; if the instrument draws it at the top, write "
            "'first_row: top'",
        )
    return RawScan(
        np.ascontiguousarray(heights.T),
        "matrix",
        reader=f"SurfaceTopography {SurfaceTopography.__version__} / {format_name}",
        notes=notes,
        **stated,
    )


def _choose_channel(reader, wanted: str | None, path: Path):
    """The channel called ``wanted``, else the reader's first of heights."""
    channels = list(reader.channels)
    if not channels:
        raise InputError(
            f"{path}: no channel of the file has x, y and heights in units of length; set them in "
            "the program that wrote it, or export a matrix of numbers as text and add a sidecar"
        )
    names = [channel.name for channel in channels]
    refuse_unknown_channel(names, wanted, path)
    channel = reader.default_channel if wanted is None else channels[names.index(wanted)]
    if channel.dim != 2 or not channel.is_uniform:
        raise InputError(
            f"{path}: channel {channel.name!r} is a line scan; a surface on a regular grid is "
            "needed"
        )
    if channel.data_kind.name != "HEIGHT":
        raise InputError(
            f"{path}: channel {channel.name!r} holds {channel.data_kind.name.lower()}, no heights; "
            f"name another in the sidecar, 'variable: NAME'; it has {', '.join(names)}"
        )
    notes = (f"channel {channel.name!r} of {len(names)}",) if len(names) > 1 else ()
    return channel, notes


def _length(unit, path: Path) -> str | None:
    """Unit of a topography; a pair of units means that the second is no length."""
    if unit is None or isinstance(unit, str):
        return stated_unit(unit)
    raise InputError(f"{path}: its values are in {unit[1]}, no heights; export the height channel")


def _spacing(topography) -> tuple[float, float]:
    sizes = topography.physical_sizes
    dx, dy = (float(size) / n for size, n in zip(sizes, topography.nb_grid_pts, strict=True))
    return dx, dy


#: Endings that SurfaceTopography reads, listed because its import takes a second.
_ENDINGS = (
    "001 002 003 004 005 al3d apx bcr bcrf cur dat datx di ezd frt hgt ibw jpk lext mdt mi mnt nid "
    "nms oir opd opdx os3d plu plux poir qep sdf spm stp sur tif tiff tmd tom top vk3 vk4 vk6 vk7 "
    "xlsx zip zmg zon"
)

FORMAT = Format(
    read_instrument,
    endings=tuple(f".{ending}" for ending in _ENDINGS.split()),
    libraries=("netCDF4", "SurfaceTopography.IO"),
)
