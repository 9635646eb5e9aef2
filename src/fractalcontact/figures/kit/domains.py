"""Contact domains and both estimates of Delta_sigma, as the figures of domains draw them."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.subject import Subject
from ...core.text import loads_of, number
from ...core.verdicts import BEYOND_BOTH, BEYOND_RANDOM, LIKE_CUT, UNDETERMINED
from .drawing import COLOURS, MARKERS, spread
from .verdicts import predicate, verdict_words

#: Statements that judge the rise of Delta_sigma with the load, by estimate.
RISES = {"area": "dimension_rises_by_area", "box": "dimension_rises_by_boxes"}
#: Estimates of Delta_sigma by name in the atlas: their words and symbols.
_ESTIMATORS = {"area": ("A_r(s)", "$A_r(s)$"), "box": ("box counting", "box counting")}

#: Verdicts by which a domain differs from a null model.
_DIFFERENT = {"random": (BEYOND_BOTH, BEYOND_RANDOM, LIKE_CUT), "cut": (BEYOND_BOTH,)}


@dataclass(frozen=True, kw_only=True)
class DeltaSigma(Estimate):
    """One estimator's Delta_sigma under every load, (n_load,).

    Its key is "area" or "box", its symbol what Delta_sigma is estimated from, for legends.
    """

    key: str
    symbol: str

    @property
    def name(self) -> str:
        """Name of its variable in the stage ``scaling``."""
        return f"delta_sigma_{self.key}"

    def at(self, i: int) -> str:
        """Delta_sigma under the i-th load in words, and why it or its interval is missing."""
        reason = str(self.reason[i])
        if reason and self.known[i]:
            return f"{number(self.value[i])}, {reason}"
        return reason or self[i].text()

    @property
    def determined(self) -> np.ndarray:
        """True if each value is determined."""
        return np.array([self[i].determined for i in range(np.size(self.value))])

    def number(self, i: int) -> str:
        """Delta_sigma under the i-th load for a sentence, without interval or reason."""
        return number(self.value[i]) if self.known[i] else "none"

    def eq6_exponent(self, i: int) -> str:
        """Exponent of the side b in eq. 6, Delta_sigma - 2, under the i-th load."""
        return number(self.value[i] - 2) if self.known[i] else "none"

    def entry(self, i: int) -> str:
        """Delta_sigma under the i-th load for a legend, which has no room for the reason."""
        text = self.at(i).split(":")[0]
        if not self.known[i]:
            return text
        return rf"$\Delta_\sigma$ {'' if text.startswith(UNDETERMINED) else '= '}{text}"

    @property
    def style(self) -> dict:
        """Colour, marker and line that stand for the estimator in every figure."""
        first = self.key == "area"
        return {
            "color": COLOURS[1 if first else 2],
            "marker": MARKERS[0 if first else 1],
            "linestyle": "-" if first else "--",
            "markerfacecolor": COLOURS[1] if first else "white",
        }


def estimates_of(states: xr.Dataset) -> tuple[DeltaSigma, ...]:
    """Both estimates of Delta_sigma, from the stage ``scaling`` over loads."""
    return tuple(
        DeltaSigma(
            *Estimate.read(states, f"delta_sigma_{key}").ends,
            reason=states[f"delta_sigma_{key}_reason"].values,
            scale=DIMENSION,
            key=key,
            symbol=symbol,
        )
        for key, (_, symbol) in _ESTIMATORS.items()
    )


def prefractals(subject: Subject, stage: str) -> xr.Dataset:
    """A stage in the reported direction and at the reported offset, over resolutions and loads."""
    return subject.reported.at_offset(subject.along(stage)).sortby("resolution")


def contact_domain(subject: Subject, resolution: int, load: int) -> np.ndarray:
    """Contact domain (y, x) at the reported offset, at a resolution under the load-th load."""
    fields = subject.states("contact")[f"in_contact_{resolution}"]
    return fields.isel(normal_force=load).values == 1


def spread_loads(n: int, most: int, including: int | None = None) -> np.ndarray:
    """Indices of up to ``most`` of n loads: first and last, evenly between, and a given one."""
    chosen = spread(n, most)
    if including is not None:
        chosen[np.argmin(np.abs(chosen - including))] = including
    return np.unique(chosen)


def departures(counts: xr.Dataset) -> dict[str, str]:
    """Loads at which domains differ from each null model, in words; empty without a comparison.

    `counts` is the stage ``domains`` over loads, of which some are compared with null models.
    """
    verdicts, words = counts["null_verdict"].values, {}
    for null, differ in _DIFFERENT.items():
        compared = np.isfinite(counts[f"local_slope_{null}_p"].values)
        some = loads_of(int(np.isin(verdicts[compared], differ).sum()), int(compared.sum()))
        words[null] = some if compared.any() else ""
    return words


def rise_words(atlas: DataTree, name: str) -> str:
    """Verdicts on the rise of Delta_sigma with the load, by both estimates."""
    return ", ".join(
        f"{predicate(verdict_words(atlas, name, RISES[key], numbers=False))} by {label}"
        for key, (label, _) in _ESTIMATORS.items()
    )


def size_axes(axes: Axes) -> None:
    """Logarithmic axes of sigma_0 over b, as eq. 6 is drawn."""
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("side $b$ of the joint (mm)")
    axes.set_ylabel(r"nominal pressure $\sigma_0$ (MPa)")
