"""The result page of a study: an index, a page a specimen, and the tables beside them.

All of it is static, links to nothing outside the folder of results, and opens from the disk.
"""

import datetime
import io
import json
import re
import zipfile
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
import yaml

from ..core.atomic import atomic_write
from ..core.determined import decided_by_scan
from ..core.labels import OPPOSITE, printable
from ..core.measured_maps import measured_maps
from ..core.subject import Subject, configuration_of
from ..core.tables import write_table
from ..core.text import duration, interval, number, undetermined
from ..report.caveats import aperture_caveat
from ..report.published import Number, Row, row_of, shown_in, stages_of
from ..report.scan_words import warnings_of_specimen
from ..study.atlas_parts import Trees
from ..study.campaign import JOINT as JOINT_FIGURES
from ..study.figure_list import JOINT, SPECIMEN, STUDY, all_figures
from .cells import absent, bare_words, error_words, estimate_words, shown, sort_value, value_words
from .common_loads import common_loads, main_load
from .curves import curves_table
from .figure_cards import SECTIONS, cards_of, png_size, section_of
from .files import (
    APERTURE,
    CARD,
    CONFIGURATION,
    CURVES,
    INDEX,
    SPECIMEN_PAGE,
    STATEMENTS,
    SUMMARY,
    TABLES,
)
from .first_screen import block_of, is_synthetic, quoted_methods
from .history import history
from .laboratory import calibration_of, tests_of
from .matrix import Row as Judged
from .matrix import checks_of, controls_of, counted, matrix_of, merged, of_study, statement_table
from .summary import Sheet, sheet_of, summary_table
from .templating import write_page
from .thumbnails import relief_thumbnail

#: Stages that the pages read. The fields of contact, the largest stage, are left out.
NEEDS = stages_of("summary", "curves", "page", "index", "section") | {
    *("quality", "choices", "statements"),
    *("study_statements", "study_comparison", "contact_maps"),
}
#: Time stamp of all members of an archive: the same tables then give the same archive.
_ZIP_TIME = (1980, 1, 1, 0, 0, 0)
#: Most letters of a label in a table.
_LONGEST = 120
#: Most letters of a warning of a scan.
_LONGEST_WARNING = 400
#: Number of a figure of the paper at the beginning of a title.
_FIGURE = re.compile(r"Figs?\. \d")
#: Last line of the log of a job.
_WORKED = re.compile(r"^worked ([\d.]+) s", re.MULTILINE)
#: Most joints with a block each on the first screen, and with a column each of verdicts.
_BLOCKS, _COLUMNS = 12, 30


@dataclass(frozen=True)
class Place:
    """Paths of the files of a study.

    Pages go to ``folder``, and name figures, atlas and explorer as files there. The last lines of
    ``logs``, which may be missing, say how long the jobs worked.
    """

    atlas: Path
    figures: Path
    logs: Path
    folder: Path

    @classmethod
    def of(cls, results: Path) -> "Place":
        """The folder of the results of a study."""
        return cls(results / "atlas.nc", results / "figures", results / "logs", results)


def write_specimen_pages(
    place: Place, explored: Collection[str], trees: Trees | None = None
) -> None:
    """Write the pages of the specimens of an atlas, which may hold one specimen of a study.

    ``explored`` are the specimens that the explorer shows. ``trees`` is the atlas with at least the
    stages of :data:`NEEDS`, where it is read already.
    """
    trees = trees or Trees(place.atlas, NEEDS)
    head = _head(place, trees.root) | {"explored": explored}
    for name in trees.names:
        tree, groups, file = trees.of(name)
        subject, rows = Subject.of(tree, name), matrix_of(tree, [name])
        values = _specimen_values(
            place, subject, sheet_of(subject), rows, (_as_typed(file), groups)
        )
        path = place.folder / SPECIMEN_PAGE.format(specimen=name)
        write_page(path, "specimen.html", head | values | quoted_methods(name, place.folder))


