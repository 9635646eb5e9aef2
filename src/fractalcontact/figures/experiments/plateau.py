"""Plateau of rigid dilatancy: synthetic joints with and without a roll-off, and the study's."""

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...core.estimate import EXPONENT, Estimate
from ...core.labels import printable
from ...core.mean_plane import without_mean_plane
from ...core.units import quantity
from ...core.verdicts import FALLING, LEVEL, RISING
from ...core.window import faces, window_slices
from ...experiments.roll_off import SURFACES
from ...mechanics.plateau import second_half
from ..kit.drawing import (
    LINE,
    LINES,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    heading,
    label_in_lines,
    legends_below,
    letter,
    settings_of,
)
from ..kit.sizes import plain_decades
from ..kit.verdicts import CIRCULAR_SHORT, row_of
from ..kit.words import PAPER, short

TITLE = "Rigid dilatancy of all joints: does a plateau need a roll-off of the spectrum?"
SUBJECT = "study"
NEEDS = ("specimens", "joints", "roll_off", "statements")
KEY = "roll_off"
ORDER = 10

#: What the paper says of rock and of concrete (:mod:`statements.sliding`).
PLATEAUS = ("dilatancy_flattens", "dilatancy_flattens_in_two")

#: Specimens that the caption names, and letters of the label of each.
MOST_NAMED, LONGEST_IN_CAPTION = 3, 40

#: Specimens whose largest offsets differ by more than this are drawn in decades.
WIDE = 5

#: Inches that a label's lines are broken for, so that a column of the legend holds them.
COLUMN = 4

#: Trends of the synthetic joints in words; without one nothing is certain.
_TRENDS = {
    LEVEL: "reaches a plateau",
    RISING: "keeps rising",
    FALLING: "falls",
    "": "shows no trend",
}

#: The second half of the offsets, over which slopes are taken.
_SECOND_HALF = {"lw": 3}
_ROLL_OFF, _UNCORRELATED = "v", "o"
_MARK = {"mfc": "white", "ms": 6, "zorder": 3}


@dataclass(frozen=True)
class Slide:
    """Dilatancy of one specimen, or of many synthetic joints, as they slide, mm.

    Attributes
    ----------
    label : str
    rows : list of str
        Directions of the specimen, or seeds of the synthetic joints: what means and bands are over.
    v : (n,) ndarray
        Offsets.
    opened, spread : (rows, n) ndarray
        Rigid dilatancy delta_r, and standard deviation sigma_z of the composite topography.
    expected : (rows, n) ndarray
        sigma_z from the heights of the faces and their correlation.
    correlation : (rows, n) ndarray
        Of the two faces.
    face : float
        Standard deviation sigma of a face in the window.
    roll_off : float or None
        Wavelength above which the spectrum is flat; NaN for a scan, None where there is none.
    uncorrelated : float
        Offset where the faces lose all correlation, mean of the directions; NaN if not reached.
    matched : bool
        Whether the upper face is the match of the lower one, so that sliding begins flush.
    slope : tuple of float
        Of many synthetic joints: slope of delta_r over the second half of v with its 95 % interval.
    trend : str
        Of many synthetic joints, as the stage ``roll_off`` has it.
    """

    label: str
    rows: list
    v: np.ndarray
    opened: np.ndarray
    spread: np.ndarray
    expected: np.ndarray
    correlation: np.ndarray
    face: float
    roll_off: float | None
    uncorrelated: float
    matched: bool
    slope: tuple[float, float, float] | None = None
    trend: str = ""

    @classmethod
    def of(cls, atlas: DataTree, name: str) -> "Slide":
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
            rows=joint["direction"].values.tolist(),
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

    @classmethod
    def synthetic(cls, atlas: DataTree, surface: str) -> "Slide":
        """Slides of synthetic joints with, or without, a roll-off; means of their directions."""
        joints = group(atlas, "roll_off", "surfaces")
        joints = joints.sel(surface=surface).transpose("seed", "direction", "rigid_offset")
        expected = joints["face_rms"] * np.sqrt(np.maximum(2 - 2 * joints["face_correlation"], 0))
        roll_off = float(joints.attrs["roll_off"]) if surface == "with_roll_off" else None
        words = f"with a roll-off at {short(roll_off)} mm" if roll_off else "without a roll-off"
        names = ("rigid_dilatancy", "composite_rms", "face_correlation")
        opened, spread, correlation = (joints[name].mean("direction").values for name in names)
        return cls(
            label=f"{joints.sizes['seed']} synthetic joints {words}",
            rows=[f"seed {seed}" for seed in joints["seed"].values],
            v=joints["rigid_offset"].values,
            opened=opened,
            spread=spread,
            expected=expected.mean("direction").values,
            correlation=correlation,
            face=float(np.sqrt(np.mean(joints["face_rms"].values ** 2))),
            roll_off=roll_off,
            uncorrelated=np.nan,
            matched=True,
            slope=Estimate.read(joints, "slope").ends,
            trend=joints["trend"].item(),
        )

    @property
    def ratio(self) -> np.ndarray:
        """delta_r / sigma_z; NaN where faces are flush."""
        return np.divide(
            self.opened, self.spread, out=np.full(self.spread.shape, np.nan), where=self.spread > 0
        )


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Dilatancy, and its ratio to the spread of the composite topography, for all that slides."""
    synthetic = [Slide.synthetic(atlas, surface) for surface in SURFACES]
    sliding = [name for name in names if settings_of(atlas, name)["opposite"] != "flat"]
    slides = synthetic + [Slide.of(atlas, name) for name in sliding]
    figure = Figure(figsize=(WIDTH, 3.6 + 0.15 * len(slides)))
    panels = figure.subplots(1, 2, sharex=True)
    _prepare(panels, slides)
    drawn = _without_repeats(slides)
    for n, slide in enumerate(drawn):
        _draw_slide(panels, n, slide)
    _mark_ends(panels[1], slides)
    _start_at_zero(panels)
    # What is below loses no height to long labels.
    lines = sum(
        str(entry.get_label()).count("\n") for entry in entries(panels[0])[len(synthetic) :]
    )
    figure.set_figheight(figure.get_figheight() + LINE * lines)
    legends_below(figure, entries(panels[0]), _marks())
    table = pd.concat([_table(slide) for slide in slides], ignore_index=True)
    return Drawing(figure, table, _caption(slides, _verdicts(atlas, sliding)))


def _roll_off(atlas, name):
    """Roll-off of an embedded surface, mm: None if it has none, NaN for a scan."""
    embedded = json.loads(atlas.attrs["configuration"])["study"].get("embedded", {})
    if name not in embedded:
        return np.nan
    stated = embedded[name].get("roll_off")
    return None if stated is None else quantity(stated, "length", f"embedded.{name}.roll_off")


def _without_repeats(slides):
    """Slides that differ; one whose faces are another's, of another material, is named with it."""
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
    """Whether one slide is the other, or begins as it does."""
    n = min(slide.v.size, other.v.size)
    return slide.rows == other.rows and all(
        np.array_equal(getattr(slide, name)[..., :n], getattr(other, name)[..., :n])
        for name in ("v", "opened", "spread")
    )


