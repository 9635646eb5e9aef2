"""Quality of a scan: statistics, spectra, steps and warnings."""

import json

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from fractalcontact.roughness.quality import height_step, scan_quality
from fractalcontact.roughness.quality_words import noise_words, range_words
from fractalcontact.roughness.spectra import FIRST_ORDER, radial_spectrum
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1


def scan(heights, spacing=(SPACING, SPACING), **attrs):
    coordinates = [d * (np.arange(n) + 0.5) for d, n in zip(spacing, heights.shape, strict=True)]
    sizes = {"spacing_y": spacing[0], "spacing_x": spacing[1]}
    attrs = {"source": "made", "sha256": "0" * 64} | sizes | attrs
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


def rough(n=128, hurst=0.8, seed=1):
    return self_affine((n, n), SPACING, hurst, rms=0.3, seed=seed)


def white(shape, seed=5):
    return np.random.default_rng(seed).normal(size=shape)


def quality(lower, upper=None, resolutions=(1, 2, 4)):
    return scan_quality(make_specimen(lower, upper), resolutions)


@pytest.fixture(scope="module")
def clean():
    return quality(scan(rough()))


@pytest.fixture(scope="module")
def noisy():
    return quality(scan(rough(256) + 0.05 * white((256, 256))), resolutions=[1, 2, 8])


# --- exact ---------------------------------------------------------------------------------------


def test_statistics_are_those_of_scipy_over_the_cells_measured():
    z = rough() ** 3
    z[:20, 30:70] = np.nan
    specimen = make_specimen(scan(z))
    found = scan_quality(specimen, [1]).sel(face="lower")
    known = specimen["lower"].values[np.isfinite(z)]
    assert found["missing_share"] == pytest.approx(800 / z.size)
    assert found["rms"] == pytest.approx(known.std())
    assert found["skewness"] == pytest.approx(stats.skew(known))
    assert found["kurtosis"] == pytest.approx(stats.kurtosis(known, fisher=False))
    assert found["lowest"] == known.min()
    assert found["height"].isel(percentile=4).item() == pytest.approx(np.median(known))


def test_the_histogram_holds_all_cells_but_the_tails(clean):
    total = np.sum(clean["density"].values[0] * np.diff(clean["edge"].values))
    assert total == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize("spacing", [(0.1, 0.1), (0.1, 0.25)])
