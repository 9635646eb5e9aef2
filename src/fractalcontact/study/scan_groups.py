"""Scans of many specimens: a folder of folders, one a group, or a table that names files."""

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath

from ..core.errors import InputError
from ..core.file_names import SIDECAR_SUFFIXES, specimen_name, split_file_name
from ..core.labels import printable
from .scan_files import (
    ScanFiles,
    case_alone,
    folder_notes,
    is_passed_over,
    list_scans,
    refuse_misleading,
    refuse_outside_link,
    refuse_unusable,
)
from .sidecar import plain_value

#: Word of a study for ``groups`` that are folders; any other text is the name of a table.
FOLDERS = "folders"
#: Columns of a table with the files and the name of a specimen; all others are keys of a sidecar.
_FILES, _NAME = ("file", "lower", "upper"), "name"
#: Keys whose cells are texts even where they look like numbers.
_WORDS = ("group", "label", "material")
LARGEST_TABLE = 64 * 2**20  # bytes
_DELIMITERS = ",;\t"

#: Result of :func:`study.scan_files.list_scans`.
Listed = tuple[dict[str, ScanFiles], dict[str, InputError]]


def list_grouped(folder: Path | str, groups: str | None) -> Listed:
    """Specimens of a study and errors of other files, as of :func:`study.scan_files.list_scans`.

    ``groups`` is "folders", the path of a table, or None for the files of the folder alone. With
    folders, a specimen is called GROUP_NAME after its folder and its file, and
    ``scans/GROUP.yaml`` is the sidecar of all of the group.

    Raises
    ------
    InputError
        If the folder or the table does not exist, or the table cannot be read.
    """
    if groups is None:
        return list_scans(folder)
    if groups == FOLDERS:
        return _list_folders(Path(folder))
    return _list_table(Path(folder), Path(groups))


def grouped_notes(folder: Path | str, groups: str | None) -> list[str]:
    """Notes of :func:`study.scan_files.folder_notes`, on the folders of groups too."""
    notes = folder_notes(folder)
    if groups == FOLDERS:
        notes += [note for path in _group_folders(Path(folder)) for note in folder_notes(path)]
    return notes


# -- a folder of folders ---------------------------------------------------------------------------


