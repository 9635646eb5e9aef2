"""Research Object Crate of a study: results, workflow and inputs as linked data.

RO-Crate 1.1 with the profile Workflow Run Crate 0.5, as one file of JSON-LD beside the atlas. The
files listed are those of the manifest, with their checksums.
"""

import contextlib
import datetime
import json
import mimetypes
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import quote

import yaml

from ..core import checksums
from ..core.atomic import atomic_write
from .figure_list import all_figures

FILE = "ro-crate-metadata.json"
_CODE = "code"
_CONTEXT = (
    "https://w3id.org/ro/crate/1.1/context",
    "https://w3id.org/ro/terms/workflow-run/context",
)
_SPECIFICATION = "https://w3id.org/ro/crate/1.1"
_PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": ("Process Run Crate", "0.5"),
    "https://w3id.org/ro/wfrun/workflow/0.5": ("Workflow Run Crate", "0.5"),
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": ("Workflow RO-Crate", "1.0"),
}
_BIOSCHEMAS = "https://bioschemas.org/profiles/ComputationalWorkflow/1.0-RELEASE"
_LICENCES = "https://spdx.org/licenses/"
#: Media types that the standard library does not know on every system.
_MEDIA = {
    ".nc": "application/x-netcdf",
    ".npy": "application/x-npy",
    ".yaml": "application/yaml",
    ".csv": "text/csv",
    ".smk": "text/x-python",
    ".py": "text/x-python",
}
#: Descriptions of files that belong to no stage and no figure.
_FILES = {
    "atlas.nc": "atlas: every number of the study, as netCDF-4",
    "specimens.txt": "names of the specimens",
    "index.html": "result page",
    "explorer.html": "explorer of all contact states",
    "summary.csv": "one row a specimen and pressure, or a measured contact map",
    "curves.csv": "curves against pressure",
    "statements.csv": "one row a statement of the paper and specimen, with its verdict",
    "tables.zip": "numbers drawn in all figures",
    "study.yaml": "configuration of the study",
}
_CONFIGURATION, _ATLAS = "study.yaml", "atlas.nc"
_FOLDERS = {
    "pages": "page of the specimen {stem}",
    "apertures": "aperture map of the specimen {stem} under the reference load",
    "cards": "card of the specimen {stem}: constants with intervals",
    "atlas": "atlas of the specimen {stem} alone",
    "embedded": "synthetic scan {stem}",
    "size_effect_parts": "size effect, surfaces {stem}",
}


@dataclass(frozen=True)
class Workflow:
    """The workflow that made a study.

    Attributes
    ----------
    folder : pathlib.Path
        Folder of the checkout, with CITATION.cff.
    main : str
        Main file of the workflow, in that folder.
    parts : tuple of str
        Patterns of its other files there.
    language, url, version : str
        Name, address and version of the workflow system.
    """

    folder: Path
    main: str
    parts: tuple[str, ...]
    language: str
    url: str
    version: str


def write_crate(
    results: Path | str, workflow: Workflow, study: str, inputs: Mapping[str, str]
) -> None:
    """Describe the results of a study, beside a copy of the files of its workflow.

    ``inputs`` are SHA-256 of the scans by path; they stay where they are. The files of the workflow
    are copied to the folder ``code``. Nothing is written without an atlas.
    """
    results = Path(results)
    atlas = results / _ATLAS
    if not atlas.is_file():
        return
    time = atlas.stat().st_mtime
    date = f"{datetime.datetime.fromtimestamp(time, datetime.UTC):%Y-%m-%dT%H:%M:%S+00:00}"
    citation = yaml.safe_load((workflow.folder / "CITATION.cff").read_text(encoding="utf-8"))
    code = _copied(results, workflow)
    files = [line.rstrip("\n").partition("  ")[::2] for line in checksums.lines_of(results)]
    entities = [_file(results, name, digest) for digest, name in files]
    graph = [
        *_heads(study, citation, date, code[0], [*code, *(entity["@id"] for entity in entities)]),
        *_people(citation),
        *_workflow_entities(results, workflow, citation, code),
        _action(study, date, _author_ids(citation), code[0], entities, inputs),
        *_scans(inputs),
        *entities,
    ]
    document = {"@context": list(_CONTEXT), "@graph": graph}
    with atomic_write(results / FILE) as path:
        text = json.dumps(document, indent=1, ensure_ascii=False)
        path.write_text(text + "\n", encoding="utf-8")


def _copied(results: Path, workflow: Workflow) -> list[str]:
    """Files of the workflow, as copied beside the results, the main one first."""
    copied = []
    for pattern in (workflow.main, *workflow.parts):
        for source in sorted(workflow.folder.glob(pattern)):
            name = f"{_CODE}/{source.relative_to(workflow.folder).as_posix()}"
            content = source.read_bytes()
            target = results / name
            if not (target.is_file() and target.read_bytes() == content):
                with atomic_write(target) as path:
                    path.write_bytes(content)
            copied.append(name)
    return copied


def _refer(names: Iterable[str]) -> list[dict[str, str]] | dict[str, str]:
    """References to entities: a list, or the reference itself where there is one entity."""
    references = [{"@id": name} for name in names]
    return references[0] if len(references) == 1 else references


