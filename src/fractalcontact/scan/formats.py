"""Which reader takes which file: by its extension, and by content where that is not enough."""

from pathlib import Path

from ..core.errors import InputError
from . import tiff
from .archives import check_archive
from .arrays import read_npy, read_npz
from .gwyddion import read_gwyddion
from .instruments import instrument_formats, read_instrument
from .labelled import read_labelled
from .matlab import read_mat
from .mesh import read_mesh
from .options import ScanOptions
from .raw import RawScan
from .text import is_text, read_text
from .x3p import read_x3p

_TEXT = (".asc", ".csv", ".dat", ".tsv", ".txt", ".xyz")
_MESH = (".obj", ".ply", ".stl")
_TIFF = (".tif", ".tiff")
#: Containers of matrices and others with one reader an extension.
_READERS = {
    ".npy": read_npy,
    ".npz": read_npz,
    ".x3p": read_x3p,
    ".h5": read_labelled,
    ".hdf5": read_labelled,
    ".nc": read_labelled,
    ".mat": read_mat,
    ".gwy": read_gwyddion,
}


def known_extensions() -> list[str]:
    """Endings of the files that can be read, with their dot, in lower case."""
    instruments = (f".{extension}" for extension in instrument_formats())
    return sorted({*_TEXT, *_MESH, *_TIFF, *_READERS, *instruments})


def read_raw(path: Path, options: ScanOptions) -> RawScan:
    """Choose the reader by extension, and by content where one extension serves two formats."""
    check_archive(path)
    extension = path.suffix.lower()
    if extension in _READERS:
        return _READERS[extension](path, options)
    if extension in _MESH:
        return read_mesh(path)
    if extension in _TIFF and not tiff.is_park_systems(path):
        return tiff.read_tiff(path, options)
    if extension in _TEXT and is_text(path):
        return read_text(path, options)
    if extension.lstrip(".") in instrument_formats():
        return read_instrument(path, options)
    if extension in _TEXT:
        raise InputError(f"{path}: not a text file; damaged, or the wrong extension?")
    known = " ".join(known_extensions())
    raise InputError(f"{path}: unknown extension {extension!r}; known: {known}")
