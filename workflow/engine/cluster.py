"""Queue of the cluster after a killed run, and its reasons for ending a job."""

import os
import re
import subprocess
from pathlib import Path

from fractalcontact.core.errors import InputError

#: Seconds within which the cluster must say what is in its queue.
PATIENCE = 60
_MORE = "the next attempt, if one is left (retries in the profile), asks for twice as much"
_MEMORY = f"the cluster ended it, it took more memory than asked for; {_MORE}"
#: Patterns in the log of a job, which SLURM's executor writes, and the reasons that they stand for.
ENDED = {
    "DUE TO TIME LIMIT": f"the cluster ended it, its time was over; {_MORE}",
    "Exceeded job memory limit": _MEMORY,
    "oom_kill": _MEMORY,
    "oom-kill": _MEMORY,
    "DUE TO NODE FAILURE": "its node failed; SLURM begins it again",
    "DUE TO PREEMPTION": "the cluster had other jobs before it; SLURM begins it again",
}


def left_in_queue(profile):
    """Numbers of the jobs of this folder that wait or run on the cluster of a profile.

    They would write the same files as a new run. Running jobs hold the guard of ``running``, but
    only the cluster knows those that wait; if it does not answer, that is an InputError. Empty
    where the executor of the profile is not SLURM.
    """
    text = (Path(profile) / "config.yaml").read_text(encoding="utf-8")
    if not re.search(r"^executor: *slurm *$", text, flags=re.MULTILINE):
        return []
    states = "PENDING,CONFIGURING,RUNNING,SUSPENDED,COMPLETING"
    command = ["squeue", "--noheader", "--format=%F|%Z", f"--user={os.getuid()}"]
    try:
        done = subprocess.run(
            [*command, f"--states={states}"],
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            encoding="utf-8",
        )
        *_, why = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
        failed = done.returncode
    except OSError:
        return []  # without a cluster, submitting a job says so, and why
    except subprocess.TimeoutExpired:
        failed, why = True, f"no answer in {PATIENCE} s"
    if failed:
        raise InputError(
            f"the cluster does not say what is in its queue (squeue: {why}), where jobs of a run "
            "that was killed may still be; wait until 'squeue' answers, then begin again"
        )
    jobs = (line.partition("|") for line in done.stdout.splitlines())
    return sorted({number for number, _, folder in jobs if folder == os.getcwd()}, key=int)


def ended_by_cluster(lines):
    """Reason why the cluster ended a job, from the lines of its log; empty if it gave none."""
    for line in reversed(lines):
        for sign, why in ENDED.items():
            if sign in line and "slurm" in line:
                return why
    return ""
