import numpy as np
import pytest
from places import SCANS

from fractalcontact.roughness.curves import BLOCKS
from fractalcontact.roughness.estimators.cube_counting import cube_counting_curves
from fractalcontact.roughness.estimators.power_spectrum import power_spectrum_curves
from fractalcontact.roughness.estimators.roughness_length import roughness_length_curves
from fractalcontact.roughness.estimators.second_differences import second_difference_curves
from fractalcontact.roughness.estimators.slit_islands import _islands, slit_island_curves
from fractalcontact.roughness.estimators.triangular_prism import triangular_prism_curves
from fractalcontact.roughness.estimators.variogram import variogram_curves
from fractalcontact.roughness.known_bias import slopes
from fractalcontact.roughness.registry import ESTIMATORS
from fractalcontact.surface.synthesis import disc_outline, self_affine


@pytest.fixture(scope="module")
def surface():
    return self_affine((96, 128), 0.1, 0.7, rms=0.3, seed=3)


def both(curves, heights, spacing=1.0):
    """Length and measure, both axes together."""
    curve = curves(heights, spacing)["both"]
    return curve.length, curve.measure()


# -- exact -----------------------------------------------------------------------------------------


def test_variogram_and_second_differences_of_a_corrugation():
    period, lag = 16, 4
    z = np.tile(np.sin(2 * np.pi * np.arange(256) / period), (256, 1))
    first, second = (f(z, 1.0) for f in (variogram_curves, second_difference_curves))
    along = {axis: dict(zip(c.length, c.measure(), strict=True)) for axis, c in first.items()}
    # <(z(x+h) - z(x))^2> = 2 sin^2(pi h / l) for a unit sine, on x; nothing on y: half of it.
    assert along["x"][lag] == pytest.approx(2 * np.sin(np.pi * lag / period) ** 2, rel=1e-2)
    assert along["y"][lag] == 0
    assert along["both"][lag] == pytest.approx(np.sin(np.pi * lag / period) ** 2, rel=1e-2)
    found = dict(zip(second["both"].length, second["both"].measure(), strict=True))[lag]
    assert found == pytest.approx(4 * np.sin(np.pi * lag / period) ** 4, rel=1e-2)


def test_profile_spectrum_holds_the_variance_and_peaks_at_the_wave():
    wave = np.tile(np.sin(2 * np.pi * np.arange(256) / 16), (256, 1))
    wavelength, density = both(power_spectrum_curves, wave, 0.5)
    assert wavelength[np.argmax(density)] == pytest.approx(8.0, rel=0.1)


def test_white_noise_is_flat_in_the_spectrum_and_level_in_windows():
    noise = np.random.default_rng(0).standard_normal((256, 256))
    _, density = both(power_spectrum_curves, noise, 0.5)
    np.testing.assert_allclose(density, 0.5, rtol=0.15)  # <z^2> times the spacing
    _, square = both(roughness_length_curves, noise, 0.5)
    np.testing.assert_allclose(square, 1, rtol=0.04)  # at short windows too: degrees of freedom


def test_pieces_of_random_walks_about_their_lines():
    steps = np.random.default_rng(0).standard_normal((400, 1024))
    curve = roughness_length_curves(np.cumsum(steps, axis=1), 1.0)["x"]
    n = curve.length
    # Exact for unit steps: n/15 - 4/(15 n).
    short = n < 64
    expected = (n - 4 / n)[short] / 15
    np.testing.assert_allclose(curve.measure()[short], expected, rtol=0.03)


def test_prism_facets_of_a_plane_have_its_slope():
    y, x = np.indices((64, 64), dtype=float)
    _, slope = both(triangular_prism_curves, 0.3 * x + 0.4 * y, 1.0)
    np.testing.assert_allclose(slope, 0.5)


def test_columns_of_a_plane_rise_by_their_side():
    y, x = np.indices((65, 65), dtype=float)
    side, rise = both(cube_counting_curves, 0.3 * x + 0.4 * y, 1.0)
    np.testing.assert_allclose(rise, 0.7 * side)


def test_square_islands_on_a_plain():
    # Squares of 4 x 4 and 12 x 12: perimeter over root of area is 4 whatever their size.
    heights = np.zeros((100, 100))
    heights[10:14, 10:14] = heights[30:42, 30:42] = 1.0
    heights[60:72, 60:72] = 1.0
    curve = slit_island_curves(heights + 1e-9 * np.indices(heights.shape).sum(axis=0), 1.0)["both"]
    near = [np.argmin(np.abs(curve.length - side)) for side in (4, 12)]
    np.testing.assert_allclose(curve.measure()[near], 4.0)


# -- independent -----------------------------------------------------------------------------------


def test_differences_are_those_of_numpy(surface):
    for name, difference, lags in (
        ("variogram", lambda z, h: z[:, h:] - z[:, :-h], (1, 3, 10)),
        (
            "second_differences",
            lambda z, h: z[:, 2 * h :] - 2 * z[:, h:-h] + z[:, : -2 * h],
            (1, 3, 10),
        ),
    ):
        curves = ESTIMATORS[name].curves(surface, 1.0)
        for axis, z in (("x", surface), ("y", surface.T)):
            found = dict(zip(curves[axis].length, curves[axis].measure(), strict=True))
            for lag in {h for h in lags if h in found}:
                expected = np.mean(difference(z, lag) ** 2)
                assert found[lag] == pytest.approx(expected, rel=1e-12), (name, axis, lag)