def write_index(place: Place, explored: Collection[str]) -> list[str]:
    """Specimens of a study, whose index is written with the other files of :data:`files.FILES`.

    ``explored`` are the specimens that the explorer shows; it may be written later.
    """
    trees = Trees(place.atlas, NEEDS)
    atlas, names = trees.root, trees.names
    reported = [trees.closure(name) for name in names]
    loads = common_loads(reported, _comparison(atlas))
    head = _head(place, atlas)
    head["explored"] = explored
    specimens, curves, rows, blocks, reliefs = [], [], [], [], {}
    cards = {name: place.folder / CARD.format(specimen=name, ending="json") for name in names}
    carded = [name for name, path in cards.items() if path.is_file()]
    study = configuration_of(atlas)["study"]
    # Specimens are read one after the other: an atlas in parts may not fit into memory.
    for name in names:
        tree = trees.of(name)[0]
        subject = Subject.of(tree, name)
        specimens.append(sheet_of(subject, loads))
        rows.append(matrix_of(tree, [name]))
        reliefs[name] = relief_thumbnail(subject["specimens"])
        curves.append(curves_table(str(atlas.attrs["study"]), [subject]))
        if name in carded and len(carded) <= _BLOCKS:
            blocks.append(block_of(subject, is_synthetic(name, study)))
    matrix, first = merged(rows), main_load(loads, reported)
    table = _finite(pd.concat(curves) if curves else curves_table("", []))
    judged = statement_table(str(atlas.attrs["study"]), [*matrix, *of_study(atlas)])
    _write_files(place, atlas, specimens, {CURVES: table, STATEMENTS: judged})
    values = _index_values(place, atlas, specimens, matrix, table, trees.held) | {
        "reliefs": reliefs,
        "loads": loads,
        "first_load": first,
        "blocks": blocks,
        "overviews": {name: size for name in names if (size := _overview_size(place, name))},
        "with_card": carded,
    }
    write_page(place.folder / INDEX, "index.html", head | values)
    return names


# -- what all pages have ---------------------------------------------------------------------------


def _head(place, atlas):
    """Values of all templates: study, date, versions, formatting functions."""
    written = datetime.datetime.fromtimestamp(place.atlas.stat().st_mtime, datetime.UTC)
    return {
        "study": printable(atlas.attrs["study"]),
        "date": f"{written:%Y-%m-%d %H:%M} UTC",
        "versions": json.loads(atlas.attrs["versions"]),
        "versions_differ": json.loads(atlas.attrs.get("versions_differ", "{}")),
        "atlas_size": f"{number(place.atlas.stat().st_size / 1e6, 0)} MB",
        "atlas_path": _as_typed(place.atlas),
        "absent": absent,
        "value_words": value_words,
        "bare_words": bare_words,
        "error_words": error_words,
        "estimate": estimate_words,
        "undetermined": undetermined,
        "aperture_caveat": aperture_caveat,
        "decided_by_scan": decided_by_scan,
        "uncertain": lambda one: interval(*one.estimate.ends),
        "sort_value": sort_value,
        "shown": shown,
        "row_of": row_of,
        "in_paper": _in_paper,
        # A study without the paper has its statements folded, on the index alone.
        "without_paper": configuration_of(atlas)["study"].get("figures") == JOINT_FIGURES,
    }


def _as_typed(path):
    """Path of an atlas as a user would type it in the folder of the project."""
    folder = path.parent.parent if path.parent.name == "atlas" else path.parent
    return "/".join(("results", folder.name, path.relative_to(folder).as_posix()))


def _columns() -> dict[str, list[Row]]:
    """Columns of the table of specimens from the register, by the kind of their cells."""
    columns: dict[str, list[Row]] = {"dimension": [], "budget": [], "number": []}
    for row in shown_in("index"):
        kind = "dimension" if row.dimension else "budget" if row.budget else "number"
        columns[kind].append(row)
    return columns


def _in_paper(figures):
    """Place of a statement in the paper: "Figs. 4, 5", "sect. 7" or "eq. 2"."""
    if figures.startswith(("sect", "eq")):
        return figures
    return f"Figs. {figures}" if len(re.findall(r"\d+", figures)) > 1 else f"Fig. {figures}"


