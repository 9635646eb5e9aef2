"""All scan formats declared by readers, and the choice of one for a file.

A format is one module in `readers` that declares its `Format`; nothing else names it.
"""

from pathlib import Path

from ..core.errors import InputError
from ..core.modules import modules_of
from . import readers
from .files import require_whole
from .format import Format
from .options import ScanOptions
from .raw import RawScan

#: Formats by the name of the reader's module.
FORMATS: dict[str, Format] = {name: module.FORMAT for name, module in modules_of(readers).items()}


_SPREADSHEET = "a spreadsheet, which is not read; save the sheet of the heights as CSV"
_ARCHIVE = "an archive, which is not unpacked; put the scan file itself here"
#: Endings of files that are often met and not read, and what to do.
_NOT_READ = {
    **dict.fromkeys((".xls", ".xlsm", ".ods"), _SPREADSHEET),
    **dict.fromkeys((".gz", ".7z", ".rar", ".tar"), _ARCHIVE),
    **dict.fromkeys((".jpg", ".jpeg", ".bmp"), "a picture, no heights; export the heights"),
}
#: Keys of a sidecar that say how some formats are laid out: idle for the others.
_LAYOUT_KEYS = frozenset(key for form in FORMATS.values() for key in form.keys)


def known_extensions() -> list[str]:
    """Endings of the files that can be read, with their dot, in lower case."""
    return sorted({ending for form in FORMATS.values() for ending in form.endings})


def likely_formats(extension: str) -> list[Format]:
    """Formats that a file may have by its ending, those that look at its content first."""
    declared = (form for form in FORMATS.values() if extension in form.endings)
    return sorted(declared, key=lambda form: form.takes is None)


def read_raw(path: Path, options: ScanOptions) -> RawScan:
    """Content of a file, read by the format that takes it; runs in the reader process alone.

    A file that no format takes, or whose library is not installed, is refused.
    """
    try:
        return _read_by_format(path, options)
    except ModuleNotFoundError as error:
        library = (error.name or "").partition(".")[0]
        if library in ("", "fractalcontact"):
            raise
        raise InputError(
            f"{path}: to read this format takes {library}, which is not installed: "
            "pip install 'fractalcontact[scans]' (in a checkout: pip install '.[scans]')"
        ) from None


def _read(form: Format, path: Path, options: ScanOptions) -> RawScan:
    """Read a file, unless its sidecar has keys that would change nothing."""
    for key in sorted(_LAYOUT_KEYS.difference(form.keys)):
        if getattr(options, key) is not None:
            raise InputError(
                f"{path}: key '{key}' has no meaning for a {path.suffix.lower()} file; remove it"
            )
    if options.missing_words and "delimiter" not in form.keys:
        raise InputError(
            f"{path}: key 'missing' is {options.missing_words[0]!r}, a word, and a "
            f"{path.suffix.lower()} file holds numbers alone; write the number, or 'none'"
        )
    return form.read(path, options)


def _read_by_format(path: Path, options: ScanOptions) -> RawScan:
    require_whole(path)
    extension = path.suffix.lower()
    formats = likely_formats(extension)
    for form in formats:
        if form.takes is None or form.takes(path):
            return _read(form, path, options)
    if advice := _NOT_READ.get(extension):
        raise InputError(f"{path}: {advice}")
    for form in formats:
        if form.refusal:
            raise InputError(f"{path}: {form.refusal}")
    readable = " ".join(known_extensions())
    raise InputError(f"{path}: unknown extension {extension!r}; known: {readable}")
