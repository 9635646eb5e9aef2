"""Draft a sidecar, with a picture, for each scan that is read only as its sidecar says.

python -m fractalcontact.commands.describe [FOLDER] [--file SCAN] [--like SIDECAR]
"""

import argparse
import html
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from ..core.directions import APERTURE
from ..core.errors import InputError, said_in_one_line
from ..core.file_names import split_file_name
from ..core.labels import natural_key, printable
from ..core.text import percent
from ..core.units import length_factor
from ..gridding.ungridded import UngriddedScan
from ..scan.draft import written
from ..scan.keys import ScanKeys
from ..scan.options import FACES, NO_MARK, of_face
from ..scan.raw import IncompleteSidecar
from ..scan.read import scan_in_mm
from ..scan.undeclared import find_marks, number, possible_marks
from ..study.checks import read_sidecar
from ..study.documents import read_study
from ..study.scan_files import ScanFiles, list_scans
from ..study.sidecar import is_contact_map, plain_value, read_yaml
from .describe_picture import draw_faces

DRAFT = ".draft"
PAGE = f"scans{DRAFT}.html"
#: Values shown for lines that are not filled in yet; the picture says so.
_SHOWN = {
    **{"unit": "mm", "unit_xy": "mm", "unit_z": "mm", "spacing": "1 mm", "first_row": "bottom"},
    **{"kind": "face", "decimal": ".", "layout": "matrix", "columns": [0, 1, 2], "axes": "none"},
    **{"heights": "up", "missing": NO_MARK},
}
#: Most numbers named that may mark missing cells.
_MAX_NAMED = 4
#: Largest factor between the reliefs of files of one instrument.
ALIKE = 5.0
_HEAD = """\
# Draft of the sidecar of {files}: what the file seems to say. Nobody has looked at it yet.
# Look at {picture}, mend and fill in the lines, then rename this file to {sidecar}.
"""
_CONFIRMED = """\
confirmed:                # what was read when this was drafted; a file that differs is refused
"""


@dataclass
class Described:
    """Report on one specimen.

    ``state`` is "draft", "complete", "written" or "refused". ``sizes`` has cells or points of each
    face, its relief in the numbers of the file and its fraction of missing cells; ``to_fill`` names
    keys of the draft that the file does not determine.
    """

    name: str
    state: str
    sizes: list[str] = field(default_factory=list)
    to_fill: list[str] = field(default_factory=list)
    sentences: list[str] = field(default_factory=list)
    picture: Path | None = None


@dataclass
class Face:
    """One file as it would be read.

    ``options`` are its scan keys, ``scan`` is None if it is refused, ``notes`` stand beside its
    picture. ``among`` are numbers among the heights that may mark missing cells, where the draft
    names none.
    """

    path: Path
    options: dict[str, Any]
    scan: UngriddedScan | None = None
    notes: list[str] = field(default_factory=list)
    among: list[float] = field(default_factory=list)


def describe(scan: ScanFiles, *, always: bool = False) -> Described:
    """Report on a scan, its sidecar drafted and its picture drawn; ``always`` draws every scan."""
    stated = _stated(scan)
    faces = {"lower": scan.lower} | ({"upper": scan.upper} if scan.upper else {})
    drafts = {face: _draft_of(path, of_face(stated, face)) for face, path in faces.items()}
    shown = {face: _read_as_drafted(path, stated, face, drafts[face][1])
             for face, path in faces.items()}  # fmt: skip
    lines, values = drafts["lower"]
    to_fill = [key for key, value in values.items() if value is None]
    to_fill += ["missing"] * bool(lines and shown["lower"].among)
    described = Described(scan.name, "draft" if lines else "complete", to_fill=to_fill)
    described.sizes = [size_words(face) for face in shown.values()]
    described.sentences = [note for face in shown.values() for note in face.notes]
    if not lines and all(face.scan is None for face in shown.values()):
        described.state = "refused"
    if lines or always:
        described.picture = _beside(scan, ".png")
        draw_faces(list(shown.values()), described.picture)
    if lines:
        text = _draft_text(scan, lines, drafts, shown)
        _beside(scan, ".yaml").write_text(text, encoding="utf-8")
    return described


