"""What a change makes again, on one small study that was made up to its atlas."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml
from projects import ROOT, copy_project, jobs_of, made, rough_heights, run, small_study, write_scan

from fractalcontact.core import sources
from fractalcontact.core.checksums import sha256
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.stages import STAGES, paths_of

pytestmark = pytest.mark.workflow
STUDY = "config/test.yaml"
ATLAS = "results/test/atlas.nc"
PACKAGE = ROOT / "src/fractalcontact"


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A study of one scan against a plane, made up to its atlas: figures take longest."""
    folder = copy_project(tmp_path_factory.mktemp("finished"))
    document = yaml.safe_load((folder / small_study(folder)).read_text())
    document["defaults"] |= {"opposite": "flat", "resolutions": [1, 2]}
    (folder / STUDY).write_text(yaml.safe_dump(document))
    write_scan(folder, "rock")
    done = made(folder, STUDY, targets=[ATLAS])
    assert done.returncode == 0, done.stderr[-3000:]
    (folder / "said").write_text(done.stdout)
    return folder


@pytest.fixture
def project(finished, tmp_path):
    """A copy of it, times and all."""
    shutil.copytree(finished, tmp_path / "project", symlinks=True)
    return tmp_path / "project"


def planned(project):
    return jobs_of(run(project, STUDY, "--dry-run", ATLAS))


def append(project, name):
    with open(project / name, "a") as file:
        file.write("# a comment\n")


def test_the_atlas_has_all_stages_of_the_table_and_a_second_run_nothing_to_do(project):
    atlas = read_atlas(project / ATLAS)
    assert set(atlas.children) == {*paths_of("specimen", "joint"), "statements", "comparison"}
    for name, group in atlas.children.items():
        assert group.attrs["description"] == STAGES[name].title
        assert list(group.children) == ([] if STAGES[name].grain == "joint" else ["rock"])
    assert (project / "results/test/specimens.txt").read_text() == "rock\n"
    # Copied, with the words of the schema and the times of the scan changed.
    append(project, "config/schema/study.schema.yaml")
    (project / "scans/rock.npy").touch()
    assert planned(project) == {}


def test_a_run_is_a_line_a_job_and_leaves_a_crate_of_what_it_made(finished):
    first, *jobs, last = (finished / "said").read_text().splitlines()
    n = len(jobs)
    assert first == f"{n} jobs; what is made goes to results/test"
    assert last.startswith(f"{n} jobs done in ")
    assert [line.split("]")[0] for line in jobs] == [f"[{k}/{n}" for k in range(1, n + 1)]
    assert any(line[6:].startswith("rock: contact states") for line in jobs)
    assert max(map(len, jobs)) <= 120
    crate = json.loads((finished / "results/test/ro-crate-metadata.json").read_text())
    entities = {entity["@id"]: entity for entity in crate["@graph"]}
    assert entities["atlas.nc"]["sha256"] == sha256(finished / ATLAS)
    scan = sha256(finished / "scans/rock.npy")
    assert [e["sha256"] for e in entities.values() if e.get("name") == "rock.npy"] == [scan]
    assert (finished / "results/test/code/Snakefile").is_file()


def test_code_counts_that_a_script_shares_with_others_or_calls_by_name(project):
    for name in (
        "workflow/scripts/_stages.py",  # beside the script of the atlas
        "src/fractalcontact/stages/windows.py",  # the function that a generic script calls
        "src/fractalcontact/study/stages.py",  # another stage: the others are not made again
    ):
        append(project, name)
    (project / "src/fractalcontact/stages/another.py").write_text("# its function\n")
    assert set(planned(project)) == {"windows", "size_laws_against_plane", "atlas"}


def test_a_scan_replaced_by_an_older_file_is_read(project):
    scan = project / "scans/rock.npy"
    np.save(project / "other.npy", rough_heights(seed=1))
    os.utime(project / "other.npy", (1_000_000_000, 1_000_000_000))
    os.replace(project / "other.npy", scan)
    jobs = planned(project)
    assert jobs["specimen"] == jobs["contact"] == jobs["analysis"] == 1
    said = made(project, STUDY, "--dry-run", targets=[ATLAS]).stdout.splitlines()
    reasons = {title: why for title, _, why in (line.strip().rpartition("  ") for line in said)}
    (specimen,) = (title for title in reasons if title.startswith("rock: levelled scan"))
    assert reasons[specimen] == "its scan changed"


def test_a_missing_scan_and_a_damaged_file_stop_everything(project):
    content = (project / ATLAS).read_bytes()
    specimen = project / "results/test/specimens/rock.nc"
    specimen.write_bytes(specimen.read_bytes()[:-1])
    refused = run(project, STUDY)
    assert refused.returncode != 0
    assert "specimens/rock.nc: damaged or replaced after it" in refused.stdout + refused.stderr
    for path in (project / "scans").iterdir():
        path.unlink()
    refused = made(project, STUDY)
    assert refused.returncode != 0
    assert "specimens that the study no longer has: rock" in refused.stderr
    assert "specimens/rock.nc: damaged or replaced after it was made; moved to" in refused.stderr
    assert (project / ATLAS).read_bytes() == content


def _files_behind(*modules):
    paths = [ROOT / "workflow/scripts/stage.py", *(PACKAGE / f"{name}.py" for name in modules)]
    files = sources.source_files(paths, package=PACKAGE)
    return {path.relative_to(ROOT).as_posix() for path in files}


def test_the_script_of_all_stages_follows_from_the_function_that_it_calls():
    alone = _files_behind()
    assert "workflow/scripts/_job.py" in alone
    assert not {path for path in alone if Path(path).parts[2:3] in (("stages",), ("study",))}
    for stage in STAGES.values():
        files = _files_behind(stage.module)
        assert f"src/fractalcontact/{stage.module}.py" in files
    windows = _files_behind(STAGES["window_states"].module)
    assert {"src/fractalcontact/size_effect/eq6.py", "src/fractalcontact/contact/solve.py"} <= (
        windows - alone
    )
    assert "src/fractalcontact/study/stages.py" not in windows
    # What follows from states takes no solver.
    assert "src/fractalcontact/contact/solve.py" not in _files_behind(STAGES["windows"].module)
