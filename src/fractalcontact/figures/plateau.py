"""Why rigid dilatancy has a plateau: it follows the composite topography, over a whole study."""

import json
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..fitting import fit_line, mean_interval, without_mean_plane
from ..specimen import faces, window_slices
from ..units import quantity
from ._words import PAPER, estimate, short
from .common import (
    LINES,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    heading,
    legends_below,
    letter,
    settings_of,
)

#: Specimens whose largest offsets differ by more than this are drawn in decades.
WIDE = 5

#: A change over the second half of v below this share of the mean is called level.
LEVEL = 0.1

#: How what explains the curves is drawn.
_EXPECTED = {"lw": 3, "alpha": 0.35, "ls": "-"}
_ROLL_OFF, _UNCORRELATED = "v", "o"
_MARK = {"mfc": "white", "ms": 6, "zorder": 3}


@dataclass(frozen=True)
class Slide:
    """What one specimen does as it slides, mm; means and bands are over its directions.

    Attributes
    ----------
    label : str
    directions : list of str
    v : (n,) ndarray
        Offsets.
    opened, spread : (directions, n) ndarray
        Rigid dilatancy delta_r, and standard deviation sigma_z of the composite topography.
    expected : (directions, n) ndarray
        sigma_z from the heights of the faces and their correlation.
    correlation : (directions, n) ndarray
        Of the two faces.
    face : float
        Standard deviation sigma of a face in the window.
    roll_off : float or None
        Wavelength above which the spectrum is flat; NaN for a scan, None where there is none.
    uncorrelated : float
        Offset where the faces lose all correlation, mean of the directions; NaN if not reached.
    matched : bool
        Whether the upper face is the match of the lower one, so that sliding begins flush.
    """

    label: str
    directions: list
    v: np.ndarray
    opened: np.ndarray
    spread: np.ndarray
    expected: np.ndarray
    correlation: np.ndarray
    face: float
    roll_off: float | None
    uncorrelated: float
    matched: bool

    @classmethod
    def of(cls, atlas, name):
        """The slide of a specimen of the atlas."""
        joint = group(atlas, "joints", name)
        specimen = group(atlas, "specimens", name)
        window = window_slices(specimen)
        lower, upper = (float(np.std(without_mean_plane(z[window]))) for z in faces(specimen))
        rho = joint["face_correlation"].values
        square = lower**2 + upper**2 - 2 * rho * lower * upper
        lost = joint["uncorrelated_offset"].values
        return cls(
            label=settings_of(atlas, name)["label"],
            directions=joint["direction"].values.tolist(),
            v=joint["rigid_offset"].values,
            opened=joint["rigid_dilatancy"].values,
            spread=joint["composite_rms"].values,
            expected=np.sqrt(np.maximum(square, 0)),
            correlation=rho,
            face=float(np.sqrt((lower**2 + upper**2) / 2)),
            roll_off=_roll_off(atlas, name),
            uncorrelated=float(lost[np.isfinite(lost)].mean())
            if np.isfinite(lost).any()
            else np.nan,
            matched=specimen.attrs["opposite"] == "match",
        )

    @property
    def ratio(self):
        """delta_r / sigma_z; NaN where faces are flush."""
        return np.divide(
            self.opened, self.spread, out=np.full(self.spread.shape, np.nan), where=self.spread > 0
        )

    @property
    def second_half(self):
        """Which offsets are in the second half of those possible."""
        return self.v >= self.v[-1] / 2


def draw(atlas, names):
    """Dilatancy, spread of the composite topography and their ratio for all that slides.

    Parameters
    ----------
    atlas : xr.DataTree
    names : sequence of str
        Specimens of the study, of which at least one slides; the others are passed over.

    Returns
    -------
    Drawing
    """
    slides = [
        Slide.of(atlas, name) for name in names if settings_of(atlas, name)["opposite"] != "flat"
    ]
    figure = Figure(figsize=(WIDTH, 3.6 + 0.15 * len(slides)))
    panels = figure.subplots(1, 3, sharex=True)
    _prepare(panels, slides)
    for n, slide in enumerate(slides):
        _draw_slide(panels, n, slide)
    _start_at_zero(panels)
    if not any(slide.matched for slide in slides):
        panels[2].text(0.5, 0.5, "no matching faces", transform=panels[2].transAxes, ha="center")
    legends_below(figure, entries(panels[0]), _marks())
    table = pd.concat([_table(slide) for slide in slides], ignore_index=True)
    return Drawing(figure, table, _caption(slides))


