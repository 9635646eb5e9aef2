"""Clouds that lie steeply, turned level before their heights are put over x and y."""

import math

import numpy as np
from numpy.typing import ArrayLike

from ..core.limits import STEEP_TILT

#: Distance from the quartiles, in quartile distances, beyond which points do not decide where the
#: plane lies (Tukey's far-out fence): spikes and unmarked missing heights.
_FENCE = 3.0
#: Largest tilt, degrees, at which the points alone show which side of the face is its upper one.
UPRIGHT = 85.0  # degrees
#: Largest thickness of a face as a fraction of its width; a thicker body has no plane to be
#: levelled by.
_THICKEST = 0.5


def common_plane(
    clouds: list[np.ndarray], upward: ArrayLike | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Unit normal (3,) and centre (3,) of the plane through one cloud, or two faces together.

    Clouds (n, 3) are finite, in mm. Faces count alike, and a gap between them does not tilt the
    plane. The normal points up; of a plane that stands nearly upright, to the side of ``upward``,
    else to larger x, then y. A body has no plane: its normal points up.

    The normal is the direction of the smallest principal component (Pearson 1901), so that squared
    normal distances are least. A least-squares plane of z over x, y would lie too flat, and not
    exist for a cloud that stands upright.
    """
    parts = [cloud[_within_fences(cloud)] for cloud in clouds]
    centres = [part.mean(axis=0) for part in parts]
    scatter = sum(np.cov((p - c).T) for p, c in zip(parts, centres, strict=True))
    (thickness, width, _), axes = np.linalg.eigh(scatter)  # eigenvalues are squares of lengths
    normal = axes[:, 0] if thickness < _THICKEST**2 * width else np.array([0.0, 0.0, 1.0])
    if upward is not None and tilt_degrees(normal) > UPRIGHT:
        down = normal @ np.asarray(upward) < 0
    else:
        down = tuple(normal[::-1]) < (0, 0, 0)
    return -normal if down else normal, np.mean(centres, axis=0)


def tilt_degrees(normal: np.ndarray) -> float:
    """Angle between a plane and the horizontal, whichever side is up; 0 to 90."""
    return math.degrees(math.atan2(math.hypot(normal[0], normal[1]), abs(normal[2])))


def is_steep(normal: np.ndarray) -> bool:
    """True if heights over x and y would be distorted: above `STEEP_TILT`, or upside down."""
    return tilt_degrees(normal) > STEEP_TILT or normal[2] < 0


def turn_level(points: np.ndarray, normal: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """Points (n, 3), turned about a horizontal axis through ``centre`` until ``normal`` is up.

    The turn is the smallest that does so: its axis is the plane's horizontal line, x stays towards
    x as far as it can, and left stays left (no mirror image).
    """
    return (points - centre) @ turning_matrix(normal).T + centre


def turning_matrix(normal: np.ndarray) -> np.ndarray:
    """Matrix (3, 3) of the smallest turn that points a unit vector up (Rodrigues)."""
    x, y, z = normal
    sine = math.hypot(x, y)
    if sine == 0:
        return np.diag([1.0, np.sign(z), np.sign(z)])
    axis_x, axis_y = y / sine, -x / sine
    cross = np.array(
        [[0, 0, axis_y], [0, 0, -axis_x], [-axis_y, axis_x, 0]]
    )  # cross @ v = axis x v
    return np.eye(3) + sine * cross + (1 - z) * cross @ cross


def _within_fences(points: np.ndarray) -> np.ndarray:
    low, high = np.percentile(points, [25, 75], axis=0)
    reach = _FENCE * (high - low)
    return ((points >= low - reach) & (points <= high + reach)).all(axis=1)
