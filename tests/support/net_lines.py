"""Printer of ``make lint``: net lines of src, workflow and tests over the last ten merges.

    python tests/support/net_lines.py

prints a line for each merge on the main line and their sum. It ends with 0 in any case: where there
is no history, as in an archive, or a shallow one, it says so.
"""

import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("src", "workflow", "tests")
MERGES = 10


def git(root: Path, *args: str) -> str:
    """Output of a git command, CalledProcessError if it fails."""
    command = ["git", "-C", str(root), *args]
    return subprocess.run(command, capture_output=True, encoding="utf-8", check=True).stdout


def net_lines(root: Path, merge: str) -> dict[str, int]:
    """Lines that a merge added to each folder, less those that it removed."""
    net = dict.fromkeys(FOLDERS, 0)
    for row in git(root, "diff", "--numstat", f"{merge}^1", merge, "--", *FOLDERS).splitlines():
        added, removed, path = row.split("\t")
        if added != "-":
            folder = next(folder for folder in FOLDERS if f"{folder}/" in path)
            net[folder] += int(added) - int(removed)
    return net


def report(root: Path = ROOT) -> list[str]:
    """Table of the last merges, newest first, or one line on why there is none."""
    try:
        log = git(root, "log", "--first-parent", "--merges", f"-{MERGES}", "--format=%h %s")
        shallow = git(root, "rev-parse", "--is-shallow-repository").strip() == "true"
    except (OSError, subprocess.CalledProcessError):
        return ["net lines: no history here, so no merges to count"]
    rows = []
    for merge, _, subject in (line.partition(" ") for line in log.splitlines()):
        try:
            rows.append((net_lines(root, merge), subject))
        except subprocess.CalledProcessError:  # the first parent is beyond a shallow history
            break
    if not rows:
        why = "the history is shallow" if shallow else "no merges yet"
        return [f"net lines: {why}, so no merges to count"]
    total = {folder: sum(net[folder] for net, _ in rows) for folder in FOLDERS}
    beyond = "; the history ends there" if shallow and len(rows) < MERGES else ""
    head = f"net lines over the last {len(rows)} merges{beyond}"
    return [head, *(_row(net, subject) for net, subject in [*rows, (total, "all of them")])]


def _row(net: dict[str, int], subject: str) -> str:
    return "  " + "  ".join(f"{folder} {net[folder]:+6d}" for folder in FOLDERS) + f"  {subject}"


if __name__ == "__main__":
    print("\n".join(report()))
