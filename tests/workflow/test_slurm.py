"""The workflow on a real SLURM of one node: `make test-slurm`, which installs and starts it."""

import csv
import os
import subprocess
import sys

import pytest
from projects import copy_project
from slurm_node import Node, missing

pytestmark = pytest.mark.skipif(
    os.environ.get("SLURM") not in ("yes", "accounting"),
    reason="a SLURM is started by `make test-slurm` alone",
)
ACCOUNTING = os.environ.get("SLURM") == "accounting"
STUDY = "config/smoke.yaml"
ATLAS = "results/smoke/atlas.nc"


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
def beside(tmp_path_factory):
    """The atlas of the smoke study made on this machine without SLURM, in what time that leaves.

    Yields
    ------
    folder : pathlib.Path
    made : subprocess.Popen
    """
    project = copy_project(tmp_path_factory.mktemp("local"))
    command = (sys.executable, "workflow/run.py", STUDY, "--", "--cores", "2", ATLAS)
    with open(project / "said.txt", "w") as said:
        running = subprocess.Popen(
            ("nice", "-n", "10", *command), cwd=project, stdout=said, stderr=said
        )
    try:
        yield project, running
    finally:
        running.terminate()
        running.wait(60)


@pytest.fixture(scope="module")
def by_slurm(node, beside, tmp_path_factory):
    """The whole of it made by what `make slurm` runs."""
    project = copy_project(tmp_path_factory.mktemp("cluster"))
    words = ("--profile", "slurm", "--", "--slurm-init-seconds-before-status-checks", "1")
    command = (sys.executable, "workflow/run.py", STUDY, *words)
    done = subprocess.run(command, cwd=project, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return project


@pytest.fixture(scope="module")
def undisturbed(by_slurm, beside):
    """Folder of the atlas made without SLURM, once it is there."""
    project, running = beside
    assert running.wait(600) == 0, (project / "said.txt").read_text()[-3000:]
    return project


def made_files(project):
    """Checksums of all that was made, by name."""
    lines = (project / "results/smoke/manifest.sha256").read_text().splitlines()
    return {line[66:]: line[:64] for line in lines}


def test_study_is_the_same_to_the_byte_on_slurm_and_here(by_slurm, undisturbed):
    ours, theirs = ((place / ATLAS).read_bytes() for place in (by_slurm, undisturbed))
    assert ours == theirs
    ours, theirs = made_files(by_slurm), made_files(undisturbed)
    assert len(theirs) > 20
    assert theirs.items() <= ours.items()


def test_figures_and_pages_are_there(by_slurm):
    names = made_files(by_slurm)
    for name in ("index.html", "explorer.html", "figures/area_slope.png"):
        assert name in names
    pictures = [name for name in names if name.startswith("figures/small_") and ".png" in name]
    assert len(pictures) > 40


def test_each_job_ran_on_slurm_once_and_none_is_left(by_slurm, node):
    jobs = node.jobs()
    assert {"contact", "flow", "atlas", "figures"} <= {job.rule for job in jobs}
    # A job that took more than it asked for is begun again, and hides that it asks for too little.
    assert [job for job in jobs if job.state != "COMPLETED"] == []
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
