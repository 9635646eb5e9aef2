"""Joint roughness coefficient and shear strength by Barton and co-workers.

Every function takes numbers or arrays and returns their common shape.
"""

import numpy as np
import xarray as xr

from ..core.limits import LARGEST_FRICTION_ANGLE

#: Numbers or arrays: the type of arguments and results.
Numbers = float | np.ndarray | xr.DataArray

#: Length of the joints that JRC and JCS are tabulated for, mm.
LABORATORY_LENGTH = 100.0


def joint_roughness(z2: Numbers) -> Numbers:
    """JRC from the rms slope Z2 of profiles along the direction of sliding: 32.2 + 32.47 log10 Z2.

    Tse & Cruden, Int. J. Rock Mech. 16 (1979) 303, from profiles sampled at 1.27 mm. The relation
    is not kept within Barton's 0-20; a slope from a finer sampling is larger and so is the JRC.
    """
    return 32.2 + 32.47 * np.log10(z2)


def scaled_joint(
    roughness: Numbers, wall_strength: Numbers, length: Numbers
) -> tuple[Numbers, Numbers]:
    """JRC and JCS, MPa, of a joint of another length, mm (Bandis, Lumsden & Barton 1981).

    JRC_n = JRC_0 (L_n/L_0)^(-0.02 JRC_0) and JCS_n = JCS_0 (L_n/L_0)^(-0.03 JRC_0) from those of a
    joint of L_0 = `LABORATORY_LENGTH`.
    """
    ratio = length / LABORATORY_LENGTH
    return roughness * ratio ** (-0.02 * roughness), wall_strength * ratio ** (-0.03 * roughness)


def barton_angle(
    pressure: Numbers, residual_angle: Numbers, roughness: Numbers, wall_strength: Numbers
) -> Numbers:
    """Friction angle phi_r + JRC log10(JCS / sigma) of :func:`barton_strength`, not truncated."""
    return residual_angle + roughness * np.log10(wall_strength / pressure)


def barton_strength(
    pressure: Numbers, residual_angle: Numbers, roughness: Numbers, wall_strength: Numbers
) -> Numbers:
    """Peak shear strength tau = sigma tan(phi_r + JRC log10(JCS / sigma)), MPa.

    Barton & Choubey, Rock Mech. 10 (1977) 1. The angle in brackets is held between the residual
    angle phi_r (above JCS asperities are sheared off) and `LARGEST_FRICTION_ANGLE`, both in
    degrees. The nominal pressure sigma > 0 and the JCS are in MPa; NaN gives NaN.
    """
    angle = barton_angle(pressure, residual_angle, roughness, wall_strength)
    angle = np.clip(angle, residual_angle, np.maximum(residual_angle, LARGEST_FRICTION_ANGLE))
    return pressure * np.tan(np.radians(angle))
