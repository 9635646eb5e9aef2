"""Jobs that a run which was killed left in a cluster's queue."""

import os
import re
import subprocess
from pathlib import Path

#: Seconds that the cluster gets to say what is in its queue.
PATIENCE = 60


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
