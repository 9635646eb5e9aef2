"""Conventions of Snakemake workflows: messages of rules, lint, the catalog, the report."""

import re
import subprocess
import sys

import pytest
import yaml
from places import ROOT
from projects import project, run

__all__ = ["project"]  # a fixture
pytestmark = pytest.mark.workflow
#: Of `snakemake --lint`, as CONTRIBUTING.md has it: functions stand beside the rules that use them,
#: and one environment is made for all rules before the first run.
MEANT = {
    "Mixed rules and functions in same snakefile.:",
    "Specify a conda environment or container for each rule.:",
}


def test_every_rule_says_in_a_sentence_what_it_does():
    for path in sorted([ROOT / "Snakefile", *ROOT.glob("workflow/rules/*.smk")]):
        text = path.read_text()
        for rule in re.split(r"(?m)^(?=(?:use )?rule |    rule:)", text)[1:]:
            name = rule.splitlines()[0]
            inherits = name.startswith("use ")
            message = re.search(r'^ +message:\n +f?"([^"]+)"$', rule, re.MULTILINE)
            assert message or inherits, (path.name, name)
            if message:
                assert len(message[1].split("{")[0]) < 80
                wildcard = "{specimen}" in rule.partition("output:")[2].partition("log:")[0]
                assert not wildcard or "{wildcards.specimen}" in message[1].replace("{{", "{")


def test_lint_finds_nothing_but_what_is_meant():
    words = ("--configfile", "config/smoke.yaml", "--lint")
    done = subprocess.run(
        [sys.executable, "-m", "snakemake", *words], cwd=ROOT, capture_output=True, text=True
    )
    assert set(re.findall(r"^ +\* (.+)$", done.stderr, re.MULTILINE)) == MEANT


def test_the_catalog_finds_what_it_wants():
    catalog = yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text())
    usage = catalog["usage"]
    assert usage["report"] is True
    assert usage["mandatory-flags"]["flags"].startswith("--configfile config/")
    deployment = usage["software-stack-deployment"]
    assert deployment.keys() == {"conda", "apptainer", "apptainer+conda"}
    assert {*map(type, deployment.values())} == {bool}
    readme = (ROOT / "README.md").read_text(encoding="utf-8").lower()
    assert "snakemake" in readme
    assert "workflow" in readme
    assert (ROOT / usage["mandatory-flags"]["flags"].split()[1]).is_file()
    assert (ROOT / "config/README.md").read_text().startswith("# ")


def test_the_report_begins_with_a_page_of_its_own():
    text = (ROOT / "Snakefile").read_text()
    (start,) = re.findall(r'^report: "(.+)"$', text, re.MULTILINE)
    assert '{{ snakemake.config["study"] }}' in (ROOT / start).read_text()


def test_nothing_assigns_to_a_name_of_snakemake():
    """A new version could take no notice of that, or break, without a word."""
    files = [*ROOT.glob("workflow/**/*.py"), *ROOT.glob("workflow/**/*.smk"), ROOT / "Snakefile"]
    assigned = re.compile(r"(?m)^\s*(?:workflow|snakemake|_?[A-Z]\w*)(?:\.\w+)+ *=[^=]|setattr\(")
    found = {path.name: assigned.findall(path.read_text()) for path in files}
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_snakemake_reads_a_study_as_the_program_does(project):
    text = (project / "config/smoke.yaml").read_text()
    (project / "config/no.yaml").write_text(text.replace("small_joint", "no"))
    planned = run(project, "config/no.yaml", "--dry-run", "results/smoke/specimens/no.nc")
    assert planned.returncode == 0, planned.stderr
    (project / "config/twice.yaml").write_text(f"{text}\nstudy: other\n")
    refused = run(project, "config/twice.yaml", "--dry-run")
    assert refused.returncode != 0
    said = refused.stdout + refused.stderr
    assert "the key 'study' stands here a second time, after line 2" in said
