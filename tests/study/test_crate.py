"""Research Object Crate of a study: the rules of RO-Crate 1.1 and of Workflow Run Crate 0.5."""

import json
from pathlib import Path
from urllib.parse import quote, unquote

import pytest
import xarray as xr
from places import ROOT

from fractalcontact.core import checksums, netcdf
from fractalcontact.study.crate import FILE, Workflow, write_crate

WORKFLOW = Workflow(
    folder=ROOT,
    main="Snakefile",
    parts=("workflow/rules/*.smk", "config/schema/*.json", "LICENSE"),
    language="Snakemake",
    url="https://snakemake.github.io",
    version="9.0",
)
SCANS = {"scans/rock (1).lower.x3p": "a" * 64, "scans/rock (1).upper.x3p": "b" * 64}
FILES = (
    "atlas.nc",
    "index.html",
    "study.yaml",
    "specimens/Stein 50%.nc",
    "figures/Stein 50%/quality.png",
    "figures/Stein 50%/quality.csv",
    "figures/statements.svg",
    "pages/Stein 50%.html",
)


@pytest.fixture
def results(tmp_path):
    """A folder with the files of a study, whose content does not matter here."""
    folder = tmp_path / "results/test"
    for name in FILES:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    netcdf.write(xr.Dataset(attrs={"title": "levelled faces"}), folder / "specimens/Stein 50%.nc")
    checksums.record(folder, [folder / name for name in FILES])
    return folder


@pytest.fixture
def graph(results):
    write_crate(results, WORKFLOW, "test", SCANS)
    document = json.loads((results / FILE).read_text(encoding="utf-8"))
    assert document["@context"][0] == "https://w3id.org/ro/crate/1.1/context"
    entities = {entity["@id"]: entity for entity in document["@graph"]}
    assert len(entities) == len(document["@graph"])
    return entities


def kinds(entity):
    return {entity["@type"]} if isinstance(entity["@type"], str) else set(entity["@type"])


def listed(value):
    return value if isinstance(value, list) else [value]


def references(value):
    if isinstance(value, dict):
        if set(value) == {"@id"}:
            yield value["@id"]
        else:
            yield from (name for one in value.values() for name in references(one))
    elif isinstance(value, list):
        yield from (name for one in value for name in references(one))


def test_the_root_has_what_the_specification_demands(graph):
    assert graph[FILE]["about"] == {"@id": "./"}
    assert {"@id": "https://w3id.org/ro/crate/1.1"} in graph[FILE]["conformsTo"]
    root = graph["./"]
    for key in ("name", "description", "datePublished", "license", "author"):
        assert root[key]
    assert kinds(graph["./"]) == {"Dataset"}
    assert graph[root["license"]["@id"]]["name"] == "MIT"


def test_all_that_is_referred_to_is_described(graph):
    outside = {
        "https://w3id.org/ro/crate/1.1",
        "https://snakemake.github.io",
    }
    referred = {name for entity in graph.values() for name in references(entity)}
    assert referred - outside <= graph.keys()


def test_every_file_is_there_is_part_of_the_root_and_has_its_size(graph, results):
    files = {name for name, entity in graph.items() if "File" in kinds(entity)}
    assert files == set(references(graph["./"]["hasPart"]))
    for name in files:
        assert (results / unquote(name)).stat().st_size == int(graph[name]["contentSize"])
        assert "/" in graph[name]["encodingFormat"]


def test_every_result_has_its_checksum_and_says_what_it_is(graph, results):
    for name in FILES:
        entity = graph[quote(name)]
        assert entity["sha256"] == checksums.sha256(results / name)
        assert entity["description"] not in ("", name)
    assert graph["specimens/Stein%2050%25.nc"]["description"] == "levelled faces, Stein 50%"
    quality = graph["figures/Stein%2050%25/quality.csv"]["description"]
    assert quality.startswith("numbers of the figure: ")
    assert quality.endswith(", Stein 50%")


def test_the_run_leads_from_configuration_and_scans_through_the_workflow_to_the_results(graph):
    workflow = graph[graph["./"]["mainEntity"]["@id"]]
    assert {"File", "SoftwareSourceCode", "ComputationalWorkflow"} == kinds(workflow)
    assert graph[workflow["programmingLanguage"]["@id"]]["name"] == "Snakemake"
    assert len(workflow["hasPart"]) >= 10
    (run,) = (entity for entity in graph.values() if "CreateAction" in kinds(entity))
    assert run["instrument"]["@id"] == workflow["@id"]
    assert graph["./"]["mentions"] == {"@id": run["@id"]}
    taken = [graph[one["@id"]] for one in listed(run["object"])]
    assert [one["name"] for one in taken] == ["study.yaml", *(Path(name).name for name in SCANS)]
    assert [one["sha256"] for one in taken[1:]] == list(SCANS.values())
    assert {"@id": "atlas.nc"} in run["result"]


def test_authors_are_those_of_the_citation(results, tmp_path):
    for name in ("Snakefile", "LICENSE"):
        (tmp_path / name).write_text(name)
    (tmp_path / "CITATION.cff").write_text(
        "title: a title\nversion: 1.2.0\nlicense: MIT\nauthors:\n"
        "  - {family-names: Chiaia, given-names: B., orcid: 'https://orcid.org/0000-0002'}\n"
        "  - name: The founders\n"
    )
    workflow = Workflow(tmp_path, "Snakefile", ("LICENSE",), "Snakemake", "https://a.org", "9")
    write_crate(results, workflow, "test", {})
    text = (results / FILE).read_text(encoding="utf-8")
    entities = {entity["@id"]: entity for entity in json.loads(text)["@graph"]}
    person, group = (entities[one["@id"]] for one in entities["./"]["author"])
    assert (person["@type"], person["name"]) == ("Person", "B. Chiaia")
    assert person["@id"] == "https://orcid.org/0000-0002"
    assert (group["@type"], group["name"]) == ("Organization", "The founders")
    # The same again for the same results, and no line of the manifest is about it.
    write_crate(results, workflow, "test", {})
    assert (results / FILE).read_text(encoding="utf-8") == text
    assert not any("crate" in line or "code/" in line for line in checksums.lines_of(results))


def test_without_an_atlas_there_is_nothing_to_describe(results):
    (results / "atlas.nc").unlink()
    write_crate(results, WORKFLOW, "test", {})
    assert not (results / FILE).exists()
    assert not (results / "code").exists()
