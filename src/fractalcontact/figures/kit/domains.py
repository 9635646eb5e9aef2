"""Contact states that the figures of domains draw, and both estimates of Delta_sigma."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from xarray import DataTree

from ...core.determined import differs, is_determined
from ...core.estimate import DIMENSION, Estimate
from ...core.fitting import FEWEST_POINTS
from ...core.labels import loads_of
from ...core.limits import MIN_NODES, WIDEST
from ...core.verdicts import UNDETERMINED
from ...core.window import window_sides
from ...domain.renormalisation import RESOLUTION
from ...mechanics.states import chosen_offset
from .drawing import COLOURS, MARKERS, group, nearest_load, settings_of, spread
from .verdicts import verdict_words
from .words import place

#: Statements that judge the rise of Delta_sigma with the load, by estimate.
RISES = {"area": "dimension_rises_by_area", "box": "dimension_rises_by_boxes"}


@dataclass(frozen=True, kw_only=True)
class DeltaSigma(Estimate):
    """One estimator's Delta_sigma under every load, (n_load,).

    Attributes
    ----------
    key : str
        "area" or "box".
    label, symbol : str
        What it is estimated from, for captions and for legends.
    """

    key: str
    label: str
    symbol: str

    def at(self, i: int) -> str:
        """Delta_sigma under the i-th load in words, or why there is none."""
        return self.reason[i] or self[i].text()

    @property
    def determined(self) -> np.ndarray:
        """Whether each value is determined: not where its interval is too wide to say anything."""
        return np.array([is_determined(*ends) for ends in zip(self.low, self.high, strict=True)])

    def entry(self, i: int) -> str:
        """Delta_sigma under the i-th load for a legend, which has no room for the reason."""
        if self.reason[i]:
            return self.reason[i].split(":")[0]
        text = self.at(i)
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


def fall_reason(by_area: DeltaSigma, i: int) -> str:
    """What decides whether A_r falls: where the interval of the exponent lies, however wide.

    Parameters
    ----------
    by_area : DeltaSigma
        Delta_sigma by A_r(s).
    i : int
        Index of the load.
    """
    low, high = by_area.low[i], by_area.high[i]
    if by_area.reason[i] or not np.isfinite([low, high]).all():
        return ""
    if low <= 2 <= high:
        return "the interval of Delta_sigma includes 2"
    side, way = ("below", "falls as s does") if high < 2 else ("above", "grows as s falls")
    if high - low > WIDEST:
        return f"the interval of Delta_sigma lies {side} 2, but is wider than {WIDEST:g}: no law"
    return f"the whole interval of Delta_sigma lies {side} 2: A_r {way}"


@dataclass(frozen=True)
class Loading:
    """One joint at the offset whose contact domains are drawn, under every load.

    Attributes
    ----------
    settings : dict
    specimen : xr.Dataset
    direction : str
    offset : float
        mm.
    contact, domains, scaling : xr.Dataset
        Of the atlas, at this direction and offset.
    """

    settings: dict
    specimen: xr.Dataset
    direction: str
    offset: float
    contact: xr.Dataset
    domains: xr.Dataset
    scaling: xr.Dataset

    @classmethod
    def of(cls, atlas: DataTree, name: str) -> "Loading":
        """The states of a specimen that the study wants drawn."""
        settings = settings_of(atlas, name)
        direction = settings["contact_directions"][0]
        stages = {stage: group(atlas, stage, name) for stage in ("contact", "domains", "scaling")}
        offset = chosen_offset(settings["map_offset"], stages["scaling"]["offset"].values)
        chosen = {
            stage: data.sel(direction=direction).sel(offset=offset, method="nearest")
            for stage, data in stages.items()
        }
        return cls(settings, group(atlas, "specimens", name), direction, offset, **chosen)

    @property
    def forces(self) -> np.ndarray:
        """F of every load, N, ascending."""
        return self.scaling["normal_force"].values

    @property
    def sides(self) -> tuple[float, float]:
        """Sides (y, x) of the window, mm."""
        return window_sides(self.specimen)

    @property
    def side(self) -> float:
        """b, mm: side of the square that has the window's area."""
        return float(np.sqrt(np.prod(self.sides)))

    @property
    def finest(self) -> int:
        """Multiple k of the scan's spacing at the finest resolution."""
        return int(self.scaling[RESOLUTION].min())

    @property
    def place(self) -> str:
        """Where the contact is, in words."""
        return place(self.direction, self.offset)

    @property
    def title(self) -> tuple[str, str]:
        """Which specimen, and where its contact is: parts of a headline."""
        return self.settings["label"], self.place

    @property
    def map_load(self) -> int:
        """Index of the load whose contact domains the study wants drawn."""
        return nearest_load(self.forces, self.settings["map_load"], self.specimen)

    @property
    def counts(self) -> xr.Dataset:
        """Box counts at the finest resolution, under every load."""
        return self.domains.sel(resolution=self.finest)

    @property
    def estimates(self) -> tuple[DeltaSigma, ...]:
        """Both estimates of Delta_sigma; that of the box counts at the finest resolution."""
        area, box = self.scaling, self.counts
        too_few = [
            ""
            if np.isfinite(value)
            else f"no fit: A_r large enough at {n} of the {FEWEST_POINTS} resolutions needed"
            for value, n in zip(area["delta_sigma"].values, area["n"].values, strict=True)
        ]
        no_dimension = [f"no dimension: {text}" if text else "" for text in box["reason"].values]
        return tuple(
            DeltaSigma(
                *Estimate.read(data, "delta_sigma").ends,
                reason=reason,
                scale=DIMENSION,
                key=key,
                label=label,
                symbol=symbol,
            )
            for key, label, symbol, data, reason in (
                ("area", "A_r(s)", "$A_r(s)$", area, too_few),
                ("box", "box counting", "box counting", box, no_dimension),
            )
        )

    def domain(self, factor: int, load: int) -> np.ndarray:
        """Contact domain (y, x) at ``factor`` times the scan's spacing under the load-th load."""
        return self.contact[f"in_contact_{factor}"].isel(normal_force=load).values == 1

    def spread_loads(self, most: int, including: int | None = None) -> np.ndarray:
        """Indices of up to ``most`` loads: first and last, evenly between, and a given one."""
        chosen = spread(len(self.forces), most)
        if including is not None:
            chosen[np.argmin(np.abs(chosen - including))] = including
        return np.unique(chosen)


