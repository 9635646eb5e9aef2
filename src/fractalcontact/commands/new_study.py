"""Small study of the scans in a folder, with drafts of the sidecars that they lack.

python -m fractalcontact.commands.new_study [--name NAME] [--scans FOLDER]
"""

import argparse
import math
import string
import sys
from collections.abc import Sequence
from pathlib import Path

import yaml

from ..core.atomic import atomic_write
from ..core.errors import InputError, said_in_one_line
from ..core.labels import listed, natural_key
from ..study.campaign import JOINT, MAX_WHOLE, NONE
from ..study.documents import study_name
from ..study.scan_files import list_scans
from .describe import Described, describe_or_refuse, row_lines

TEMPLATE = Path(__file__).with_suffix(".yaml")


def new_study(path: Path, scans: Path) -> list[Described]:
    """Reports on the scans of a folder, whose study is written with drafts of missing sidecars.

    ``path`` is the file of the study, its stem the name. Files that are refused by their names have
    reports too.

    Raises
    ------
    InputError
        If the file exists, or the folder holds no scan.
    """
    if path.exists():
        raise InputError(f"{path} exists and stays; for another study: make new NAME=other")
    files, refused = list_scans(scans)
    if not files and not refused:
        raise InputError(
            f"{scans}: no scan in this folder; put a file there (scans/README.md names the "
            "formats), then: make new"
        )
    rows = [Described(key, "refused", sentences=[str(why)]) for key, why in refused.items()]
    rows += [describe_or_refuse(files[key]) for key in sorted(files, key=natural_key)]
    text = string.Template(TEMPLATE.read_text(encoding="utf-8")).substitute(
        name=path.stem,
        scans=yaml.safe_dump({"scans": str(scans)}, width=math.inf).rstrip(),
        specimens=listed(files) or "none",
        # Thousands of pictures would take longer than the numbers.
        figures=JOINT if len(files) <= MAX_WHOLE else NONE,
    )
    with atomic_write(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return rows


def next_steps(path: Path, scans: Path, rows: Sequence[Described]) -> list[str]:
    """Next steps after :func:`new_study` in three lines."""
    drafts = [row.name for row in rows if row.state == "draft"]
    first = f"enter your rock under materials in {path}"
    if drafts:
        first += (
            f"; compare the draft of {listed(drafts, 3)} in {scans} with its picture, complete it, "
            "and rename NAME.draft.yaml to NAME.yaml"
        )
    if "refused" in [row.state for row in rows]:
        first += "; mend or remove the refused files"
    return [
        f"1. {first}",
        f"2. make check-scans STUDY={path}   reads every scan and solves nothing",
        f"3. make STUDY={path}   computes the study of your scans alone",
    ]


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Write the study and print the next steps; exit code 1 if it cannot be written, else 0."""
    parser = argparse.ArgumentParser(prog="new_study", description=__doc__.split("\n")[0])
    parser.add_argument("--name", default="mine", help="name of the study")
    parser.add_argument("--scans", type=Path, default=Path("scans"), help="folder of the scans")
    parser.add_argument("--config", type=Path, default=Path("config"), help="folder of the studies")
    chosen = parser.parse_args(arguments)
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]  # a text file
    path = chosen.config / f"{study_name({'study': chosen.name}, 'NAME')}.yaml"
    rows = new_study(path, chosen.scans)
    lines = [line for row in rows for line in row_lines(row)]
    lines += [f"{path}: written", *next_steps(path, chosen.scans, rows)]
    sys.stdout.write("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
