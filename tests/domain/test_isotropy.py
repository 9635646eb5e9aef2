"""Occupied intervals along and across sliding."""

import numpy as np
import pytest

from fractalcontact.domain.isotropy import interval_dimensions

STRIPES = np.zeros((64, 96), bool)
STRIPES[::16] = True


def values(domain, spacing=(1.0, 1.0), direction="E"):
    return [one.value for one in interval_dimensions(domain, spacing, direction)]


def test_a_filled_window_has_one_and_scattered_nodes_none():
    assert values(np.ones((128, 128), bool)) == pytest.approx([1, 1], abs=0.1)
    scattered = np.zeros((128, 128), bool)
    scattered[8::32, 8::32] = True
    assert values(scattered) == pytest.approx([0, 0], abs=1e-9)


def test_stripes_have_one_along_and_none_across():
    assert values(STRIPES) == pytest.approx([1, 0], abs=0.1)
    assert values(STRIPES, direction="S") == pytest.approx([0, 1], abs=0.1)


def test_a_cantor_set_on_lines_has_its_own_dimension():
    """Thirds left out along x, whole along y: ln 2/ln 3 along x and 1 along y."""
    line = np.array([True])
    for _ in range(5):
        line = np.concatenate([line, np.zeros_like(line), line])
    domain = np.broadcast_to(line, (243, 243))
    along, across = values(domain)
    assert along == pytest.approx(np.log(2) / np.log(3), abs=0.08)
    assert across == pytest.approx(1, abs=0.08)


def test_turning_the_domain_swaps_the_directions():
    domain = np.random.default_rng(1).random((96, 96)) < 0.05
    first, turned = (
        interval_dimensions(d, (0.1, 0.1), way) for d, way in ((domain, "E"), (domain.T, "N"))
    )
    for one, other in zip(first, turned, strict=True):
        assert one.value == pytest.approx(other.value, abs=1e-9)


def test_oblong_cells_change_no_exponent_and_lengths_are_those_of_the_axis():
    domain = np.random.default_rng(2).random((96, 96)) < 0.05
    square, oblong = (interval_dimensions(domain, s, "E") for s in ((0.1, 0.1), (0.3, 0.1)))
    assert [one.value for one in oblong] == pytest.approx([one.value for one in square])
    assert oblong[1].over == pytest.approx(3 * np.array(square[1].over))


def test_isotropic_surfaces_cut_at_a_height_agree_within_their_intervals():
    inside = 0
    for seed in range(20):
        domain = _cut(np.random.default_rng(seed), 128)
        along, across = interval_dimensions(domain, (0.1, 0.1), "E")
        half = np.hypot(along.width, across.width) / 2
        inside += abs(along.value - across.value) <= half
    assert inside >= 18


def _cut(rng, n):
    """The highest nodes of an isotropic surface."""
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(n), np.fft.fftfreq(n)))
    noise = np.fft.fft2(rng.standard_normal((n, n)))
    heights = np.fft.ifft2(noise * np.maximum(q, 0.03) ** -1.8).real
    return heights > np.quantile(heights, 0.97)


def test_no_contact_has_no_exponent():
    assert np.isnan(values(np.zeros((32, 32), bool))).all()