def drafted_keys(lower: Path, upper: Path, stated: Mapping[str, Any]) -> dict[str, Any]:
    """Scan keys of two faces by their drafts, below those stated; None of what neither file states.

    Keys in which the upper file differs stand under ``upper``, as in a sidecar; what it does not
    state is taken from the lower one.
    """
    drafts = {
        face: _draft_of(path, of_face(stated, face))[1]
        for face, path in (("lower", lower), ("upper", upper))
    }
    common = drafts["upper"] | {
        key: value for key, value in drafts["lower"].items() if value is not None
    }
    differing = {
        key: value
        for key, value in drafts["upper"].items()
        if value is not None and value != common[key]
    }
    of_upper = differing | dict(stated.get("upper") or {})
    return {**common, **stated} | ({"upper": of_upper} if of_upper else {})


def _stated(scan: ScanFiles) -> dict[str, Any]:
    """Scan keys of a sidecar, or of a draft that its owner may have completed in part."""
    if scan.sidecar is not None:
        return read_sidecar(scan.sidecar)[0]
    draft = _beside(scan, ".yaml")
    if not draft.is_file():
        return {}
    keys = ScanKeys.model_fields
    document = {key: value for key, value in read_yaml(draft).items() if value is not None}
    return {key: document[key] for key in document if key in keys and key != "confirmed"}


def _draft_of(path: Path, options: Mapping[str, Any]) -> tuple[list[str], dict[str, Any]]:
    """Lines of the draft for one file, and their values; empty if the sidecar is complete."""
    try:
        scan_in_mm(path, options, are_heights=not is_contact_map(options))
    except IncompleteSidecar as error:
        lines = [line.removeprefix("    ") for line in error.draft.split("\n")]
        return lines, plain_value("\n".join(lines), f"draft for {path}")
    except InputError:
        pass
    return [], {}


def _read_as_drafted(path: Path, stated: Mapping, face: str, draft: Mapping[str, Any]) -> Face:
    """File as its draft says.

    Blank keys take the values of `_SHOWN` where it has one that fits the layout.
    """
    blanks = [key for key, value in draft.items() if value is None]
    filled = {key: value for key, value in draft.items() if value is not None}
    options = {**of_face(stated, face), **filled}
    options |= {key: _SHOWN[key] for key in blanks if key in _SHOWN}
    if options.get("layout") == "points" and "spacing" in blanks:  # shown as lengths, not as cells
        options = {key: options[key] for key in options if key not in ("spacing", "first_row")}
    shown = Face(path, options)
    shown.notes = [f"NOT STATED: {key}, shown as {_SHOWN.get(key, 'nothing')}" for key in blanks]
    kind = options.get("kind")
    if kind == "profile":
        shown.notes.append("the file seems to hold no face, but a profile")
        options["kind"] = "face"
    try:
        shown.scan = scan_in_mm(path, options, are_heights=False)
    except InputError as error:
        shown.notes.append(str(error).split("\n")[0])
        return shown
    if warnings := shown.scan.provenance["warnings"]:
        shown.notes += warnings.split("\n")
    every = _marks(shown)
    marks = [mark for mark, is_outside in every.items() if is_outside]
    if every:
        shown.notes.append(f"is {' and '.join(map(number, every))} the mark of missing cells?")
    if draft.get("missing") == NO_MARK:
        shown.among = [mark for mark, is_outside in every.items() if not is_outside]
    if marks and draft.get("missing") == NO_MARK:
        options["missing"] = marks if len(marks) > 1 else marks[0]
        shown.scan = scan_in_mm(path, options, are_heights=False)
    return shown


def _marks(face: Face) -> dict[float, bool]:
    """Numbers of the file that may mark missing cells, and whether each lies far outside others."""
    assert face.scan is not None
    options, values = face.options, face.scan.values
    if is_contact_map(options):
        return {}
    heights = values if face.scan.layout == "matrix" else values[:, 2]
    unit = options.get("unit_z") or options.get("unit") or "mm"
    sign = -1 if options.get("heights") == "down" or options.get("kind") == APERTURE else 1
    factor = sign * length_factor(str(unit), str(face.path))
    # Heights in the file's own unit, without rounding errors of the conversion.
    own = np.round(heights / factor, 9 - int(np.log10(np.nanmax(np.abs(heights / factor)) + 1)))
    if options.get("kind") == APERTURE:
        own = own[own != 0]
    marks = {float(f"{mark.value:.7g}"): mark.outside for mark in find_marks(own)}
    rest = np.where(np.isin(own, [mark for mark, outside in marks.items() if outside]), np.nan, own)
    return marks | {float(f"{value:.7g}"): False for value, _ in possible_marks(rest)}


