"""Stages of one joint scanned with square cells, and with cells twice as wide or twice as tall.

The faces are smooth, so that every scan resolves them: what is measured in mm, MPa and N is then
the same. Where a spacing is taken for the other one, numbers change by a factor of about two.
"""

from functools import cache

import numpy as np
import pytest
import xarray as xr
from made_stages import stages_of
from materials import ROCK
from scipy import ndimage
from unchecked_settings import resolve_unchecked

from fractalcontact.study.configuration import solver_settings

#: Spacing of the surface that is scanned, mm, and the cells of it that one of a scan is long.
FINEST, SQUARE, OBLONG = 0.05, (2, 2), {"wide": (2, 4), "tall": (4, 2)}
#: Largest difference of a number, relative to its largest value under any load.
CLOSE = 0.2
_WAYS = ("along", "across")
_CUBED = ("transmissivity", "hydraulic_aperture", "critical_gap", "channel_fraction")
_FURTHER = ("branch_transmissivity", "offset_transmissivity", "unloaded_transmissivity")
#: Numbers that every scan resolves, by stage.
RESOLVED = {
    "joints": ("plateau_level",),
    "quality": ("rms", "skewness", "kurtosis", "height", "overlap_depth", "gap_mean", "gap_sd"),
    "closure": (
        *("closure", "interface_closure", "area_corrected", "perimeter", "mean_gap"),
        *("gap_deviation", "interface_stiffness", "conductance", "rigid_opening", "separation"),
    ),
    "dilatancy": ("elastic_dilatancy", "separation"),
    "area": ("rms_slope", "m0", "m2", "persson_share"),
    "scaling": ("sigma_n", "area_corrected"),
    "branches": ("interface_closure", "interface_stiffness", "area", "recovered_energy"),
    "flow": (
        *(f"{name}_{way}" for name in (*_CUBED, "reynolds_gradient", *_FURTHER) for way in _WAYS),
        *("gap_slope", "gap_quantile", "zimmerman_aperture", "offset_mean_gap"),
    ),
    "strength": (
        *("jrc_used", "grasselli_theta_max", "grasselli_roughness", "dilatancy_angle"),
        *("rigid_dilatancy_angle", "peak_strength", "shear_strength", "residual_strength"),
        "contact_strength",
    ),
    "windows": ("direct_strength",),
    "elastic_model": ("pressure",),
    "comparison": ("stiffness", "dilatancy"),
}


def smooth(seed):
    """Surface of 8 x 8 mm with waves of about 1 mm along y and 1.5 mm along x, of rms 1."""
    noise = np.random.default_rng(seed).normal(size=(160, 160))
    heights = ndimage.gaussian_filter(noise, (5, 8), mode="wrap")
    return heights / heights.std()


def face(heights, steps):
    """Every so many cells of a surface, as a scan."""
    places = tuple(slice(step // 2, None, step) for step in steps)
    values, spacing = heights[places], [FINEST * step for step in steps]
    coords = [
        (axis, side * (np.arange(n) + 0.5), {"units": "mm"})
        for axis, side, n in zip("yx", spacing, values.shape, strict=True)
    ]
    attrs = {"spacing_y": spacing[0], "spacing_x": spacing[1], "source": "made"}
    return xr.DataArray(values, dims=("y", "x"), coords=coords, attrs=attrs)


@cache
def stages(steps):
    """Stages of the joint scanned with such cells."""
    lower = 0.15 * smooth(1)
    faces = [face(z, steps) for z in (lower, lower + 0.03 * smooth(2) + 0.02)]
    study = {
        "study": "oblong",
        "materials": {"rock": ROCK},
        "defaults": {
            **{"material": "rock", "directions": ["N"], "contact_directions": ["N"]},
            **{"loads": ["1 MPa", "5 MPa", "20 MPa", "60 MPa"], "seating_pressure": "1 MPa"},
            **{"offsets": ["0 mm", "0.4 mm", "0.8 mm"], "window": ["5.6 mm", "6.4 mm"]},
            "resolutions": [1, 2],
        },
    }
    settings = resolve_unchecked(study, "joint", {}, "oblong")
    return stages_of("joint", faces, settings, solver_settings({}, "oblong"))


@pytest.mark.parametrize("cells", OBLONG)
@pytest.mark.parametrize("stage", RESOLVED)
def test_oblong_cells_give_the_numbers_of_square_ones(stage, cells):
    square, oblong = stages(SQUARE)[stage], stages(OBLONG[cells])[stage]
    different = {}
    for name in RESOLVED[stage]:
        expected, found = (one[name].values.astype(float) for one in (square, oblong))
        both = np.isfinite(expected) & np.isfinite(found)
        assert both.any(), name
        apart = np.abs(found - expected)[both].max() / np.abs(expected[both]).max()
        if apart > CLOSE:
            different[name] = apart
    assert not different
