"""Additions to Snakemake, a file each: why it is there, what it takes, how to do without.

CONTRIBUTING.md has what each was measured to be worth. The two packages are plugins of Snakemake,
which finds them by their names on the path that ``workflow/run.py`` gives it.
"""

import os
import sys
from pathlib import Path


def use_checkout(root: Path) -> None:
    """Take the code of a checkout, here and in its jobs, wherever its environment was installed."""
    paths = [str(root / "src"), str(root / "workflow")]
    sys.path[:0] = paths
    known = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    os.environ["PYTHONPATH"] = os.pathsep.join(dict.fromkeys([*paths, *known]))