def _draw_slide(panels, n, slide):
    colour, line = colour_of(n), LINES[n % 4]
    # In decades flush faces have no place, and what rounding leaves of their spread would be shown.
    shown = slide.v > 0 if panels[1].get_xscale() == "log" else np.full(slide.v.shape, True)
    v = slide.v[shown]
    label = label_in_lines(slide.label, width=COLUMN)
    if slide.slope is not None:
        label += f"\nslope {_slope_words(*slide.slope)}"
    for axes, values in zip(panels, (slide.opened, slide.ratio), strict=True):
        if axes is panels[1] and not slide.matched:
            continue  # its dilatancy counts from faces that were apart already
        values = values[:, shown]
        mean, low, high = values.mean(axis=0), values.min(axis=0), values.max(axis=0)
        if axes.get_yscale() == "log":
            mean, low, high = (np.where(y > 0, y, np.nan) for y in (mean, low, high))
        axes.fill_between(v, low, high, color=colour, alpha=0.15, lw=0)
        axes.plot(v, mean, color=colour, ls=line, label=label)
    if slide.slope is not None:
        half = second_half(slide.v)
        mean = slide.opened[:, half].mean(axis=0)
        panels[0].plot(slide.v[half], mean, color=colour, **_SECOND_HALF)
    for at, marker in ((slide.roll_off, _ROLL_OFF), (slide.uncorrelated, _UNCORRELATED)):
        if at is not None and slide.v[0] <= at <= slide.v[-1]:
            height = np.interp(at, slide.v, slide.opened.mean(axis=0))
            panels[0].plot(at, height, marker, color=colour, **_MARK)


def _mark_ends(axes, slides):
    """Lines at the least and the largest ratio of a mean, which the caption states."""
    ratios = _mean_ratios(slides)
    if not ratios.size:
        return
    for end, va in ((ratios.min(), "top"), (ratios.max(), "bottom")):
        axes.axhline(end, color="0.4", lw=0.8, ls=(0, (1, 2)))
        axes.text(0.02, end, short(end), transform=axes.get_yaxis_transform(), va=va)


