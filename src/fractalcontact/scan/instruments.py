"""Files of measuring instruments, through SurfaceTopography."""

from functools import cache
from pathlib import Path

import numpy as np

from ..errors import InputError
from .options import ScanOptions
from .raw import RawScan

#: Formats read elsewhere in this package, with stricter checks.
_OWN_FORMATS = {"xyz", "asc", "npy", "npz", "x3p"}
#: Extensions in use that SurfaceTopography does not list.
_MORE_EXTENSIONS = {"di": "di"}


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
    """Read an instrument's file; the extension says which format, the content must confirm it.

    SurfaceTopography indexes heights [x, y] with both ascending, so they are transposed.

    Raises
    ------
    InputError
        If the file is damaged, holds line scans only, or lacks the channel asked for.
    """
    import SurfaceTopography

    reasons = []
    for format_name in instrument_formats()[path.suffix.lstrip(".").lower()]:
        try:
            topography, notes = _read_channel(path, format_name, options.variable)
        except InputError:
            raise
        except Exception as error:  # a damaged file makes these readers raise anything
            reasons.append(f"as {format_name}: {type(error).__name__}: {str(error)[:200]}")
            continue
        heights = np.ma.filled(np.ma.asarray(topography.heights(), dtype=np.float64), np.nan)
        n_x, n_y = heights.shape
        size_x, size_y = topography.physical_sizes
        reader = f"SurfaceTopography {SurfaceTopography.__version__} / {format_name}"
        return RawScan(
            np.ascontiguousarray(heights.T),
            "matrix",
            reader=reader,
            unit_xy=topography.unit,
            unit_z=topography.unit,
            spacing=(float(size_x) / n_x, float(size_y) / n_y),
            notes=notes,
        )
    raise InputError(
        f"{path}: damaged, or not what its extension says ({'; '.join(reasons)}); export it again, "
        "or export x, y, z as text"
    )


def _read_channel(path: Path, format_name: str, wanted: str | None):
    """Read one height channel; ``wanted`` is its name."""
    import SurfaceTopography

    reader = SurfaceTopography.open_topography(str(path), format=format_name)
    try:
        names = [channel.name for channel in reader.channels]
        if not names:
            raise InputError(f"{path}: the file holds no height channel")
        if wanted is not None and wanted not in names:
            raise InputError(
                f"{path}: no channel {wanted!r} (key 'variable'); it has {', '.join(names)}"
            )
        channel = reader.default_channel if wanted is None else reader.channels[names.index(wanted)]
        if channel.dim != 2 or not channel.is_uniform:
            raise InputError(
                f"{path}: channel {channel.name!r} is a line scan; a surface on a regular grid is "
                "needed"
            )
        notes = (f"channel {channel.name!r} of {len(names)}",) if len(names) > 1 else ()
        return reader.topography(channel_index=channel.index), notes
    finally:
        reader.close()
