"""Validity of the elastic model: real mean pressure against strength, and slope of the faces.

The model is a linear elastic half-space (of a stated hardness elastic-perfectly plastic), for small
slopes. One function judges it; the result page, its summary and the caption of Fig. 8 quote it.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..core.resolved import CORRECTED_NODES

#: Verdicts, best first; the last where there is no state to judge.
GOOD, PARTLY, POOR, NOT_ASKED = "good", "in part", "poor", "not asked"

#: Rms slope of the composite topography up to which half-spaces are a fair model of its faces, and
#: up to which they are one in part: chosen bounds, not measured ones. A surface of that rms slope
#: is at most 4 %, or 25 %, larger than its projection.
SMALL_SLOPE, MODERATE_SLOPE = 0.3, 0.75

#: A contact that all material around it confines yields as a whole at about three times the
#: uniaxial strength (Tabor 1951, The Hardness of Metals).
CONFINED = 3.0

#: Young's modulus over uniaxial strength of rocks and concretes is between these (Deere and Miller
#: 1966: most rocks 200 to 500; concrete up to 1000): bounds of a strength that is not stated.
LEAST_RATIO, LARGEST_RATIO = 200.0, 1000.0

#: Why there is no real mean pressure: the areas of fewer nodes are not corrected for their edge.
NO_PRESSURE = f"fewer than {CORRECTED_NODES} nodes in contact, too few for a real mean pressure"

#: The real mean pressure of a fully yielded contact is its hardness, to rounding.
_ROUNDING = 1e-6
_HARDNESS, _USUAL = "hardness", "usual strengths"


@dataclass(frozen=True)
class Validity:
    """A verdict on the elastic model, and what decides it.

    Attributes
    ----------
    verdict : str
        :data:`GOOD`, :data:`PARTLY`, :data:`POOR` or :data:`NOT_ASKED`.
    pressure : float
        Real mean pressure, MPa; NaN where there is none.
    good_to, poor_from : float
        Pressures up to which it is good, and from which it is poor, MPa.
    limit : str
        What they are, in words: "joint wall strength (80 MPa)".
    rms_slope : float
        Of the composite topography.
    reason : str
        One line on both.
    """

    verdict: str
    pressure: float
    good_to: float
    poor_from: float
    limit: str
    rms_slope: float
    reason: str

    @property
    def capped(self) -> bool:
        """Whether a stated hardness caps the pressure, which then is no test of the model."""
        return self.limit.startswith(_HARDNESS)

    @property
    def stated(self) -> bool:
        """Whether a strength or a hardness was stated, and judges the pressure."""
        return not self.limit.startswith(_USUAL)

    @property
    def sentence(self) -> str:
        """Reason and verdict, for a caption."""
        verdict = "good in part" if self.verdict == PARTLY else self.verdict
        return f"{self.reason}: elastic model {verdict}."


def elastic_model_validity(
    pressure: float, rms_slope: float, material: Mapping[str, float]
) -> Validity:
    """Judge the elastic model under one load: the worse of pressure and slope counts.

    Good up to the hardness, which caps the pressure, or to the joint wall strength; in part up to
    three times that strength; poor beyond. Where neither is stated the strength lies between E/1000
    and E/200: good up to the first, poor from three times the second. Slopes are good up to 0.3, in
    part up to 0.75.

    Parameters
    ----------
    pressure : float
        Real mean pressure, MPa: ``sigma_n`` of the stage ``scaling``. NaN gives no verdict.
    rms_slope : float
        Of the composite topography; NaN counts nothing.
    material : mapping of str to float
        ``modulus``, ``hardness`` (infinite where nothing yields) and ``joint_wall_strength`` (NaN
        where not stated), MPa.
    """
    good_to, poor_from, limit = _limits(material)
    if not np.isfinite(pressure):
        return Validity(NOT_ASKED, pressure, good_to, poor_from, limit, rms_slope, NO_PRESSURE)
    by_pressure = _graded(pressure, good_to * (1 + _ROUNDING), poor_from * (1 + _ROUNDING))
    by_slope = GOOD
    if np.isfinite(rms_slope):
        by_slope = _graded(rms_slope, SMALL_SLOPE, MODERATE_SLOPE)
    verdict = max(by_pressure, by_slope, key=(GOOD, PARTLY, POOR).index)
    place = _place(pressure, by_pressure, material)
    reason = f"sigma_n = {_pressure(pressure)}, {place} the {limit}"
    if np.isfinite(material["hardness"]):
        reason += ", which caps it: not a test of the model"
    if np.isfinite(rms_slope):
        size = "small" if by_slope == GOOD else "not small"
        reason += f"; rms slope {rms_slope:.3g}, {size}"
    return Validity(verdict, pressure, good_to, poor_from, limit, rms_slope, reason)


def _graded(value, good_to, poor_from):
    return GOOD if value <= good_to else PARTLY if value <= poor_from else POOR


def _place(pressure, verdict, material):
    """Where a pressure lies, as the limit's words go on; a strength not stated is a range."""
    if np.isfinite(material["hardness"]) or np.isfinite(material["joint_wall_strength"]):
        return "within" if verdict == GOOD else "beyond"
    if verdict == GOOD:
        return "below"
    return "among" if pressure <= float(material["modulus"]) / LEAST_RATIO else "above"


def _limits(material):
    """Pressures up to which the model is good, and from which it is poor, and what they are."""
    hardness, strength = float(material["hardness"]), float(material["joint_wall_strength"])
    if np.isfinite(hardness):
        return hardness, hardness, f"{_HARDNESS} ({_pressure(hardness)})"
    if np.isfinite(strength):
        return strength, CONFINED * strength, f"joint wall strength ({_pressure(strength)})"
    low, high = usual_strengths(material)
    words = f"{_USUAL}, none being stated (E/1000 to E/200: {low:.3g} to {high:.3g} MPa)"
    return low, CONFINED * high, words


def usual_strengths(material: Mapping[str, float]) -> tuple[float, float]:
    """Least and largest uniaxial strength usual for the modulus of a material, MPa.

    Parameters
    ----------
    material : mapping of str to float
        ``modulus`` in MPa.
    """
    modulus = float(material["modulus"])
    return modulus / LARGEST_RATIO, modulus / LEAST_RATIO


def _pressure(pressure):
    """A pressure in MPa, so that it can be compared with the strength beside it."""
    return f"{float(f'{pressure:.3g}'):g} MPa"
