"""The documents name keys, commands, files and links that exist."""

import re
import textwrap

import pytest
import yaml
from places import ROOT

from fractalcontact.core.keys import schema_of
from fractalcontact.study.checks import read_sidecar
from fractalcontact.study.keys import SidecarKeys, StudyKeys
from fractalcontact.study.sidecar import sidecar_of_matrix

#: All but the changelog, which names things as they were called at its time.
DOCUMENTS = [
    *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "config/README.md")),
    ROOT / "packages/roughcontact/README.md",
    *sorted(ROOT.glob("packages/roughcontact/docs/*.md")),
    *sorted(ROOT.glob("docs/*.md")),
]
KEY = re.compile(r"`([A-Za-z_.0-9]+)`")


def keys_of(node):
    """Names of keys in a JSON schema, at every depth."""
    if isinstance(node, dict):
        yield from node.get("properties", {})
        for name, child in node.items():
            if name not in ("if", "else"):
                yield from keys_of(child)
    elif isinstance(node, list):
        for child in node:
            yield from keys_of(child)


def test_every_key_of_a_study_and_of_a_sidecar_is_explained():
    explained = set()
    documents = (ROOT / "docs/keys.md", ROOT / "config/README.md")
    for line in "".join(path.read_text(encoding="utf-8") for path in documents).splitlines():
        explained |= {part for key in KEY.findall(line) for part in key.split(".")}
        # Those of a mapping stand in braces: `{modulus, poisson}`.
        for group in re.findall(r"`\{([a-z_, ]+)\}`", line):
            explained |= set(group.split(", "))
    schema = schema_of(StudyKeys), schema_of(SidecarKeys)
    assert set(keys_of([*schema])) - explained == set()


def block_of(name, first):
    """The indented block of a document that begins with this line, as text."""
    lines = re.search(
        rf"^    {re.escape(first)}.*\n(?:    .+\n)*",
        (ROOT / name).read_text(encoding="utf-8"),
        re.MULTILINE,
    )
    return textwrap.dedent(lines[0])


def test_the_sidecar_of_the_first_hour_is_that_of_a_matrix(tmp_path):
    path = tmp_path / "granite.yaml"
    path.write_text(block_of("docs/first_hour.md", "kind: face"), encoding="utf-8")
    assert read_sidecar(path) == (sidecar_of_matrix(0.05), {})


def test_the_sidecar_of_the_readme_is_one(tmp_path):
    path = tmp_path / "rock.yaml"
    path.write_text(block_of("README.md", "label: granite"), encoding="utf-8")
    keys, settings = read_sidecar(path)
    assert keys == sidecar_of_matrix(0.05)
    assert set(settings["material"]) == {
        "modulus",
        "poisson",
        "basic_friction_angle",
        "joint_wall_strength",
    }
    assert settings["opposite"] == "flat"


def test_the_readme_states_the_material_that_scans_get():
    """That of the default study, where nothing else is stated."""
    study = yaml.safe_load((ROOT / "config/paper.yaml").read_text(encoding="utf-8"))
    material = study["materials"][study["defaults"]["material"]]
    text = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    strength = material["joint_wall_strength"]
    for words in (f"E = {material['modulus']}", f"ratio {material['poisson']}", strength):
        assert words in text
    assert study["defaults"]["material"] in text
    assert study["defaults"]["opposite"] == "match"


MAKEFILES = [ROOT / "Makefile", ROOT / "benchmarks/Makefile"]
TARGETS = {
    target
    for path in MAKEFILES
    for line in re.findall(r"(?m)^\.PHONY: (.+)$", path.read_text(encoding="utf-8"))
    for target in line.split()
}


def test_help_has_a_line_for_every_target():
    lines = [
        line
        for path in MAKEFILES
        for line in re.findall(r"(?m)^#: +make +([a-z-]+) ", path.read_text(encoding="utf-8"))
    ]
    assert sorted(lines) == sorted(TARGETS - {"help", "study", "moved"})


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_commands_files_and_links_of_a_document_exist(path):
    text = path.read_text(encoding="utf-8")
    # After `make` and settings such as NAME=value: at the start of code or of an indented line.
    call = r"(?:`|^ {4}(?:\w+=\w+ )*)make(?: [A-Z]+=[^\s`]+)* ([a-z-]+)"
    targets = re.findall(call, text, re.MULTILINE)
    assert set(targets) <= TARGETS

    files = re.findall(r"`((?:[a-z_.]+/)+[a-z_0-9.-]+\.(?:py|md|yaml|smk|yml))`", text)
    files += [link for link in re.findall(r"\]\(([^)#]+)", text) if "://" not in link]
    by_command = ("results/", "config/mine.yaml", "config/other.yaml")
    files = [file for file in files if not file.startswith(by_command)]
    homes = (ROOT, path.parent, ROOT / "src", *ROOT.glob("src/*"))
    assert [file for file in files if not any((home / file).exists() for home in homes)] == []
