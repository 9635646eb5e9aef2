"""Declaration of a scan format: endings, reader, limits of reading."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .options import ScanOptions
from .raw import RawScan

#: Bytes of memory for each of the file. Heights deflate to a third, double in size as float64, and
#: are copied two or three times on their way.
MEMORY_PER_BYTE = 24
#: Seconds of processor time, many times what the slowest sound file takes.
SECONDS_PER_MEGABYTE = 2


@dataclass(frozen=True)
class Format:
    """One family of scan files; each module of `readers` declares one as its ``FORMAT``.

    Attributes
    ----------
    read : callable
        From the path of a file and `ScanOptions` to a `RawScan`; only called in the reader process.
    endings : tuple of str
        Of file names, with their dot, in lower case.
    keys : tuple of str
        Keys of a sidecar that have a meaning for these files and not for all others.
    takes : callable or None
        Whether a file is of this format, by its content, where others share an ending; None if
        every file with these endings is.
    refusal : str
        What is wrong with a file with these endings that no format takes.
    libraries : tuple of str
        Modules that take long to import: the reader process imports them once, not for each file.
    memory_per_byte : int
        Bytes of memory that reading may take for each byte of the file, inflated if packed.
    seconds_per_megabyte : int
        Seconds of processor time that it may take for each megabyte.
    """

    read: Callable[[Path, ScanOptions], RawScan]
    endings: tuple[str, ...] = ()
    keys: tuple[str, ...] = ()
    takes: Callable[[Path], bool] | None = None
    refusal: str = ""
    libraries: tuple[str, ...] = ()
    memory_per_byte: int = MEMORY_PER_BYTE
    seconds_per_megabyte: int = SECONDS_PER_MEGABYTE
