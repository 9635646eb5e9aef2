"""Gap of two faces as scanned and registered: its distribution, and the cells that overlap."""

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.window import window_slices
from ..surface.suspect import overlap_statistics

#: Bins of the distribution of the gap.
GAP_BINS = 60
#: Parts of a scan for which the overlap is stated.
REGIONS = ("scan", "window")

_OVERLAP = {
    "overlap_cells": ("region", "1", "cells where the upper face lies below the lower one"),
    "overlap_fraction": ("region", "1", "fraction of the cells of both faces that overlap"),
    "overlap_depth": ("region", "mm", "deepest overlap of the faces as scanned and registered"),
    "gap_mean": ("region", "mm", "mean gap of the faces as scanned and registered"),
    "gap_sd": ("region", "mm", "standard deviation of that gap"),
}


def _overlap(specimen):
    statistics = overlap_statistics(specimen, window_slices(specimen))
    keys = ("cells", "fraction", "depth", "gap_mean", "gap_sd")
    return labelled(
        _OVERLAP, {name: list(statistics[key]) for name, key in zip(_OVERLAP, keys, strict=True)}
    )


_GAPS = {
    "gap_edge": ("gap_edge", "mm", "edges of the bins of the gap, one of them at zero"),
    "gap": ("gap_bin", "mm", "middle of the bin of the gap"),
    "gap_cells": ("gap_bin", "1", "cells whose gap lies in the bin"),
}


def _gap_histogram(specimen):
    """Cells in bins of the gap over the whole scan."""
    gap = (specimen["upper"] - specimen["lower"]).values
    measured = gap[np.isfinite(gap)]
    low, high = (measured.min(), measured.max()) if measured.size else (0.0, 0.0)
    width = ((high - low) or 1.0) / GAP_BINS
    first, last = np.floor(low / width), np.ceil(high / width)
    edges = width * np.arange(first, max(last, first + 1) + 1)
    middles, counts = (edges[1:] + edges[:-1]) / 2, np.histogram(measured, edges)[0]
    return labelled(_GAPS, {"gap_edge": edges, "gap": middles, "gap_cells": counts})


def gap_statistics(specimen: xr.Dataset) -> dict[str, tuple]:
    """Overlap and gap of two faces by region of the scan, and the gap's distribution over the scan.

    Variables for ``xr.Dataset``, of a specimen from :func:`surface.specimen.make_specimen`.
    """
    return _overlap(specimen) | _gap_histogram(specimen)
