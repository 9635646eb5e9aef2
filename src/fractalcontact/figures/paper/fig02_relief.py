"""Shaded relief of the levelled faces, and their dimension (Fig. 2)."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.subject import Subject
from ...core.text import compact, length_unit
from ...core.window import face_words, spacing_of
from .. import kit

TITLE = "Fig. 2: shaded relief of the levelled faces, and the surface dimension"
SUBJECT = "specimen"
NEEDS = ("specimens", "surface_dimension")
ORDER = 20

#: Variables of the table, by estimator.
_COLUMNS = ("dimension", "hurst_x", "hurst_y", "fit_min", "fit_max", "n", "recommended")


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Relief of each face lit from the North-West, and Delta_g; the data are of the lower face."""
    subject = Subject.of(atlas, name)
    specimen, dimension = subject["specimens"], subject["surface_dimension"]
    faces = [face for face in ("lower", "upper") if face in specimen]
    sides = kit.scan_extent(specimen)
    alone = len(faces) == 1

    width = kit.WIDTH * (0.55 if alone else 0.35)
    height = min(max(width * sides[0] / sides[1], 1.6), 1.3 * width) + 1.2
    figure = Figure(figsize=(kit.WIDTH, height))
    ratios = [1.6 if alone else 1.2] * len(faces) + [1]
    *maps, axes = figure.subplots(1, len(ratios), width_ratios=ratios)
    handles: list[Artist] = [kit.draw_faces(figure, maps, specimen, faces, sides)]
    if any(not np.isfinite(specimen[face]).all() for face in faces):
        handles.append(kit.missing_patch())
    handles += _draw_dimensions(axes, dimension)
    handles += map(kit.heading, _range_words(dimension))
    titles = [*(face_words(specimen, face) for face in faces)]
    titles.append(rf"$\Delta_g$ of the {titles[0]}")
    for panel, which, title in zip((*maps, axes), "abc", titles, strict=False):
        kit.letter(panel, which, title)
    figure.legend(handles=handles, loc="outside lower left", ncols=3, columnspacing=1)
    kit.headline(figure, subject.label, below=_size_words(specimen, sides))
    best = dimension["estimator"] == dimension["recommended"]
    table = kit.rows(dimension.assign(recommended=best), *_COLUMNS, "known_dimension", face="lower")
    return kit.Drawing(figure, table, _caption(specimen, faces, dimension))


def _draw_dimensions(axes, dimension):
    """Estimates of Delta_g with their intervals, one below the other; the lines of a legend."""
    names = dimension["estimator"].values
    estimates = Estimate.read(dimension, "dimension", scale=DIMENSION)
    places = np.arange(len(names))
    words = (estimates[n].text() if estimates.known[n] else "no fit" for n in places)
    labels = [f"{name.replace('_', ' ')}\n{text}" for name, text in zip(names, words, strict=True)]
    axes.set_yticks(places, labels, fontsize=7)
    axes.set_ylim(len(places) - 0.4, -0.6)
    axes.set_xlabel(r"surface dimension $\Delta_g$ (1)")
    axes.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
    if not estimates.known.any():
        kit.say_empty(axes, "no fit: the scan has\ntoo few scales")
        axes.set_xticks([])
        return []
    recommended = rf"recommended $\Delta_g$ {_recommended(dimension).text()}"
    if dimension["no_dimension"].item():
        recommended = "preferred estimator, 95 %: no dimension"
    best = names == dimension["recommended"].item()
    handles = []
    for those, label, style in (
        (~best, "other estimators, 95 %", {"color": "0.45", "mfc": "white"}),
        (best, recommended, {"color": kit.COLOURS[1]}),
    ):
        of = estimates.known & those
        if of.any():
            value, bars = estimates.value[of], kit.reach(*estimates[of].ends)
            style |= {"fmt": "o", "capsize": 2, "label": label}
            handles.append(axes.errorbar(value, places[of], xerr=bars, **style))
    stated = float(dimension["known_dimension"])
    if np.isfinite(stated):
        label = rf"known $\Delta_g$ {compact(stated)}"
        handles.append(axes.axvline(stated, color=kit.COLOURS[2], ls="--", lw=0.8, label=label))
    axes.grid(axis="x", color="0.9", lw=0.5)
    return handles


def _recommended(dimension):
    return Estimate.read(dimension, "recommended_dimension", scale=DIMENSION)


def _range_words(dimension):
    """Entries of a legend: lengths of the recommended fit, and how x and y differ."""
    words = []
    if _recommended(dimension).known:
        best = dimension.sel(estimator=dimension["recommended"].item())
        ends = " to ".join(f"{compact(float(best[f'fit_{end}']))}" for end in ("min", "max"))
        words.append(f"recommended: {best['length_kind'].item()}s {ends} mm")
    if compared := int(dimension["axes_compared"]):
        differing = f"{int(dimension['axes_differing'])} of {compared} estimators"
        words.append(f"Hurst exponent: $x$, $y$ differ by\n{differing}")
    return words


def _size_words(specimen, sides):
    """Size and spacing of the scan; one number for the spacing where both agree."""
    name, size = length_unit(max(sides))
    spacings = " and ".join(sorted({compact(spacing, 4) for spacing in spacing_of(specimen)}))
    return (
        f"{compact(sides[1] / size, 4)} × {compact(sides[0] / size, 4)} {name}, spacing "
        f"{spacings} mm"
    )


def _caption(specimen, faces, dimension):
    return kit.caption(
        __name__,
        faces=faces,
        absent=1 - float(specimen["valid"].mean()),
        fitted=int(dimension["dimensions_fitted"]),
        reason=dimension["no_dimension"].item(),
        estimator=dimension["recommended"].item().replace("_", " "),
        recommended=_recommended(dimension),
        known=float(dimension["known_dimension"]),
        lowest=float(dimension["lowest_dimension"]),
        highest=float(dimension["highest_dimension"]),
    )
