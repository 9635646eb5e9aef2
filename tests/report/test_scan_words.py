"""Sentences on a specimen as the check of scans makes it, and as an atlas gives it back."""

import numpy as np
import xarray as xr

from fractalcontact.report.scan_words import warnings_of_specimen

QUALITY = xr.Dataset(attrs={"warning": ""})


def test_outliers_are_told_alike_of_a_specimen_and_of_its_atlas():
    heights = np.zeros((6, 6))
    heights[2, 3], heights[4, 1] = 5.0, 1.0
    outlier = heights > 2
    attrs = {"tilt_degrees": 0.0, "opposite": "match", "outliers": "keep", "name": "rock"}
    words = []
    for count, cells in ((1, outlier), (np.int64(1), outlier.astype(np.int8))):
        specimen = xr.Dataset(
            {"lower": (("y", "x"), heights), "outlier": (("y", "x"), cells)},
            attrs=attrs | {"outlier_count": count},
        )
        words += warnings_of_specimen(specimen, QUALITY)
    assert words[0] == words[1]
    assert words[0].startswith("1 outlier kept, up to 5 mm from the mean plane where the relief")