def _draft_text(scan: ScanFiles, lines: list[str], drafts: Mapping, shown: Mapping) -> str:
    """Draft of a sidecar: keys of both faces, then keys of one face."""
    files = " and ".join(printable(path.name) for path in scan.files)
    name = split_file_name(scan.lower.name)[0]
    text = _HEAD.format(files=files, picture=f"{name}{DRAFT}.png", sidecar=f"{name}.yaml")
    lower, upper = shown["lower"], shown.get("upper")
    text += "\n".join(_with_marks(lines, lower)) + "\n"
    if upper is None:
        return text + _confirmed(lower)
    own = {key: value for key, value in drafts["upper"][1].items()
           if value is not None and value != drafts["lower"][1].get(key, value)}  # fmt: skip
    for face, described in (("lower", lower), ("upper", upper)):
        block = [f"{key}: {written(value)}" for key, value in own.items()] * (face == "upper")
        block += _confirmed(described).rstrip("\n").split("\n") if described.scan else []
        text += f"{face}:\n" + "".join(f"  {line}\n" for line in block) if block else ""
    return text


def _with_marks(lines: list[str], face: Face) -> list[str]:
    """Lines with the marks of missing cells that all of the file shows, not its first lines."""
    missing = face.options.get("missing")
    if face.among and missing == NO_MARK:
        numbers = ", ".join(map(number, face.among[:_MAX_NAMED]))
        return [
            f"missing:                  # FILL IN: none, or the mark of missing cells: {numbers}?"
            if line.startswith("missing:")
            else line
            for line in lines
        ]
    return [
        f"missing: {written(missing):<16} # the file holds it as no height could be"
        if line.startswith(f"missing: {NO_MARK}") and missing not in (None, NO_MARK)
        else line
        for line in lines
    ]


def _confirmed(face: Face) -> str:
    if face.scan is None:
        return ""
    size = face.scan.size
    return _CONFIRMED + "".join(f"  {key}: {written(value)}\n" for key, value in size.items())


def size_words(face: Face) -> str:
    """Cells or points of a file, its relief in its own numbers, and its missing cells."""
    if face.scan is None:
        return "refused"
    size, values = face.scan.size, face.scan.values
    heights = values if face.scan.layout == "matrix" else values[:, 2]
    missing = percent(float(np.isnan(heights).mean()))
    ny, nx = size.get("shape", (0, 0))
    cells = f"{nx} x {ny} cells" if nx else f"{size['points']} points"
    return f"{cells}, relief {size.get('relief', float('nan')):g}, missing {missing}"


def _beside(scan: ScanFiles, ending: str) -> Path:
    """Path of a draft's file beside a scan."""
    return scan.lower.with_name(f"{split_file_name(scan.lower.name)[0]}{DRAFT}{ending}")


# -- files of one instrument ---------------------------------------------------------------------


def write_alike(scan: ScanFiles, like: Mapping[str, Any]) -> Described:
    """Report on a scan that gets the sidecar of another scan of the same instrument, if it fits.

    ``scan`` has no sidecar; ``like`` is the whole content of the other one.
    """
    blocks = [of_face(like, face) for face in FACES][: len(scan.files)]
    faces = [Face(*pair) for pair in zip(scan.files, map(_scan_keys, blocks), strict=True)]
    sizes = []
    for face, block in zip(faces, blocks, strict=True):
        try:
            face.scan = scan_in_mm(face.path, face.options)
        except InputError as error:
            return Described(scan.name, "refused", sentences=[str(error).split("\n")[0]])
        sizes.append(face.scan.size)
        relief, expected = sizes[-1].get("relief"), block.get("confirmed", {}).get("relief")
        if relief and expected and not 1 / ALIKE <= relief / expected <= ALIKE:
            sentence = (
                f"{face.path}: the relief is {relief:g}, but the sidecar was confirmed for "
                f"{expected:g}; describe this scan by itself"
            )
            return Described(scan.name, "refused", sentences=[sentence])
    described = Described(scan.name, "written", [size_words(face) for face in faces])
    own = ("confirmed", "label", *FACES)
    whole = like if len(faces) == 2 else blocks[0]
    document = {key: value for key, value in whole.items() if key not in own}
    if len(faces) == 1:
        document["confirmed"] = sizes[0]
    else:
        for key, size in zip(FACES, sizes, strict=True):
            block = {name: value for name, value in like.get(key, {}).items() if name not in own}
            document[key] = block | {"confirmed": size}
    text = yaml.safe_dump(document, sort_keys=False, allow_unicode=True)
    name = split_file_name(scan.lower.name)[0]
    scan.lower.with_name(f"{name}.yaml").write_text(text, encoding="utf-8")
    described.picture = _beside(scan, ".png")
    draw_faces(faces, described.picture)
    return described


