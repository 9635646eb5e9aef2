import hashlib

import numpy as np
import pytest
import yaml
from ensembles import ensemble

from fractalcontact.roughness.estimators.roughness_length import roughness_length_curves
from fractalcontact.study.embedded import write_scan
from fractalcontact.study.sidecar import sidecar_of_matrix
from fractalcontact.surface.synthesis import (
    band_slope,
    disc_outline,
    grid_side,
    self_affine,
)

SEEDS = range(ensemble("synthetic seeds"))
SPACING = 0.08


def second_difference_hurst(heights, shortest, longest):
    """H from second differences along x and y: knows nothing of spectra, blind to tilt."""
    lags = np.unique(np.geomspace(shortest, longest, 10).astype(int))
    size = [
        np.mean((heights[2 * lag :] - 2 * heights[lag:-lag] + heights[: -2 * lag]) ** 2)
        + np.mean((heights[:, 2 * lag :] - 2 * heights[:, lag:-lag] + heights[:, : -2 * lag]) ** 2)
        for lag in lags
    ]
    return np.polyfit(np.log(lags), np.log(size), 1)[0] / 2


@pytest.mark.parametrize("roll_off", [None, 256 * SPACING / 3])
@pytest.mark.parametrize("hurst", [0.5, 0.76, 0.79, 0.9])
def test_hurst_asked_for_comes_back_from_an_independent_estimator(hurst, roll_off):
    longest = 32 if roll_off is None else 256 / 3 / 4
    found = [
        second_difference_hurst(
            self_affine((256, 256), SPACING, hurst, rms=0.3, seed=seed, roll_off=roll_off),
            4,
            longest,
        )
        for seed in SEEDS
    ]
    assert np.mean(found) == pytest.approx(hurst, abs=0.05)


def test_roughness_length_finds_the_hurst_exponent_too():
    found = []
    for seed in SEEDS:
        surface = self_affine((256, 256), SPACING, 0.79, rms=0.3, seed=seed)
        curve = roughness_length_curves(surface, SPACING)["both"]
        side, rms = curve.length, np.sqrt(curve.measure())
        fitted = (side >= 8 * SPACING) & (side <= 64 * SPACING)
        found.append(np.polyfit(np.log(side[fitted]), np.log(rms[fitted]), 1)[0])
    assert np.mean(found) == pytest.approx(0.79, abs=0.05)


def test_heights_do_not_grow_beyond_the_roll_off():
    heights = [self_affine((256, 256), 1.0, 0.8, rms=1.0, seed=s, roll_off=16.0) for s in SEEDS]

    def difference(lag):
        return np.mean([np.mean((z[lag:] - z[:-lag]) ** 2) for z in heights])

    assert difference(16) == pytest.approx(2, rel=0.1)
    assert difference(100) == pytest.approx(2, rel=0.1)
    assert difference(2) < 0.7  # below it they do


def test_opposite_edges_know_nothing_of_each_other():
    pairs = [
        self_affine((128, 128), 1.0, 0.8, rms=1.0, seed=s, roll_off=16.0)
        for s in range(ensemble("edge pairs"))
    ]
    across = [np.corrcoef(z[0], z[-1])[0, 1] for z in pairs]
    beside = [np.corrcoef(z[0], z[1])[0, 1] for z in pairs]
    assert np.mean(across) == pytest.approx(0, abs=0.12)
    assert np.mean(beside) > 0.8


def test_spectrum_is_isotropic():
    ratio = []
    for seed in SEEDS:
        z = self_affine((128, 128), 1.0, 0.7, rms=1.0, seed=seed, roll_off=20.0)
        along, across = np.mean(np.diff(z, axis=0) ** 2), np.mean(np.diff(z, axis=1) ** 2)
        ratio.append(np.log(along / across))
    assert np.mean(ratio) == pytest.approx(0, abs=0.05)


def mean_squares(surfaces, lags):
    """Mean square height differences (axis, lag) along x and y, over surfaces of like size."""
    return np.array(
        [
            [np.mean([np.mean((z[:, k:] - z[:, :-k]) ** 2) for z in surfaces]) for k in lags]
            for surfaces in (surfaces, [z.T for z in surfaces])
        ]
    )


