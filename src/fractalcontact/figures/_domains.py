"""What the figures of contact domains share: states drawn, both estimates, size effect."""

import textwrap
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.ticker import MaxNLocator, NullLocator

from ..fitting import FEWEST_POINTS
from ..scaling import RESOLUTION, hausdorff_measure, nominal_pressure
from ..sweep import window_sides
from ._mechanics import TOWARDS, spread
from .common import COLOURS, MARKERS, force_label, group, map_offset, settings_of

PAPER = "Borri-Brunetto, Carpinteri and Chiaia (1999)"

#: Domains of fewer nodes than this get rings where the nodes are too small to be seen in print:
#: more than so many along a side of the map.
FEW_NODES = 100
FINE_NODES = 100


@dataclass(frozen=True)
class Estimate:
    """One estimator's Delta_sigma under every load, with its 95 % interval.

    Attributes
    ----------
    key : str
        "area" or "box".
    label, symbol : str
        What it is estimated from, for captions and for legends.
    value, low, high : (n_load,) ndarray
        NaN where there is none.
    reason : list of str
        Why there is none, else "".
    """

    key: str
    label: str
    symbol: str
    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    reason: list

    def text(self, i):
        """Delta_sigma under the i-th load in words."""
        return self.reason[i] or interval(self.value[i], self.low[i], self.high[i])

    def entry(self, i):
        """Delta_sigma under the i-th load for a legend."""
        return wrapped(self.reason[i]) if self.reason[i] else rf"$\Delta_\sigma$ = {self.text(i)}"

    @property
    def style(self):
        """Colour, marker and line that stand for the estimator in every figure."""
        first = self.key == "area"
        return {
            "color": COLOURS[1 if first else 2],
            "marker": MARKERS[0 if first else 1],
            "linestyle": "-" if first else "--",
            "markerfacecolor": COLOURS[1] if first else "white",
        }


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
    def of(cls, atlas, name):
        """The states of a specimen that the study wants drawn."""
        settings = settings_of(atlas, name)
        direction = settings["contact_directions"][0]
        stages = {stage: group(atlas, stage, name) for stage in ("contact", "domains", "scaling")}
        offset = map_offset(settings, stages["scaling"]["offset"].values)
        chosen = {
            stage: data.sel(direction=direction).sel(offset=offset, method="nearest")
            for stage, data in stages.items()
        }
        return cls(settings, group(atlas, "specimens", name), direction, offset, **chosen)

    @property
    def forces(self):
        """F of every load, N, ascending."""
        return self.scaling["load"].values

    @property
    def sides(self):
        """Sides (y, x) of the window, mm."""
        return window_sides(self.specimen)

    @property
    def side(self):
        """b, mm: side of the square that has the window's area."""
        return float(np.sqrt(np.prod(self.sides)))

    @property
    def finest(self):
        """Multiple k of the scan's spacing at the finest resolution."""
        return int(self.scaling[RESOLUTION].min())

    @property
    def place(self):
        """Where the contact is, in words."""
        if self.direction == "none":
            return "against a rigid plane"
        return f"at an offset v = {short(self.offset)} mm towards {TOWARDS[self.direction]}"

    @property
    def estimates(self):
        """Both estimates of Delta_sigma; that of the box counts at the finest resolution."""
        area, box = self.scaling, self.domains.sel(resolution=self.finest)
        too_few = [
            ""
            if np.isfinite(value)
            else f"no fit: A_r at {n} of the {FEWEST_POINTS} resolutions needed"
            for value, n in zip(area["delta_sigma"].values, area["n"].values, strict=True)
        ]
        no_dimension = [f"no dimension: {text}" if text else "" for text in box["reason"].values]
        return tuple(
            Estimate(
                key,
                label,
                symbol,
                *(data[f"delta_sigma{end}"].values for end in ("", "_low", "_high")),
                reason,
            )
            for key, label, symbol, data, reason in (
                ("area", "A_r(s)", "$A_r(s)$", area, too_few),
                ("box", "box counting", "box counting", box, no_dimension),
            )
        )

    def fit_ranges(self, load=None):
        """In words: what the estimates are fitted over, under one load, or the widest of all."""
        which = slice(None) if load is None else [load]
        scaling = self.scaling.isel(load=which)
        box = self.domains.sel(resolution=self.finest).isel(load=which)
        used = np.isfinite(scaling["sigma_n"] * scaling["delta_sigma"]).any("load")
        spacing = scaling["spacing"].where(used)
        spans = (
            ("A_r(s) over s", spacing, spacing),
            ("box counts over r", box.fit_min, box.fit_max),
        )
        words = [
            f"{what} = {short(low.min())} to {short(high.max())} mm"
            for what, low, high in spans
            if np.isfinite(low).any()
        ]
        widest = ", at most" if load is None else ""
        return f"fitted{widest}: {' and '.join(words)}" if words else "no fits"

    def domain(self, factor, load):
        """Contact domain (y, x) at ``factor`` times the scan's spacing under the load-th load."""
        return self.contact[f"in_contact_{factor}"].isel(load=load).values

    @property
    def finest_spacing(self):
        """s at the finest resolution, mm."""
        return float(self.scaling["spacing"].min())

    def nearest_load(self, force):
        """Index of the load nearest to a force in N."""
        return int(np.argmin(np.abs(self.forces - force)))

    def spread_loads(self, most, including=None):
        """Indices of up to ``most`` loads: first and last, evenly between, and a given one."""
        chosen = spread(len(self.forces), most)
        if including is not None:
            chosen[np.argmin(np.abs(chosen - including))] = including
        return np.unique(chosen)