def _scan_keys(document: Mapping[str, Any]) -> dict[str, Any]:
    allowed = ScanKeys.model_fields.keys() - {"confirmed", *FACES}
    return {key: value for key, value in document.items() if key in allowed}


def _like(path: Path, scans: Mapping[str, ScanFiles]) -> tuple[dict, ScanFiles]:
    """Content of a sidecar or a draft, and its scan."""
    document = read_yaml(path)
    if empty := [key for key, value in document.items() if value is None]:
        raise InputError(f"{path}: key '{empty[0]}' is empty; fill it in")
    name = split_file_name(path.name)[0].removesuffix(DRAFT)
    own = [scan for scan in scans.values() if split_file_name(scan.lower.name)[0] == name]
    if not own:
        raise InputError(f"{path}: no scan {name} beside it; name the sidecar of a scan")
    return document, own[0]


# -- the command -----------------------------------------------------------------------------------


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Write drafts and pictures, print one table; 1 if a file cannot be read at all, else 0."""
    parser = argparse.ArgumentParser(prog="describe", description=__doc__.split("\n")[0])
    parser.add_argument("folder", nargs="?", help="default: the study's")
    parser.add_argument("--file", type=Path, help="this scan alone, with its picture in any case")
    parser.add_argument("--like", type=Path, help="sidecar or draft that holds for all alike")
    parser.add_argument("--study", default="config/paper.yaml")
    chosen = parser.parse_args(arguments)
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]  # a text file
    study = read_study(chosen.study)
    path = chosen.file or chosen.like
    folder = path.parent if path else Path(chosen.folder or study.get("scans") or "scans")
    return _run(folder, chosen)


def _run(folder: Path, chosen: argparse.Namespace) -> int:
    scans, refused = list_scans(folder)
    names = sorted(scans, key=natural_key)
    if chosen.file:
        names = [name for name in names if chosen.file.name in [f.name for f in scans[name].files]]
        if not names:
            raise InputError(f"{chosen.file}: no scan of this name in {folder}")
    rows = []
    if not chosen.file:
        rows = [Described(name, "refused", sentences=[str(why)]) for name, why in refused.items()]
    for row in rows:
        sys.stdout.write("\n".join(row_lines(row)) + "\n")
    like = _like(chosen.like, scans) if chosen.like else None
    for name in names:
        scan = scans[name]
        if like is None:
            row = describe_or_refuse(scan, always=chosen.file is not None)
        elif scan.sidecar is None and scan.lower.suffix == like[1].lower.suffix:
            row = write_alike(scan, like[0])
        else:
            continue
        rows.append(row)
        sys.stdout.write("\n".join(row_lines(row)) + "\n")
        sys.stdout.flush()
    drawn = [row for row in rows if row.picture]
    if len(drawn) > 1:
        (folder / PAGE).write_text(_page(rows), encoding="utf-8")
        sys.stdout.write(f"pictures: {folder / PAGE}\n")
    states = [row.state for row in rows]
    counts = {state: states.count(state) for state in dict.fromkeys(states)}
    sys.stdout.write(f"{folder}: {', '.join(f'{n} {state}' for state, n in counts.items())}\n")
    return int("refused" in counts)


def describe_or_refuse(scan: ScanFiles, *, always: bool = False) -> Described:
    """Report on a scan as of :func:`describe`, or the sentence by which it is refused."""
    try:
        return describe(scan, always=always)
    except InputError as error:
        return Described(scan.name, "refused", sentences=[str(error)])


def row_lines(row: Described) -> list[str]:
    """Lines of the table of drafts for one specimen."""
    fill = f"; fill in {', '.join(row.to_fill)}" if row.to_fill else ""
    first = f"{printable(row.name, 24):24} {row.state:9} {' | '.join(row.sizes)}{fill}"
    return [
        first,
        *(f"    {printable(sentence, 300)}" for sentence in dict.fromkeys(row.sentences)),
    ]


def _page(rows: Sequence[Described]) -> str:
    """Page of all pictures, with the next steps."""
    parts = ["<!doctype html><meta charset='utf-8'><title>scans as they would be read</title>"]
    for row in rows:
        words = html.escape("\n".join(row_lines(row)))
        image = f"<img src='{html.escape(row.picture.name)}' width='900'>" if row.picture else ""
        parts.append(f"<pre>{words}</pre>{image}")
    return "\n".join(parts)


if __name__ == "__main__":
    sys.exit(main())
