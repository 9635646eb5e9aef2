"""What the figures of the joint's mechanics share: units, words for estimates, maps of a scan."""

import numpy as np
from matplotlib.patches import Patch, Rectangle
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from ..specimen import window_slices
from .common import COLOURS

TOWARDS = {"E": "East", "N": "North", "W": "West", "S": "South"}

#: Grey of cells that were not measured.
MISSING = "0.7"

#: Lets a line or a word be seen on light and on dark ground.
HALO = [withStroke(linewidth=2.5, foreground="white")]


def length_unit(span):
    """Unit that suits lengths up to ``span`` mm: its name, and how many mm it is."""
    if span >= 2000:
        return "m", 1000.0
    return ("mm", 1.0) if span >= 0.1 else ("µm", 1e-3)


def force_unit(largest):
    """Unit that suits forces up to ``largest`` N: its name, and how many N it is."""
    return ("kN", 1000.0) if largest >= 1000 else ("N", 1.0)


def estimate(value, low, high, unit=""):
    """A fitted value with its 95 % interval in words; "no fit" where there is none."""
    if not np.isfinite(value):
        return "no fit"
    text = f"{value:.3g} [{low:.3g}, {high:.3g}]"
    return f"{text} {unit}".rstrip()


def slope_text(line, unit=""):
    """Slope of a :class:`fractalcontact.fitting.LineFit` with its interval in words."""
    return estimate(line.slope, line.slope_low, line.slope_high, unit)


def spread(n, most):
    """Indices of up to ``most`` of n things, the first and the last among them."""
    return np.unique(np.round(np.linspace(0, n - 1, min(n, most))).astype(int))


def place(direction):
    """Where the contact is, in words."""
    return (
        "against a rigid plane" if direction == "none" else f"sliding towards {TOWARDS[direction]}"
    )


def state_label(direction, offset):
    """One of the states of a legend."""
    return "against a plane" if direction == "none" else f"$v$ = {offset:.3g} mm"


def scan_extent(specimen):
    """Sides (y, x) of the whole scan, mm."""
    return tuple(specimen.sizes[axis] * specimen.attrs[f"spacing_{axis}"] for axis in "yx")


def window_outline(specimen, unit_mm, slid=(0.0, 0.0), **style):
    """The window as a rectangle, in units from the corner of the scan.

    Parameters
    ----------
    specimen : xr.Dataset
    unit_mm : float
        mm in a unit of the axes.
    slid : (float, float)
        How far (y, x) the window has slid, mm.
    **style
        Of the rectangle.
    """
    corner, sides = [], []
    for cells, axis, moved in zip(window_slices(specimen), "yx", slid, strict=True):
        spacing = specimen.attrs[f"spacing_{axis}"]
        corner.append((cells.start * spacing + moved) / unit_mm)
        sides.append((cells.stop - cells.start) * spacing / unit_mm)
    return Rectangle(corner[::-1], sides[1], sides[0], fill=False, path_effects=HALO, **style)


def draw_map(axes, image, sides, unit, *, interpolation="nearest", **options):
    """An image true to scale, with distances from its corner.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    image : (ny, nx) or (ny, nx, 3) ndarray
        Values (NaN is drawn grey) or colours.
    sides : (float, float)
        (y, x) in mm.
    unit : (str, float)
        From :func:`length_unit`.
    interpolation : str
        By default none, so that no missing cell is filled.
    **options
        Of ``imshow``.

    Returns
    -------
    matplotlib.image.AxesImage
    """
    name, size = unit
    extent = (0, sides[1] / size, 0, sides[0] / size)
    axes.set_facecolor(MISSING)
    drawn = axes.imshow(image, extent=extent, interpolation=interpolation, **options)
    for axis, letter in ((axes.xaxis, "x"), (axes.yaxis, "y")):
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.set_label_text(f"${letter}$ ({name})")
    return drawn


def missing_patch():
    """Entry of a legend for cells that were not measured."""
    return Patch(facecolor=MISSING, edgecolor="none", label="not measured")


def letter(axes, which, title):
    """Letter of a panel as the paper has it, at its upper left, before a title."""
    axes.set_title(f"({which}) {title}", loc="left")


def colour_of(i):
    """The i-th colour that can be seen as a line on white: all but the yellow."""
    return COLOURS[i % (len(COLOURS) - 1)]
