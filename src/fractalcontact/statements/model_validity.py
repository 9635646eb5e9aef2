"""Validity of the elastic model: real mean pressure against strength, and slope of the faces.

The model is a linear elastic half-space (of a stated hardness elastic-perfectly plastic), for small
slopes. One function judges it, once, for the atlas: the stage ``elastic_model``, which the result
page, its summary and the caption of Fig. 8 quote.
"""

from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.limits import MAX_TOUCHING
from ..core.per_curve import per_curve
from ..core.settings import Material
from ..core.text import compact, percent
from ..core.validity import LOAD, SLOPE, Limits, Validity, pressure_words
from ..core.verdicts import GOOD, HARDNESS, IN_PART, NO_PRESSURE, NOT_JUDGED, POOR, STRENGTH, USUAL

#: Rms slope of the composite topography up to which half-spaces model its faces fairly, and up to
#: which they do so in part: chosen bounds, not measured ones. A surface of that rms slope is at
#: most 4 %, or 25 %, larger than its projection.
SMALL_SLOPE, MODERATE_SLOPE = 0.3, 0.75

#: A contact that all material around it confines yields as a whole at about three times the
#: uniaxial strength (Tabor 1951, The Hardness of Metals).
CONFINED = 3.0

#: Young's modulus over uniaxial strength of rocks and concretes is between these (Deere and Miller
#: 1966: most rocks 200 to 500; concrete up to 1000): bounds of a strength that is not stated.
MIN_RATIO, LARGEST_RATIO = 200.0, 1000.0


#: Fraction F / (H A_0) of the largest load beyond which nearly all of the window touches: a contact
#: domain then has no dimension of its own.
FULL_LOAD_FRACTION = 0.87

#: The real mean pressure of a fully yielded contact is its hardness, to rounding.
_ROUNDING = 1e-6

#: Limitation of a hardness.
DELETED = "crushed rock vanishes instead of filling the gap"

#: Verdicts from the best to the worst.
_GRADES = (GOOD, IN_PART, POOR)

#: Verdicts of the states, over (direction, offset, load): unit and long name.
_OF_STATES = {
    "verdict": ("1", f"verdict on the elastic model: {GOOD}, {IN_PART}, {POOR} or {NOT_JUDGED}"),
    "pressure": ("MPa", "real mean pressure sigma_n that is judged"),
    "reason": ("1", "pressure and slope, that which decides the verdict first"),
    "decided_by": ("1", f"cause of a verdict that is not good: {SLOPE}, {LOAD} or pressure"),
}
#: Limits of the material: unit and long name.
_OF_MATERIAL = {
    "criterion": ("1", f"limit of the pressure: {HARDNESS}, {STRENGTH} or {USUAL}"),
    "strength_low": ("MPa", "lower end of that strength"),
    "strength_high": ("MPa", "upper end of that strength"),
    "good_to": ("MPa", "real mean pressure up to which the elastic model is good"),
    "poor_from": ("MPa", "real mean pressure from which the elastic model is poor"),
}


def model_validity(area: xr.Dataset, scaling: xr.Dataset, material: Material) -> xr.Dataset:
    """Verdicts on the elastic model in every state at the scan's own resolution.

    :data:`_OF_STATES` over (direction, offset, load), and the :class:`Limits` of the material.
    """
    dims = ("direction", "offset", "normal_force")
    finest = scaling["sigma_n"].sel(resolution=scaling["resolution"].min(), drop=True)
    pressures, slopes = xr.align(finest.transpose(*dims), area["rms_slope"], join="exact")
    of_state = {
        "pressure": pressures,
        "rms_slope": slopes,
        "nominal_pressure": pressures["nominal_pressure"],
    }

    def judged(**state: np.ndarray) -> dict[str, Any]:
        numbers = {name: float(value) for name, value in state.items()}
        validity = elastic_model_validity(**numbers, material=material)
        return {name: getattr(validity, name) for name in _OF_STATES}

    result = xr.Dataset(per_curve(of_state, judged, _OF_STATES, along=()), pressures.coords)
    of_material = {name: ((), *words) for name, words in _OF_MATERIAL.items()}
    return result.assign(labelled(of_material, material_limits(material)._asdict()))