def _work(logs: Path) -> str:
    """Time and number of the jobs of a study, in words; empty without their logs."""
    texts = (path.read_text(encoding="utf-8", errors="replace") for path in logs.rglob("*.log"))
    seconds = [float(last) for text in texts for last in _WORKED.findall(text)[-1:]]
    return f"{duration(sum(seconds))} of work in {len(seconds)} jobs" if seconds else ""


# -- the pages -------------------------------------------------------------------------------------


def _index_values(
    place: Place,
    atlas: xr.DataTree,
    specimens: list[Sheet],
    rows: list[Judged],
    curves: pd.DataFrame,
    groups: Collection[str],
) -> dict[str, Any]:
    """Values of ``index.html`` but for those of :func:`_head`, from the rows of its tables."""
    own = [name for name, figure in all_figures().items() if figure.subject == STUDY]
    together = of_study(atlas)
    return {
        "specimens": specimens,
        "work": _work(place.logs),
        "columns": _columns(),
        "longest": _LONGEST,
        "matrix": rows,
        "counted": counted if len(specimens) > _COLUMNS else None,
        "verdicts": counted([*rows, *together]),
        "controls": controls_of(rows),
        "checks": checks_of(rows),
        "together": together,
        "maps": [printable(one.attrs["label"], _LONGEST) for one in measured_maps(atlas).values()],
        "cards": cards_of(
            own,
            place.figures,
            "figures",
            atlas=_as_typed(place.atlas),
            groups=groups,
        ),
        "curves": _records(curves),
        "pictures": _pictures(rows, place),
        "of_paper": _of_paper(place, configuration_of(atlas)["study"], specimens),
    }


def _overview_size(place: Place, name: str) -> tuple[int, int] | None:
    """Pixels of the picture of a joint on the first screen; None where it was not drawn."""
    path = place.figures / name / "overview.png"
    return png_size(path) if path.is_file() else None


def _of_paper(
    place: Place, study: Mapping[str, Any], specimens: Iterable[Sheet]
) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """Figures of the paper: number, title here, and the specimens with the name of their figure.

    Specimens are in the order of the study, in which the paper's sandstone is the first.
    """
    names = [sheet.words["specimen"] for sheet in specimens]
    order = [name for name in study.get("embedded", {}) if name in names]
    order += [name for name in names if name not in order]
    rows = []
    for name, figure in all_figures().items():
        numbers, _, title = figure.title.partition(": ")
        drawn = [one for one in order if (place.figures / one / f"{name}.png").is_file()]
        if _FIGURE.match(numbers) and drawn:
            rows.append((numbers, title, [(one, name) for one in drawn]))
    return rows


def _comparison(atlas):
    """Specimens side by side; None for a single one."""
    several = "study_comparison" in atlas.children
    return atlas["study_comparison/study"].to_dataset() if several else None


def _finite(table: pd.DataFrame) -> pd.DataFrame:
    """Table with infinite values as missing ones, for spreadsheets and scripts."""
    return table.mask(table.isin([np.inf, -np.inf]))


