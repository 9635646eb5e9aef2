"""The classical theories that are drawn beside the results.

Every function takes numbers or arrays and returns their common shape.
"""

from typing import NamedTuple

import numpy as np
from scipy import special

#: kappa of A/A0 = kappa p / (E* h'_rms). Persson, J. Chem. Phys. 115 (2001) 3840.
PERSSON_KAPPA = np.sqrt(8 / np.pi)
#: Bush, Gibson & Thomas, Wear 35 (1975) 87.
BUSH_GIBSON_THOMAS_KAPPA = np.sqrt(2 * np.pi)

#: Barton's total friction angle is not used above this, degrees (Barton & Choubey, Rock Mech. 10
#: (1977) 1): at low stress the logarithm would take it past the vertical.
LARGEST_FRICTION_ANGLE = 70.0

#: Length of the joints that JRC and JCS are tabulated for, mm.
LABORATORY_LENGTH = 100.0


class Asperities(NamedTuple):
    """Summits of a random surface as Greenwood and Williamson see them."""

    density: float
    """Summits per area, mm-2."""
    radius: float
    """Mean radius R of the summits, mm."""
    height_deviation: float
    """Standard deviation sigma_s of summit heights, mm."""


def linear_area(pressure, modulus, rms_slope, kappa):
    """Part of the nominal area in contact at light load: kappa p / (E* h'_rms).

    Parameters
    ----------
    pressure : array_like
        Nominal pressure p, MPa.
    modulus : array_like
        E*, MPa.
    rms_slope : array_like
        h'_rms of the surface (both directions), of the composite topography.
    kappa : float
        `PERSSON_KAPPA`, `BUSH_GIBSON_THOMAS_KAPPA` or a computed value (2.1-2.3).
    """
    return kappa * pressure / (modulus * rms_slope)


def persson_area(pressure, modulus, rms_slope):
    """Part of the nominal area in contact at any load: erf(sqrt 2 p / (E* h'_rms)).

    Parameters as for `linear_area`, of which Persson's line is the tangent at zero load. Persson,
    J. Chem. Phys. 115 (2001) 3840; this form in Manners & Greenwood, Wear 261 (2006) 600.
    """
    return special.erf(np.sqrt(2) * pressure / (modulus * rms_slope))


def asperities(m0, m2, m4) -> Asperities:
    """Summits of a Gaussian surface from the spectral moments of its profiles.

    Parameters
    ----------
    m0, m2, m4 : array_like
        Mean squares of height (mm2), slope (1) and second derivative (mm-2) of profiles.

    Notes
    -----
    McCool, Wear 107 (1986) 37, after Nayak, J. Lubr. Technol. 93 (1971) 398, with
    alpha = m0 m4 / m2^2: density m4 / (6 pi sqrt 3 m2), R = (3/8) sqrt(pi / m4),
    sigma_s^2 = (1 - 0.8968 / alpha) m0. A surface has alpha > 1.5; NaN below 0.8968.
    """
    alpha = m0 * m4 / m2**2
    variance = np.where(alpha > 0.8968, (1 - 0.8968 / alpha) * m0, np.nan)
    return Asperities(
        density=m4 / (6 * np.pi * np.sqrt(3) * m2),
        radius=3 / 8 * np.sqrt(np.pi / m4),
        height_deviation=np.sqrt(variance),
    )


def greenwood_williamson_area(force, modulus, radius, height_deviation):
    """Real contact area of exponentially distributed asperities: F sqrt(pi R / sigma_s) / E*, mm2.

    Parameters
    ----------
    force : array_like
        N.
    modulus : array_like
        E*, MPa.
    radius, height_deviation : array_like
        R and sigma_s of `asperities`, mm.

    Notes
    -----
    Greenwood & Williamson, Proc. R. Soc. A 295 (1966) 300.
    """
    return force * np.sqrt(np.pi * radius / height_deviation) / modulus


def archard_exponent(level):
    """Exponent of A ~ F^(1 - 3^-n) for spheres covered with spheres: 2/3 at level 1 (Hertz).

    Archard, Proc. R. Soc. A 243 (1957) 190.

    Parameters
    ----------
    level : int array_like
        n, from 1: how many generations of spheres there are.
    """
    return 1 - 3.0 ** -np.asarray(level)


def joint_roughness(z2):
    """JRC from the rms slope of profiles: 32.2 + 32.47 log10 Z2.

    Tse & Cruden, Int. J. Rock Mech. 16 (1979) 303, from profiles sampled at 1.27 mm. The relation
    is not kept within Barton's 0-20; a slope from a finer sampling is larger and so is the JRC.

    Parameters
    ----------
    z2 : array_like
        Rms slope of the profiles along the direction of sliding.
    """
    return 32.2 + 32.47 * np.log10(z2)


def scaled_joint(roughness, wall_strength, length):
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


def barton_strength(pressure, residual_angle, roughness, wall_strength):
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