def elastic_model_validity(
    pressure: float, rms_slope: float, material: Material, nominal_pressure: float = 0.0
) -> Validity:
    """Verdict on the elastic model under one load: the worse of pressure and slope counts.

    Of contacts that crush at a hardness the pressure is no test: they are judged by the fraction of
    what the window can carry, good up to half of it, poor beyond 87 %. Else good up to the joint
    wall strength, in part up to three times that strength, poor beyond. Where neither is stated the
    strength lies between E/1000 and E/200: good up to the first, poor from three times the second.
    Slopes are good up to 0.3, in part up to 0.75.

    The pressure is the real mean one, MPa, ``sigma_n`` of the stage ``scaling``; NaN gives no
    verdict. The rms slope is of the composite topography; NaN counts nothing. The nominal pressure
    F / A_0 is in MPa.
    """
    limits = material_limits(material)
    if not np.isfinite(pressure):
        return Validity(NOT_JUDGED, pressure, NO_PRESSURE, "", limits)
    ends = (limits.good_to * (1 + _ROUNDING), limits.poor_from * (1 + _ROUNDING))
    by_pressure = _graded(pressure, *ends)
    place = _place(pressure, by_pressure, limits)
    words = f"contacts bear {pressure_words(pressure)} on average, {place}"
    judgements = [(by_pressure, "pressure", f"{words} the {limits.words}")]
    if limits.criterion == HARDNESS and by_pressure == GOOD:
        share = nominal_pressure / limits.good_to
        words = f"the load is {percent(share)} of the most that contacts with a hardness of "
        words += f"{pressure_words(limits.good_to)} can carry"
        judgements = [(_graded(share, MAX_TOUCHING, FULL_LOAD_FRACTION), LOAD, words)]
    if np.isfinite(rms_slope):
        by_slope = _graded(rms_slope, SMALL_SLOPE, MODERATE_SLOPE)
        size = "small" if by_slope == GOOD else "too steep"
        judgements.append((by_slope, SLOPE, f"rms slope {compact(rms_slope)}, {size}"))
    judgements.sort(key=lambda judgement: -_GRADES.index(judgement[0]))  # the worst first
    verdict, by, _ = judgements[0]
    # A load far below the largest that the window carries is no reason for a verdict.
    sentences = [words for grade, cause, words in judgements if cause != LOAD or grade == verdict]
    if limits.criterion == HARDNESS:
        sentences.append(DELETED)
    reason = "; ".join(sentences)
    return Validity(verdict, pressure, reason, "" if verdict == GOOD else by, limits)


def _graded(value, good_to, poor_from):
    return GOOD if value <= good_to else IN_PART if value <= poor_from else POOR


def _place(pressure, verdict, limits):
    """Position of a pressure relative to the limit, in words; assumed strengths are a range."""
    if limits.criterion != USUAL:
        return "within" if verdict == GOOD else "beyond"
    if verdict == GOOD:
        return "below"
    return "among" if pressure <= limits.strength_high else "above"


def material_limits(material: Material) -> Limits:
    """Limits of the elastic model of a material: its hardness, its strength, or usual strengths."""
    hardness, strength = float(material.hardness), float(material.joint_wall_strength)
    if np.isfinite(hardness):
        return Limits(HARDNESS, hardness, hardness, hardness, hardness)
    if np.isfinite(strength):
        return Limits(STRENGTH, strength, strength, strength, CONFINED * strength)
    modulus = float(material.modulus)
    low, high = modulus / LARGEST_RATIO, modulus / MIN_RATIO
    return Limits(USUAL, low, high, low, CONFINED * high)
