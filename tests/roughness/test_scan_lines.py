"""Alternate scan lines: found with their size where they exceed the noise, nowhere else."""

import numpy as np
import pytest

from fractalcontact.roughness.quality import scan_quality
from fractalcontact.roughness.scan_lines import STRETCH, line_alternation
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine
from fractalcontact.surface.window import WindowRequest

N = 96
SIGN = (-1.0) ** np.arange(N)


def rough(seed=1, hurst=0.8, n=N):
    return self_affine((n, n), 0.1, hurst, rms=0.1, seed=seed)


@pytest.mark.parametrize("shape", [(STRETCH, STRETCH), (40, 200), (1, 64)])
def test_the_difference_of_alternating_levels_is_exact(shape):
    levels = np.tile(0.25 * (-1.0) ** np.arange(shape[1]), (shape[0], 1))
    difference, noise = line_alternation(levels)
    assert difference == pytest.approx(0.5, rel=1e-12)
    assert noise < 1e-12
    assert np.isnan(line_alternation(levels.T)[0])


def test_noise_is_that_of_independent_heights():
    z = np.random.default_rng(0).normal(scale=0.3, size=(400, 400))
    difference, noise = line_alternation(z)
    assert np.isnan(difference)
    assert noise == pytest.approx(0.3, rel=0.02)


@pytest.mark.parametrize("hurst", [0.3, 0.8])
@pytest.mark.parametrize("times", [2.0, 5.0])
def test_alternating_columns_of_a_rough_surface_are_measured(hurst, times):
    z = rough(hurst=hurst)
    _, noise = line_alternation(z)
    difference, beside = line_alternation(z + times * noise / 2 * SIGN)
    assert difference == pytest.approx(times * noise, rel=0.05)
    assert beside == pytest.approx(noise, rel=1e-9)  # it has no part in what stands beside it


def test_noise_has_no_part_in_the_difference_of_alternate_lines():
    """On independent heights their squares add, whichever of the two is larger."""
    z = np.random.default_rng(0).normal(scale=0.3, size=(400, 400))
    for difference in (0.3, 1.0):
        found, noise = line_alternation(z + difference / 2 * (-1.0) ** np.arange(400))
        assert found == pytest.approx(difference, rel=0.03)
        assert noise == pytest.approx(0.3, rel=0.02)


def test_lines_sheared_to_and_fro_are_found():
    """Every other row shifted along itself: its heights differ by the slope times the shift."""
    z = rough(hurst=0.9)
    z[1::2, :-3] = z[1::2, 3:]
    difference, noise = line_alternation(z.T)
    assert difference > noise


@pytest.mark.parametrize("seed", range(8))
def test_rough_surfaces_and_lines_shifted_at_random_do_not_alternate(seed):
    rng = np.random.default_rng(seed)
    for hurst in (0.2, 0.8):
        z = rough(seed, hurst)
        shifted = z + 0.02 * rng.normal(size=N)
        stretched = z + rng.normal(size=(N, 1))
        for heights in (z, z.T, shifted, shifted.T, stretched, np.round(z, 2)):
            assert np.isnan(line_alternation(heights)[0])


def test_holes_are_left_out_and_too_little_says_nothing():
    z = rough() + 0.05 * SIGN
    z[::3, ::20] = np.nan  # every third row is in pieces
    assert line_alternation(z)[0] == pytest.approx(0.1, rel=0.1)
    assert np.isnan(line_alternation(z[:, : STRETCH - 1])).all()
    assert np.isnan(line_alternation(np.full((40, 40), np.nan))).all()


@pytest.mark.parametrize(
    ("lines", "axis", "named"), [("columns", "x", SIGN), ("rows", "y", SIGN[:, np.newaxis])]
)
def test_the_quality_of_a_scan_holds_and_names_them(lines, axis, named):
    import xarray as xr

    z = rough() + 0.05 * named
    place = 0.1 * np.arange(N)
    scan = xr.DataArray(
        z,
        dims=("y", "x"),
        coords={"y": place, "x": place},
        attrs={"spacing_x": 0.1, "spacing_y": 0.1},
    )
    specimen = make_specimen(scan, **vars(WindowRequest()))
    quality = scan_quality(specimen, [1])
    found = quality["alternation"].sel(face="lower")
    assert found.sel(axis=axis).item() == pytest.approx(0.1, rel=0.1)
    assert int(found.notnull().sum()) == 1
    assert found.attrs["units"] == "mm"
    assert f"alternate {lines} of the lower face differ by" in quality.attrs["warning"]
    sound = scan_quality(make_specimen(scan.copy(data=rough()), **vars(WindowRequest())), [1])
    assert "alternate" not in sound.attrs["warning"]