@pytest.mark.parametrize("anisotropy", [0.5, 2.0])
@pytest.mark.parametrize("hurst", [0.5, 0.8])
def test_an_anisotropic_surface_is_one_stretched_along_y(hurst, anisotropy):
    options = {"rms": 1.0, "anisotropy": anisotropy}
    surfaces = [self_affine((128, 128), 1.0, hurst, seed=s, **options) for s in SEEDS]
    along_x, along_y = mean_squares(surfaces, [4, 8])
    np.testing.assert_allclose(along_x / along_y, anisotropy ** (2 * hurst), rtol=0.25)
    # The same height differences, at a distance that is longer by the anisotropy.
    (wider,) = mean_squares(surfaces, [round(4 * anisotropy)])[1]
    assert wider == pytest.approx(along_x[0], rel=0.15)


@pytest.fixture(scope="module")
def uneven():
    """Gaussian and intermittent surfaces of the same seeds and spectrum, scaled to one rms."""
    options = {"rms": 1.0, "roll_off": 16.0}
    return {
        share: [
            self_affine((128, 128), 1.0, 0.8, seed=s, intermittency=share, **options)
            for s in range(ensemble("uneven surfaces"))
        ]
        for share in (0.0, 0.15, 0.3)
    }


def test_uneven_roughness_leaves_the_spectrum_as_it_is(uneven):
    lags = [1, 4, 16]
    gaussian = mean_squares(uneven[0.0], lags)
    for share in (0.15, 0.3):
        np.testing.assert_allclose(mean_squares(uneven[share], lags), gaussian, rtol=0.2)


def test_uneven_roughness_gives_slopes_heavy_tails_at_short_distances(uneven):
    def kurtosis(surfaces, lag):
        steps = [z[:, lag:] - z[:, :-lag] for z in surfaces]
        return np.median([np.mean(d**4) / np.mean(d**2) ** 2 for d in steps])

    for lag in (1, 4, 16):
        assert kurtosis(uneven[0.0], lag) == pytest.approx(3, abs=0.3)
    for share, least in ((0.15, 6), (0.3, 12)):
        by_lag = [kurtosis(uneven[share], lag) for lag in (1, 4, 16)]
        assert by_lag[0] > least
        assert by_lag == sorted(by_lag, reverse=True)


def test_rough_places_are_drawn_independently_of_the_waves(uneven):
    # Were they not, high places would be rough ones: heights and local slopes would correlate.
    found = [
        np.corrcoef(z[:-1, :-1].ravel(), np.abs(np.diff(z, axis=1)[:-1]).ravel())[0, 1]
        for z in uneven[0.15]
    ]
    assert np.mean(found) == pytest.approx(0, abs=3 * np.std(found) / np.sqrt(len(found)))


def test_rms_is_that_of_the_levelled_patch():
    z = self_affine((60, 90), SPACING, 0.8, rms=0.3, seed=4)
    assert z.shape == (60, 90)
    assert z.dtype == np.float64
    assert np.sqrt(np.mean(z**2)) == pytest.approx(0.3)
    y, x = np.indices(z.shape)
    plane = np.stack([np.ones(z.size), y.ravel(), x.ravel()], axis=1)
    assert np.linalg.lstsq(plane, z.ravel(), rcond=None)[0] == pytest.approx(0, abs=1e-12)


def test_surface_does_not_depend_on_the_unit_of_length():
    mm = self_affine((50, 50), SPACING, 0.8, rms=0.3, seed=4, roll_off=1.0)
    um = self_affine((50, 50), 1e3 * SPACING, 0.8, rms=300.0, seed=4, roll_off=1e3)
    np.testing.assert_allclose(um, 1e3 * mm, rtol=1e-9, atol=1e-9)


