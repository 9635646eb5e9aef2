"""Grasselli's parameters: exact faces, and numbers of the compiled class of surface-roughness."""

import numpy as np
import pytest

from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.roughness.grasselli import grasselli
from fractalcontact.surface.synthesis import self_affine

SPACING = (0.1, 0.1)
#: theta*_max, C, A_0, theta*_max / (C + 1) of surface-roughness 0.0.3 by direction: seed 1.
COMPILED = {
    "E": (70.150, 1.391, 0.497, 29.337),
    "N": (71.099, 1.407, 0.492, 29.536),
    "W": (69.389, 1.405, 0.503, 28.851),
    "S": (68.321, 1.357, 0.508, 28.988),
}


@pytest.mark.parametrize("direction", COMPILED)
def test_another_program_finds_the_same(direction):
    face = without_mean_plane(
        self_affine((128, 128), 0.1, 0.8, rms=0.2, seed=1, roll_off=128 * 0.1 / 5)
    )
    found = grasselli(face, SPACING, direction)
    off = np.abs(np.subtract(found, COMPILED[direction]))
    assert (off < [1e-3, 5e-3, 2e-3, 0.05]).all()


def test_teeth_face_the_sliding_with_one_flank():
    """45 degrees up and as much down: half of the area faces each way, all of it as steep."""
    along = np.arange(61) % 12
    face = np.tile(SPACING[1] * np.minimum(along, 12 - along), (60, 1))
    for direction in "EW":
        found = grasselli(face, SPACING, direction)
        assert found.theta_max == pytest.approx(45)
        assert found.a_0 == pytest.approx(0.5, abs=0.01)
        assert found.c < 0.05
        assert found.roughness == pytest.approx(45, rel=0.05)


def test_opposite_directions_exchange_the_flanks():
    face = self_affine((80, 90), 0.1, 0.7, rms=0.1, seed=5, roll_off=1.5)
    np.testing.assert_allclose(
        grasselli(face, SPACING, "E"), grasselli(face[:, ::-1], SPACING, "W"), rtol=1e-9
    )
    np.testing.assert_allclose(
        grasselli(face, SPACING, "N"), grasselli(face.T, SPACING, "E"), rtol=1e-9
    )


def test_a_flat_face_and_holes_have_no_law_or_less_area():
    assert np.isnan(grasselli(np.zeros((40, 40)), SPACING, "E")).all()
    face = self_affine((80, 80), 0.1, 0.8, rms=0.1, seed=5, roll_off=1.5)
    whole = grasselli(face, SPACING, "E")
    face[10:12, 20:24] = np.nan
    assert grasselli(face, SPACING, "E").roughness == pytest.approx(whole.roughness, rel=0.02)
