"""The Snakefile itself: the whole chain, small; a killed run; bad input among good."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import yaml
from print_size import faults_of_study
from projects import ROOT, command, project, run, small_study, write_scan
from stage_names import EXPERIMENTS
from stated import GRANITE, array_sidecar, sidecar

from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.figure_list import figures_of, study_figures_of
from fractalcontact.study.scan_files import list_scans

__all__ = ["project"]  # a fixture
SCANS = ROOT.parent / "shared" / "scans"
pytestmark = pytest.mark.workflow


@pytest.mark.full
def test_smoke_study_ends_with_figures_and_a_killed_run_gives_the_same_atlas(project):
    whole = run(project)
    assert whole.returncode == 0, whole.stderr
    results = project / "results/smoke"
    atlas = (results / "atlas.nc").read_bytes()
    for name, opposite in (("small_twin", "match"), ("small_joint", "flat")):
        drawn = {path.stem for path in (results / "figures" / name).glob("*.png")}
        assert drawn == set(figures_of(opposite))
    drawn = {path.stem for path in (results / "figures").glob("*.svg")}
    assert drawn == set(study_figures_of([*EXPERIMENTS, "defaults", "comparison"]))
    assert faults_of_study(results / "atlas.nc") == {}
    again = run(project, "config/smoke.yaml", "--dry-run")
    assert "Nothing to be done" in again.stdout + again.stderr

    shutil.rmtree(results)
    process = subprocess.Popen(
        command("config/smoke.yaml"),
        cwd=project,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    deadline = time.monotonic() + 120
    while not list(results.glob("specimens/*.nc")) and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert not (results / "atlas.nc").exists()
    run(project, "config/smoke.yaml", "--unlock")
    resumed = run(project)
    assert resumed.returncode == 0, resumed.stderr
    assert (results / "atlas.nc").read_bytes() == atlas


@pytest.mark.full
def test_one_bad_scan_is_one_clear_error_and_the_good_one_finishes(project):
    study = small_study(project)
    rough = write_scan(project, "good")
    write_scan(project, "constant", np.ones((40, 40)))
    np.save(project / "scans/unitless.npy", rough)
    (project / "scans/empty.xyz").write_text("")
    (project / "scans/empty.yaml").write_text("unit: mm\n")
    np.save(project / "scans/far.npy", rough)
    (project / "scans/far.yaml").write_text(array_sidecar(0.1, offsets=["50 mm"]))
    done = run(project, study, "--keep-going")
    assert done.returncode != 0
    errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    for name in ("constant.npy", "unitless.npy", "empty.xyz", "far"):
        assert any(name in line for line in errors), (name, errors)
    drawn = {path.stem for path in (project / "results/test/figures/good").glob("*.png")}
    assert drawn == set(figures_of("match"))


@pytest.mark.full
def test_accuracy_is_a_study_of_its_own(project):
    study = yaml.safe_load((project / "config/accuracy_small.yaml").read_text())
    study |= {"study": "speed"}
    study["speed"] |= {"sizes": [24], "runs": 1}
    study["convergence"] |= {"cells": [5, 8, 12], "trials": 2}
    (project / "config/speed.yaml").write_text(yaml.safe_dump(study))
    done = run(project, "config/speed.yaml")
    assert done.returncode == 0, done.stderr
    results = project / "results/speed"
    for ending in ("png", "svg", "csv", "txt"):
        drawn = {path.stem for path in (results / "figures").glob(f"*.{ending}")}
        assert drawn == set(study_figures_of(study))
    assert (results / "index.html").is_file()
    atlas = read_atlas(results / "atlas.nc")
    assert set(atlas["speed"].children) == {
        f"n24_{kind}" for kind in ("hertz", "punch", "h0.8_c10")
    }
    assert atlas["convergence/hertz/force_order"] > 1


def test_reading_the_workflow_imports_nothing_heavy():
    """Those of accuracy alone know the solver's jobs, where they are asked for."""
    rules = "\n".join(path.read_text() for path in sorted(ROOT.glob("workflow/rules/*.smk")))
    statement = r"^from (?:fractalcontact|contactlab|engine)[.\w]* import (?:\([^)]*\)|[^\n]+)"
    imports = [
        "import sys",
        f"sys.path.append({str(ROOT / 'workflow')!r})",
        *re.findall(statement, rules, re.MULTILINE),
    ]
    assert "from engine.plan import Plan" in imports
    names = "import sys; print(sorted({'xarray', 'numba', 'matplotlib'} & set(sys.modules)))"
    code = "\n".join([*imports, names])
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_an_unknown_key_stops_before_anything_runs(project):
    study = small_study(project, grane={})
    done = run(project, study)
    assert done.returncode != 0
    assert "unknown key 'grane'; did you mean 'grain'?" in done.stdout + done.stderr
    assert not (project / "results").exists()


