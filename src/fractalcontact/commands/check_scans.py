"""Check of the scans of a folder: each is read as by a study and described, without a solve.

Laboratory tables that sidecars or the study name are read too.

python -m fractalcontact.commands.check_scans [FOLDER] [--study config/paper.yaml]
"""

import argparse
import json
import math
import sys
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from ..core.errors import InputError, said_in_one_line
from ..core.labels import natural_key, printable
from ..core.text import length_words, percent, plain
from ..core.window import face_words, spacing_of, window_sides
from ..domain.measured_map import read_contact_map
from ..gridding.outline import outline_words
from ..joint.joint import choose_offsets
from ..measured.beforehand import check_tests
from ..measured.readings import read_test
from ..report.scan_words import gap_words, outlier_words, warnings_of_specimen
from ..roughness.dimension import surface_dimension
from ..roughness.quality import scan_quality
from ..roughness.quality_words import overlap_words, suspect_words
from ..roughness.recommended import beyond_roll_off, dimension_words
from ..scan.read import read_faces
from ..stages.specimen import specimen_of_faces
from ..states.states import hardness_of
from ..study.checks import check_study, read_scans
from ..study.configuration import resolve_settings, solver_settings
from ..study.documents import read_study
from ..study.laboratory_tests import require_files
from ..study.scan_groups import grouped_notes
from ..study.sidecar import is_contact_map

#: Columns of the table: heading and width.
COLUMNS = {
    "specimen": 16,
    "faces": 5,
    "cells": 11,
    "spacing": 10,
    "field (mm)": 13,
    "relief": 8,
    "missing": 7,
    "outl.": 5,
    "tilt": 5,
    "window (mm)": 13,
    "noise": 8,
    "shortest": 8,
}
WIDTH = 120
LEGEND = (
    "cells, field, window: x, y. relief: highest less lowest. missing: of the face with more. "
    "outl.: cells flagged as outliers. noise: standard deviation of independent errors of the "
    "cells (< where none is seen). shortest: wavelength below which the relief is the "
    "instrument's; a spacing s shows waves from 2 s on."
)
INDENT = "    "


@dataclass
class Checked:
    """Report on one specimen, or on a file that makes none.

    ``cells`` has text by column of the table, and is empty if it was refused; ``lines`` are
    sentences below it; ``refusal`` is why it cannot be read.
    """

    name: str
    cells: dict[str, str] = field(default_factory=dict)
    lines: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    refusal: str = ""


def check_scans(folder: Path | str, study: Mapping, source: str) -> Iterator[Checked]:
    """Reports on all scans of a folder, numbers in names sorted as numbers.

    ``study`` has passed :func:`study.checks.check_study`; ``source`` is its file, for errors. A
    refused scan does not keep the others from being read.
    """
    scans, stated, refused = read_scans({**study, "scans": folder})
    for name in sorted(scans.keys() | refused.keys(), key=natural_key):
        scan = scans.get(name)
        try:
            if name in refused:
                raise refused[name]
            yield _check(scan, study, source, stated[name])
        except InputError as error:
            if scan is None:
                yield Checked(name, refusal=str(error))
                continue
            yield Checked(name, lines=[_file_names(scan)], refusal=_shown(error, scan))
    yield from _embedded(study, source)


def _embedded(study, source):
    """Laboratory tests of specimens that the study generates; the study states all else of them."""
    for name in sorted(study.get("embedded", {}), key=natural_key):
        row, tests = Checked(name, lines=[f"embedded in {source}"]), []
        try:
            tests = resolve_settings(study, name, {}, source).measured
            require_files(tests)
            _add_tests(row, [(test, read_test(test)) for test in tests])
        except InputError as error:
            row.refusal = str(error)
        if tests or row.refusal:
            yield row


def _check(scan, study, source, stated):
    """Report on one specimen, read as the rules of the study read it."""
    if scan.name in study.get("embedded", {}):
        raise InputError(f"'{scan.name}' is also an embedded specimen of {source}; rename one")
    options, own = stated
    if is_contact_map(options):
        return _map_row(scan, read_contact_map(scan.lower, options, label=scan.name))
    settings = resolve_settings(study, scan.name, own, source, scan)
    faces = read_faces(scan.lower, scan.upper, options)
    specimen = specimen_of_faces(*faces, settings, scan.name)
    _require_solvable(specimen, settings)
    require_files(settings.measured)
    dimension = surface_dimension(
        specimen["lower"].values, spacing_of(specimen), fit_range=settings.surface_range
    )
    tests = check_tests(specimen, settings, solver_settings(study, source))
    row = _specimen_row(scan, specimen, scan_quality(specimen, settings.resolutions))
    if specimen.attrs["outlier_count"] and settings.outliers == "fill" and not scan.upper:
        # Outliers that are filled may be missing cells, or a misread file: their heights tell.
        kept = replace(settings, outliers="keep")
        as_scanned = specimen_of_faces(*faces, kept, scan.name)
        row.warnings.append(outlier_words(as_scanned, "filled in the study"))
    _add_tests(row, tests)
    doubtful = dimension["no_dimension"].item() or beyond_roll_off(dimension)
    (row.warnings if doubtful else row.lines).append(dimension_words(dimension))
    return row