def _group_folders(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    paths = (path for path in folder.iterdir() if path.is_dir() and not is_passed_over(path.name))
    return sorted(paths)


def _list_folders(folder: Path) -> Listed:
    subfolders = _group_folders(folder)
    names = {path.name for path in subfolders}
    scans, refused = list_scans(folder, group_folders=names)
    for subfolder in subfolders:
        try:
            refuse_misleading(subfolder)
            if subfolder.is_symlink():
                raise InputError(f"{subfolder}: a link; put the folder of the group itself here")
            shared = _sidecar_beside(folder, subfolder.name)
            members, wrong = list_scans(subfolder)
        except InputError as error:
            refused[printable(subfolder.name)] = error
            continue
        refused |= {f"{subfolder.name}/{name}": error for name, error in wrong.items()}
        for scan in members.values():
            name = specimen_name(f"{subfolder.name}_{scan.name}")
            try:
                refuse_unusable(name, scan.lower)
                if name in scans:
                    raise _one_name(name, scans[name].lower, scan.lower)
                scans[name] = replace(scan, name=name, group=subfolder.name, shared=shared)
            except InputError as error:
                refused[f"{subfolder.name}/{scan.name}"] = error
    return _without_clashes(scans, refused)


def _without_clashes(scans: dict[str, ScanFiles], refused: dict[str, InputError]) -> Listed:
    """Specimens, sorted, whose names differ in more than upper and lower case; errors of others."""
    clashes = case_alone({name: {"only": scan.lower} for name, scan in scans.items()})
    kept = {name: scans[name] for name in sorted(scans.keys() - clashes.keys())}
    return kept, refused | clashes


def _sidecar_beside(folder: Path, stem: str) -> Path | None:
    """Sidecar NAME.yaml (or .yml) of a folder; a link out of the folder is refused."""
    paths = [path for ending in SIDECAR_SUFFIXES if (path := folder / f"{stem}{ending}").exists()]
    if len(paths) > 1:
        raise InputError(f"{paths[0]} and {paths[1].name}: two sidecars of {stem}; remove one")
    for path in paths:
        refuse_outside_link(path, folder)
    return paths[0] if paths else None


def _one_name(name, first, second):
    return InputError(
        f"{second}: its specimen is called {name!r}, as that of {first}; rename one of them"
    )


# -- a table ---------------------------------------------------------------------------------------


def _list_table(folder: Path, table: Path) -> Listed:
    if not folder.is_dir():
        raise InputError(
            f"{folder}: no such folder (not mounted?); it must hold the files of {table}: correct "
            "'scans' in the study"
        )
    scans: dict[str, ScanFiles] = {}
    refused: dict[str, InputError] = {}
    for number, cells in _rows(table):
        where, name = f"{table}: line {number}", ""
        try:
            scan = _scan_of_row(folder, cells, where)
            name = scan.name
            if name in scans:
                raise InputError(
                    f"{where}: a second specimen {name!r}; give each a name of its own in a column "
                    f"'{_NAME}'"
                )
            scans[name] = scan
        except InputError as error:
            refused[f"{where} {printable(name)}".strip()] = error
    return _without_clashes(scans, refused)


def _rows(table: Path) -> list[tuple[int, dict[str, str]]]:
    """Cells by column of every row that has any, with the number of its line."""
    try:
        with open(table, "rb") as stream:
            content = stream.read(LARGEST_TABLE + 1)
        text = content.decode("utf-8-sig")
    except OSError as error:
        raise InputError(
            f"{table}: cannot be read ({error.strerror}); 'groups' is '{FOLDERS}' or the path of a "
            "table of specimens"
        ) from error
    except UnicodeDecodeError as error:
        raise InputError(f"{table}: not text in UTF-8 ({error.reason}); save it as that") from error
    if len(content) > LARGEST_TABLE:
        raise InputError(f"{table}: longer than {LARGEST_TABLE // 2**20} MB; split the study")
    first = text.split("\n", 1)[0]
    delimiter = max(_DELIMITERS, key=first.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    rows: list[tuple[int, dict[str, str]]] = []
    try:
        head = [cell.strip() for cell in next(reader, [])]
        _require_columns(table, head)
        for cells in reader:
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(head):
                raise InputError(
                    f"{table}: line {reader.line_num}: {len(cells)} cells, expected {len(head)} "
                    "as in its first line; put cells that contain the delimiter between quotes"
                )
            stripped = (cell.strip() for cell in cells)
            rows.append((reader.line_num, dict(zip(head, stripped, strict=True))))
    except csv.Error as error:
        raise InputError(f"{table}: line {reader.line_num}: no table of cells ({error})") from error
    return rows


def _require_columns(table: Path, head: Sequence[str]) -> None:
    twice = sorted({name for name in head if head.count(name) > 1})
    if twice:
        raise InputError(f"{table}: two columns are called {printable(twice[0], 60)!r}; rename one")
    if "file" not in head and not {"lower", "upper"} <= set(head):
        raise InputError(
            f"{table}: its first line names no files; expected a column 'file', or 'lower' and "
            "'upper', with paths below the folder of the scans"
        )


def _scan_of_row(folder: Path, cells: Mapping[str, str], where: str) -> ScanFiles:
    faces = {key: _path(folder, cells[key], f"{where}: {key}") for key in _FILES if cells.get(key)}
    only, lower, upper = (faces.get(key) for key in _FILES)
    if (only is None) == (lower is None or upper is None) or (only and (lower or upper)):
        raise InputError(
            f"{where}: expected one face under 'file', or two under 'lower' and 'upper'"
        )
    first = only or lower
    assert first is not None
    original, _ = split_file_name(first.name)
    stated = cells.get(_NAME) or original
    name = specimen_name(stated)
    refuse_unusable(name, first)
    row = {
        key: text if key in _WORDS else plain_value(text, f"{where}: {key}")
        for key, text in cells.items()
        if text and key not in (*_FILES, _NAME)
    }
    sidecar = _sidecar_beside(first.parent, original)
    return ScanFiles(name, first, upper, sidecar, row=row, row_of=where)


def _path(folder: Path, text: str, where: str) -> Path:
    relative = PurePosixPath(text)
    if relative.is_absolute() or ".." in relative.parts:
        shown = printable(text, 80)
        raise InputError(f"{where}: {shown!r} leads out of {folder}; write a path below it")
    path = folder / relative
    refuse_misleading(path)
    if not path.exists() and not path.is_symlink():
        raise InputError(f"{where}: no file {printable(path, 120)}")
    refuse_outside_link(path, folder)
    return path