def _records(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows of a table for a script; None for missing numbers."""
    return table.astype(object).where(table.notna(), None).to_dict("records")


def _pictures(rows: Iterable[Judged], place: Place) -> set[tuple[str, str]]:
    """Specimens and figures of statements whose picture exists."""
    shown = {(name, cell.figure) for row in rows for name, cell in row.cells.items()}
    return {
        (name, figure)
        for name, figure in shown
        if (place.figures / name / f"{figure}.png").is_file()
    }


def _specimen_values(
    place: Place,
    subject: Subject,
    sheet: Sheet,
    rows: list[Judged],
    held: tuple[str, Collection[str]],
) -> dict[str, Any]:
    """Values of ``specimen.html`` but for those of :func:`_head`.

    ``held`` is the path of its atlas, as typed, and the names of the groups in it.
    """
    figures, choices = all_figures(), subject["choices"]
    faces = [str(face) for face in subject["quality"]["face"].values]
    names = [name for name, one in figures.items() if one.subject in (SPECIMEN, JOINT)]
    cards = cards_of(
        names,
        place.figures / subject.name,
        f"../figures/{subject.name}",
        atlas=held[0],
        groups=held[1],
        specimen=subject.name,
    )
    aperture = APERTURE.format(specimen=subject.name, ending="vtk")
    sections = [
        (name, title, [card for card in cards if section_of(figures[card.name]) == name])
        for name, title in SECTIONS.items()
    ]
    return {
        "sheet": sheet,
        "material": subject.settings["material"],
        "label": printable(subject.label),
        "opposite": OPPOSITE[sheet.words["opposite"]],
        "tests": tests_of(subject),
        "calibration": calibration_of(subject),
        "sections": [(name.replace(" ", "-"), title, found) for name, title, found in sections],
        "history": history(subject["specimens"], faces),
        "warnings": _warnings(subject),
        "quantities": _quantities(subject, sheet),
        "plan": choices.attrs,
        "choices": choices[["value", "reason", "error", "error_of"]].to_dataframe().itertuples(),
        "statements": [(row, row.cells[subject.name]) for row in rows],
        "apertures": (place.folder / aperture).is_file(),
        "drawn": {card.name for card in cards},
    }


def _warnings(subject: Subject) -> list[str]:
    """Warnings of the check of scans that no light repeats, and a doubt about its twins."""
    of_light = str(subject["quality"].attrs.get("warning", ""))
    warnings = warnings_of_specimen(subject["specimens"], subject["quality"])
    ensemble = subject.stages.get("ensemble", xr.Dataset())
    if doubt := str(ensemble.attrs.get("doubt", "")):
        warnings = [*warnings, f"first touch and dilatancy of its twins mean little: {doubt}"]
    return [printable(warning, _LONGEST_WARNING) for warning in warnings if warning != of_light]


def _quantities(subject: Subject, sheet: Sheet) -> list[tuple[Row, Number, str, str]]:
    """Rows of the specimen's page: number, name, and where the scan lies among its twins."""
    budget, quantities = subject.state("error_budget"), []
    for row in shown_in("page"):
        within = ""
        if "within_twins" in budget and row.budget in budget["quantity"]:
            within = str(budget["within_twins"].sel(quantity=row.budget).item())
        several = "{" in row.page
        numbers = sheet.numbers[row.name] if several else [sheet.of(row.name)]
        quantities += [(row, number, row.page.format(**number.at), within) for number in numbers]
    return quantities


# -- the files beside them -------------------------------------------------------------------------


def _write_files(
    place: Place, atlas: xr.DataTree, specimens: list[Sheet], tables: Mapping[str, pd.DataFrame]
) -> None:
    """Write the summary, further tables by file, the configuration, and the archive of tables."""
    summary = summary_table(str(atlas.attrs["study"]), specimens, measured_maps(atlas))
    write_table(place.folder / SUMMARY, _finite(summary))
    for name, table in tables.items():
        write_table(place.folder / name, table)
    _write_configuration(place.folder / CONFIGURATION, atlas)
    _write_tables(place)


def _write_configuration(path: Path, atlas: xr.DataTree) -> None:
    """Write the study as its user wrote it, without comments: it can be run again."""
    stated: Mapping[str, Any] = configuration_of(atlas)["study"]
    text = yaml.safe_dump(dict(stated), sort_keys=False, allow_unicode=True)
    with atomic_write(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _write_tables(place: Place) -> None:
    """Write all numbers drawn in figures, with the tables of the study, into one archive."""
    members = [(place.folder / name, name) for name in (SUMMARY, CURVES, STATEMENTS)]
    for path in sorted(place.figures.rglob("*.csv")):
        members.append((path, f"figures/{path.relative_to(place.figures).as_posix()}"))
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, name in members:
            member = zipfile.ZipInfo(name, _ZIP_TIME)
            member.external_attr = 0o644 << 16  # unpacked files can be read
            archive.writestr(member, path.read_bytes(), zipfile.ZIP_DEFLATED)
    with atomic_write(place.folder / TABLES) as temporary:
        temporary.write_bytes(stream.getvalue())