def _marks():
    """Entries of the legend for what is marked on every curve."""
    marks = ((_ROLL_OFF, "(a) roll-off length"), (_UNCORRELATED, "(a) faces uncorrelated"))
    return [
        heading(
            "lines: means; bands: from least to most of\nthe joints or directions, no intervals"
        ),
        Line2D([], [], color="0.3", label="(a) half over which the slope is taken", **_SECOND_HALF),
        *(
            Line2D([], [], ls="none", marker=marker, color="0.3", label=words, **_MARK)
            for marker, words in marks
        ),
        Line2D([], [], color="0.4", lw=0.8, ls=(0, (1, 2)), label="(b) least and largest mean"),
    ]


def _prepare(panels, slides):
    """Scales, labels and letters; decades where one specimen slides much farther than another."""
    opened, ratio = panels
    farthest = [slide.v[-1] for slide in slides]
    decades = max(farthest) > WIDE * min(farthest)
    for axes in panels:
        axes.set_xlabel("offset $v$ (mm)")
        if decades:
            axes.set_xscale("log", nonpositive="mask")
    if decades:
        opened.set_yscale("log", nonpositive="mask")
        plain_decades(opened.yaxis)
    opened.set_ylabel(r"rigid dilatancy $\delta_r$ (mm)")
    ratio.set_ylabel(r"dilatancy over spread $\delta_r/\sigma_z$ (1)")
    titles = ("dilatancy", r"over the spread $\sigma_z$ of the composite topography")
    for axes, which, title in zip(panels, "ab", titles, strict=True):
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
    """Every direction of one specimen, or every synthetic joint."""
    rows, n = slide.opened.shape
    return pd.DataFrame(
        {
            "specimen": slide.label,
            "direction_or_seed": np.repeat(slide.rows, n),
            "offset_mm": np.tile(slide.v, rows),
            "rigid_dilatancy_mm": slide.opened.ravel(),
            "composite_rms_mm": slide.spread.ravel(),
            "composite_rms_expected_mm": slide.expected.ravel(),
            "dilatancy_over_rms": slide.ratio.ravel(),
            "roll_off_mm": np.nan if slide.roll_off is None else slide.roll_off,
            "uncorrelated_offset_mm": slide.uncorrelated,
        }
    )


def _caption(slides, verdicts):
    synthetic = slides[: len(SURFACES)]
    words = (
        f"After Figs. 6a and 7a of {PAPER}. Rigid dilatancy delta_r, alone and over the spread "
        f"sigma_z of the composite topography. {_explanation(synthetic, slides)}"
    )
    return f"{words} The paper's plateaus: {verdicts}." if verdicts else words


def _verdicts(atlas, names):
    """Verdicts on the plateaus that the paper has of a material, specimen by specimen."""
    said: dict[str, list[str]] = {}
    for name in names:
        for row in (row_of(atlas, "statements", name, statement) for statement in PLATEAUS):
            if row is not None:
                mark = f" ({CIRCULAR_SHORT})" if row["circular"] else ""
                label = settings_of(atlas, name)["label"]
                said.setdefault(row["verdict"].item(), []).append(
                    f"{printable(label, LONGEST_IN_CAPTION)}{mark}"
                )
    few = sum(map(len, said.values())) <= MOST_NAMED
    return "; ".join(
        f"{verdict} for {', '.join(of) if few else f'{len(of)} specimens'}"
        for verdict, of in said.items()
    )


def _explanation(synthetic, slides):
    """Whether delta_r follows sigma_z, and what the roll-off does to both."""
    with_it, without = synthetic
    return (
        f"With a roll-off delta_r of synthetic joints {_TRENDS[with_it.trend]}, without it "
        f"{_TRENDS[without.trend]} (slopes: legend); delta_r / sigma_z stays "
        f"{_span(_mean_ratios(slides))}."
    )


def _mean_ratios(slides):
    """delta_r / sigma_z of all slides, means of their rows, at all offsets."""
    drawn = [slide.ratio.mean(axis=0)[slide.v > 0] for slide in slides if slide.matched]
    ratios = np.concatenate(drawn)
    return ratios[np.isfinite(ratios)]


def _slope_words(slope, low, high):
    """Slope of delta_r over the second half of v, with its interval."""
    if not np.isfinite(slope):
        return "too few offsets"
    return f"{Estimate(slope, low, high, scale=EXPONENT).text()} mm/mm"


def _span(values, joint=" to "):
    """The least and the most of some numbers, once if they read alike."""
    return joint.join(dict.fromkeys((short(np.min(values)), short(np.max(values)))))