def _roll_off(atlas, name):
    """Roll-off of an embedded surface, mm: None if it has none, NaN for a scan."""
    embedded = json.loads(atlas.attrs["configuration"])["study"].get("embedded", {})
    if name not in embedded:
        return np.nan
    stated = embedded[name].get("roll_off")
    return None if stated is None else quantity(stated, "length", f"embedded.{name}.roll_off")


def _draw_slide(panels, n, slide):
    colour = colour_of(n)
    for axes, values in zip(panels, (slide.opened, slide.spread, slide.ratio), strict=True):
        if axes is panels[2] and not slide.matched:
            continue  # its dilatancy counts from faces that were apart already
        mean, low, high = values.mean(axis=0), values.min(axis=0), values.max(axis=0)
        if axes.get_yscale() == "log":
            mean, low, high = (np.where(y > 0, y, np.nan) for y in (mean, low, high))
        axes.fill_between(slide.v, low, high, color=colour, alpha=0.15, lw=0)
        axes.plot(slide.v, mean, color=colour, ls=LINES[n % 4], label=slide.label)
    panels[1].plot(slide.v, slide.expected.mean(axis=0), color=colour, **_EXPECTED)
    for at, marker in ((slide.roll_off, _ROLL_OFF), (slide.uncorrelated, _UNCORRELATED)):
        if at is not None and slide.v[0] <= at <= slide.v[-1]:
            for axes, values in zip(panels[:2], (slide.opened, slide.spread), strict=True):
                height = np.interp(at, slide.v, values.mean(axis=0))
                axes.plot(at, height, marker, color=colour, **_MARK)


def _marks():
    """Entries of the legend for what is marked on every curve."""
    return [
        heading("bands: from the least to the most of the directions"),
        Line2D([], [], color="0.3", label=r"(b) $\sqrt{2}\,\sigma\,\sqrt{1-\rho(v)}$", **_EXPECTED),
        Line2D([], [], ls="none", marker=_ROLL_OFF, color="0.3", label="roll-off length", **_MARK),
        Line2D(
            [],
            [],
            ls="none",
            marker=_UNCORRELATED,
            color="0.3",
            label="faces uncorrelated",
            **_MARK,
        ),
    ]


def _prepare(panels, slides):
    """Scales, labels and letters; decades where one specimen slides much farther than another."""
    opened, spread, ratio = panels
    farthest = [slide.v[-1] for slide in slides]
    decades = max(farthest) > WIDE * min(farthest)
    for axes in panels:
        axes.set_xlabel("offset $v$ (mm)")
        if decades:
            axes.set_xscale("log", nonpositive="mask")
    if decades:
        opened.set_yscale("log", nonpositive="mask")
        spread.set_yscale("log", nonpositive="mask")
    opened.set_ylabel(r"rigid dilatancy $\delta_r$ (mm)")
    spread.set_ylabel(r"spread of the composite $\sigma_z$ (mm)")
    ratio.set_ylabel(r"$\delta_r/\sigma_z$ (–)")
    for axes, which, title in zip(panels, "abc", ("dilatancy", "spread", "ratio"), strict=True):
        letter(axes, which, title)


def _start_at_zero(panels):
    """Axes that are not in decades begin at zero, or below it where dilatancy does."""
    for axes in panels:
        if axes.get_xscale() == "linear":
            axes.set_xlim(left=0)
        if axes.get_yscale() == "linear":
            lowest = axes.dataLim.y0
            axes.set_ylim(bottom=1.1 * lowest if lowest < 0 else 0)


def _table(slide):
    """Every direction of one specimen."""
    directions, n = slide.opened.shape
    return pd.DataFrame(
        {
            "specimen": slide.label,
            "direction": np.repeat(slide.directions, n),
            "offset_mm": np.tile(slide.v, directions),
            "rigid_dilatancy_mm": slide.opened.ravel(),
            "composite_rms_mm": slide.spread.ravel(),
            "composite_rms_expected_mm": slide.expected.ravel(),
            "dilatancy_over_rms": slide.ratio.ravel(),
            "roll_off_mm": np.nan if slide.roll_off is None else slide.roll_off,
            "uncorrelated_offset_mm": slide.uncorrelated,
        }
    )


class Trend(NamedTuple):
    """Slope over the second half of v with its 95 % interval, and the change over its mean."""

    slope: float
    low: float
    high: float
    change: float

    @classmethod
    def of(cls, slide, values):
        """Trend of one quantity, (directions, n): the mean slope of the directions.

        Its interval comes from how the directions differ; from the points of the line where there
        is but one direction, which takes neighbouring offsets as independent.
        """
        half = slide.second_half
        v = slide.v[half]
        lines = [fit_line(v, row[half]) for row in values]
        slope, low, high = (
            mean_interval([line.slope for line in lines])[:3]
            if len(lines) > 1
            else (lines[0].slope, lines[0].slope_low, lines[0].slope_high)
        )
        return cls(slope, low, high, slope * np.ptp(v) / np.mean(values[:, half]))


