"""Synthetic mated faces that slide, of one spectrum at every size: their composite, and S(v).

One face slides over its copy. Both are cut from one larger surface, so that the window has no edge
effects at any displacement.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from scipy import special

from fractalcontact.surface.synthesis import band_limited, band_slope

from .units import SPACING

#: Stream of the seeds: faces share no noise with the surfaces of other experiments.
_STREAM = 5
#: Points of the integral over the spectrum for each radian of q v, and fewest points in all.
_POINTS, _FEWEST = 32, 4000


class FaceClass(NamedTuple):
    """Spectrum of the faces of one Hurst exponent; lengths in mm."""

    hurst: float
    prefactor: float
    cut_off: float
    roll_off: float


def face_class(hurst: float, recipe: Mapping[str, Any]) -> FaceClass:
    """Spectrum of the faces of a recipe with Hurst exponent ``hurst``.

    The recipe has ``cut_off`` and ``roll_off`` in nodes, ``sizes`` in nodes per side, and
    ``rms_slope``, the h'_rms of a face: one prefactor for all sizes, in the mean of the largest.
    """
    lengths = {key: recipe[key] * SPACING for key in ("cut_off", "roll_off")}
    largest = max(recipe["sizes"])
    of_one = band_slope((largest, largest), SPACING, hurst, prefactor=1.0, **lengths)
    return FaceClass(hurst, (recipe["rms_slope"] / of_one) ** 2, **lengths)


def sliding_face(faces: FaceClass, size: int, reach: int, number: int) -> np.ndarray:
    """Heights of one face, mm, (size, size + reach): all cells that a sliding window reaches."""
    entropy = (_STREAM, round(1000 * faces.hurst), size, number)
    seed = int(np.random.SeedSequence(entropy).generate_state(1)[0])
    return band_limited(
        (size, size + reach),
        SPACING,
        faces.hurst,
        prefactor=faces.prefactor,
        cut_off=faces.cut_off,
        roll_off=faces.roll_off,
        seed=seed,
    )


def mated_composite(face: np.ndarray, offset: int) -> np.ndarray:
    """Composite topography h(x) = z(x + v) - z(x) (n, n) of a face and its copy about its mean, mm.

    The face (n, n + reach) is in mm, the offset v in nodes along x, up to the reach. The mean, the
    tilt of the window times v, is taken off: a joint opens by the separation of its mean planes,
    whatever their tilt.
    """
    size = len(face)
    composite = face[:, offset : offset + size] - face[:, :size]
    return composite - composite.mean()


def height_difference(offset: np.ndarray, faces: FaceClass) -> np.ndarray:
    """Height-difference function S(v) = <(z(x + v) - z(x))^2>, mm2: mean square of the composite.

    The integral of 2 C(q) (1 - J_0(q v)) q dq / (2 pi), v in mm. It goes with v^2 below the
    cut-off, about as v^(2H) up to the roll-off, and is twice the mean square height beyond.
    Spectrum: Persson et al., J. Phys. Condens. Matter 17 (2005) R1.
    """
    offset = np.asarray(offset, float)
    largest, corner = 2 * np.pi / faces.cut_off, 2 * np.pi / faces.roll_off
    turns = largest * offset.max(initial=0.0)
    q = np.linspace(0.0, largest, max(_FEWEST, int(_POINTS * turns)) + 1)
    density = faces.prefactor * np.maximum(q, corner) ** (-2 * (1 + faces.hurst))
    waves = 1 - special.j0(offset[..., np.newaxis] * q)
    return np.trapezoid(density * q * waves, q, axis=-1) / np.pi
