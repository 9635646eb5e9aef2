"""What can be said of a cluster without one: the profile, and jobs that a killed run left."""

import json
import os
import re
import subprocess
import sys

import pytest
import yaml
import yte
from places import ROOT
from projects import project  # noqa: F401

sys.path.append(str(ROOT / "workflow"))
from engine import cluster
from engine.cluster import ended_by_cluster, left_in_queue

from fractalcontact.core.errors import InputError

PROFILE = ROOT / "workflow/profiles/slurm"
FAKE = """#!/bin/sh
cat <<'END'
{}
END
"""
#: The words are those of SLURM 22.05 whose slurmctld is down.
DOWN = """#!/bin/sh
echo "slurm_load_jobs error: Unable to contact slurm controller (connect failure)" >&2
exit 1
"""


@pytest.fixture
def answers(tmp_path, monkeypatch):
    """Let commands of SLURM say something; those that are not told are as on a machine without."""
    tools = tmp_path / "tools"
    tools.mkdir()
    monkeypatch.setenv("PATH", f"{tools}:/usr/bin:/bin")

    def say(name, text):
        (tools / name).write_text(FAKE.format(text))
        (tools / name).chmod(0o755)

    for name in ("scontrol", "squeue"):
        say(name, "")
    return say


def settings():
    with open(PROFILE / "config.yaml") as file:
        return yte.process_yaml(file, require_use_yte=True)


def test_profile_asks_who_knows_of_jobs_that_ended(answers):
    answers("scontrol", "AccountingStorageType   = accounting_storage/none")
    assert settings()["slurm-status-command"] == "squeue"
    assert settings()["slurm-efficiency-report"] is None
    answers("scontrol", "ClusterName = x\nAccountingStorageType   = accounting_storage/slurmdbd")
    assert settings()["slurm-status-command"] == "sacct"
    assert settings()["slurm-efficiency-report"] is True


def test_profiles_agree_where_the_cluster_makes_no_difference():
    here = yaml.safe_load((ROOT / "workflow/profiles/default/config.yaml").read_text())
    there = settings()
    assert {key for key in here if there.get(key) != here[key]} <= {"printshellcmds"}


def test_jobs_of_this_folder_alone_are_left_in_the_queue(answers, tmp_path, monkeypatch):
    answers("squeue", f"12|{tmp_path}\n7|{tmp_path}\n9|/home/other\n12|{tmp_path}")
    monkeypatch.chdir(tmp_path)
    assert left_in_queue(PROFILE) == ["7", "12"]
    assert left_in_queue(ROOT / "workflow/profiles/default") == []


def test_jobs_that_wait_count_as_those_that_run(tmp_path, monkeypatch):
    """Every state of a job that has not ended is asked for, of this user alone."""
    words = []

    def squeue(command, **settings):
        words.extend(command)
        return subprocess.CompletedProcess(command, 0, "", "")

    monkeypatch.setattr(cluster.subprocess, "run", squeue)
    assert left_in_queue(PROFILE) == []
    (states,) = [word for word in words if word.startswith("--states=")]
    assert {"PENDING", "RUNNING", "CONFIGURING", "COMPLETING"} <= set(states[9:].split(","))
    assert f"--user={os.getuid()}" in words


