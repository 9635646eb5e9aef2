"""Axes, interval bars and exponents shared by the figures of strength and size."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from ...core.estimate import Estimate
from ...core.limits import JRC_RANGE, JRC_SAMPLING, LARGEST_FRICTION_ANGLE
from ...core.text import compact, length_unit, number
from ...core.verdicts import OFF_LENGTHS
from .drawing import MARKERS, colour_of
from .points import draw_points

#: Legend of means whose friction angle is truncated in most sub-windows.
TRUNCATED = f"hollow: a lower bound, most angles truncated at {compact(LARGEST_FRICTION_ANGLE, 6)}°"
#: Words on bars and places for the legends of :func:`draw_over_size`.
BARS = "bars: 95 % intervals; the whole window has none"
SHIFTED = "pressures at one $b$ are drawn side by side"
#: Words of a panel without strength.
NO_STRENGTH = "no strength: the study states no basic\nfriction angle, or no offset fits"
#: Largest ratio of the ends of an axis, and the digits at which a decade is numbered up to it.
_TICKS = ((3.0, (1, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9)), (10.0, (1, 2, 3, 5, 7)), (300.0, (1, 2, 5)))
#: The frame ends at the smallest mean over the first; the second, a fraction, lies below it.
_MARGIN, _OUT_OF_FRAME = 3.0, 1e-3


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
    axes.xaxis.set_major_formatter(lambda value, _: compact(value / size, 6))
    axes.set_xlabel(f"side $b$ of the {of} ({name})")


def roughness_words(strength: xr.Dataset) -> str:
    """JRC of the scan in words, and whether Barton's law of scale keeps it within its range.

    `strength` is the stage of one direction.
    """
    jrc = float(strength["jrc"].sel(sampling=JRC_SAMPLING))
    used = float(strength["jrc_used"])
    step = float(strength["step"].sel(sampling=JRC_SAMPLING))
    words = f"JRC is {compact(jrc)} (steps of {compact(step)} mm)"
    if used != jrc:
        words += f", {compact(used)} used"
    if np.isfinite(used) and np.isnan(strength["scaled_roughness"]):
        words += (
            "; this length lies off his law of scale"
            if strength["barton_scaled_reason"] == OFF_LENGTHS
            else f"; scaled to this length it exceeds {compact(JRC_RANGE[1], 6)}, the largest of "
            "his law"
        )
    return words


def draw_over_size(
    axes: Axes,
    laws: xr.Dataset,
    name: str,
    *,
    filled: xr.DataArray | None = None,
    apart: float = 0.03,
) -> None:
    """Means over sub-windows against b with their intervals, side by side for the pressures.

    `laws` goes over ``part`` and ``normal_force``, as does `filled`, which is True for results (all
    without it). Neighbouring pressures stand the fraction `apart` of b from each other.
    """
    b, loads = laws["side"].values, laws.sizes["normal_force"]
    for j in range(loads):
        one = laws.isel(normal_force=j)
        places = b * (1 + apart * (j - (loads - 1) / 2))
        means = Estimate.read(one, name)
        trusted = np.ones(b.shape, bool) if filled is None else filled.isel(normal_force=j)
        draw_points(axes, places, means.value, trusted, **series(j))
        draw_bars(axes, places, *means.ends, colour_of(j + 1))


def series(j: int) -> dict[str, Any]:
    """Colour and marker of the j-th pressure."""
    return {"color": colour_of(j + 1), "marker": MARKERS[j % len(MARKERS)]}


def name_exponents(axes: Axes, laws: xr.Dataset, name: str, of: str) -> None:
    """Legend entries with the power of b of a quantity ``of`` under each pressure."""
    truncated = (laws["truncated_fraction_at_equal_v_over_b"] > 0).any("part").values & (
        "strength" in name
    )
    exponents = Estimate.read(laws, name)
    for j, pressure in enumerate(laws["nominal_pressure"].values):
        # An undetermined exponent is given too: its interval shows the sign in the caption.
        missing = "no fit (truncated)" if truncated[j] else "no fit"
        words = f" = {number(exponents[j])}" if exponents[j].known else f": {missing}"
        if np.isneginf(exponents[j].low):
            words = f" below {number(exponents[j].high)}"
        label = rf"$\sigma_0$ = {compact(pressure)} MPa: ${of}\sim b^x$, $x${words}"
        axes.plot([], [], ls="none", label=label, **series(j))


def draw_bars(
    axes: Axes, b: np.ndarray, mean: np.ndarray, low: np.ndarray, high: np.ndarray, colour: str
) -> None:
    """Intervals of means over b (n,), mm, on a logarithmic axis; NaN has none.

    An interval that includes zero ends below the frame.
    """
    finite = np.isfinite(low) & (mean > 0)
    bottom = np.maximum(low[finite], _OUT_OF_FRAME * mean[finite])
    axes.vlines(b[finite], bottom, high[finite], color=colour, lw=0.8)


def logarithmic(axes: Axes, values: np.ndarray) -> None:
    """Logarithmic axis along y, which ends below the smallest of the positive values drawn."""
    axes.set_yscale("log")
    smallest = np.min(values, where=values > 0, initial=np.inf)
    bottom = max(axes.get_ylim()[0], smallest / _MARGIN)
    if np.isfinite(smallest):
        # The axis needs a number at or below the smallest mean.
        places = np.outer(10.0 ** np.floor(np.log10(smallest)), (1, 2, 5))
        bottom = min(bottom, 0.95 * places[places <= smallest].max())
    axes.set_ylim(bottom=bottom)
    plain_decades(axes.yaxis)