@pytest.mark.full
def test_a_study_without_a_name_is_not_taken_for_the_default_one(project):
    study = small_study(project)
    text = (project / study).read_text().replace("study: test\n", "")
    (project / study).write_text(text)
    done = run(project, study)
    assert done.returncode != 0
    assert f"{study}: missing key 'study'" in done.stdout + done.stderr


HOSTILE = [
    *("a b", 'it\'s "x"', "--help", "$(touch pwned)", "`touch pwned`;|&<>", "*?[a]"),
    *(
        "~a",
        "c\\d",
        "50%",
        "Stein (über)",
        "岩石" * 20,
        "x" * 200,
        "e..f",
        "%(x)s",
        "E",
        "null",
        "1e3",
    ),
]


@pytest.mark.full
def test_files_of_any_permitted_name_are_scheduled_and_run(project):
    study = small_study(project)
    for name in HOSTILE:
        write_scan(project, name)
    scans, _ = list_scans(project / "scans")
    assert len(scans) == len(HOSTILE)
    planned = run(project, study, "--dry-run")
    assert planned.returncode == 0, planned.stdout[-3000:] + planned.stderr
    worst = [
        name for name, scan in scans.items() if scan.lower.stem in HOSTILE[1:4] + HOSTILE[11:13]
    ]
    made = [f"results/test/specimens/{name}.nc" for name in worst]
    done = run(project, study, *made)
    assert done.returncode == 0, done.stderr
    assert not list(project.rglob("*pwned"))
    again = run(project, study, "--dry-run", *made)
    assert "Nothing to be done" in again.stdout + again.stderr


@pytest.mark.full
@pytest.mark.scans
@pytest.mark.skipif(not SCANS.is_dir(), reason="the real scans are not beside the project")
def test_a_real_pair_dropped_in_gives_figures(project):
    study = small_study(project)
    folder = SCANS / "cnl_granite_pair"
    shutil.copy(folder / "Extracted_M_CNL_SideA_bottom.txt", project / "scans/granite.lower.txt")
    shutil.copy(folder / "Extracted_M_CNL_SideB_top.txt", project / "scans/granite.upper.txt")
    (project / "scans/granite.yaml").write_text(sidecar(GRANITE))
    done = run(project, study)
    assert done.returncode == 0, done.stderr
    drawn = {path.stem for path in (project / "results/test/figures/granite").glob("*.png")}
    assert drawn == set(figures_of("match"))
    atlas = read_atlas(project / "results/test/atlas.nc")
    specimen = atlas["specimens/granite"]
    assert specimen.attrs["opposite"] == "scanned"
    gap = (specimen["upper"] - specimen["lower"]).values
    assert np.nanmean(gap) == pytest.approx(0.6365, abs=0.01)
    curves = atlas["closure/granite"]
    # To the tolerance that follows from the accuracy of a study which states none.
    assert (curves["residual"] <= 1e-3).equals(curves["solved"])
    assert curves["solved"].isel(direction=0).sel(resolution=1).all()