def opening(number, loading):
    """First words of a caption."""
    return f"After Fig. {number} of {PAPER}: {loading.settings['label']}, {loading.place}."


def number(value, digits=2):
    """A number to some decimals, never a negative zero."""
    return f"{round(float(value), digits) + 0.0:.{digits}f}"


def short(value):
    """Three digits of a number, without an exponent up to a million."""
    return f"{float(f'{float(value):.3g}'):g}"


def wrapped(text):
    """Text broken into lines that fit under one panel of three."""
    return textwrap.fill(text, 34)


def legend_below(axes):
    """A legend under the axes, where it hides nothing."""
    # Padding in heights of the font: room for the ticks and the label of the axis.
    axes.legend(loc="upper left", bbox_to_anchor=(0, 0), borderaxespad=4.8)


def interval(value, low, high):
    """A value with its 95 % interval in words."""
    return f"{number(value)} [{number(low)}, {number(high)}]"


def draw_domain(axes, domain, sides):
    """Contact domain in black, true to scale, in mm from the window's corner.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    domain : (ny, nx) bool ndarray
    sides : (float, float)
        Of the window (y, x), mm.
    """
    axes.imshow(domain, cmap="Greys", vmin=0, vmax=1, extent=(0, sides[1], 0, sides[0]))
    nodes = np.argwhere(domain)
    if len(nodes) < FEW_NODES and max(domain.shape) > FINE_NODES:
        y, x = ((nodes + 0.5) * np.divide(sides, domain.shape)).T
        axes.plot(x, y, "o", ms=4, mfc="none", mec=COLOURS[2], mew=0.7, clip_on=False)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))


def label_spacings(axes, spacings):
    """A logarithmic axis of few spacings s, each with its own tick."""
    axes.set_xscale("log")
    axes.set_xticks(spacings, [short(s) for s in spacings])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xlabel("spacing $s$ (mm)")


def fractal_pressure(scaling, key, delta):
    """sigma* = F / H_D under one load if the contact domain has the dimension ``delta``.

    Parameters
    ----------
    scaling : xr.Dataset
        Under one load.
    key : {"area", "box"}
        H_D is the geometric mean over the resolutions fitted, or that of the finest one.
    delta : float

    Returns
    -------
    float
        In N mm^-delta.
    """
    # sigma_n was kept at the resolutions that were fitted, and no others.
    fitted = scaling["area"].where(np.isfinite(scaling["sigma_n"]))
    area = fitted if key == "area" else scaling["area"].sel(resolution=[scaling.resolution.min()])
    measure = hausdorff_measure(scaling["spacing"], area, delta)
    return float(scaling["load"] / np.exp(np.log(measure).mean(RESOLUTION)))


def size_effect(loading, estimate, i, sides):
    """Eq. 6 under the i-th load: nominal pressure over the side b of the joint.

    Parameters
    ----------
    loading : Loading
    estimate : Estimate
    i : int
    sides : (n,) ndarray
        b, mm.

    Returns
    -------
    (3, n) ndarray
        sigma_0 in MPa for Delta_sigma and both ends of its interval, sigma* going with each; NaN
        where there is no Delta_sigma.
    """
    scaling = loading.scaling.isel(load=i)
    dimensions = (estimate.value[i], estimate.low[i], estimate.high[i])
    pressures = [fractal_pressure(scaling, estimate.key, delta) for delta in dimensions]
    return np.array(
        [nominal_pressure(p, d, sides) for p, d in zip(pressures, dimensions, strict=True)]
    )


def trend(forces, value, low, high, *, rising):
    """In words: whether a value rises, or falls, with the load as the paper claims.

    Parameters
    ----------
    forces, value, low, high : (n,) array_like
        F in N; the value and its interval, NaN where there is none.
    rising : bool
        The paper's claim.

    Returns
    -------
    str
        Holds if the value moves the right way by more than the intervals at both ends.
    """
    known = np.flatnonzero(np.isfinite(value))
    if len(known) < 2:
        return "this cannot be told, as fewer than two loads have a value"
    first, last = known[0], known[-1]
    steps = np.diff(np.asarray(value)[known]) * (1 if rising else -1)
    ends = " to ".join(
        f"{interval(value[i], low[i], high[i])} at {force_label(forces[i])}" for i in (first, last)
    )
    if steps.sum() <= 0:
        return f"this does not hold ({ends})"
    apart = low[last] > high[first] if rising else high[last] < low[first]
    verdict = "this holds" if apart else "this is not established, the intervals overlap"
    every = "every step" if (steps > 0).all() else f"{(steps > 0).sum()} of {len(steps)} steps"
    return f"{verdict} ({ends}; {'up' if rising else 'down'} at {every})"


def disagreement(scaling):
    """In words: how far the two estimates of Delta_sigma are apart, under one load or several."""
    compared = scaling.where(np.isfinite(scaling["difference"]))
    difference = np.atleast_1d(compared["difference"].values)
    n = int(np.isfinite(difference).sum())
    if n == 0:
        return "The two estimates cannot be compared, one of them is missing."
    disagree = int(np.sum(compared["disagree"].values == 1))
    if difference.size == 1:
        ends = (compared[f"difference{end}"].item() for end in ("", "_low", "_high"))
        verdict = "they disagree" if disagree else "their intervals do not tell them apart"
        return f"A_r(s) less box counting is {interval(*ends)}: {verdict}."
    return (
        f"A_r(s) less box counting is {number(np.nanmin(difference))} to "
        f"{number(np.nanmax(difference))}; the two disagree, beyond their intervals, at {disagree} "
        f"of the {n} loads where both exist."
    )
