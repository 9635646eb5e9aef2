"""Joint roughness coefficient and shear strength by Barton and co-workers.

Every function takes numbers or arrays and returns their common shape.
"""

import numpy as np
import xarray as xr

from ..core.limits import LARGEST_FRICTION_ANGLE

#: What the functions take and return.
Numbers = float | np.ndarray | xr.DataArray

#: Length of the joints that JRC and JCS are tabulated for, mm.
LABORATORY_LENGTH = 100.0


def joint_roughness(z2: Numbers) -> Numbers:
    """JRC from the rms slope of profiles: 32.2 + 32.47 log10 Z2.

    Tse & Cruden, Int. J. Rock Mech. 16 (1979) 303, from profiles sampled at 1.27 mm. The relation
    is not kept within Barton's 0-20; a slope from a finer sampling is larger and so is the JRC.

    Parameters
    ----------
    z2 : array_like
        Rms slope of the profiles along the direction of sliding.
    """
    return 32.2 + 32.47 * np.log10(z2)


def scaled_joint(
    roughness: Numbers, wall_strength: Numbers, length: Numbers
) -> tuple[Numbers, Numbers]:
    """JRC and JCS of a joint of another length (Bandis, Lumsden & Barton 1981).

    Parameters
    ----------
    roughness : array_like
        JRC_0 of a joint of `LABORATORY_LENGTH`.
    wall_strength : array_like
        JCS_0, MPa, of the same.
    length : array_like
        L_n, mm.

    Returns
    -------
    roughness, wall_strength
        JRC_n = JRC_0 (L_n/L_0)^(-0.02 JRC_0) and JCS_n = JCS_0 (L_n/L_0)^(-0.03 JRC_0), MPa.
    """
    ratio = length / LABORATORY_LENGTH
    return roughness * ratio ** (-0.02 * roughness), wall_strength * ratio ** (-0.03 * roughness)


def barton_strength(
    pressure: Numbers, residual_angle: Numbers, roughness: Numbers, wall_strength: Numbers
) -> Numbers:
    """Peak shear strength tau = sigma tan(phi_r + JRC log10(JCS / sigma)), MPa.

    Barton & Choubey, Rock Mech. 10 (1977) 1. The angle in brackets is held between the residual
    angle (above JCS asperities are sheared off) and `LARGEST_FRICTION_ANGLE`.

    Parameters
    ----------
    pressure : array_like
        Nominal pressure sigma > 0, MPa; NaN gives NaN.
    residual_angle : array_like
        phi_r, degrees.
    roughness : array_like
        JRC.
    wall_strength : array_like
        JCS, MPa.
    """
    angle = residual_angle + roughness * np.log10(wall_strength / pressure)
    angle = np.clip(angle, residual_angle, np.maximum(residual_angle, LARGEST_FRICTION_ANGLE))
    return pressure * np.tan(np.radians(angle))
