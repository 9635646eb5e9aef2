"""The classical theories that are drawn beside the results.

Every function takes numbers or arrays and returns their common shape.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy import special

from ..core.labels import cf_attrs

#: Numbers or arrays: the type of arguments and results.
Numbers = float | np.ndarray | xr.DataArray

#: kappa of A/A0 = kappa p / (E* h'_rms). Persson, J. Chem. Phys. 115 (2001) 3840.
PERSSON_KAPPA = np.sqrt(8 / np.pi)
#: Bush, Gibson & Thomas, Wear 35 (1975) 87.
BUSH_GIBSON_THOMAS_KAPPA = np.sqrt(2 * np.pi)
#: Range of the values computed in the literature for many hills at light load.
COMPUTED_KAPPA = (2.1, 2.3)

#: Points of a line of a theory.
LINE_POINTS = 60

#: The three values of kappa as attributes of a dataset.
KAPPA_ATTRS = {
    "persson_kappa": float(PERSSON_KAPPA),
    "bush_gibson_thomas_kappa": float(BUSH_GIBSON_THOMAS_KAPPA),
    "computed_kappa": list(COMPUTED_KAPPA),
}

#: g of :func:`fudged_persson_area`: the middle of the range that fits computations.
FUDGE = 0.435

#: Published areas of periodic surfaces of H = 0.8 by Green's function molecular dynamics: p/E*,
#: A/A0 and h'_rms. A second series lies 2 to 6 % lower.
PERIODIC_AREAS = {1e-3: 0.00827, 5e-3: 0.0399, 0.01: 0.0779, 0.025: 0.1852}
PERIODIC_SLOPE = 0.2766
PERIODIC_SCATTER = 0.06

#: Ratio of successive frequencies of the Weierstrass-Mandelbrot profile, as Majumdar and Bhushan
#: take it.
FREQUENCY_RATIO = 1.5


class Asperities(NamedTuple):
    """Summits of a random surface as Greenwood and Williamson see them."""

    radius: Numbers
    """Mean radius R of the summits, mm."""
    height_deviation: Numbers
    """Standard deviation sigma_s of summit heights, mm."""


def linear_area(pressure: Numbers, modulus: Numbers, rms_slope: Numbers, kappa: Numbers) -> Numbers:
    """Fraction of the nominal area in contact at light load: kappa p / (E* h'_rms).

    The nominal pressure p and E* are in MPa, h'_rms is the slope of the composite topography (both
    directions), kappa is `PERSSON_KAPPA`, `BUSH_GIBSON_THOMAS_KAPPA` or a computed value (2.1-2.3).
    """
    return kappa * pressure / (modulus * rms_slope)


def persson_area(pressure: Numbers, modulus: Numbers, rms_slope: Numbers) -> Numbers:
    """Fraction of the nominal area in contact at any load: erf(sqrt 2 p / (E* h'_rms)).

    Parameters as for `linear_area`, of which Persson's line is the tangent at zero load. Persson,
    J. Chem. Phys. 115 (2001) 3840; this form in Manners & Greenwood, Wear 261 (2006) 600.
    """
    return special.erf(np.sqrt(2) * pressure / (modulus * rms_slope))


def persson_line(least: float, most: float) -> xr.Dataset:
    """Persson's kappa between two reduced pressures p / (E* h'_rms), as a line to draw."""
    pressure = np.geomspace(least, most, LINE_POINTS)
    words = {
        "line_pressure": (pressure, "p / (E* h'_rms) of the theory's line"),
        "persson_line": (persson_area(pressure, 1.0, 1.0) / pressure, "area slope by Persson"),
    }
    table = {
        name: ("line_point", values, cf_attrs("1", text)) for name, (values, text) in words.items()
    }
    return xr.Dataset(table)


def fudged_persson_area(
    pressure: Numbers, modulus: Numbers, rms_slope: Numbers, fudge: float = FUDGE
) -> np.ndarray:
    """Fraction of the nominal area in contact by Persson's theory with its elastic energy lessened.

    A = erf(p / sqrt(2 (g + (1 - g) A) V)), V = (E* h'_rms)^2 / 4: Persson's for g = 1, steeper by
    1/sqrt(g) at light load, the same at full contact. Xu et al., J. Mech. Phys. Solids (2024);
    computations without adhesion want g of 0.42 to 0.45. By fixed-point iteration, which contracts
    for g > 0. Parameters as for :func:`linear_area`.
    """
    ratio = np.sqrt(2) * np.asarray(pressure / (modulus * rms_slope), float)
    area = special.erf(ratio)
    for _ in range(200):
        last, area = area, special.erf(ratio / np.sqrt(fudge + (1 - fudge) * area))
        if np.all(np.abs(area - last) <= 1e-14):
            break
    return area


def asperities(m0: Numbers, m2: Numbers, m4: Numbers) -> Asperities:
    """Summits of a Gaussian surface from the spectral moments of its profiles.

    m0, m2 and m4 are mean squares of height (mm2), slope (1) and second derivative (mm-2). McCool,
    Wear 107 (1986) 37, after Nayak, J. Lubr. Technol. 93 (1971) 398, with alpha = m0 m4 / m2^2: R =
    (3/8) sqrt(pi / m4), sigma_s^2 = (1 - 0.8968 / alpha) m0. A surface has alpha > 1.5; NaN below
    0.8968.
    """
    alpha = m0 * m4 / m2**2
    # xr.where would drop the attributes of the coordinates.
    variance = (1 - 0.8968 / alpha) * m0 * np.where(alpha > 0.8968, 1.0, np.nan)
    return Asperities(radius=3 / 8 * np.sqrt(np.pi / m4), height_deviation=np.sqrt(variance))


def greenwood_williamson_area(
    force: Numbers, modulus: Numbers, radius: Numbers, height_deviation: Numbers
) -> Numbers:
    """Real contact area of exponentially distributed asperities: F sqrt(pi R / sigma_s) / E*, mm2.

    F in N, E* in MPa, R and sigma_s of :func:`asperities` in mm. Greenwood & Williamson, Proc. R.
    Soc. A 295 (1966) 300.
    """
    return force * np.sqrt(np.pi * radius / height_deviation) / modulus


def no_majumdar_bhushan(dimension: float) -> str:
    """Reason why Majumdar and Bhushan's law does not apply to D = Delta_g - 1; "" if it does."""
    if not np.isfinite(dimension):
        return "no Delta_g to use: see no_dimension of the stage surface_dimension"
    return "" if 1 < dimension < 1.5 else f"needs D between 1 and 1.5, not {dimension:.2f}"


def roughness_scale(mean_square: Numbers, lag: Numbers, dimension: Numbers) -> Numbers:
    """Scale G of a fractal profile, mm, from its structure function S, mm2, at one lag tau, mm.

    Majumdar & Bhushan, J. Tribol. 112 (1990) 205: S = C G^(2 (D-1)) tau^(4-2D) with C = Gamma(2D-3)
    sin[(2D-3) pi/2] / [(4-2D) ln gamma], gamma = 1.5, after Berry & Lewis, Proc. R. Soc. A 370
    (1980) 459. That is S of the profile G^(D-1) sum cos(gamma^n x) / gamma^((2-D) n), whose gamma^n
    are radians per length; were they waves per length, as 2 pi in the cosine would have it, G^(D-1)
    were (2 pi)^(2-D) times smaller. NaN outside 1 < D < 1.5, to which the area law is held.
    """
    dimension = np.where((dimension > 1) & (dimension < 1.5), dimension, np.nan)
    constant = special.gamma(2 * dimension - 3) * np.sin((2 * dimension - 3) * np.pi / 2)
    constant = constant / ((4 - 2 * dimension) * np.log(FREQUENCY_RATIO))
    return (mean_square / (constant * lag ** (4 - 2 * dimension))) ** (1 / (2 * (dimension - 1)))


def majumdar_bhushan_area(
    force: Numbers, modulus: Numbers, dimension: Numbers, scale: Numbers
) -> Numbers:
    """Real contact area of a fractal surface without plasticity, mm2: A ~ F^(2/(3-D)).

    F in N, E* in MPa, D of profiles (one less than that of the surface), scale G of
    :func:`roughness_scale` in mm. NaN outside 1 < D < 1.5: above it small spots carry most of the
    load, and without plasticity the law has no limit.

    Majumdar & Bhushan, J. Tribol. 113 (1991) 1, with their a_c = 0. Spots of area a number n(a) =
    (D/2) a_L^(D/2) a^(-D/2-1) up to a_L and carry (4 sqrt(pi)/3) E* G^(D-1) a^((3-D)/2) each
    (Hertz, radius a^(D/2) / (pi^2 G^(D-1))), so that A = D/(2-D) a_L and F = (4 sqrt(pi)/3) E*
    G^(D-1) D/(3-2D) a_L^((3-D)/2). The nominal area does not enter, and nothing keeps A below it.
    """
    dimension = np.where((dimension > 1) & (dimension < 1.5), dimension, np.nan)
    unit = 4 * np.sqrt(np.pi) / 3 * modulus * scale ** (dimension - 1)
    unit = unit * dimension / (3 - 2 * dimension)
    largest_spot = (force / unit) ** (2 / (3 - dimension))
    return dimension / (2 - dimension) * largest_spot


def archard_exponent(level: Numbers) -> Numbers:
    """Exponent of A ~ F^(1 - 3^-n) for spheres covered with spheres: 2/3 at n = 1 (Hertz).

    n generations of spheres: Archard, Proc. R. Soc. A 243 (1957) 190.
    """
    return 1 - 3.0 ** -np.asarray(level)
