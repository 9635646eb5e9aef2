"""What every job of a study does first whose jobs are to be caught in mid-work.

held_faults.py writes it beside workflow/engine/job.py, which then calls it.

A job whose rule has an order in the folder HELD_JOBS stands still for as long as the order says
"hold"; "memory 2000" makes it take 2000 MB more than it needs, and go on. The rule of a job is the
folder of its log, which Snakemake writes into its script.
"""

import os
import time
from pathlib import Path

MB = 2**20
#: Seconds for which the memory is held alone: whoever measures it has to see it.
SEEN = 5


def _obey(order):
    order.with_suffix(".begun").write_text(str(os.getpid()), encoding="utf-8")
    while order.exists():
        verb, *words = order.read_text(encoding="utf-8").split() or ["hold"]
        if verb == "memory":
            _ballast.append(bytearray(b"x") * (int(words[0]) * MB))
            time.sleep(SEEN)
            return
        time.sleep(0.1)


_ballast = []


def hold(log):
    """Obey the order of the rule that has this log, if there is one."""
    for order in Path(os.environ["HELD_JOBS"]).iterdir() if "HELD_JOBS" in os.environ else ():
        if not order.suffix and f"/logs/{order.name}/" in log:
            _obey(order)
