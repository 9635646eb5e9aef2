"""Nothing stale, nothing damaged: replaced scans, changed code, moved checkouts, spoilt results."""

import json
import os
import shutil
import subprocess
import time

import numpy as np
import pytest
import yaml
from projects import command, copy_project, jobs_of, made, rough_heights, run, small_study
from projects import write_scan as write_scan_in
from stated import array_sidecar

from fractalcontact.core.atomic import UNFINISHED
from fractalcontact.core.checksums import sha256
from fractalcontact.core.netcdf import read
from fractalcontact.study.atlas import read_atlas

# What each kind of change makes again is in test_rerun.py; here studies run to their figures.
pytestmark = [pytest.mark.workflow, pytest.mark.full]
STUDY = "config/test.yaml"
#: Little is made where a test needs no more; figures take longest.
SPECIMEN = "results/test/specimens/rock.nc"
ATLAS = ["results/test/atlas.nc"]
#: Long before anything here was made.
LONG_AGO = (1_000_000_000, 1_000_000_000)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A study of one embedded surface and one scan, both against a plane, that was made."""
    folder = copy_project(tmp_path_factory.mktemp("finished"))
    study = small_study(folder, embedded={"own": embedded("own surface")})
    study_file = folder / study
    document = yaml.safe_load(study_file.read_text())
    document["defaults"] |= {"opposite": "flat", "resolutions": [1, 2]}
    study_file.write_text(yaml.safe_dump(document))
    write_scan_in(folder, "rock")
    done = made(folder, study)
    assert done.returncode == 0, done.stderr[-3000:]
    return folder


def embedded(label):
    recipe = {"size": "4 mm", "spacing": "0.1 mm", "dimension": 2.2, "rms": "0.1 mm", "seed": 1}
    return {"label": label, **recipe}


@pytest.fixture
def project(finished, tmp_path):
    """A copy of it, times and all."""
    return copied(finished, tmp_path / "project")


def copied(source, target):
    shutil.copytree(source, target, symlinks=True)
    return target


def planned(project, *options):
    return jobs_of(run(project, STUDY, "--dry-run", *options))


def atlas_of(project):
    return (project / "results/test/atlas.nc").read_bytes()


def made_of(project):
    """Checksum of the scan that the specimen was made of."""
    attributes = read(project / SPECIMEN).attrs
    return json.loads(attributes["lower_scan"])["sha256"]


# -- scans -----------------------------------------------------------------------------------------


def replace_by_an_older_one(path, content):
    other = path.with_name("other")
    other.write_bytes(content)
    os.utime(other, LONG_AGO)
    os.replace(other, path)


def test_a_scan_replaced_by_an_older_file_is_read_and_so_is_the_first_when_it_comes_back(project):
    scan = project / "scans/rock.npy"
    first, specimen = scan.read_bytes(), (project / SPECIMEN).read_bytes()
    np.save(scan, rough_heights(seed=1))
    second = scan.read_bytes()
    for content in (second, first):
        replace_by_an_older_one(scan, content)
        jobs = planned(project)
        assert jobs["roughness_and_composite"] == jobs["contact"] == 1
        done = made(project, STUDY, targets=[SPECIMEN])
        assert done.returncode == 0, done.stderr[-3000:]
        assert made_of(project) == sha256(scan)
        assert planned(project, SPECIMEN) == {}
    assert (project / SPECIMEN).read_bytes() == specimen


def test_a_sidecar_replaced_by_an_older_file_is_read(project):
    sidecar = project / "scans/rock.yaml"
    replace_by_an_older_one(sidecar, array_sidecar(0.2).encode())
    assert planned(project)["roughness_and_composite"] == 1
    replace_by_an_older_one(sidecar, b"# of x, y and z\n" + array_sidecar(0.1).encode())
    assert planned(project) == {}


def test_a_touched_scan_solves_nothing(project):
    for path in (project / "scans").iterdir():
        path.touch()
    assert planned(project) == {}


def test_a_scan_replaced_while_its_job_runs_is_never_stale(project):
    scan = project / "scans/large.npy"
    write_scan_in(project, "large", rough_heights(n=900))
    log, output = (
        "results/test/logs/roughness_and_composite/large.log",
        "results/test/specimens/large.nc",
    )
    running = subprocess.Popen(
        command(STUDY, output),
        cwd=project,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    while not (project / log).exists() and running.poll() is None:
        time.sleep(0.01)
    time.sleep(0.7)  # by now it is read, or about to be
    other = rough_heights(seed=2, n=900)
    np.save(project / "other.npy", other)
    os.utime(project / "other.npy", LONG_AGO)
    os.replace(project / "other.npy", scan)
    said = running.communicate()[1]
    if running.returncode:
        assert "changed while" in said
        assert not (project / output).exists()
    assert planned(project, output) == {"roughness_and_composite": 1}
    done = run(project, STUDY, output)
    assert done.returncode == 0, done.stderr[-3000:]
    assert planned(project, output) == {}


def test_a_missing_folder_of_scans_keeps_the_atlas(project):
    atlas = atlas_of(project)
    (project / "scans").rename(project / "unmounted")
    for done in (run(project, STUDY), made(project, STUDY)):
        assert done.returncode != 0
        assert "scans: no such folder (not mounted?)" in done.stdout + done.stderr
    (project / "scans").mkdir()
    for done in (run(project, STUDY), made(project, STUDY)):
        said = done.stdout + done.stderr
        assert done.returncode != 0
        assert "specimens that the study no longer has: rock" in said
        assert "make DROP=yes" in said
        assert "scans: no scan files there" in said
    assert atlas_of(project) == atlas
    # Nor does a list that was damaged, which is set aside, forget them.
    listed = project / "results/test/specimens.txt"
    listed.write_bytes(b"\xff\xfe")
    assert "no longer has: rock" in made(project, STUDY).stderr
    # A lock that a killed run left is in nobody's way then either.
    (project / ".snakemake/locks").mkdir(exist_ok=True)
    (project / ".snakemake/locks/0.output.lock").write_text("results/test/atlas.nc\n")
    told = made(project, STUDY, targets=ATLAS, FRACTALCONTACT_DROP="yes")
    assert told.returncode == 0, told.stderr[-3000:]
    assert "results/test keeps files of rock, which the study no longer has" in told.stderr
    assert list(read_atlas(project / ATLAS[0])["specimens"].children) == ["own"]
    assert planned(project, *ATLAS) == {}


def test_results_that_snakemake_has_no_record_of_are_made_again(project):
    shutil.rmtree(project / ".snakemake")
    np.save(project / "scans/rock.npy", rough_heights(seed=1))
    jobs = planned(project)
    assert {"synthetic_scan", "contact", "figures_against_plane"} <= set(jobs)
    assert jobs["contact"] == 2
    done = made(project, STUDY, targets=[SPECIMEN])
    assert done.returncode == 0, done.stderr[-3000:]
    assert made_of(project) == sha256(project / "scans/rock.npy")


# -- code, versions, settings ----------------------------------------------------------------------

#: What words alone make again: nothing is solved.
DRAWING = {
    *("atlas", "figures_against_plane", "study_figures", "explorer", "result_page"),
    *("card_and_page", "all_drawn", "all"),
}


def append(path, text):
    with open(path, "a") as file:
        file.write(text)


def test_code_counts_that_a_script_shares_with_others(project):
    append(project / "workflow/scripts/_figures.py", "# another way to say it\n")
    drawing = {"figures_against_plane", "study_figures", "card_and_page", "result_page"}
    assert drawing <= set(planned(project)) <= DRAWING
    append(project / "src/fractalcontact/scan/__init__.py", "# another reader\n")
    assert "roughness_and_composite" in planned(project)


def test_a_changed_version_of_a_library_makes_again_what_imports_it(project):
    for name, jobs in {"matplotlib": DRAWING - {"atlas"}, "scipy": None}.items():
        info = project / f"src/{name}-999.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 999.0\n")
        found = planned(project)
        if jobs is None:
            assert {"roughness_and_composite", "contact", "atlas"} <= set(found)
        else:
            assert set(found) == jobs


def test_words_alone_solve_nothing(project):
    append(project / "config/schema/study.schema.json", "\n")
    assert planned(project) == {}
    study = yaml.safe_load((project / STUDY).read_text())
    study["embedded"]["own"]["label"] = "another name for it"
    (project / STUDY).write_text(yaml.safe_dump(study))
    # The report names specimens, and solves nothing.
    made_again = {"size_laws_against_plane", "specimen_atlas_against_plane"}
    assert set(planned(project)) == DRAWING | made_again


def test_a_moved_and_a_copied_checkout_are_as_they_were(project, tmp_path):
    moved = tmp_path / "moved elsewhere"
    project.rename(moved)
    assert planned(moved) == {}
    again = tmp_path / "it's a copy"
    subprocess.run(["cp", "-r", moved, again], check=True)  # new times for everything
    assert planned(again) == {}


# -- damage ----------------------------------------------------------------------------------------

DAMAGES = {
    "truncated": lambda content: content[: len(content) // 2],
    "emptied": lambda content: b"",
    "one bit": lambda content: content[:200] + bytes([content[200] ^ 4]) + content[201:],
    "text": lambda content: b"<html>404</html>",
}
KINDS = (
    "embedded/own.npy",
    "specimens/rock.nc",
    "contact/own/0.0.0.nc",
    "figures/rock/fig02_relief.png",
    "figures/own/quality.csv",
    "atlas.nc",
)


def damage(path, how, *, keep_times):
    content, times = path.read_bytes(), (path.stat().st_atime_ns, path.stat().st_mtime_ns)
    path.write_bytes(DAMAGES[how](content))
    if keep_times:
        os.utime(path, ns=times)


def test_what_was_damaged_or_removed_is_made_again_by_the_same_command(project):
    results = project / "results/test"
    removed = (
        "figures/own/fig08_prefractals.svg",
        "figures/rock/errors.txt",
        "embedded/own.yaml",
    )
    before = {name: (results / name).read_bytes() for name in (*KINDS, *removed)}
    ways = [(how, keep) for how in DAMAGES for keep in (True, False)]
    for name, (how, keep) in zip(KINDS, ways, strict=False):
        damage(results / name, how, keep_times=keep)
    for name in removed:
        (results / name).unlink()
    leftover = results / f"figures/own/{UNFINISHED}x1y2.png"
    leftover.write_bytes(b"half")
    done = made(project, STUDY)
    assert done.returncode == 0, done.stderr[-3000:]
    for name in KINDS:
        said = f"results/test/{name}: damaged or replaced after it was made; moved to results/test"
        assert f"{said}/damaged/{name}, and made again" in done.stderr
    assert f"removed {leftover.relative_to(project)}, which a killed run left" in done.stderr
    assert not leftover.exists()
    assert {name: (results / name).read_bytes() for name in before} == before
    assert planned(project) == {}


def test_a_file_damaged_while_the_study_runs_is_not_read(project):
    """Its name is said once, in one sentence, and the same command goes on from there."""
    spoilt = project / "results/test/specimens/rock.nc"
    (project / "results/test/contact/rock/0.0.0.nc").unlink()
    damage(spoilt, "one bit", keep_times=True)
    target = "results/test/contact/rock/0.0.0.nc"
    # As if it had happened after the run had looked.
    done = run(project, STUDY, target)
    errors = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert set(errors) == {
        "error: results/test/specimens/rock.nc: damaged or replaced after it was made (its "
        "checksum is not that in results/test/checksums/specimens/rock.sha256); 'make' sets it "
        "aside and makes it again"
    }
    assert "HDF error" not in done.stderr
    again = made(project, STUDY, targets=[target])
    assert again.returncode == 0, again.stderr[-3000:]
