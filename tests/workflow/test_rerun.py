"""What a change makes again, on one small study that was made whole."""

import base64
import itertools
import json
import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
import yaml
from projects import jobs_of, made, rough_heights, run, write_scan
from stage_names import OF_SPECIMENS
from stated import array_sidecar

from fractalcontact.core.checksums import sha256
from fractalcontact.study.atlas import read_atlas

pytestmark = pytest.mark.workflow
STUDY = "config/test.yaml"
RULE = "roughness_and_composite"
ATLAS, FIGURE = "results/test/atlas.nc", "results/test/figures/rock/fig02_relief.png"


@pytest.fixture
def project(finished, tmp_path):
    """A copy of it, times and all."""
    shutil.copytree(finished, tmp_path / "project", symlinks=True)
    return tmp_path / "project"


def planned(project, *targets):
    return jobs_of(run(project, STUDY, "--dry-run", *(targets or [ATLAS])))


def append(project, name):
    with open(project / name, "a") as file:
        file.write("# a comment\n")


def test_the_atlas_has_all_stages_of_the_table_and_a_second_run_nothing_to_do(project):
    atlas = read_atlas(project / ATLAS)
    assert set(atlas.children) == {
        *(name for name in OF_SPECIMENS if name != "strength"),
    }
    for name, group in atlas.children.items():
        assert group.attrs["description"]
        assert list(group.children) == ["rock"], name
    assert (project / "results/test/specimens.txt").read_text() == "rock\n"
    # Copied, with the words of the schema and the times of the scan changed.
    append(project, "config/schema/study.schema.json")
    (project / "scans/rock.npy").touch()
    assert planned(project) == {}


def test_a_run_is_a_line_a_job_and_leaves_a_crate_of_what_it_made(finished):
    first, *jobs, last, page = (finished / "said").read_text().splitlines()
    n = len(jobs)
    assert first == f"{n} jobs; what is made goes to results/test"
    assert last.startswith(f"{n} jobs done in ")
    assert page.endswith("results/test/index.html")
    assert [line.split("]")[0] for line in jobs] == [f"[{k:2}/{n}" for k in range(1, n + 1)]
    assert any("] rock: contact states" in line for line in jobs)
    assert max(map(len, jobs)) <= 120
    crate = json.loads((finished / "results/test/ro-crate-metadata.json").read_text())
    entities = {entity["@id"]: entity for entity in crate["@graph"]}
    assert entities["atlas.nc"]["sha256"] == sha256(finished / ATLAS)
    scan = sha256(finished / "scans/rock.npy")
    assert [e["sha256"] for e in entities.values() if e.get("name") == "rock.npy"] == [scan]
    assert (finished / "results/test/code/Snakefile").is_file()


def test_code_counts_by_rooms_and_what_is_no_code_makes_nothing_again(project):
    for name in ("tests/test_a.py", "docs/a.md", "benchmarks/a.py"):
        (project / name).parent.mkdir(exist_ok=True)
        (project / name).write_text("# a comment\n")
    # Another stage: those there are need nothing of it.
    (project / "src/fractalcontact/stages/another.py").write_text("# its function\n")
    append(project, "src/fractalcontact/figures/kit/__init__.py")
    assert set(planned(project, ATLAS, FIGURE)) == {"figures_against_plane"}
    for name in (
        "workflow/scripts/atlas.py",
        "src/fractalcontact/stages/windows.py",  # the function that a script calls
        "src/fractalcontact/study/campaign.py",  # which the rules alone read
        "src/fractalcontact/statements/judge.py",
    ):
        append(project, name)
    assert set(planned(project)) == {"windows", "size_laws_against_plane", "atlas"}
    append(project, "src/fractalcontact/joint/__init__.py")
    assert {"roughness_and_composite", "contact", "closure_and_box_counts"} <= set(planned(project))


