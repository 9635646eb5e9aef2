"""What a cluster knows of jobs: which a killed run left in its queue, and why it ended one."""

import os
import re
import subprocess
from pathlib import Path

#: Seconds that the cluster gets to say what is in its queue.
PATIENCE = 60
#: Where the executor keeps what jobs wrote past their own logs, until they have succeeded.
LOGS = Path(".snakemake/slurm_logs")
_MORE = "the next attempt, if one is left (retries in the profile), asks for twice as much"
_MEMORY = f"the cluster ended it, it took more memory than asked for; {_MORE}"
#: What SLURM writes there when it ends a job.
ENDED = {
    "DUE TO TIME LIMIT": f"the cluster ended it, its time was over; {_MORE}",
    "Exceeded job memory limit": _MEMORY,
    "oom": _MEMORY,
    "DUE TO NODE FAILURE": "its node failed; SLURM begins it again",
    "DUE TO PREEMPTION": "the cluster had other jobs before it; SLURM begins it again",
}


def left_in_queue(profile):
    """Jobs of this folder that wait or run on the cluster of a profile.

    They would write what a new run writes too. Those that run hold the guard of ``_running``; those
    that wait are known to the cluster alone.

    Parameters
    ----------
    profile : path-like
        Folder of the profile; where its executor is not SLURM, nothing is known.

    Returns
    -------
    list of str
        Their numbers.
    """
    text = (Path(profile) / "config.yaml").read_text(encoding="utf-8")
    if not re.search(r"^executor: *slurm *$", text, flags=re.MULTILINE):
        return []
    states = "PENDING,CONFIGURING,RUNNING,SUSPENDED,COMPLETING"
    command = ["squeue", "--noheader", "--format=%F|%Z", f"--user={os.getuid()}"]
    try:
        done = subprocess.run(
            [*command, f"--states={states}"], capture_output=True, text=True, timeout=PATIENCE
        )
    except (OSError, subprocess.TimeoutExpired):
        return []  # no cluster answers: to submit a job says so, and why
    jobs = (line.partition("|") for line in done.stdout.splitlines())
    return sorted({number for number, _, folder in jobs if folder == os.getcwd()}, key=int)


def last_words(rule, since):
    """What jobs of a rule wrote past their logs on a cluster, the last one last.

    Parameters
    ----------
    rule : str
    since : float
        Seconds since the epoch; what is older is of another run.

    Returns
    -------
    list of str
        Lines.
    """
    lines = []
    for path in sorted(LOGS.glob(f"rule_{rule}/**/*.log"), key=_age):
        try:
            if path.stat().st_mtime >= since:
                lines += path.read_text(encoding="utf-8", errors="replace").splitlines()
        except OSError:
            continue
    return lines


def ended_by_cluster(lines):
    """Why the cluster ended a job, in words for its user; nothing if it did not say so."""
    for line in reversed(lines):
        for sign, why in ENDED.items():
            if sign in line and "slurm" in line:
                return why
    return ""


def _age(path):
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0
