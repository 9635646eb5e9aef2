"""Where the project, and the real scans that are kept beside it, are."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
BENCHMARKS = ROOT / "benchmarks"
#: Never committed: who gave them has not given them away.
SCANS = ROOT.parent / "shared" / "scans"
