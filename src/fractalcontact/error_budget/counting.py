"""Sampling error from the number of contacts, of a window without others beside it."""

import numpy as np

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from ..core.limits import MAX_TOUCHING
from ..roughness.plane_spectrum import amplitude_error
from .refinement import LoadCurve

#: Standard deviation of the largest of many heights whose tail falls by e over a length: Gumbel's.
_LARGEST_SPREAD = np.pi / np.sqrt(6)


def counting_error(curve: LoadCurve) -> np.ndarray:
    """Error from the number of contacts, half-width at 95 %, (quantity, normal_force).

    The number N of independent clusters varies by 1/sqrt(N) of itself (Poisson). So does their
    stiffness, as long as contacts act side by side. The area under a given force varies less
    (:mod:`states.area_sampling`).

    At a given separation the force varies by 1/sqrt(N). So at a given force the separation varies
    by l/sqrt(N), with l = sigma_0/(d sigma/d w_int), the length over which the pressure falls by e.
    Closure also counts from the highest of the heights, whose tail falls over the same length: the
    largest of many such heights scatters by pi/sqrt(6) l (Gumbel).

    The window holds few of the long waves. The mean gap is as uncertain as their amplitude, and the
    stiffness follows it: K of heights a h under F is that of h under F/a (exact of elastic
    half-spaces), so that ln K falls by d ln K/d ln F for each unit of ln a.

    The error of Delta_sigma is its published interval, which leaves out parts of the window. Where
    more than half of the window touches there are no separate contacts. Then only the area has an
    error: f (1 - f) is the variance of a fraction f.
    """
    clusters = np.maximum(curve.domains["clusters"].values, 1.0)
    touching = curve.curve["area_share"].values
    fraction = t_quantile(np.inf) / np.sqrt(clusters)
    length = np.where(touching > MAX_TOUCHING, np.nan, curve.decay_length())
    summit_spread = t_quantile(np.inf) * _LARGEST_SPREAD * length
    area = curve.curve["area_corrected"].values
    stiffness = curve.curve["interface_stiffness"].values
    apart = curve.curve["area_sampling"].values
    together = fraction * np.sqrt(np.clip(1 - touching, 0, 1))
    amplitude = t_quantile(np.inf) * _amplitude_error(curve)
    of_stiffness = np.hypot(fraction, amplitude * _steepness(curve.forces, stiffness))
    value, low, high = Estimate.read(curve.domains, "delta_sigma").ends
    return curve.over_quantities(
        closure=np.hypot(fraction * length, summit_spread),
        separation=np.hypot(fraction * length, amplitude * curve.curve["mean_gap"].values),
        area_corrected=np.where(np.isnan(apart), together, apart) * area,
        stiffness=np.where(touching > MAX_TOUCHING, np.nan, of_stiffness * stiffness),
        delta_sigma=np.fmax(high - value, value - low),
    )


def _amplitude_error(curve: LoadCurve) -> float:
    """Relative standard deviation of the amplitude of the waves."""
    try:
        return amplitude_error(curve.composite, curve.space.spacing)
    except ValueError:  # flush faces have no waves
        return 0.0


def _steepness(forces: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """d ln K / d ln F (normal_force); 1, as of K ~ F, where it is not known."""
    if len(forces) < 2:
        return np.ones(len(forces))
    with np.errstate(all="ignore"):
        slope = np.gradient(np.log(stiffness), np.log(forces))
    return np.where(np.isfinite(slope), slope, 1.0)
