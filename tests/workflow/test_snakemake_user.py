"""The workflow as a user of Snakemake takes it, without make."""

import re
import shutil
import subprocess
import sys

import pytest
from forked_snakemake import dry_run
from places import ROOT
from projects import copy_project, jobs_of

pytestmark = pytest.mark.workflow
SMOKE = ("--configfile", "config/smoke.yaml")
STUDY = ("--cores", "2", "--configfile", "config/test.yaml")


def snakemake(folder, *words):
    """Snakemake in a folder, with no profile and no plugin."""
    if "-n" in words:
        return dry_run(folder, *words)
    return subprocess.run(
        [sys.executable, "-m", "snakemake", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=900,
    )


def rules_of(text):
    """Names of rules in a graph, or in the picture of one."""
    return set(re.findall(r'label = "(\w+)"', text) or re.findall(r">(\w+)</text>", text))


def test_the_picture_of_the_rules_is_theirs_and_the_page_on_them_names_every_rule(tmp_path):
    graph = snakemake(copy_project(tmp_path), *SMOKE, "--rulegraph", "dot", "--", "pages")
    assert graph.returncode == 0, graph.stderr[-3000:]
    picture = (ROOT / "docs/chain.svg").read_text(encoding="utf-8")
    assert rules_of(graph.stdout) == rules_of(picture) >= {"contact", "atlas"}
    page = (ROOT / "docs/workflow.md").read_text(encoding="utf-8")
    rules = "".join(path.read_text() for path in ROOT.glob("workflow/rules/*.smk"))
    names = re.findall(r"(?m)^(?:rule (\w+):|use rule \w+ as (\w+) with:)", rules)
    assert not [name for pair in names if f"`{(name := ''.join(pair))}`" not in page]


@pytest.fixture
def project(finished, tmp_path):
    return shutil.copytree(finished, tmp_path / "project", symlinks=True)


def test_options_of_snakemake_do_what_its_manual_says(project):
    assert jobs_of(snakemake(project, *STUDY, "-n")) == {}
    again = jobs_of(snakemake(project, *STUDY, "-n", "-R", "contact"))
    assert again["contact"] == again["closure_and_box_counts"] == 1
    assert "roughness_and_composite" not in again
    until = snakemake(project, *STUDY, "-n", "-R", "contact", "--until", "closure_and_box_counts")
    assert {"contact", "closure_and_box_counts"} <= set(jobs_of(until))
    assert "flow" not in jobs_of(until)
    first = snakemake(project, *STUDY, "-n", "-R", "contact", "--batch", "atlas=1/2")
    assert "atlas" not in jobs_of(first)
    report = snakemake(project, *STUDY[2:], "--report", "results/report.html")
    assert report.returncode == 0, report.stderr[-3000:]
    assert "fig02_relief" in (project / "results/report.html").read_text()


def test_snakemake_alone_makes_the_bytes_that_make_has(project):
    """One job of the chain; test_switched_off.py makes all of it."""
    closure = project / "results/test/closure/rock.nc"
    before, time = closure.read_bytes(), closure.stat().st_mtime_ns
    rule = "closure_and_box_counts"
    done = snakemake(project, *STUDY, "-R", rule, "--until", rule)
    assert done.returncode == 0, done.stderr[-3000:]
    assert closure.stat().st_mtime_ns > time
    assert closure.read_bytes() == before


def test_touched_results_count_as_made(project):
    (project / "workflow/scripts/contact.py").open("a").write("# a comment\n")
    assert "contact" in jobs_of(snakemake(project, *STUDY, "-n"))
    touched = snakemake(project, *STUDY, "--touch")
    assert touched.returncode == 0, touched.stderr[-3000:]
    assert jobs_of(snakemake(project, *STUDY, "-n")) == {}


def test_another_workflow_takes_it_as_a_module(project, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    shutil.copytree(project / "scans", other / "scans")
    shutil.copytree(project / "config", other / "config")
    (other / "Snakefile").write_text(
        'configfile: "config/test.yaml"\n'
        f'module rock:\n    snakefile: "{project}/Snakefile"\n    config: config\n'
        "use rule * from rock as rock_*\n"
        "rule size:\n"
        '    input: "results/test/specimens/rock.nc"\n'
        '    output: "size.txt"\n'
        '    shell: "wc -c {input} > {output}"\n'
    )
    done = snakemake(other, "--cores", "2", "size")
    assert done.returncode == 0, done.stderr[-3000:]
    assert (other / "size.txt").is_file()
    assert jobs_of(done) == {"rock_roughness_and_composite": 1, "size": 1}