def _require_solvable(specimen, settings):
    """Refuse offsets and loads that the study would refuse after reading the specimen."""
    every = dict.fromkeys([*settings.directions, *settings.contact_directions])
    choose_offsets(specimen, settings.offsets, list(every))
    hardness_of(settings, specimen)


def _add_tests(row, tests):
    """Add a sentence on each laboratory test, and warnings of its readings."""
    for test, read in tests:
        name = printable(Path(test.file).name)
        row.lines.append(f"{test.kind} test {test.label}: {name}, {read.curve.x.size} readings")
        row.lines += filter(None, (read.note,))
        row.warnings += filter(None, (read.warning,))


def _specimen_row(scan, specimen, quality):
    """Numbers, sentences and warnings of a specimen."""
    attrs, faces = specimen.attrs, [str(face) for face in quality["face"].values]
    files = [json.loads(attrs[f"{face}_scan"]) for face in faces]
    end = quality["range_end"].item()
    relief = float(quality["highest"].max() - quality["lowest"].min())
    cells = {
        **_grid_cells(specimen.sizes, attrs),
        "specimen": scan.name,
        "faces": str(len(faces)),
        "relief": length_words(relief),
        "missing": percent(quality["missing_share"].values.max()),
        "outl.": str(attrs.get("outlier_count", "-")),
        "tilt": f"{attrs['tilt_degrees']:.1f}°",
        "window (mm)": _pair(window_sides(specimen)[::-1]),
        "noise": _noise(quality),
        "shortest": length_words(end) if math.isfinite(end) else "-",
    }
    lines = [_file_names(scan)]
    for face, file in zip(faces, files, strict=True):
        words = face_words(specimen, face)
        stated = f"{words}: {file['reader']}, {file['layout']}, unit {file['file_unit']}"
        lines.append("; ".join(filter(None, (stated, file["notes"]))))
        if file.get("overrides"):
            lines.append(f"{words}, the sidecar overrides: {file['overrides']}")
    warnings = warnings_of_specimen(specimen, quality)
    if len(faces) == 2:
        overlap = overlap_words(specimen, quality)
        is_warned_of = any(overlap in warning for warning in warnings)
        lines.append(gap_words(specimen) if is_warned_of else f"{gap_words(specimen)}; {overlap}")
    if suspicious := suspect_words(specimen):
        lines.append(f"suspicious: {suspicious}")
    return Checked(scan.name, cells, lines, warnings)


def _noise(quality):
    """Largest noise floor seen, or its upper bound where none is seen."""
    seen = quality["noise_rms"].max().item()
    if math.isfinite(seen):
        return length_words(seen)
    limit = quality["noise_limit"].max().item()
    return f"<{length_words(limit)}" if math.isfinite(limit) else "-"


def _map_row(scan, contact):
    """Numbers of a measured contact map."""
    attrs = contact.attrs
    cells = {
        **_grid_cells(contact.sizes, attrs),
        "specimen": scan.name,
        "faces": "map",
        "missing": percent(1 - float(contact["measured"].mean())),
    }
    nominal, share, pressure, force = (
        float(contact[name]) for name in ("nominal_area", "area_share", "nominal_pressure", "force")
    )
    series = f", series {attrs['series']}" if attrs["series"] else ""
    stated = (
        f"contact map: {attrs['reader']}, A_0 = {nominal:.4g} mm2 (outline: "
        f"{outline_words(json.loads(attrs['outline']))}), {percent(share)} in contact above "
        f"{attrs['threshold']:g}{series}"
    )
    load = f"F = {force:.4g} N, F/A_0 = {pressure:.4g} MPa"
    lines = [_file_names(scan), stated, load if math.isfinite(pressure) else "no load stated"]
    if not attrs["binary"]:
        force = f"{attrs['integral']:.4g} N"
        lines.append(f"the cells within the outline add up to {force} if they hold MPa")
    if contact.sizes["threshold"] > 1:
        shares = ", ".join(
            f"{percent(part)} above {threshold:g}"
            for threshold, part in zip(
                contact["threshold"].values, contact["threshold_area_share"].values, strict=True
            )
        )
        lines.append(f"in contact {shares}")
    return Checked(scan.name, cells, lines, [attrs["warning"]] if attrs["warning"] else [])