def departures(counts: xr.Dataset) -> str:
    """Words on the loads at which domains differ from their null models.

    Parameters
    ----------
    counts : xr.Dataset
        Of the stage ``domains``, over load, of domains that are looked at closely.
    """
    p = {null: counts[f"local_slope_{null}_p"].values for null in ("random", "cut")}
    compared = {null: values[np.isfinite(values)] for null, values in p.items()}
    if not compared["random"].size:
        return f"No domain has the {MIN_NODES} nodes that a comparison with null models needs."
    random, cut = (loads_of(sum(map(differs, p)), p.size) for p in compared.values())
    beside = f", from bearing-area cuts at {cut}" if compared["cut"].size else ""
    return f"Domains of {MIN_NODES} nodes or more differ from random nodes at {random}{beside}."


def rise_words(atlas: DataTree, name: str, loading: Loading, *, numbers: bool = True) -> str:
    """Verdicts on the rise of Delta_sigma with the load, by both estimates.

    Parameters
    ----------
    atlas : DataTree
        With the stage ``statements``.
    name : str
        The specimen.
    loading : Loading
    numbers : bool, optional
        Whether the numbers follow that decide.
    """
    return ", ".join(
        f"by {estimate.label} {verdict_words(atlas, name, RISES[estimate.key], numbers=numbers)}"
        for estimate in loading.estimates
    )


def disagreement(scaling: xr.Dataset) -> str:
    """Words on how far the estimates of Delta_sigma are apart, under one load or several."""
    compared = scaling.where(np.isfinite(scaling["difference"]))
    difference = np.atleast_1d(compared["difference"].values)
    n = int(np.isfinite(difference).sum())
    if n == 0:
        return "One estimate is missing."
    disagree = int(np.sum(compared["disagree"].values == 1))
    if difference.size == 1:
        return "They disagree." if disagree else "Their intervals overlap."
    return f"They disagree at {disagree} of {n} loads."
