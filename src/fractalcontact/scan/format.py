"""Declaration of a scan format: endings, reader, limits of reading."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from .options import ScanOptions
from .raw import RawScan

#: Bytes of memory for each byte of the file. Heights deflate to a third, double in size as float64,
#: and are copied two or three times on their way.
MEMORY_PER_BYTE = 24
#: Seconds of processor time, many times what the slowest sound file takes.
SECONDS_PER_MEGABYTE = 2


@dataclass(frozen=True)
class Format:
    """Family of scan files; each module of `readers` declares one as its ``FORMAT``."""

    read: Callable[[Path, ScanOptions], RawScan]  # only called in the reader process
    endings: tuple[str, ...] = ()  # of file names, with their dot, in lower case
    #: Keys of a sidecar that have a meaning for these files and not for all others.
    keys: tuple[str, ...] = ()
    #: Recognises the format by content where others share an ending; None takes all.
    takes: Callable[[Path], bool] | None = None
    refusal: str = ""  # fault of a file with these endings that no format takes
    #: Modules that take long to import: the reader process imports them once.
    libraries: tuple[str, ...] = ()
    #: Bytes of memory for each byte of the file, inflated if packed.
    memory_per_byte: int = MEMORY_PER_BYTE
    seconds_per_megabyte: int = SECONDS_PER_MEGABYTE  # of processor time
