"""Write the gap between two scanned faces, without a study: numbers, a map and a picture.

python -m fractalcontact.commands.gap_of_scans LOWER UPPER
    [--unit mm] [--keys SIDECAR.yaml] [--outliers fill] [--out gap.csv]

LOWER and UPPER are scans of the two faces. Files that do not describe themselves are read as a
draft of their sidecar suggests, in the unit given, or as SIDECAR.yaml says, like a sidecar in the
folder of scans; its keys `registration` and `grid` hold here too. The map is gap.csv unless --out
names a file that ends in .csv, .nc or .vtk; the picture goes beside it.
"""

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..cards.apertures import MAP_ENDINGS, write_aperture
from ..core.errors import InputError, said_in_one_line
from ..core.labels import printable
from ..core.text import percent
from ..scan.raw import IncompleteSidecar
from ..scan.read import read_faces
from ..study.checks import read_sidecar
from ..surface.cleaning import clean_faces
from .describe import drafted_keys
from .describe_picture import colours, draw_histogram

#: Percentiles of the gap that are printed.
_PERCENTILES = (1, 5, 25, 50, 75, 95, 99)


@said_in_one_line
def main(arguments: Sequence[str] | None = None) -> int:
    """Write the map and its picture, and print the numbers; 1 for a wrong request, else 0."""
    parser = argparse.ArgumentParser(prog="gap_of_scans", description=__doc__)
    parser.add_argument("lower")
    parser.add_argument("upper")
    parser.add_argument("--out", default="gap.csv", help="file to write: .csv, .nc or .vtk")
    parser.add_argument("--unit", help="of files that state none, such as mm")
    parser.add_argument("--keys", help="YAML file of keys as a sidecar has them")
    parser.add_argument("--outliers", default="keep", help="keep, mask or fill; keep by default")
    given = parser.parse_args(arguments)
    out = Path(given.out)
    if out.suffix not in MAP_ENDINGS:
        raise InputError(f"{out}: write a file that ends in {', '.join(MAP_ENDINGS)}")
    # Settings of a study in the same sidecar, such as a material, do not change the gap.
    keys, _ = read_sidecar(Path(given.keys) if given.keys else None)
    keys = dict(keys) | ({"unit": given.unit} if given.unit else {})
    lower, upper = Path(given.lower), Path(given.upper)
    try:
        gap = gap_of(lower, upper, keys, given.outliers)
    except IncompleteSidecar:
        # Keys decide how a file is read: one that needs a draft is read again as that says.
        gap = gap_of(lower, upper, complete(lower, upper, keys), given.outliers)
    picture = out.with_suffix(".png")
    write_aperture(gap, out)
    _draw(gap, picture)
    sys.stdout.write("\n".join([*words(gap), f"{out}: the gap in mm", f"{picture}: its picture"]))
    sys.stdout.write("\n")
    return 0


def complete(lower: Path, upper: Path, stated: Mapping) -> dict[str, Any]:
    """Keys of two files, with what a draft suggests where they need more than is stated.

    Raises
    ------
    InputError
        If the draft leaves a key open.
    """
    drafted = drafted_keys(lower, upper, stated)
    left = [key for key, value in drafted.items() if value is None]
    if not left:
        return drafted
    how = "--unit mm" if left == ["unit"] else "a sidecar and --keys SIDECAR.yaml"
    raise InputError(f"{lower}, {upper}: the files do not state {', '.join(left)}; write {how}")


def gap_of(lower: Path, upper: Path, keys: Mapping, outliers: str = "keep") -> xr.DataArray:
    """Gap (y, x) between two scanned faces as the registration leaves them, ``aperture`` in mm.

    It is the height of the upper face above the lower one: below zero where the faces overlap, NaN
    where a face is missing. ``keys`` are those of `scan.read.read_faces`, ``outliers`` is that of
    `surface.cleaning.clean_faces`; both may raise InputError. Attributes ``registration`` and
    ``cleaning`` say what was done.
    """
    low, high = read_faces(lower, upper, keys)
    assert high is not None  # two files were given
    cleaned, _, attrs = clean_faces([low, high], outliers=outliers, name=str(lower))
    gap = (cleaned[1] - cleaned[0]).rename("aperture")
    source = f"{upper.name} above {lower.name}"
    done = {
        "registration": high.attrs["registration"],
        "cleaning": attrs["cleaning"],
        "source": source,
    }
    return gap.assign_attrs(units="mm", long_name="gap between the faces", **done)


def words(gap: xr.DataArray) -> list[str]:
    """Lines on the sizes, the gap and the registration."""
    done = json.loads(gap.attrs["registration"])
    present = gap.values[np.isfinite(gap.values)]
    ny, nx = gap.shape
    dx, dy = (float(np.diff(gap[axis].values).mean()) for axis in "xy")
    shares = np.percentile(present, _PERCENTILES)
    overlapping = percent(float(np.mean(present < 0)))
    percentiles = ", ".join(f"{p} %: {g:.4g}" for p, g in zip(_PERCENTILES, shares, strict=True))
    lines = [
        f"{gap.attrs['source']}: {nx} x {ny} cells of {dx:.4g} x {dy:.4g} mm, "
        f"{percent(1 - present.size / gap.size)} without a height of both",
        f"gap: mean {present.mean():.4g} mm, standard deviation {present.std():.4g} mm, "
        f"{present.min():.4g} to {present.max():.4g} mm",
        f"percentiles of the gap, mm: {percentiles}",
        f"overlap: the upper face lies below the lower one in {overlapping} of the cells",
        f"suspicious cells: {gap.attrs['cleaning']}",
    ]
    if not done["applied"]:
        return [*lines, f"registration {done['mode']}: nothing was moved; {done['note']}"]
    return [
        *lines,
        f"registration {done['mode']}: the upper face moved by {done['shift_x_mm']:.4g} mm along x "
        f"and {done['shift_y_mm']:.4g} mm along y, turned by {done['rotation_degrees']:.3g} "
        f"degrees; standard deviation of the gap {done['gap_sd_before_mm'] or np.nan:.4g} mm "
        f"before, {done['gap_sd_after_mm']:.4g} mm after; {done['note']}",
    ]


def _draw(gap: xr.DataArray, path: Path) -> None:
    """Map of the gap and its histogram."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 4.8), layout="constrained")
    FigureCanvasAgg(figure)
    of_map, histogram = figure.subplots(1, 2, width_ratios=(3, 2))
    low, high = np.nanpercentile(gap, [0.5, 99.5])  # spikes would hide the rest
    image = of_map.pcolormesh(
        gap["x"], gap["y"], gap, cmap=colours(), vmin=low, vmax=high, rasterized=True
    )
    of_map.set(aspect="equal", facecolor="red", xlabel="x (mm)", ylabel="y (mm)")
    figure.colorbar(image, ax=of_map, label="gap (mm)", extend="both")
    draw_histogram(histogram, gap.values, "gap (mm)")
    figure.suptitle(printable(gap.attrs["source"], 120), fontsize=9)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    sys.exit(main())
