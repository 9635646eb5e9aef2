"""Plateau of rigid dilatancy: synthetic joints with and without a roll-off, and the study's."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core import directions
from fractalcontact.core.estimate import EXPONENT, Estimate
from fractalcontact.core.labels import printable
from fractalcontact.core.subject import Subject, configuration_of
from fractalcontact.core.text import compact
from fractalcontact.core.units import quantity
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import LINES, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below, mark
from fractalcontact.figures.kit.panel import Panel, rows
from fractalcontact.figures.kit.sizes import plain_decades
from fractalcontact.figures.kit.verdicts import labels_by_verdict

TITLE = "Rigid dilatancy of all joints: does a plateau need a roll-off of the spectrum?"
SUBJECT = "study"
NEEDS = ("specimens", "joints", "roll_off", "statements")
KEY = "roll_off"
ORDER = 10

#: The paper's statements on rock and on concrete (:mod:`statements.sliding`).
PLATEAUS = ("dilatancy_flattens", "dilatancy_flattens_in_two")
#: Specimens that the caption names, and letters of the label of each, there and in the legend.
MAX_NAMED, MAX_IN_CAPTION, MAX_IN_LEGEND = 3, 40, 60
#: Variables of a specimen, and those of the synthetic joints that correspond.
DRAWN = {
    "rigid_dilatancy": "joint_dilatancy",
    "composite_rms": "joint_rms",
    "composite_rms_expected": "joint_rms_expected",
    "dilatancy_over_rms": "joint_dilatancy_over_rms",
}
_TITLES = ("dilatancy", r"over the spread $\sigma_z$ of the composite topography")
#: Marks of the roll-off length and of the offset where the faces lose their correlation.
_MARKS = {"roll_off_mm": ("v", "roll-off length"), "uncorrelated_mm": ("o", "faces uncorrelated")}
_MARK: dict[str, Any] = {"ls": "none", "mfc": "white", "ms": 6, "zorder": 3}


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Dilatancy, and its ratio to the spread of the composite topography, for all that slides."""
    joints, settings = (
        atlas["roll_off/surfaces"].to_dataset(),
        configuration_of(atlas)["settings"],
    )
    sliding = [name for name in names if directions.slides(settings[name]["opposite"])]
    slides = [_synthetic(joints.sel(surface=surface)) for surface in joints["surface"].values]
    # A specimen that crushes has the faces of another specimen.
    other = [name for name in sliding if not settings[name]["capped_variant"]]
    slides += [_of_specimen(atlas, name) for name in other]
    figure = Figure(figsize=(WIDTH, 3.6 + 0.15 * len(slides)))
    panels = [Panel(*surface) for surface in zip(figure.subplots(1, 2), "ab", _TITLES, strict=True)]
    for n, slide in enumerate(slides):
        _draw_slide(panels, slide, {"color": colour_of(n), "ls": LINES[n % 4]})
    opened, ratio = (panel.axes for panel in panels)
    for axes in (opened, ratio):
        axes.set_xlabel("offset $v$ (mm)")
        axes.set_xscale("log")
    opened.set(yscale="log", ylabel=r"rigid dilatancy $\delta_r$ (mm)")
    plain_decades(opened.yaxis)
    ratio.set_ylabel(r"dilatancy over spread $\delta_r/\sigma_z$ (1)")
    ratio.set_ylim(bottom=min(0, ratio.dataLim.y0))
    legends_below(figure, entries(opened), _marks(), columnspacing=3)
    table = pd.concat([_table(slide) for slide in slides], ignore_index=True)
    return Drawing(figure, table, caption(__name__, **_words(atlas, sliding, slides, joints)))


def _synthetic(joints: xr.Dataset) -> xr.Dataset:
    """Slides of synthetic joints with, or without, a roll-off; means of their directions."""
    rolled = joints["surface"].item() == "with_roll_off"
    length = float(joints.attrs["roll_off"]) if rolled else np.nan
    words = f"with a roll-off at {compact(length)} mm" if rolled else "without a roll-off"
    slope = Estimate.read(joints, "slope", scale=EXPONENT)
    label = f"{joints.sizes['seed']} synthetic joints {words}"
    slide = joints[list(DRAWN.values())].rename({new: old for old, new in DRAWN.items()})
    slide = slide.drop_vars("surface").rename(seed="direction_or_seed")
    of_seeds = [f"seed {seed}" for seed in joints["seed"].values]
    said = f"slope {slope.text()} mm/mm" if slope.known else "slope: too few offsets"
    attrs = {"label": label, "slope": said, "since": float(joints["slope_offset_min"])}
    attrs |= {"roll_off_mm": length, "uncorrelated_mm": np.nan, "matched": True}
    return slide.assign_coords(direction_or_seed=of_seeds).assign_attrs(attrs)