def _heads(
    study: str, citation: Mapping, date: str, main: str, parts: Iterable[str]
) -> list[dict[str, Any]]:
    """Descriptor and root, which every crate has, and the profiles that it follows."""
    licence = _LICENCES + citation["license"]
    return [
        {
            "@id": FILE,
            "@type": "CreativeWork",
            "about": {"@id": "./"},
            "conformsTo": _refer(
                [_SPECIFICATION, "https://w3id.org/workflowhub/workflow-ro-crate/1.0"]
            ),
        },
        {
            "@id": "./",
            "@type": "Dataset",
            "name": f"Study {study}",
            "description": f"Results of the study {study}. {citation['title']}.",
            "datePublished": date,
            "license": {"@id": licence},
            "author": _refer(_author_ids(citation)),
            "conformsTo": _refer(_PROFILES),
            "mainEntity": {"@id": main},
            "mentions": _refer(["#run"]),
            "hasPart": _refer(parts),
        },
        {"@id": licence, "@type": "CreativeWork", "name": citation["license"], "url": licence},
        *(
            {"@id": url, "@type": "CreativeWork", "name": name, "version": version}
            for url, (name, version) in _PROFILES.items()
        ),
        {"@id": _BIOSCHEMAS, "@type": "CreativeWork", "name": "ComputationalWorkflow"},
    ]


def _author_ids(citation: Mapping) -> list[str]:
    return [
        person.get("orcid", f"#author-{number}")
        for number, person in enumerate(citation["authors"], 1)
    ]


def _people(citation: Mapping) -> list[dict[str, Any]]:
    """Authors: people have a family name, groups a name."""
    people = []
    for identifier, person in zip(_author_ids(citation), citation["authors"], strict=True):
        if "family-names" in person:
            names = {"familyName": person["family-names"], "givenName": person["given-names"]}
            name = f"{person['given-names']} {person['family-names']}"
            people.append({"@id": identifier, "@type": "Person", "name": name, **names})
        else:
            people.append({"@id": identifier, "@type": "Organization", "name": person["name"]})
    return people


def _workflow_entities(
    results: Path, workflow: Workflow, citation: Mapping, code: list[str]
) -> list[dict[str, Any]]:
    """Main file of the workflow, its other files, its language."""
    language = {"@id": "#language"}
    described = [_described(results, name) for name in code]
    described[0] |= {
        "@type": ["File", "SoftwareSourceCode", "ComputationalWorkflow"],
        "name": citation["title"],
        "version": str(citation["version"]),
        "programmingLanguage": language,
        "license": {"@id": _LICENCES + citation["license"]},
        "author": _refer(_author_ids(citation)),
        "conformsTo": {"@id": _BIOSCHEMAS},
        "hasPart": _refer(code[1:]),
    }
    system = {
        "@type": "ComputerLanguage",
        "name": workflow.language,
        "url": {"@id": workflow.url},
        "identifier": {"@id": workflow.url},
        "version": workflow.version,
    }
    return [*described, language | system]


def _action(
    study: str,
    date: str,
    agents: list[str],
    main: str,
    entities: list[dict],
    inputs: Mapping[str, str],
) -> dict[str, Any]:
    """Run of the workflow: from the configuration and the scans to all other files."""
    names = [entity["@id"] for entity in entities]
    taken = [name for name in names if name == _CONFIGURATION]
    return {
        "@id": "#run",
        "@type": "CreateAction",
        "name": f"Making of the study {study}",
        "description": "run of the workflow: from configuration and scans to the results",
        "agent": _refer(agents),
        "endTime": date,
        "actionStatus": "http://schema.org/CompletedActionStatus",
        "instrument": {"@id": main},
        "object": _refer([*taken, *map(_scan_id, inputs)]),
        "result": _refer(name for name in names if name not in taken),
    }


def _scan_id(path: str) -> str:
    return f"#scan-{quote(path, safe='')}"


def _scans(inputs: Mapping[str, str]) -> list[dict[str, Any]]:
    """Entities of the scans by name and checksum; the files of their owners are not packed."""
    return [
        {
            "@id": _scan_id(path),
            "@type": "CreativeWork",
            "name": Path(path).name,
            "description": "scan of a crack, not part of this crate",
            "sha256": digest,
        }
        for path, digest in inputs.items()
    ]


def _described(results: Path, name: str) -> dict[str, Any]:
    path = results / name
    media = _MEDIA.get(path.suffix) or mimetypes.guess_type(path.name)[0] or "text/plain"
    return {
        "@id": quote(name),
        "@type": "File",
        "name": name,
        "encodingFormat": media,
        "contentSize": str(path.stat().st_size),
    }


def _file(results: Path, name: str, digest: str) -> dict[str, Any]:
    """Entity of a result, with checksum and description."""
    description = _description(results, name)
    return _described(results, name) | {"description": description, "sha256": digest}


def _description(results: Path, name: str) -> str:
    """Kind of a result by its place: that of a figure, of a stage, or of a file of its own."""
    path = Path(name)
    first = path.parts[0]
    if name in _FILES:
        return _FILES[name]
    if first == "figures":
        figure = all_figures().get(path.stem)
        title = figure.title if figure else path.stem
        kind = {".csv": "numbers of the figure", ".txt": "caption of the figure"}
        of = f", {path.parts[1]}" if len(path.parts) > 2 else ""
        return f"{kind.get(path.suffix, 'figure')}: {title}{of}"
    if first in _FOLDERS:
        return _FOLDERS[first].format(stem=path.stem)
    if path.suffix == ".nc":
        words = _title_of(results / first) or first
        return f"{words}, {'/'.join(path.with_suffix('').parts[1:])}"
    return name


@cache
def _title_of(folder: Path) -> str:
    """Title of the datasets of a stage; empty where they have none, or the first is damaged."""
    import netCDF4  # takes longer to import than all the rest

    for path in sorted(folder.glob("*.nc"))[:1]:
        with contextlib.suppress(OSError), netCDF4.Dataset(path) as file:
            return str(getattr(file, "title", ""))
    return ""
