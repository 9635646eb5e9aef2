"""Write the aperture of a joint at a pressure, as CSV, netCDF or VTK.

python -m fractalcontact.commands.export_aperture RESULTS SPECIMEN --out FILE
    [--pressure "5 MPa"] [--points POINTS.csv] [--frame window]

The ending of FILE says the form: .csv, .nc or .vtk. POINTS.csv has the columns x and y, in mm.
x and y are in the coordinates of the scan, or with `--frame window` from the corner of the window.
"""

import argparse
import sys
from collections.abc import Sequence

from ..cards.apertures import (
    FRAMES,
    aperture_at,
    aperture_at_points,
    in_frame,
    outside_words,
    write_aperture,
)
from ..core.errors import InputError, said_in_one_line
from ..core.units import quantity
from ..study.atlas_parts import open_atlas


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Write the file; exit code 1 for a wrong request, else 0."""
    parser = argparse.ArgumentParser(prog="export_aperture", description=__doc__)
    parser.add_argument("results", help="folder of the results of a study, such as results/paper")
    parser.add_argument("specimen")
    parser.add_argument("--out", required=True, help="file to write: .csv, .nc or .vtk")
    parser.add_argument("--pressure", help="such as '5 MPa'; the reference load by default")
    parser.add_argument("--points", help="CSV file with columns x and y in mm; the grid by default")
    parser.add_argument(
        "--frame", choices=FRAMES, default="scan", help="of x and y; scan by default"
    )
    given = parser.parse_args(arguments)
    pressure = given.pressure and quantity(given.pressure, "pressure", "--pressure")
    atlas = open_atlas(given.results)
    if given.specimen not in atlas.specimens:
        raise InputError(
            f"{given.results}: no specimen {given.specimen!r}; it has "
            f"{', '.join(atlas.specimens) or 'none'}"
        )
    contact = atlas[f"contact/{given.specimen}"]
    aperture = in_frame(aperture_at(contact, pressure, given.specimen, given.results), given.frame)
    points = given.points and aperture_at_points(aperture, given.points)
    write_aperture(points if given.points else aperture, given.out)
    said = f"{aperture.attrs['source']}; x and y in mm, {aperture.attrs['frame']}"
    sys.stdout.write(f"{given.out}: aperture in mm, {said}\n")
    if given.points and (words := outside_words(aperture, points)):
        sys.stdout.write(f"{given.points}: {words}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