def _of_specimen(atlas: DataTree, name: str) -> xr.Dataset:
    """The slide of a specimen in all directions."""
    subject = Subject.of(atlas, name)
    joint = subject["joints"]
    embedded = configuration_of(atlas)["study"].get("embedded", {}).get(name, {})
    stated = embedded.get("roll_off")
    length = quantity(stated, "length", f"embedded.{name}.roll_off") if stated else np.nan
    attrs = {"label": subject.label, "slope": "", "since": np.inf, "roll_off_mm": length}
    attrs["uncorrelated_mm"] = float(joint["mean_uncorrelated_offset"])
    # The dilatancy of faces that do not match starts from their initial separation.
    attrs["matched"] = subject["specimens"].attrs["opposite"] == "match"
    slide = joint[list(DRAWN)].rename(direction="direction_or_seed")
    return slide.drop_attrs(deep=False).assign_attrs(attrs)


def _draw_slide(panels: Sequence[Panel], slide: xr.Dataset, style: dict[str, Any]) -> None:
    """Dilatancy of a slide and its ratio to the spread, the means with their bands; its marks."""
    # A logarithmic axis has no zero offset, where the spread of flush faces is rounding alone.
    slide = slide.isel(rigid_offset=(slide["rigid_offset"] > 0).values)
    v, of = slide["rigid_offset"].values, slide.attrs
    label = "\n".join(filter(None, (printable(of["label"], MAX_IN_LEGEND), of["slope"])))
    label = label.replace("$", r"\$")
    shown = ("rigid_dilatancy", "dilatancy_over_rms")[: 1 + of["matched"]]
    for panel, name in zip(panels, shown, strict=False):
        values = slide[name].where((slide[name] > 0) | (name != "rigid_dilatancy"))
        low, mean, high = (
            getattr(values, end)("direction_or_seed") for end in ("min", "mean", "max")
        )
        panel.axes.fill_between(v, low, high, color=style["color"], alpha=0.15, lw=0)
        panel.axes.plot(v, mean, label=label, **style)
    opened = slide["rigid_dilatancy"].mean("direction_or_seed").values
    half = v >= of["since"]
    panels[0].axes.plot(v[half], opened[half], color=style["color"], lw=3)
    for key, (marker, _) in _MARKS.items():
        if v[0] <= of[key] <= v[-1]:
            height = np.interp(of[key], v, opened)
            panels[0].axes.plot(of[key], height, color=style["color"], marker=marker, **_MARK)


def _marks() -> list[Artist]:
    """Entries of the legend for what is marked on every curve."""
    bands = "lines: means; bands: from least to most of\nthe joints or directions, no intervals"
    marks = [
        mark(color="0.3", marker=marker, label=f"(a) {words}", **_MARK)
        for marker, words in _MARKS.values()
    ]
    return [heading(bands), mark(color="0.3", label="(a) half with the slope", lw=3), *marks]


def _table(slide: xr.Dataset) -> pd.DataFrame:
    """Every direction of one specimen, or every synthetic joint."""
    table = rows(slide, *DRAWN, specimen=slide.attrs["label"])
    return table.assign(**{key: slide.attrs[key] for key in _MARKS})


def _words(
    atlas: DataTree, names: Sequence[str], slides: Sequence[xr.Dataset], joints: xr.Dataset
) -> dict[str, Any]:
    """Trends of the synthetic joints, and verdicts on the plateaus that the paper has."""
    said = labels_by_verdict(atlas, names, PLATEAUS, MAX_IN_CAPTION)
    flush = [slide["dilatancy_over_rms"] for slide in slides if slide.attrs["matched"]]
    means = np.concatenate(
        [of_joint.mean("direction_or_seed", skipna=False).values for of_joint in flush]
    )
    ends = (end(means[np.isfinite(means)]) for end in (np.min, np.max))
    with_it, without = joints["trend"].values
    return {
        "with_it": with_it,
        "without": without,
        "ratios": dict.fromkeys(map(compact, ends)),
        "verdicts": said,
        "named": sum(map(len, said.values())) <= MAX_NAMED,
    }
