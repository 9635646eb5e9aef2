"""Verdict on the elastic model, as the stage ``elastic_model`` states it."""

from typing import NamedTuple

import xarray as xr

from .verdicts import HARDNESS, USUAL

#: Reasons other than the pressure for a verdict that is not good.
SLOPE, LOAD = "slope", "load"


class Limits(NamedTuple):
    """Pressure limits of the elastic model of a material, and their source.

    The criterion is :data:`HARDNESS`, :data:`STRENGTH` or, where neither is stated, :data:`USUAL`,
    with the ends of that strength, MPa (one value where it is stated). The model is good up to a
    real mean pressure ``good_to`` and poor from ``poor_from`` on, MPa.
    """

    criterion: str
    strength_low: float
    strength_high: float
    good_to: float
    poor_from: float

    @property
    def words(self) -> str:
        """Criterion and its strength: "joint wall strength (80 MPa)"."""
        if self.criterion != USUAL:
            return f"{self.criterion} ({pressure_words(self.strength_low)})"
        ends = f"{self.strength_low:.3g} to {self.strength_high:.3g}"
        return f"{USUAL}, none being stated (E/1000 to E/200: {ends} MPa)"


class Validity(NamedTuple):
    """Verdict on the contact model, elastic or crushing, and its reason.

    The verdict is :data:`GOOD`, :data:`IN_PART`, :data:`POOR` or :data:`NOT_JUDGED`; ``pressure``
    is the real mean pressure judged, MPa, NaN if missing. The reason is one line on pressure and
    slope, the deciding one first: ``decided_by`` is :data:`SLOPE`, :data:`LOAD` or "pressure" of a
    verdict that is not good.
    """

    verdict: str
    pressure: float
    reason: str
    decided_by: str
    limits: Limits

    @classmethod
    def of(cls, state: xr.Dataset) -> "Validity":
        """The verdict on one state of the stage ``elastic_model``."""
        limits = Limits(*(state[name].item() for name in Limits._fields))
        verdict, pressure, reason, by = (state[name].item() for name in cls._fields[:-1])
        return cls(verdict, pressure, reason, by, limits)

    @property
    def capped(self) -> bool:
        """True if a stated hardness caps the pressure, which then is no test of the model."""
        return self.limits.criterion == HARDNESS

    @property
    def stated(self) -> bool:
        """True if a stated strength or hardness judges the pressure."""
        return self.limits.criterion != USUAL


def pressure_words(pressure: float) -> str:
    """Pressure in MPa, the unit of the strength it is compared with."""
    return f"{float(f'{pressure:.3g}'):g} MPa"