def test_islands_are_those_counted_by_hand():
    heights = np.zeros((8, 8))
    heights[1:4, 1:4] = heights[2, 6] = heights[6, 2] = heights[6, 7] = 1.0
    heights[2, 2] = 0.0
    known = np.ones(heights.shape, bool)
    known[7, 2] = False
    area, perimeter, block = _islands(heights, known, 0.5)
    # A ring (12 sides outside, 4 inside), its lake, and an islet; of two more islets one touches
    # the rim and one a missing cell, as does the sea.
    found = sorted(zip(area, perimeter, block, strict=True))
    assert found == [(1, 4, 1 * BLOCKS + 1), (1, 4, 1 * BLOCKS + 3), (8, 16, 1 * BLOCKS + 1)]


# -- properties ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ESTIMATORS)
def test_parts_are_the_whole(surface, name):
    for curve in ESTIMATORS[name].curves(surface, 0.1).values():
        left_out = curve.without_each_part()
        assert left_out.shape[0] <= BLOCKS**2
        weight = curve.weight[:, curve.weight.any(axis=0)]
        # Means over all parts but one, weighted with what is left, have the mean of all.
        left = weight.sum(axis=1) - weight.T
        known = np.isfinite(left_out)
        total = np.sum(np.where(known, left_out, 0) * left, axis=0)
        whole = np.sum(weight, axis=1) * (weight.shape[1] - 1)
        held = whole > 0
        np.testing.assert_allclose(total[held] / whole[held], curve.measure()[held], rtol=1e-9)


@pytest.mark.parametrize("name", ESTIMATORS)
def test_turned_surfaces_have_turned_curves(surface, name):
    curves = ESTIMATORS[name].curves(surface, 0.1)
    turned = ESTIMATORS[name].curves(surface.T, 0.1)
    for axis, other in {"both": "both", "x": "y", "y": "x"}.items():
        if axis in curves:
            np.testing.assert_allclose(
                curves[axis].measure(), turned[other].measure(), rtol=1e-9, equal_nan=True
            )
            one, there = curves[axis].total, turned[other].total
            if one.shape[1] == BLOCKS**2:  # part by part; strips of profiles are parts of one axis
                there = there.reshape(-1, BLOCKS, BLOCKS).swapaxes(1, 2).reshape(one.shape)
                np.testing.assert_allclose(there, one, rtol=1e-9, atol=1e-12 * one.max())


@pytest.mark.parametrize("name", ESTIMATORS)
def test_missing_cells_change_the_curves_little(name):
    surface = self_affine((192, 192), 0.1, 0.7, rms=0.3, seed=3)
    disc = np.where(disc_outline(surface.shape, 0.1, 19.0), surface, np.nan)
    disc[np.random.default_rng(0).random(disc.shape) < 1e-3] = np.nan
    whole, cut = (ESTIMATORS[name].curves(z, 0.1)["both"] for z in (surface, disc))
    shared = np.interp(cut.length, whole.length, whole.measure())
    middle = (cut.length > 0.4) & (cut.length < 2.4) & np.isfinite(cut.measure() + shared)
    assert middle.sum() >= 3
    np.testing.assert_allclose(cut.measure()[middle], shared[middle], rtol=0.3)


# -- another program -------------------------------------------------------------------------------


def _brownian_profiles(n, hurst, count):
    """Exact fractional Brownian motion: circulant embedding of its increments."""
    lag = np.arange(n + 1.0)
    covariance = (np.abs(lag + 1) ** (2 * hurst) + np.abs(lag - 1) ** (2 * hurst)) / 2
    covariance -= lag ** (2 * hurst)
    spectrum = np.fft.fft(np.concatenate([covariance, covariance[-2:0:-1]])).real
    noise = np.random.default_rng(0).standard_normal((count, 2, len(spectrum)))
    increments = np.fft.fft(np.sqrt(spectrum / len(spectrum)) * (noise[:, 0] + 1j * noise[:, 1]))
    return np.cumsum(increments.real[:, :n], axis=1)


@pytest.mark.scans
@pytest.mark.parametrize(
    ("name", "method"),
    [("variogram", "SVA"), ("roughness_length", "DFA"), ("power_spectrum", "PSD")],
)
def test_profiles_give_what_the_authors_of_the_fault_found_for_their_methods(name, method):
    path = SCANS / "corona_fault" / "PaperStats.csv"
    if not path.exists():
        pytest.skip("the real scans are not beside the project")
    # It holds no value of the fault itself: means over 10,000 made profiles of known H, by method.
    table = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")
    estimator = ESTIMATORS[name]
    for row in table[(table["method"] == method) & (table["L"] == 1000)]:
        if row["H_true"] not in (0.5, 0.6, 0.7, 0.8):
            continue
        profiles = _brownian_profiles(1000, row["H_true"], 200)
        curve = estimator.curves(profiles, 1.0)["x"]
        used = (curve.length >= 8) & (curve.length <= 100)
        slope = slopes(np.log(curve.length[used]), np.log(curve.measure()[used])[np.newaxis])[0]
        hurst = (slope - estimator.slope_at_zero) / estimator.slope_per_hurst
        assert hurst == pytest.approx(row["H_true"], abs=0.05)
        assert abs(hurst - row["mean"]) < row["std"]
