"""Alternation of scan lines: every other column or row of a line scanner shifted or sheared.

A scanner that measures to and fro has two kinds of line. If they disagree, a spectrum across the
lines has a peak at its shortest wave of two spacings, which no rough surface has.
"""

import math

import numpy as np
import xarray as xr
from scipy import stats

from ..core.text import length_words
from .quality_words import AXES

#: Nodes of a stretch across the lines; even, so that all begin with the same kind.
STRETCH = 32
#: Orders with which the power of the alternation is compared: lower by three or more, as the taper
#: smears it over the next two.
_BESIDE = range(STRETCH // 2 - 6, STRETCH // 2 - 2)
#: Probability of an alternation by chance where lines are shifted at random, each as a whole.
_BY_CHANCE = 1e-4


def line_alternation(heights: np.ndarray) -> tuple[float, float]:
    """Difference of alternate columns, and the noise, mm, of heights (ny, nx) in mm.

    The difference is the root mean square one of neighbouring columns that alternation makes: twice
    its amplitude. It is NaN where chance may make it, or no stretch of `STRETCH` nodes is complete.
    The noise is the standard deviation of independent heights with the power of the waves next to
    it.

    Stretches are tapered (Hann). Their power at order n/2, less that at the neighbouring orders, is
    the square of the amplitude; the spectrum of a rough surface falls there, so that it is not
    overestimated. Columns that are shifted at random are alike in all rows, so that only stretches
    count: the ratio of the powers must exceed the quantile of F with one degree of freedom for each
    and two for each neighbouring order.
    """
    ny, nx = heights.shape
    count = nx // STRETCH
    if count == 0:
        return math.nan, math.nan
    parts = heights[:, : count * STRETCH].reshape(ny, count, STRETCH)
    complete = np.isfinite(parts).all(axis=2)
    stretches = int(complete.any(axis=0).sum())
    if stretches == 0:
        return math.nan, math.nan
    chosen = parts[complete]
    chosen = chosen - chosen.mean(axis=1, keepdims=True)
    taper = np.hanning(STRETCH + 1)[:-1]
    power = np.mean(np.abs(np.fft.rfft(chosen * taper, axis=1)) ** 2, axis=0)
    neighbours = float(power[list(_BESIDE)].mean())
    alternating = float(power[-1])
    noise = math.sqrt(neighbours / np.sum(taper**2))
    freedom = (stretches, 2 * len(_BESIDE) * stretches)
    if not alternating > stats.f.isf(_BY_CHANCE, *freedom) * neighbours:
        return math.nan, noise
    return 2 * math.sqrt(alternating - neighbours) / float(taper.sum()), noise


#: Variables of the quality of a scan: dimensions, unit, long name.
ALTERNATION = {
    "alternation": (
        ("face", "axis"),
        "mm",
        "difference between neighbouring scan lines along the axis; missing if none is seen",
    ),
    "alternation_noise": (("face", "axis"), "mm", "noise of the nodes beside that difference"),
}


def alternations(heights: list[np.ndarray]) -> dict[str, np.ndarray]:
    """Values of `ALTERNATION` for the faces of a scan, along x and along y."""
    differences = np.array([[line_alternation(z), line_alternation(z.T)] for z in heights])
    return dict(zip(ALTERNATION, np.moveaxis(differences, -1, 0), strict=True))


def scan_line_warnings(quality: xr.Dataset) -> list[str]:
    """Alternations that exceed the noise, a sentence each."""
    sentences = []
    for face in quality["face"].values:
        for axis, line in zip(AXES, ("columns", "rows"), strict=True):
            of_axis = quality.sel(face=face, axis=axis)
            difference, noise = of_axis["alternation"].item(), of_axis["alternation_noise"].item()
            if difference > noise:
                sentences.append(
                    f"alternate {line} of the {face} face differ by {length_words(difference)}, "
                    f"more than the noise of {length_words(noise)}: the two scan directions of "
                    "the instrument disagree; correct this in the instrument's program"
                )
    return sentences
