"""Parts of the workflow that Snakemake lacks, a file each: reason, cost, how to do without.

CONTRIBUTING.md has the measured gain of each part. The two packages are plugins of Snakemake,
which finds them by their names on the path that ``workflow/run.py`` gives it.
"""

import os
import sys
from pathlib import Path


def use_checkout(root: Path) -> None:
    """Import the code of a checkout, here and in its jobs, wherever its environment comes from."""
    paths = [str(root / "src"), str(root / "workflow")]
    sys.path[:0] = paths
    others = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    os.environ["PYTHONPATH"] = os.pathsep.join(dict.fromkeys([*paths, *others]))
