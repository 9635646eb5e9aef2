"""Slides of joints: dilatancy of specimens, and of synthetic joints with or without roll-off."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr
from xarray import DataTree

from fractalcontact.core.estimate import EXPONENT, Estimate
from fractalcontact.core.subject import Subject, configuration_of
from fractalcontact.core.units import quantity
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.words import short

#: Kind of the synthetic joints whose spectrum is flat above a wavelength.
WITH_ROLL_OFF = "with_roll_off"

#: Variables of a specimen, and those of the synthetic joints that correspond.
DRAWN = {
    "rigid_dilatancy": "joint_dilatancy",
    "composite_rms": "joint_rms",
    "composite_rms_expected": "joint_rms_expected",
    "dilatancy_over_rms": "joint_dilatancy_over_rms",
}


@dataclass(frozen=True)
class Slide:
    """Dilatancy of one specimen, or of many synthetic joints, as they slide.

    Attributes
    ----------
    label : str
    data : xr.Dataset
        Variables of :data:`DRAWN` over (direction_or_seed, rigid_offset): means and bands are
        over the first.
    roll_off : float or None
        Wavelength above which the spectrum is flat; NaN for a scan, None where there is none.
    uncorrelated : float
        Offset where the faces lose all correlation; NaN if not reached.
    matched : bool
        Whether the upper face is the match of the lower one, so that sliding begins flush.
    slope : Estimate or None
        Of many synthetic joints: slope of delta_r from ``since`` on.
    since : float
    trend : str
        Of many synthetic joints, as the stage ``roll_off`` has it.
    """

    label: str
    data: xr.Dataset
    roll_off: float | None
    uncorrelated: float = np.nan
    matched: bool = True
    slope: Estimate | None = None
    since: float = np.inf
    trend: str = ""

    @classmethod
    def of(cls, atlas: DataTree, name: str) -> "Slide":
        """The slide of a specimen of the atlas."""
        subject = Subject.of(atlas, name)
        joint = subject["joints"]
        return cls(
            label=subject.label,
            data=_over_rows(joint[list(DRAWN)], "direction"),
            roll_off=_roll_off(atlas, name),
            uncorrelated=float(joint["mean_uncorrelated_offset"]),
            matched=subject["specimens"].attrs["opposite"] == "match",
        )

    @classmethod
    def synthetic(cls, joints: xr.Dataset) -> "Slide":
        """Slides of synthetic joints with, or without, a roll-off; means of their directions."""
        rolled = joints["surface"].item() == WITH_ROLL_OFF
        roll_off = float(joints.attrs["roll_off"]) if rolled else None
        words = f"with a roll-off at {short(roll_off)} mm" if roll_off else "without a roll-off"
        data = joints[list(DRAWN.values())].rename({new: old for old, new in DRAWN.items()})
        data = data.drop_vars("surface").assign_coords(
            seed=[f"seed {n}" for n in data["seed"].values]
        )
        return cls(
            label=f"{joints.sizes['seed']} synthetic joints {words}",
            data=_over_rows(data, "seed"),
            roll_off=roll_off,
            slope=Estimate.read(joints, "slope", scale=EXPONENT),
            since=float(joints["slope_offset_min"]),
            trend=joints["trend"].item(),
        )

    @property
    def v(self) -> np.ndarray:
        """Offsets (n,), mm."""
        return self.data["rigid_offset"].values

    @property
    def ratios(self) -> np.ndarray:
        """delta_r / sigma_z (n,), mean of directions or seeds; missing where faces are flush."""
        means = self.data["dilatancy_over_rms"].mean("direction_or_seed", skipna=False).values
        return means[(self.v > 0) & np.isfinite(means)]

    @property
    def slope_words(self) -> str:
        """Slope of many synthetic joints, in a line of its own; empty for a specimen."""
        if self.slope is None:
            return ""
        return (
            f"\nslope {self.slope.text()} mm/mm" if self.slope.known else "\nslope too few offsets"
        )

    def table(self) -> pd.DataFrame:
        """Every direction of one specimen, or every synthetic joint."""
        roll_off = np.nan if self.roll_off is None else self.roll_off
        ends = {"roll_off_mm": roll_off, "mean_uncorrelated_offset_mm": self.uncorrelated}
        return rows(self.data, *DRAWN, specimen=self.label).assign(**ends)


def _roll_off(atlas, name):
    """Roll-off of an embedded surface, mm; None without one, NaN for a scan."""
    embedded = configuration_of(atlas)["study"].get("embedded", {})
    if name not in embedded:
        return np.nan
    stated = embedded[name].get("roll_off")
    return None if stated is None else quantity(stated, "length", f"embedded.{name}.roll_off")


def _over_rows(data, rows):
    data = data.rename({rows: "direction_or_seed"})
    return data.transpose("direction_or_seed", "rigid_offset")


def without_repeats(slides: Sequence[Slide]) -> list[Slide]:
    """Different slides; specimens with the same faces but another material share one."""
    found: list[Slide] = []
    for slide in slides:
        for n, other in enumerate(found):
            if _alike(slide, other):
                longer, shorter = sorted((other, slide), key=lambda one: -one.v.size)
                found[n] = replace(longer, label=f"{longer.label}; the same: {shorter.label}")
                break
        else:
            found.append(slide)
    return found


def _alike(slide, other):
    """True if one slide is the other, or begins as it does."""
    n = min(slide.v.size, other.v.size)
    names = ["rigid_dilatancy", "composite_rms"]
    one, two = (each.data[names].isel(rigid_offset=slice(n)) for each in (slide, other))
    return one.equals(two)


def least_and_largest(slides: Sequence[Slide]) -> list[float]:
    """Ends of delta_r / sigma_z over all slides that begin flush; empty without one."""
    ratios = np.concatenate([slide.ratios for slide in slides if slide.matched])
    return [ratios.min(), ratios.max()] if ratios.size else []
