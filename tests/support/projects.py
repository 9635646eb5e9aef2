"""Working copies of the project, studies and scans for tests that run the workflow itself."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from forked_snakemake import dry_run
from places import ROOT
from stage_names import EXPERIMENTS
from stated import array_sidecar


def copy_project(folder):
    """A working copy without results, with the bytecode and kernels that are compiled already."""
    for name in ("Snakefile", "CITATION.cff", "environment.yml", "config", "workflow", "src"):
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("kernels"))
        else:
            shutil.copy(source, folder / name)
    (folder / "scans").mkdir()
    kernels = Path("src/roughcontact/__pycache__/kernels")
    (folder / kernels).parent.mkdir(exist_ok=True)
    (folder / kernels).symlink_to(ROOT / kernels)
    return folder


@pytest.fixture
def project(tmp_path):
    return copy_project(tmp_path)


def command(study, *options):
    """Snakemake as a user may call it."""
    profile = ("--workflow-profile", "workflow/profiles/default")
    base = (sys.executable, "-m", "snakemake", "--cores", "2", "--configfile", study)
    return [*base, *profile, *options]


def run(project, study="config/smoke.yaml", *options):
    words = command(study, *options)
    if "--dry-run" in options:
        return dry_run(project, *words[words.index("snakemake") + 1 :])
    return subprocess.run(
        words,
        cwd=project,
        capture_output=True,
        text=True,
        timeout=900,
        encoding="utf-8",
    )


def made(project, study, *options, targets=(), **environment):
    """What `make` runs."""
    base = (sys.executable, "workflow/run.py", study, *options, "--", "--cores", "2", *targets)
    return subprocess.run(
        base,
        cwd=project,
        capture_output=True,
        text=True,
        timeout=900,
        env=os.environ | environment,
        encoding="utf-8",
    )


def jobs_of(planned):
    """Rules and their numbers of jobs, in what a dry run says; none if nothing is to be done."""
    text = planned.stdout + planned.stderr
    assert planned.returncode == 0, text[-3000:]
    if "Nothing to be done" in text:
        return {}
    table = text[text.index("Job stats:") :].split("total")[0].splitlines()[3:]
    return {words[0]: int(words[1]) for words in map(str.split, table) if len(words) == 2}


def small_study(project, **changes):
    """A study of scans alone, as fast as one can be."""
    study = yaml.safe_load((project / "config/smoke.yaml").read_text(encoding="utf-8"))
    study |= {"study": "test", "scans": "scans", "embedded": {}, "specimens": {}}
    for experiment in EXPERIMENTS:
        study.pop(experiment, None)
    study["defaults"] |= {"window": "auto", "offsets": "auto", "loads": ["1 MPa", "10 MPa"]}
    study |= changes
    (project / "config/test.yaml").write_text(yaml.safe_dump(study), encoding="utf-8")
    return "config/test.yaml"


def rough_heights(seed=0, n=40):
    return np.random.default_rng(seed).normal(size=(n, n)).cumsum(0).cumsum(1) * 1e-3


def write_scan(project, name, heights=None):
    """A scan with its sidecar in the project's folder."""
    heights = rough_heights() if heights is None else heights
    np.save(project / f"scans/{name}.npy", heights)
    (project / f"scans/{name}.yaml").write_text(array_sidecar(0.1), encoding="utf-8")
    return heights
