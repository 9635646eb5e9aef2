"""Write the constants of a joint's card for another code.

python -m fractalcontact.commands.export_constants CARD --to CODE [--out FILE]

CODE is porepy, geos, opengeosys, udec, 3dec, flac3d, dfnworks, ags4 or csv.
"""

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from ..cards.write import read_card
from ..core.atomic import atomic_write
from ..core.errors import said_in_one_line

#: Codes that constants are written for, and their modules in ``cards.exports``.
CODES = {
    **{code: code for code in ("porepy", "geos", "opengeosys", "udec")},
    **{"3dec": "three_dec", "flac3d": "flac3d", "dfnworks": "dfnworks"},
    **{"ags4": "ags4", "csv": "csv"},
}


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Print the constants, or write them to a file; exit code 1 without a card, else 0."""
    parser = argparse.ArgumentParser(prog="export_constants", description=__doc__)
    parser.add_argument("card", help="YAML or JSON, such as results/paper/cards/NAME.yaml")
    parser.add_argument("--to", choices=CODES, required=True)
    parser.add_argument("--out", help="file to write; printed by default")
    given = parser.parse_args(arguments)
    text = exported(read_card(given.card), given.to)
    if not given.out:
        sys.stdout.write(text)
        return 0
    with atomic_write(Path(given.out)) as temporary:
        temporary.write_bytes(text.encode())
    return 0


def exported(card: dict[str, Any], code: str) -> str:
    """Text of the constants of a card for one of :data:`CODES`."""
    return import_module(f"fractalcontact.cards.exports.{CODES[code]}").text_of(card)


if __name__ == "__main__":
    sys.exit(main())