def _caption(slides):
    return (
        f"Why rigid dilatancy has a plateau (Figs. 6a and 7a of {PAPER}). "
        f"(a) Rigid dilatancy, mean of the directions; (b) standard deviation of the composite "
        f"topography, with sqrt(2) sigma sqrt(1 - rho(v)) from the heights sigma of the faces and "
        f"their correlation rho; (c) their ratio. {_explanation(slides)} Slopes over the second "
        f"half of v, with intervals from how the directions differ: "
        f"{'; '.join(_slope_words(slide) for slide in slides)}."
    )


def _slope_words(slide):
    opened, spread = (Trend.of(slide, values) for values in (slide.opened, slide.spread))
    roll_off = (
        "no roll-off"
        if slide.roll_off is None
        else "roll-off not known"
        if np.isnan(slide.roll_off)
        else f"roll-off {short(slide.roll_off)} mm"
    )
    if not np.isfinite(opened.slope):
        return f"{slide.label} ({roll_off}): too few offsets"
    half = slide.spread[:, slide.second_half].mean()
    return (
        f"{slide.label} ({roll_off}): delta_r {estimate(opened.slope, opened.low, opened.high)} "
        f"mm/mm, {100 * opened.change:+.2g} % of its mean, sigma_z "
        f"{estimate(spread.slope, spread.low, spread.high)} mm/mm, {100 * spread.change:+.2g} %, "
        f"there {half / (np.sqrt(2) * slide.face):.2g} of sqrt(2) sigma"
    )


def _explanation(slides):
    """Whether delta_r follows sigma_z, and whether the roll-off length decides on its plateau."""
    passed = [s for s in slides if s.roll_off is not None and 2 * s.roll_off <= s.v[-1]]
    without = [s for s in slides if s.roll_off is None]
    sentences = [_following(slides)]
    if passed:
        missed = max(_missed(slide) for slide in passed)
        lost = [s.uncorrelated / s.roll_off for s in passed if np.isfinite(s.uncorrelated)]
        where = f", at {_span(lost)} times the roll-off length," if lost else ""
        sentences.append(
            f"Where the second half of v lies beyond the roll-off length, sigma_z is what the "
            f"correlation makes it to {100 * missed:.2g} % (rms): once the faces have none left to "
            f"lose{where} it saturates at sqrt(2) sigma, and {_levels(passed)}."
        )
    if without:
        missed = max(_missed(slide) for slide in without)
        left = np.concatenate([slide.correlation[:, -1] for slide in without])
        sentences.append(
            f"Without a roll-off the heights have no sigma of their own (the formula misses by "
            f"{100 * missed:.2g} %), a correlation of {_span(left)} is left at the largest v, and "
            f"{_levels(without)}."
        )
    return " ".join(sentences)


def _following(slides):
    """How constant delta_r / sigma_z is while sigma_z grows; from flush faces alone."""
    matched = [slide for slide in slides if slide.matched and slide.v.size > 1]
    if not matched:
        return "No specimen starts from matching faces, whose dilatancy could be compared."
    grown = [s.spread.mean(axis=0)[-1] / s.spread.mean(axis=0)[s.v > 0][0] for s in matched]
    ratios = [s.ratio.mean(axis=0)[s.v > 0] for s in matched]
    return (
        f"delta_r follows sigma_z: from the first offset to the last sigma_z grows "
        f"{_span(grown)} times, their ratio stays between {_span(np.concatenate(ratios), ' and ')}."
    )


def _missed(slide):
    """Root mean square of what the correlation alone does not explain of sigma_z, as a part."""
    return np.sqrt(np.mean((slide.expected - slide.spread) ** 2) / np.mean(slide.spread**2))


def _levels(slides):
    """How many level off, and how many keep rising."""
    trends = [Trend.of(slide, slide.opened) for slide in slides]
    level = sum(abs(trend.change) <= LEVEL for trend in trends)
    rising = [trend for trend in trends if trend.change > LEVEL]
    sure = sum(trend.low > 0 for trend in rising)
    beyond = f" (the intervals of {sure} exclude zero)" if rising else ""
    return (
        f"over the second half of v delta_r changes by less than {100 * LEVEL:g} % in {level} of "
        f"{len(slides)} and rises by more in {len(rising)}{beyond}"
    )


def _span(values, joint=" to "):
    """The least and the most of some numbers, once if they read alike."""
    return joint.join(dict.fromkeys((short(np.min(values)), short(np.max(values)))))
