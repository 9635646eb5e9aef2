"""The workflow on a real SLURM of one node: `make test-slurm`, which installs and starts it."""

import csv
import os
import subprocess
import sys

import pytest
from projects import copy_project, made
from slurm_node import Node, missing

pytestmark = pytest.mark.skipif(
    os.environ.get("SLURM") not in ("yes", "accounting"),
    reason="a SLURM is started by `make test-slurm` alone",
)
ACCOUNTING = os.environ.get("SLURM") == "accounting"
STUDY = "config/smoke.yaml"
#: Drawn anew they may differ in the last digit of a place: figures, and the pages that hold them.
DRAWN = (".svg", ".png", ".html")


@pytest.fixture(scope="module")
def node(tmp_path_factory):
    if reason := missing(ACCOUNTING):
        (pytest.skip if ACCOUNTING else pytest.fail)(reason)
    node = Node(tmp_path_factory.mktemp("slurm"), accounting=ACCOUNTING)
    try:
        yield node.start()
    finally:
        node.stop()
        assert node.left() == []


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """The smoke study made on this machine, without SLURM."""
    project = copy_project(tmp_path_factory.mktemp("local"))
    done = made(project, STUDY)
    assert done.returncode == 0, done.stderr[-3000:]
    return project


@pytest.fixture(scope="module")
def by_slurm(node, tmp_path_factory):
    """The same made by what `make slurm` runs, and what that said."""
    project = copy_project(tmp_path_factory.mktemp("cluster"))
    words = ("--profile", "slurm", "--", "--slurm-init-seconds-before-status-checks", "2")
    command = (sys.executable, "workflow/run.py", STUDY, *words)
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return project


def made_files(project):
    """Checksums of all that was made, but of what is drawn, by name."""
    lines = (project / "results/smoke/manifest.sha256").read_text().splitlines()
    names = {line[66:]: line[:64] for line in lines}
    return {name: digest for name, digest in names.items() if not name.endswith(DRAWN)}, set(names)


def test_study_is_the_same_to_the_byte_on_slurm_and_here(by_slurm, undisturbed):
    ours, theirs = (
        (place / "results/smoke/atlas.nc").read_bytes() for place in (by_slurm, undisturbed)
    )
    assert ours == theirs
    assert made_files(by_slurm) == made_files(undisturbed)


def test_jobs_ran_on_slurm_and_none_is_left(by_slurm, node):
    rules = {job.rule for job in node.jobs() if job.state == "COMPLETED"}
    assert {"specimen", "contact", "analysis", "atlas", "figures"} <= rules
    assert node.queue() == []


@pytest.mark.skipif(not ACCOUNTING, reason="no accounts: `make test-slurm-accounting` keeps them")
def test_report_says_what_each_job_asked_for_and_used(by_slurm):
    (path,) = by_slurm.glob("results/efficiency_report_*.csv")
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) > 20
    words = ("RuleName", "Elapsed", "RequestedMem_MB", "MaxRSS_MB", "Memory Usage (%)")
    for row in rows:
        print("  ".join(row[word] for word in words))
        assert float(row["RequestedMem_MB"]) > 0
    assert any(0 < float(row["MaxRSS_MB"]) < float(row["RequestedMem_MB"]) for row in rows)
