"""What every interpreter of a study does first whose jobs are to be caught in mid-work.

held_faults.py writes it above workflow/scripts/sitecustomize.py.

A job whose rule has an order in the folder HELD_JOBS stands still for as long as the order says
"hold"; "memory 2000" makes it take 2000 MB more than it needs, and go on. The rule of a job is the
folder of its log, which Snakemake writes into its script.
"""

import os
import sys
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
if "HELD_JOBS" in os.environ:
    for _word in sys.orig_argv:
        if "/.snakemake/scripts/" in _word:
            _script = Path(_word).read_text(encoding="utf-8")
            for _order in Path(os.environ["HELD_JOBS"]).iterdir():
                if not _order.suffix and f"/logs/{_order.name}/" in _script:
                    _obey(_order)
