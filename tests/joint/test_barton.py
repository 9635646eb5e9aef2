"""Joint roughness coefficient and shear strength by Barton and co-workers."""

import numpy as np
import pytest

from fractalcontact.joint import barton


def test_joint_roughness_of_known_slopes():
    assert barton.joint_roughness(0.1) == pytest.approx(32.2 - 32.47)
    assert barton.joint_roughness(1.0) == pytest.approx(32.2)


def test_joint_of_laboratory_length_is_not_corrected():
    assert barton.scaled_joint(10.0, 80.0, 100.0) == (10.0, 80.0)
    jrc, jcs = barton.scaled_joint(10.0, 80.0, 1000.0)
    assert jrc == pytest.approx(10 * 10**-0.2)
    assert jcs == pytest.approx(80 * 10**-0.3)


def test_barton_strength():
    # 30 degrees + 10 log10(100) = 50 degrees.
    assert barton.barton_strength(1.0, 30.0, 10.0, 100.0) == pytest.approx(np.tan(np.radians(50)))
    # At sigma = JCS the asperities give nothing more.
    assert barton.barton_strength(100.0, 30.0, 10.0, 100.0) == pytest.approx(
        100 * np.tan(np.radians(30))
    )


def test_barton_angle_stays_between_residual_and_largest():
    low, high = barton.barton_strength(np.array([1e-6, 1e4]), 30.0, 15.0, 100.0)
    assert low == pytest.approx(1e-6 * np.tan(np.radians(70)))
    assert high == pytest.approx(1e4 * np.tan(np.radians(30)))
    assert np.isnan(barton.barton_strength(np.nan, 30.0, 15.0, 100.0))


def test_larger_joints_are_weaker():
    length = np.array([100.0, 200.0, 400.0])
    jrc, jcs = barton.scaled_joint(12.0, 90.0, length)
    strength = barton.barton_strength(2.0, 30.0, jrc, jcs)
    assert (np.diff(strength) < 0).all()
