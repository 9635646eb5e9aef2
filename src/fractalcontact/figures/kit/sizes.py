"""What the figures of strength and of the size b share: axes, bars of intervals, exponents."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.fitting import FEWEST_POINTS
from ...core.limits import JRC_RANGE, JRC_SAMPLING, LARGEST_FRICTION_ANGLE
from .points import draw_points
from .verdicts import claim
from .words import length_unit, short

#: Where more than this fraction of the sub-windows had their angle held, a marker is left open.
MOSTLY = 0.5
#: What such a marker says.
HELD = f"hollow: friction angle of most held at {LARGEST_FRICTION_ANGLE:g}°, no result"
#: How :func:`apart` is declared in a legend.
SHIFTED = "pressures at one $b$ are drawn side by side"
#: Why no strength is drawn.
NO_STRENGTH = "no strength: the study states no basic\nfriction angle, or no offset fits"
#: Numbers of a decade that stand at an axis whose ends are up to this factor apart.
_TICKS = ((3.0, (1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9)), (10.0, (1, 2, 3, 5, 7)), (300.0, (1, 2, 5)))
#: The frame ends at this part of the smallest mean; a bar as much shorter leaves it for certain.
_MARGIN, _OUT_OF_FRAME = 3.0, 1e-3
#: Pressures at one b are set apart by this part of b, so that their bars do not hide each other.
_APART = 0.03


def plain_decades(axis: Axis) -> None:
    """Ticks of a logarithmic axis as plain numbers: 1, 2, 5, 10 ... where it is short."""
    low, high = axis.get_view_interval()
    span = high / low if 0 < low < high else np.inf
    places = next((subs for most, subs in _TICKS if span < most), (1,))
    axis.set_major_locator(LogLocator(subs=places))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_formatter(NullFormatter())


def size_axis(axes: Axes, b: np.ndarray, of: str) -> None:
    """Logarithmic axis of the side b, mm, "of" something, in the unit that suits it."""
    axes.set_xscale("log")
    if len(b):
        axes.set_xlim(b.min() / 1.3, b.max() * 1.3)
    name, size = length_unit(b.max(initial=1.0))
    plain_decades(axes.xaxis)
    axes.xaxis.set_major_formatter(lambda value, _: f"{value / size:g}")
    axes.set_xlabel(f"side $b$ of the {of} ({name})")


def share_shown(laws: xr.Dataset, name: str) -> int:
    """Index of the smallest v/b at which all sizes have a value, else most of them."""
    known = np.isfinite(laws[name].values).all(axis=2).sum(axis=1)
    return int(np.argmax(known))


def share_words(laws: xr.Dataset, share: int) -> str:
    """A v/b in per cent."""
    return f"{short(100 * float(laws['share'][share]))} %"


def roughness_words(strength: xr.Dataset) -> str:
    """JRC of the scan, and whether the law of scale keeps it within Barton's.

    Parameters
    ----------
    strength : xr.Dataset
        Stage ``strength`` of one direction.
    """
    jrc = float(strength["jrc"].sel(sampling=JRC_SAMPLING))
    used = float(strength["jrc_used"])
    step = float(strength["step"].sel(sampling=JRC_SAMPLING))
    words = f"JRC {short(jrc)} (steps of {short(step)} mm)"
    if used != jrc:
        words += f", {short(used)} used"
    if np.isfinite(used) and np.isnan(strength["scaled_roughness"]):
        words += f", scaled to this length above Barton's {JRC_RANGE[1]:g}"
    return words


def draw_means(
    axes: Axes, b: np.ndarray, mean: np.ndarray, held: np.ndarray, colour: str, marker: str
) -> None:
    """Means over sub-windows against b; open where most of the sub-windows had their angle held."""
    draw_points(axes, b, mean, ~(held > MOSTLY), color=colour, marker=marker)


def strength_verdict(atlas: DataTree, name: str, laws: xr.Dataset, share: int) -> str:
    """A sentence on the fall of strength with size, with the numbers that can be counted.

    Parameters
    ----------
    atlas : DataTree
        With the stage ``statements``.
    name : str
        The specimen.
    laws : xr.Dataset
        Stage ``windows``.
    share : int
        Index of the v/b drawn.
    """
    held, drawn = points_held(laws, share)
    bound = f"friction angle held at {LARGEST_FRICTION_ANGLE:g} degrees at {held} of {drawn} points"
    mostly = 2 * held > drawn
    why = bound if mostly else ""
    return claim(atlas, name, "strength_falls_with_size", numbers=not mostly, why=why)


def points_held(laws: xr.Dataset, share: int) -> tuple[int, int]:
    """How many mean strengths at a v/b are hollow, being mostly held, and how many are drawn."""
    drawn = np.isfinite(laws["similar_strength"].values[share])
    hollow = drawn & (laws["similar_held"].values[share] > MOSTLY)
    return int(hollow.sum()), int(drawn.sum())


def cases_words(laws: xr.Dataset, share: int) -> str:
    """What a verdict on strength counts as cases, where it does; empty where points are counted.

    A case is a pressure at a v/b that enough sizes have.
    """
    held, drawn = points_held(laws, share)
    sizes = np.isfinite(laws["similar_strength"].transpose("share", "part", ...).values).sum(axis=1)
    judged = np.flatnonzero((sizes >= FEWEST_POINTS).any(axis=1)).tolist()
    if 2 * held > drawn or not judged:
        return ""
    places = ", ".join(share_words(laws, i) for i in judged)
    return f"cases: every pressure at $v/b$ = {places}; drawn: {share_words(laws, share)}"


def apart(b: np.ndarray, j: int, n: int) -> np.ndarray:
    """The sides b, moved a little sideways for the j-th of n series."""
    return b * (1 + _APART * (j - (n - 1) / 2))


def draw_bars(
    axes: Axes, b: np.ndarray, mean: np.ndarray, low: np.ndarray, high: np.ndarray, colour: str
) -> None:
    """Intervals of means on a logarithmic axis; one that reaches zero runs out of the frame."""
    known = np.isfinite(low) & (mean > 0)
    bottom = np.maximum(low[known], _OUT_OF_FRAME * mean[known])
    axes.vlines(b[known], bottom, high[known], color=colour, lw=0.8)


def logarithmic(axes: Axes, values: np.ndarray) -> None:
    """Logarithmic axis along y, which ends below the smallest of the positive values drawn."""
    axes.set_yscale("log")
    smallest = np.min(values, where=values > 0, initial=np.inf)
    bottom = max(axes.get_ylim()[0], smallest / _MARGIN)
    if np.isfinite(smallest):
        # With a number at or below the smallest mean.
        places = np.outer(10.0 ** np.floor(np.log10(smallest)), (1, 2, 5))
        bottom = min(bottom, 0.95 * places[places <= smallest].max())
    axes.set_ylim(bottom=bottom)
    plain_decades(axes.yaxis)


def along_size(laws: xr.Dataset, name: str, index: tuple[int, ...]) -> list[np.ndarray]:
    """Mean, low and high of a quantity along b, at an index of its other dimensions."""
    size = "scale" if "scale" in laws[name].dims else "part"
    return list(Estimate.read(laws.transpose(size, ...), name)[(slice(None), *index)].ends)


def interval_text(laws: xr.Dataset, name: str, index: int | tuple[int, ...] = ()) -> str:
    """A fitted number with its interval, at an index."""
    return Estimate.read(laws, name, scale=EXPONENT)[index].text()
