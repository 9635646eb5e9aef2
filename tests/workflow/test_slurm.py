"""The workflow on a real SLURM of one node: `make test-slurm`, which installs and starts it."""

import os
import shutil
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


@pytest.fixture(scope="module")
def node(tmp_path_factory):
    reason = missing(ACCOUNTING)
    if reason:
        pytest.fail(reason)
    node = Node(tmp_path_factory.mktemp("slurm"), accounting=ACCOUNTING)
    try:
        yield node.start()
    finally:
        node.stop()
        assert not node.left()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """The smoke study made on this machine, without SLURM."""
    project = copy_project(tmp_path_factory.mktemp("local"))
    done = made(project, STUDY)
    assert done.returncode == 0, done.stderr[-3000:]
    return project


def on_slurm(project, *options):
    """What `make slurm` runs."""
    command = (sys.executable, "workflow/run.py", STUDY, "--profile", "slurm", "--", *options)
    return subprocess.run(command, cwd=project, capture_output=True, text=True, timeout=900)


def manifest(project):
    return (project / "results/smoke/manifest.sha256").read_text()


def test_study_is_the_same_to_the_byte_on_slurm_and_here(node, undisturbed, tmp_path):
    project = copy_project(tmp_path)
    done = on_slurm(project)
    assert done.returncode == 0, done.stderr[-5000:]
    ours, theirs = ((p / "results/smoke/atlas.nc").read_bytes() for p in (project, undisturbed))
    assert ours == theirs
    assert manifest(project) == manifest(undisturbed)
    assert "SLURM" in done.stderr or "slurm" in done.stderr
    assert node.queue() == []
    if ACCOUNTING:
        reports = list(project.rglob("efficiency_report*.csv"))
        assert reports, "no efficiency report"
        print(reports[0].read_text())
    shutil.rmtree(project / "results")
