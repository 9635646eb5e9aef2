"""Campaigns through the workflow: what is planned, and that one more specimen adds its jobs."""

import json

import numpy as np
import pytest
from projects import jobs_of, project, rough_heights, run, small_study
from stated import array_sidecar

from fractalcontact import open_atlas

__all__ = ["project"]  # a fixture
pytestmark = pytest.mark.workflow
#: Jobs of every specimen.
OF_SPECIMEN = (
    *("roughness_and_composite", "contact", "windows", "closure_and_box_counts", "flow"),
    *("strength", "specimen_atlas"),
    "card_and_page",
)

#: Jobs of the study.
OF_STUDY = ("atlas", "study_figures", "all_drawn", "result_page", "all")


def write_groups(project, names):
    for number, name in enumerate(names):
        path = project / f"scans/{name}.npy"
        path.parent.mkdir(exist_ok=True)
        np.save(path, rough_heights(number))
        (path.parent.with_suffix(".yaml")).write_text(array_sidecar(0.1))


def test_jobs_go_with_the_specimens_and_few_files_of_each_are_asked_for(project):
    write_groups(project, ["a/s1", "a/s2", "b/s1"])
    study = small_study(project, groups="folders", atlas="parts")
    planned = run(project, study, "--dry-run")
    jobs = jobs_of(planned)
    assert {name: jobs.pop(name) for name in OF_SPECIMEN} == dict.fromkeys(OF_SPECIMEN, 3)
    assert jobs == dict.fromkeys(OF_STUDY, 1)
    asked = small_study(project, groups="folders", atlas="parts", explorer=["a_s1"])
    assert jobs_of(run(project, asked, "--dry-run"))["explorer"] == 1
    assert "fig02_relief" not in planned.stdout + planned.stderr
    asked = small_study(project, groups="folders", atlas="parts", figures=["fig02_relief"])
    drawn = run(project, asked, "--dry-run", "--summary")
    assert drawn.stdout.count("fig02_relief.png") == 3
    assert jobs_of(run(project, asked, "--dry-run"))["figures"] == 3
    assert "fig01_strength.png" not in drawn.stdout


def test_an_unknown_specimen_is_named(project):
    write_groups(project, ["a/s1"])
    study = small_study(project, groups="folders", atlas="parts")
    asked = run(project, study, "--dry-run", "results/test/specimens/b_s1.nc")
    assert "no specimen 'b_s1'" in asked.stdout + asked.stderr


@pytest.mark.full
def test_one_more_specimen_runs_its_own_jobs_and_the_gather(project):
    write_groups(project, ["a/s1", "b/s1"])
    study = small_study(project, groups="folders", atlas="parts", figures=["fig02_relief"])
    first = run(project, study)
    assert first.returncode == 0, first.stderr[-3000:]
    assert jobs_of(run(project, study, "--dry-run")) == {}
    before = times_of(project / "results/test", ("a_s1", "b_s1"))
    assert any("fig02_relief.png" in name for name in before)
    write_groups(project, ["b/s2"])
    assert jobs_of(run(project, study)) == {  # what it ran, not what it planned
        **dict.fromkeys((*OF_SPECIMEN, "figures"), 1),
        **dict.fromkeys(OF_STUDY, 1),
    }
    assert times_of(project / "results/test", ("a_s1", "b_s1")) == before
    assert (project / "results/test/figures/b_s2/fig02_relief.png").stat().st_size > 10_000
    atlas = open_atlas(project / "results/test")
    assert atlas.specimens == ("a_s1", "b_s1", "b_s2")
    assert atlas.groups == {"a_s1": "a", "b_s1": "b", "b_s2": "b"}
    compared = atlas["study_comparison/study"]
    assert compared["group"].values.tolist() == ["a", "b", "b"]
    assert json.loads(atlas.attrs["scan_checksums"]).keys() == set(atlas.specimens)
    assert jobs_of(run(project, study, "--dry-run")) == {}


def times_of(results, specimens):
    """When each file of some specimens was written, by name: cards and pages too."""
    return {
        str(path): path.stat().st_mtime_ns
        for path in results.rglob("*")
        if path.is_file() and any(name in str(path) for name in specimens)
    }
