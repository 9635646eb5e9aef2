"""Picture of scans as they would be read: relief, histogram, sizes, the first lines of the file."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..core.directions import APERTURE
from ..core.labels import printable
from ..core.text import percent

_MAX_POINTS = 60_000
_MAX_CELLS = 800  # along a side
_LINES, _WIDTH = 8, 110  # of text


def draw_faces(faces: Sequence[Any], path: Path) -> None:
    """Draw files (:class:`commands.describe.Face`) as they would be read into a PNG, a row each."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 5.6 * len(faces)), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(
        2 * len(faces), 2, width_ratios=(3, 2), height_ratios=(4, 1.6) * len(faces)
    )
    for n, face in enumerate(faces):
        relief, histogram = figure.add_subplot(grid[2 * n, 0]), figure.add_subplot(grid[2 * n, 1])
        _write_lines(figure.add_subplot(grid[2 * n + 1, :]), face)
        if face.scan is None:
            relief.set_axis_off()
            histogram.set_axis_off()
            continue
        of_map = face.options.get("kind") == APERTURE
        label = "negative of the aperture (mm)" if of_map else "height (mm)"
        z = _draw_relief(figure, relief, face, label)
        draw_histogram(histogram, z, label)
    figure.savefig(path, dpi=90)


def _draw_relief(figure, axes, face, label):
    """The relief over x and y, missing cells in red; its heights in mm."""
    scan = face.scan
    if scan.layout == "matrix":
        z, (dx, dy) = scan.values, scan.spacing
        ny, nx = z.shape
        step = max(1, -(-max(z.shape) // _MAX_CELLS))
        shown = np.ma.masked_invalid(z[::step, ::step])
        extent = (0, nx * dx, 0, ny * dy)
        image = axes.imshow(shown, origin="lower", extent=extent, cmap=colours(), aspect="equal")
        title = f"{nx} x {ny} cells of {dx:.4g} x {dy:.4g} mm"
    else:
        points = scan.values[:: max(1, len(scan.values) // _MAX_POINTS)]
        x, y, z = points.T
        image = axes.scatter(x, y, c=z, s=2, cmap=colours(), linewidths=0)
        axes.set_aspect("equal")
        title = f"{len(scan.values)} points"
        z = scan.values[:, 2]
    present = z[np.isfinite(z)]
    if present.size:  # spikes would hide the relief
        image.set_clim(*np.percentile(present, [0.5, 99.5]))
    figure.colorbar(image, ax=axes, label=label, extend="both")
    axes.set(xlabel="x (mm)", ylabel="y (mm)", title=f"{printable(face.path.name, 60)}: {title}")
    return z


def colours() -> Any:
    """Colours of a relief, missing cells in red."""
    from matplotlib import colormaps

    return colormaps["viridis"].with_extremes(bad="red")


def draw_histogram(axes: Any, z: np.ndarray, label: str) -> None:
    """Histogram of values in mm; their ends, median and missing share above it."""
    present = z[np.isfinite(z)]
    if present.size:
        # The margin of 1 um gives equal values a range too.
        ends = (present.min() - 1e-3, present.max() + 1e-3)
        axes.hist(present, bins=60, range=ends, color="0.4")
        axes.set_title(
            f"{present.min():.5g} to {present.max():.5g} mm, median {np.median(present):.5g} mm\n"
            f"missing {percent(1 - present.size / z.size)} (red)",
            fontsize=9,
        )
    axes.set(xlabel=label, ylabel="cells")


def _write_lines(axes, face):
    """Remarks to look at, then the first lines of the file as they stand."""
    axes.set_axis_off()
    notes = [f"! {printable(note, _WIDTH)}" for note in face.notes]
    shown = [*notes, *first_lines(face.path)][: _LINES + len(notes)]
    axes.text(0, 1, "\n".join(shown), va="top", family="monospace", fontsize=8, parse_math=False)


def first_lines(path: Path) -> list[str]:
    """First lines of a text file; none for a binary file."""
    with open(path, "rb") as stream:
        head = stream.read(4000)
    wide = head.startswith((b"\xff\xfe", b"\xfe\xff"))
    if b"\0" in head and not wide:
        return ["(no text)"]
    text = head.decode("utf-16" if wide else "utf-8", errors="replace")
    return [printable(line.expandtabs(4), _WIDTH) for line in text.splitlines()[:_LINES]]