def test_no_cluster_has_no_queue(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    assert left_in_queue(PROFILE) == []


def script(path, text):
    path.write_text(text)
    path.chmod(0o755)


@pytest.mark.usefixtures("answers")
def test_a_queue_that_the_cluster_does_not_tell_is_not_an_empty_one(tmp_path, monkeypatch):
    squeue = tmp_path / "tools/squeue"
    for text, why in (
        (DOWN, "squeue: slurm_load_jobs error: Unable to contact slurm controller"),
        ("#!/bin/sh\nexit 3\n", "squeue: exit code 3"),
        ("#!/bin/sh\nexec sleep 60\n", "squeue: no answer in 0.2 s"),
    ):
        script(squeue, text)
        monkeypatch.setattr(cluster, "PATIENCE", 0.2 if "sleep" in text else 60)
        with pytest.raises(InputError, match="wait until 'squeue' answers") as refused:
            left_in_queue(PROFILE)
        assert why in str(refused.value)
        assert left_in_queue(ROOT / "workflow/profiles/default") == []


@pytest.mark.usefixtures("answers")
def test_run_is_refused_while_the_queue_is_unknown(tmp_path, project):  # noqa: F811
    script(tmp_path / "tools/squeue", DOWN)
    words = ("workflow/run.py", "config/smoke.yaml", "--profile", "slurm")
    done = subprocess.run(
        [sys.executable, *words], cwd=project, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 1
    assert "Traceback" not in done.stderr
    (line,) = [line for line in done.stderr.splitlines() if line.startswith("error: ")]
    assert "Unable to contact slurm controller" in line
    assert "begin again" in line
    assert not (project / "results").exists()


def test_every_rule_asks_for_more_at_a_second_attempt():
    files = [ROOT / "Snakefile", *sorted((ROOT / "workflow/rules").glob("*.smk"))]
    found = [
        (path.name, amount)
        for path in files
        for amount in re.findall(r"(?m)^        (?:mem_mb|runtime)=(.*),$", path.read_text())
    ]
    assert len(found) > 50
    # All of these take the attempt.
    assert not [f for f in found if not f[1].startswith(("doubled(", "memory(", "minutes("))]
    shared = (ROOT / "workflow/rules/common.smk").read_text()
    exec(re.search(r"^def doubled.*?\n\n\n", shared, re.MULTILINE | re.DOTALL)[0], own := {})
    for amount in (3, lambda wildcards: 3):
        asked = own["doubled"](amount)
        assert [asked(None, attempt) for attempt in (1, 2, 3)] == [3, 6, 12]
    assert shared.count("    return doubled(lambda wc: estimates.") == 2  # memory and minutes


def test_why_the_cluster_ended_a_job_is_said_in_its_users_words():
    """The lines are those that SLURM 22.05 wrote, and one of a kernel that counts memory."""
    lines = {
        "slurmstepd-vm: error: *** JOB 31 ON vm CANCELLED AT now DUE TO TIME LIMIT ***": "its time",
        "slurmstepd-vm: error: Exceeded job memory limit": "more memory",
        "slurmstepd: error: Detected 1 oom_kill event in StepId=7.batch.": "more memory",
    }
    for line, why in lines.items():
        assert why in ended_by_cluster(["Building DAG of jobs...", line, ""])
    memory, time = list(lines)[1], next(iter(lines))
    assert "its time" in ended_by_cluster([memory, time])  # the last attempt counts
    assert not ended_by_cluster(["a room DUE TO TIME LIMIT", "Finished jobid: 0"])
    assert not ended_by_cluster([])


SCRIPT = """
import json, sys
from types import SimpleNamespace
sys.path[:0] = [{workflow!r}, {package!r}]
from engine.job import job
from fractalcontact.core.errors import InputError, OutputError
told = {{"resources": json.loads(sys.argv[1]), "config": {{"study": "test"}}}}
snakemake = SimpleNamespace(log=["job.log"], input=[], output=[], **told)
with job(snakemake):
    print("works")
    raise {error}("rock.npy: no numbers; write some")
"""


@pytest.mark.parametrize(
    ("error", "attempt", "works"),
    [
        ("InputError", 2, False),
        ("InputError", 1, True),  # of another run: what was wrong may have been mended
        ("OutputError", 2, True),  # there may be room by now
        ("RuntimeError", 2, True),
    ],
)
def test_further_attempt_repeats_an_error_that_it_would_find_again(tmp_path, error, attempt, works):
    paths = {"workflow": str(ROOT / "workflow"), "package": str(ROOT / "src")}
    command = [sys.executable, "-c", SCRIPT.format(error=error, **paths)]
    for number, expected in ((1, True), (attempt, works), (attempt, works)):
        # A run here has no such resource: that of workflow/profiles/slurm.
        told = json.dumps({} if number == 1 else {"attempt": number})
        done = subprocess.run(
            [*command, told], cwd=tmp_path, capture_output=True, text=True, timeout=120
        )
        assert done.returncode == 1
        assert done.stderr == ""
        assert "rock.npy: no numbers; write some" in (tmp_path / "job.log").read_text()
        assert ("works" in done.stdout) == expected


def test_an_error_that_was_not_the_end_of_an_attempt_is_not_repeated(tmp_path):
    """A library may have said it, before the cluster ended the job."""
    paths = {"workflow": str(ROOT / "workflow"), "package": str(ROOT / "src")}
    (tmp_path / "job.log").write_text("error: of a library\nand then it was killed\n")
    command = [sys.executable, "-c", SCRIPT.format(error="InputError", **paths)]
    done = subprocess.run(
        [*command, '{"attempt": 2}'], cwd=tmp_path, capture_output=True, text=True, timeout=120
    )
    assert "works" in done.stdout
