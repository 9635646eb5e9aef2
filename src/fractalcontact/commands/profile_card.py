"""Write the card of a profile: Delta_g, Z2 and the JRC by step and fit.

python -m fractalcontact.commands.profile_card FILE [--out FOLDER]

FILE is text whose first line is "x [mm], z [um]"; the card goes to FOLDER/cards (results/profiles).
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ..cards.profile import card_of_profile
from ..cards.write import write_card
from ..core.checksums import sha256
from ..core.errors import said_in_one_line
from ..core.file_names import specimen_name
from ..joint.profile import profile_coefficients
from ..scan.columns import read_profile


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Write the card; 1 if the file is no profile, else 0."""
    parser = argparse.ArgumentParser(prog="profile_card", description=__doc__)
    parser.add_argument("file")
    parser.add_argument("--out", default="results/profiles")
    given = parser.parse_args(arguments)
    heights, spacing = read_profile(given.file)
    name = specimen_name(Path(given.file).stem)
    coefficients = profile_coefficients(heights, spacing)
    write_card(
        card_of_profile(name, coefficients, heights.size, spacing, sha256(given.file)), given.out
    )
    sys.stdout.write(f"{Path(given.out, 'cards', f'{name}.html')}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