def test_a_scan_replaced_by_an_older_file_is_read(project):
    scan = project / "scans/rock.npy"
    np.save(project / "other.npy", rough_heights(seed=1))
    os.utime(project / "other.npy", (1_000_000_000, 1_000_000_000))
    os.replace(project / "other.npy", scan)
    jobs = planned(project)
    assert jobs["roughness_and_composite"] == jobs["contact"] == jobs["closure_and_box_counts"] == 1
    said = made(project, STUDY, "--dry-run", targets=[ATLAS]).stdout.splitlines()
    reasons = {title: why for title, _, why in (line.strip().rpartition("  ") for line in said)}
    (specimen,) = (title for title in reasons if title.startswith("rock: levelled faces"))
    assert reasons[specimen] == "its scan changed"


def test_an_edited_sidecar_is_read_whatever_its_time(project):
    sidecar = project / "scans/rock.yaml"
    sidecar.write_text(array_sidecar(0.2))
    os.utime(sidecar, (1_000_000_000, 1_000_000_000))
    jobs = planned(project)
    assert jobs["roughness_and_composite"] == jobs["contact"] == jobs["closure_and_box_counts"] == 1


def test_a_missing_scan_and_a_damaged_file_stop_everything(project):
    content = (project / ATLAS).read_bytes()
    specimen = project / "results/test/specimens/rock.nc"
    specimen.write_bytes(specimen.read_bytes()[:-1])
    (project / "results/test/contact/rock/0.0.0.nc").unlink()
    refused = run(project, STUDY, ATLAS)
    assert refused.returncode != 0
    assert "specimens/rock.nc: damaged or replaced after it" in refused.stdout + refused.stderr
    for path in (project / "scans").iterdir():
        path.unlink()
    refused = made(project, STUDY)
    assert refused.returncode != 0
    assert "specimens that the study no longer has: rock" in refused.stderr
    assert "specimens/rock.nc: damaged or replaced after it was made; moved to" in refused.stderr
    assert (project / ATLAS).read_bytes() == content


def record_of(project, name):
    """What Snakemake keeps of how it made a file."""
    return project / ".snakemake/metadata" / base64.urlsafe_b64encode(name.encode()).decode()