def test_the_radial_spectrum_of_white_noise_is_its_variance_times_the_cell(spacing):
    _, density = radial_spectrum(0.02 * white((128, 128)), spacing)
    assert np.mean(density[: len(density) // 2]) == pytest.approx(
        0.02**2 * spacing[0] * spacing[1], rel=0.05
    )


@pytest.mark.parametrize("spacing", [(0.1, 0.25), (0.25, 0.1)])
def test_the_radial_spectrum_has_waves_that_every_direction_has(spacing):
    wavelength, _ = radial_spectrum(white((128, 128)), spacing)
    assert wavelength.min() > 2 * max(spacing)  # two of the longer sides of a cell
    assert wavelength.max() <= 128 * min(spacing) / FIRST_ORDER


def test_the_radial_spectrum_of_a_self_affine_surface_falls_as_it_should():
    wavelength, density = radial_spectrum(rough(256, 0.7), (SPACING, SPACING))
    slope = np.polyfit(np.log(wavelength), np.log(density), 1)[0]
    assert slope == pytest.approx(2 + 2 * 0.7, abs=0.15)


def test_the_radial_spectrum_sees_no_hole():
    z = rough()
    z[10:20, 10:20] = np.nan
    _, density = radial_spectrum(z, (SPACING, SPACING))
    assert density.size > 8
    assert np.isfinite(density).all()


# --- steps ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("offset", [0.0, 100.0])
def test_the_step_of_a_converter_is_found(offset):
    step = 0.0123
    z = step * np.round(rough() / step) + offset
    z[3, 4] = np.nan
    assert height_step(z) == pytest.approx(step, rel=1e-6)


def test_a_step_is_found_in_what_levelling_took_the_plane_off():
    step = 0.01
    tilted = rough(31) + 0.05 * SPACING * np.arange(31)  # too few nodes for a spectrum
    found = quality(scan(step * np.round(tilted / step) + 7))
    assert found["height_step"].item() == pytest.approx(step, rel=1e-6)
    assert "multiples of 10 µm" in range_words(found, "lower")


def test_single_precision_far_from_zero_has_a_step():
    z = (rough() + 1e5).astype(np.float32).astype(float)
    assert height_step(z) == pytest.approx(2.0**-7, rel=1e-6)


@pytest.mark.parametrize("z", [rough(), np.round(rough(), 9), rough().astype(np.float32)])
def test_free_heights_have_no_step(z):
    assert np.isnan(height_step(z))


# --- noise, warnings -----------------------------------------------------------------------------


def test_a_clean_scan_has_no_warning(clean):
    assert clean.attrs["warning"] == ""
    assert not clean["below_range"].any()
    assert noise_words(clean, "lower").count("none seen") == 2


def test_resolutions_below_the_noise_floor_are_named_with_their_wavelength(noisy):
    end = noisy["range_end"].item()
    assert 4 * SPACING < end < 16 * SPACING
    assert noisy["below_range"].values.tolist() == [True, True, False]
    warning = noisy.attrs["warning"]
    assert warning.startswith("spacings of 0.1, 0.2 mm are finer than the scan resolves")
    assert "waves, 0.2, 0.4 mm," in warning
    assert "noise floor along" in warning


def test_the_worse_face_decides():
    lower, upper = rough(256), rough(256) + 0.05 * white((256, 256))
    found = quality(scan(lower), scan(upper + 0.2))
    assert found["noise_rms"].sel(face="lower").isnull().all()
    np.testing.assert_allclose(found["noise_rms"].sel(face="upper"), 0.05, rtol=0.1)
    assert "upper face" in found.attrs["ended_by"]


def test_the_distribution_of_the_gap_holds_all_cells_and_parts_those_that_overlap():
    lower, upper = rough(64), rough(64, seed=2) + 0.2
    upper[:9] = np.nan
    specimen = make_specimen(scan(lower), scan(upper))
    found = scan_quality(specimen, [1])
    gap = (specimen["upper"] - specimen["lower"]).values
    assert found["gap_cells"].sum() == np.isfinite(gap).sum()
    assert 0.0 in found["gap_edge"]
    overlapping = found["gap_cells"].where(found["gap"] < 0, 0).sum()
    assert overlapping == (gap < 0).sum() > 0


def test_noise_floors_are_levels_of_the_spectra_of_white_noise(noisy):
    noise = noisy["noise_rms"].sel(face="lower")
    np.testing.assert_allclose(noisy["noise_floor"].sel(face="lower"), noise**2 * SPACING)
    radial = noisy["radial_noise_floor"].sel(face="lower")
    assert radial == pytest.approx(float(noise.min()) ** 2 * SPACING**2)


def test_scan_lines_are_separated_from_isotropic_noise(noisy):
    found = quality(scan(rough(256) + 0.1 * white((256, 1))))
    assert "more along y: scan lines along x are shifted" in noise_words(found, "lower")
    assert "scan lines" not in noise_words(noisy, "lower")


def test_a_grid_finer_than_its_points_shows_no_shorter_waves():
    found = quality(scan(rough(), points=128 * 128 // 9), resolutions=[1, 4])
    assert found["point_pitch"].item() == pytest.approx(3 * SPACING, rel=0.01)
    assert found["range_end"].item() == pytest.approx(6 * SPACING, rel=0.01)
    assert found["below_range"].values.tolist() == [True, False]
    assert "distance of the points" in found.attrs["ended_by"]


def test_a_scan_too_small_for_a_spectrum_says_so():
    found = quality(scan(rough(16)))
    assert np.isnan(found["range_end"])
    assert found.attrs["warning"] == ""
    assert "too small for a spectrum" in noise_words(found, "lower")


def test_the_window_and_the_mask_of_the_specimen_stay_as_they_are():
    specimen = make_specimen(scan(rough()))
    before = specimen.copy(deep=True)
    scan_quality(specimen, [1])
    xr.testing.assert_identical(specimen, before)
    assert json.loads(specimen.attrs["lower_scan"])["source"] == "made"