def _grid_cells(sizes, attrs):
    """Cells, spacing and field, for the table."""
    spacings = [attrs[f"spacing_{axis}"] for axis in "xy"]
    square = f"{spacings[0]:.3g}" == f"{spacings[1]:.3g}"
    return {
        "cells": f"{sizes['x']} x {sizes['y']}",
        "spacing": length_words(spacings[0]) if square else _pair(spacings),
        "field (mm)": _pair([sizes[a] * s for a, s in zip("xy", spacings, strict=True)]),
    }


def _pair(lengths):
    """Two lengths (x, y) in mm."""
    return " x ".join(plain(length) for length in lengths)


def _file_names(scan):
    """Files of a specimen and the source of its settings, below the folder of its group."""
    names = [path.name for path in (*scan.files, scan.sidecar, scan.shared) if path]
    within = f"group {printable(scan.group)}: " if scan.group else ""
    stated = f", {printable(scan.row_of)}" if scan.row_of else ""
    return f"{within}{' + '.join(map(printable, names))}{stated}"


def _shown(error, scan):
    """Message of an error; file names in it cannot control a terminal."""
    message = str(error)
    for path in (scan.lower, scan.upper, scan.sidecar, scan.shared):
        if path is not None:
            message = message.replace(path.name, printable(path.name))
    return message


# -- the table -------------------------------------------------------------------------------------


def table_lines(checked: Checked) -> list[str]:
    """Lines of the table for one specimen, of at most `WIDTH` letters unless a word is longer."""
    name = printable(checked.name, COLUMNS["specimen"])
    row = _row(checked.cells | {"specimen": name}) if checked.cells else name
    sentences = [*checked.lines]
    sentences += [f"WARNING: {warning}" for warning in checked.warnings]
    if checked.refusal:
        sentences.append(f"REFUSED: {checked.refusal}")
    elif not checked.warnings:
        sentences.append("ok")
    wrapped = [line for sentence in sentences for line in _wrapped(sentence)]
    return [row, *wrapped]


def _row(cells):
    return " ".join(f"{cells.get(key, ''):<{width}}" for key, width in COLUMNS.items()).rstrip()


def _wrapped(sentence):
    """Lines of a sentence; its own line breaks (text of a sidecar) are kept."""
    lines = []
    for line in sentence.split("\n"):
        lead = INDENT + " " * (len(line) - len(line.lstrip()))
        lines += textwrap.wrap(
            printable(line.strip()),
            WIDTH,
            initial_indent=lead,
            subsequent_indent=lead + "  ",
            break_on_hyphens=False,
        )
    return lines


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table; 1 if a file was refused or the study is wrong, else 0."""
    parser = argparse.ArgumentParser(prog="check_scans", description=__doc__.split("\n")[0])
    parser.add_argument("folder", nargs="?", help="default: the study's")
    parser.add_argument("--study", default="config/paper.yaml")
    options = parser.parse_args(arguments)
    # Names may have letters that the encoding of the terminal lacks.
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]  # a text file
    study = read_study(options.study)
    check_study(study, options.study)
    return _print_table(Path(options.folder or study.get("scans") or "scans"), study, options.study)


def _print_table(folder, study, source):
    """Print the report on each file of a folder; 1 if one was refused, else 0."""
    counts = {"ok": 0, "with warnings": 0, "refused": 0}
    _write([_row({key: key for key in COLUMNS}), "-" * WIDTH])
    for checked in check_scans(folder, study, source):
        state = "refused" if checked.refusal else "with warnings" if checked.warnings else "ok"
        counts[state] += 1
        _write(table_lines(checked))
    _write(["-" * WIDTH, *_wrapped(LEGEND)])
    for note in grouped_notes(folder, study.get("groups")):
        _write(_wrapped(f"NOTE: {note}"))
    words = ", ".join(f"{n} {state}" for state, n in counts.items())
    _write([f"{printable(folder)}: {words}"])
    return int(counts["refused"] > 0)


def _write(lines):
    sys.stdout.write("\n".join(lines) + "\n")
    sys.stdout.flush()  # a large scan takes a while


if __name__ == "__main__":
    sys.exit(main())