#: Ways in which a record is lost.
LOSSES = {
    "lost": lambda path, content: path.unlink(),
    "empty": lambda path, content: path.write_bytes(b""),
    "zeroed": lambda path, content: path.write_bytes(bytes(len(content))),
    "cut": lambda path, content: path.write_bytes(content[: len(content) // 2]),
    "no text": lambda path, content: path.write_bytes(b"\xff" * len(content)),
    "no record": lambda path, content: path.write_bytes(b'["a list"]'),
}


def lose(project, name, how):
    path = record_of(project, name)
    LOSSES[how](path, path.read_bytes())


def change_scan(project):
    np.save(project / "scans/rock.npy", rough_heights(seed=1))


def change_study(project, **settings):
    document = yaml.safe_load((project / STUDY).read_text())
    document["defaults"] |= settings
    (project / STUDY).write_text(yaml.safe_dump(document))


def change_loads(project):
    change_study(project, loads=["2 MPa", "20 MPa"])


def change_label(project):
    change_study(project, label="another name for it")


#: A file of each kind: its rule, and what is changed of what that rule reads.
KINDS = {
    "results/test/specimens/rock.nc": ("roughness_and_composite", change_scan),
    "results/test/contact/rock/0.0.0.nc": ("contact", change_loads),
    ATLAS: ("atlas", change_label),
    FIGURE: ("figures_against_plane", change_label),
}
#: Every kind and every way; test_provenance.py has what is done with each record.
LOST = list(zip(itertools.cycle(KINDS), LOSSES, strict=False))


@pytest.mark.parametrize(
    ("name", "how"),
    [*LOST[: len(KINDS)], *(pytest.param(*lost, marks=pytest.mark.full) for lost in LOST[4:])],
)
def test_a_change_is_seen_though_the_record_of_a_result_is_lost(project, name, how):
    rule, change = KINDS[name]
    lose(project, name, how)
    change(project)
    assert planned(project, ATLAS, FIGURE)[rule] == 1


def test_the_atlas_is_of_the_scan_and_the_study_of_now_though_records_are_lost(project):
    for name, how in LOST[: len(KINDS)]:
        lose(project, name, how)
    change_scan(project)
    change_loads(project)
    done = made(project, STUDY, targets=[ATLAS])
    assert done.returncode == 0, done.stderr[-3000:]
    atlas = read_atlas(project / ATLAS)
    scans = json.loads(atlas.attrs["scan_checksums"])["rock"]
    assert scans == {"lower": sha256(project / "scans/rock.npy")}
    assert atlas["closure/rock"]["nominal_pressure"].max() == pytest.approx(20)
    assert "is missing or damaged" in " ".join(done.stderr.split())
    assert planned(project) == {}


def test_a_job_that_failed_with_a_new_scan_leaves_nothing_that_counts_as_made_of_it(project):
    change_scan(project)
    checksums = project / "results/test/checksums/specimens"
    checksums.rename(project / "kept")
    checksums.write_text("so the job fails once it has solved everything")
    assert run(project, STUDY, ATLAS).returncode != 0
    checksums.unlink()
    (project / "kept").rename(checksums)
    assert {"roughness_and_composite", "contact", "atlas"} <= set(planned(project))


def test_results_stay_whole_for_their_readers_until_the_new_ones_replace_them(project):
    """A label is in atlas and figure, which are made again."""
    paths = [project / ATLAS, project / FIGURE]
    before = [sha256(path) for path in paths]
    seen = [set() for _ in paths]
    change_label(project)
    words = (sys.executable, "workflow/run.py", STUDY, "--", "--cores", "2", ATLAS, FIGURE)
    said = (project / "said").open("w")
    running = subprocess.Popen(words, cwd=project, stdout=said, stderr=said)
    while running.poll() is None:
        for path, digests in zip(paths, seen, strict=True):
            digests.add(sha256(path))
    assert running.returncode == 0, (project / "said").read_text()[-3000:]
    assert seen == [{old, sha256(path)} for old, path in zip(before, paths, strict=True)]
    assert len(seen[0]) == 2


def test_results_of_before_that_stay_where_their_job_failed_do_not_count_as_made_by_it(project):
    before = (project / ATLAS).read_bytes()
    change_label(project)
    assert made(project, STUDY, targets=["results/test/windows/rock.nc"]).returncode == 0
    closure = project / "results/test/closure/rock.nc"
    content, times = closure.read_bytes(), closure.stat()
    closure.write_bytes(content[:-1])  # so that the job of the atlas refuses it
    os.utime(closure, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert run(project, STUDY, ATLAS).returncode != 0
    assert (project / ATLAS).read_bytes() == before
    closure.write_bytes(content)
    os.utime(closure, ns=(times.st_atime_ns, times.st_mtime_ns))
    assert planned(project) == {"atlas": 1}


def test_a_run_has_the_code_of_its_checkout_wherever_its_environment_was_made(project):
    with open(project / "src/fractalcontact/study/figure_list.py", "a") as file:
        file.write('raise ValueError("code of this checkout")\n')
    assert "code of this checkout" in made(project, STUDY, "--dry-run").stderr


def test_a_job_on_a_cluster_works_with_what_its_run_was_planned_with(project):
    specimen = project / "results/test/specimens/rock.nc"
    before = specimen.read_bytes()
    specimen.unlink()
    (project / "scans/rock.yaml").write_text(array_sidecar(0.2))
    write_scan(project, "new")
    (project / STUDY).write_text("study: another\nscans: nowhere\n")
    # As the executor of a cluster calls it.
    words = ("--mode", "remote", "--force", "--nolock", "--allowed-rules", RULE)
    done = run(project, STUDY, *words, "--target-jobs", f"{RULE}:specimen=rock")
    assert done.returncode == 0, done.stderr[-3000:]
    assert specimen.read_bytes() == before
