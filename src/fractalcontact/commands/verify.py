"""Comparison of every file of a study with the checksum that its job recorded.

python -m fractalcontact.commands.verify STUDY_FILE_OR_RESULTS_FOLDER
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from ..core.checksums import KNOWN, check
from ..core.errors import InputError, said_in_one_line
from ..study.documents import read_study, study_name


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Print damaged or missing files; exit code 1 for any, or without checksums, else 0."""
    (given,) = sys.argv[1:] if arguments is None else arguments
    results = results_of(given)
    if not results.is_dir():
        raise InputError(f"{results}: no such folder; run 'make' first")
    checked = check(results)
    for word in ("damaged", "unrecorded", "missing"):
        for path in getattr(checked, word):
            sys.stdout.write(f"{word}: {path}\n")
    words = ("intact", "damaged", "unrecorded", "missing")
    counts = [f"{len(getattr(checked, word))} {word}" for word in words]
    wrong = not checked.intact or any(getattr(checked, word) for word in words[1:])
    if wrong:
        KNOWN.unlink(missing_ok=True)  # it describes the files before their damage
    advice = "; 'make' makes again all files that the study needs" if wrong else ""
    sys.stdout.write(f"{results}: {', '.join(counts)}{advice}\n")
    return int(wrong)


def results_of(given: Path | str) -> Path:
    """Folder of the results of a study, given itself or by the study's file."""
    path = Path(given)
    return path if path.is_dir() else Path("results") / study_name(read_study(path), path)


if __name__ == "__main__":
    sys.exit(main())