def test_same_seed_gives_same_bits_and_another_seed_another_surface():
    def fingerprint(seed):
        z = self_affine((64, 64), SPACING, 0.8, rms=0.3, seed=seed)
        return hashlib.sha256(z.tobytes()).hexdigest()

    assert fingerprint(7) == fingerprint(7)
    assert fingerprint(7) != fingerprint(8)


@pytest.mark.parametrize(
    "wrong",
    [
        {"hurst": 1.0},
        {"hurst": 0.0},
        {"rms": 0.0},
        {"spacing": -1.0},
        {"shape": (1, 9)},
        {"roll_off": 0.0},
        {"anisotropy": 0.0},
        {"intermittency": -0.1},
        {"intermittency": 0.5},
    ],
)
def test_senseless_arguments_are_refused(wrong):
    arguments = {"shape": (9, 9), "spacing": 1.0, "hurst": 0.5, "rms": 1.0, "seed": 0} | wrong
    with pytest.raises(ValueError, match=r"must|needs"):
        self_affine(**arguments)


def test_disc_has_its_area_and_its_symmetry():
    disc = disc_outline((500, 500), 0.1, 50.0)
    assert disc.sum() * 0.01 == pytest.approx(np.pi * 25**2, rel=2e-3)
    assert (disc == disc[::-1]).all()
    assert (disc == disc.T).all()
    assert not disc[0, 0]


def test_scan_is_written_whole_with_its_sidecar(tmp_path):
    heights = self_affine((20, 30), SPACING, 0.8, rms=0.3, seed=1)
    heights[0, 0] = np.nan
    path = tmp_path / "new" / "twin.npy"
    write_scan(path, heights, SPACING, sidecar={"title": "a twin"})
    write_scan(path, heights, SPACING, sidecar={"title": "a twin, again"})
    np.testing.assert_array_equal(np.load(path, allow_pickle=False), heights)
    assert yaml.safe_load(path.with_suffix(".yaml").read_text()) == {
        **sidecar_of_matrix(0.08),
        "title": "a twin, again",
    }
    assert sorted(p.name for p in path.parent.iterdir()) == ["twin.npy", "twin.yaml"]


def test_failed_write_leaves_the_old_scan_and_no_rest(tmp_path):
    path = tmp_path / "twin.npy"
    write_scan(path, np.zeros((3, 3)), SPACING, sidecar={})
    before = path.read_bytes()
    with pytest.raises(ValueError, match="allow_pickle"):
        write_scan(path, np.array([object()]), SPACING, sidecar={})
    assert path.read_bytes() == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["twin.npy", "twin.yaml"]


def test_sidecar_cannot_contradict_the_scan(tmp_path):
    with pytest.raises(ValueError, match="unit"):
        write_scan(tmp_path / "a.npy", np.zeros((3, 3)), SPACING, sidecar={"unit": "m"})
    with pytest.raises(ValueError, match=r"\.npy"):
        write_scan(tmp_path / "a.npz", np.zeros((3, 3)), SPACING, sidecar={})


@pytest.mark.parametrize("roll_off", [None, 12 * SPACING])
@pytest.mark.parametrize("shape", [(24, 24), (25, 25), (20, 32)])
def test_the_slope_of_a_band_is_that_of_all_its_waves(shape, roll_off):
    """Also of those at the end of the grid's spectrum, each of which is its own mirror image."""
    hurst, prefactor, shortest = 0.7, 3e-4, 2 * SPACING
    side = grid_side(shape)
    q_y, q_x = np.meshgrid(*[2 * np.pi * np.fft.fftfreq(side, SPACING)] * 2, indexing="ij")
    q = np.hypot(q_y, q_x)
    longest = 2 * np.pi / roll_off if roll_off else 0.0
    seen = (q > 0) & (q <= 2 * np.pi / shortest * (1 + 1e-9))
    density = prefactor * np.maximum(q[seen], longest) ** (-2 * (1 + hurst))
    expected = np.sqrt(np.sum(q[seen] ** 2 * density)) / (side * SPACING)
    found = band_slope(
        shape, SPACING, hurst, prefactor=prefactor, cut_off=shortest, roll_off=roll_off
    )
    assert found == pytest.approx(expected)
