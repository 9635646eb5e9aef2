"""Quality sheet of a scan: relief, mask, histogram, profiles, spectra and what was done to it."""

import textwrap

import numpy as np
import pandas as pd
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from xarray import DataTree

from ...roughness.quality_words import AXES, length_words, noise_words, range_words
from ...surface.specimen import window_slices
from ..kit.drawing import (
    COLOURS,
    WIDTH,
    Drawing,
    group,
    headline,
    label_short_span,
    letter,
    settings_of,
)
from ..kit.maps import MISSING, draw_map, missing_patch, scan_extent, window_outline
from ..kit.words import length_unit, percent, supplementary
from ..paper.fig02_relief import draw_faces
from ._history import history

TITLE = "Quality of the scan: relief, missing cells, spectra, noise floor and fractal range"
SUBJECT = "specimen"
NEEDS = ("specimens", "quality")
ORDER = 30

#: Outliers up to this many are ringed, so that single cells can be seen.
FEW_OUTLIERS = 400
OUTLIER, FILLED, PRESENT = COLOURS[2], COLOURS[1], "0.96"
FACE_COLOURS = {"lower": COLOURS[0], "upper": COLOURS[4]}
AXIS_COLOURS = {"x": COLOURS[1], "y": COLOURS[2]}
#: Letters in a line of the text, and inches a line is high.
LETTERS, LINE = 138, 0.128


def draw(atlas: DataTree, name: str) -> Drawing:
    """The quality sheet of a specimen.

    Its data are spectra, histograms and profiles drawn, by `panel` and face.
    """
    specimen = group(atlas, "specimens", name)
    quality = group(atlas, "quality", name)
    label = settings_of(atlas, name)["label"]
    faces = [str(face) for face in quality["face"].values]
    sides = scan_extent(specimen)
    lines = _text_lines(specimen, quality, faces)

    columns = len(faces) + 1
    maps = min(max(WIDTH / columns * 0.85 * sides[0] / sides[1], 1.3), 3.6) + 0.5
    heights = [maps, 1.9, 2.5]
    text = LINE * (len(lines) + 1)
    figure = Figure(figsize=(WIDTH, sum(heights) + text + 0.7))
    panels, below = figure.subfigures(2, 1, height_ratios=[sum(heights) + 0.7, text])  # type: ignore[misc]  # an array
    grid = panels.add_gridspec(3, 6, height_ratios=heights)
    width = 6 // columns
    top, last = (
        [panels.add_subplot(grid[row, i * width : (i + 1) * width]) for i in range(columns)]
        for row in (0, 2)
    )
    middle = [panels.add_subplot(grid[1, 2 * i : 2 * i + 2]) for i in range(3)]

    outline = draw_faces(panels, top[:-1], specimen, faces, sides)
    marks = _draw_mask(top[-1], specimen, faces, sides)
    _draw_histogram(middle[0], quality, faces)
    for axes, axis in zip(middle[1:], AXES, strict=True):
        _draw_profile(axes, specimen, faces, axis)
    for axes, face in zip(last[:-1], faces, strict=True):
        _draw_spectrum(axes, quality, face)
    _draw_radial(last[-1], quality, faces)
    titles = [*(f"{face} face" for face in faces), "mask", "heights", "along $x$", "along $y$"]
    titles += [*(f"spectra, {face} face" for face in faces), "radial spectrum"]
    for which, (axes, title) in enumerate(zip([*top, *middle, *last], titles, strict=True)):
        letter(axes, "abcdefghij"[which], title)
    panels.legend(
        handles=[outline, *marks, *_spectrum_entries(quality, faces)],
        loc="outside lower center",
        ncols=4,
    )
    headline(panels, label)
    below.text(
        0.01,
        1,
        "\n".join(lines),
        va="top",
        fontsize=6.5,
        linespacing=1.2,
        parse_math=False,
    )
    return Drawing(figure, _table(specimen, quality, faces), _caption(label, specimen, quality))


# -- maps ------------------------------------------------------------------------------------------


def _draw_mask(axes, specimen, faces, sides):
    """What of the scan is missing, filled or an outlier; the entries of a legend."""
    missing = np.isnan([specimen[face].values for face in faces]).any(axis=0)
    image = np.full((*missing.shape, 3), to_rgb(PRESENT))
    image[missing] = to_rgb(MISSING)
    marks = [missing_patch()] if missing.any() else []
    if "filled" in specimen and specimen["filled"].any():
        image[specimen["filled"].values] = to_rgb(FILLED)
        marks.append(Patch(facecolor=FILLED, label="filled"))
    outliers = specimen["outlier"].values if "outlier" in specimen else np.zeros_like(missing)
    image[outliers] = to_rgb(OUTLIER)
    draw_map(axes, image, sides)
    _, size = length_unit(max(sides))
    if outliers.any():
        marks.append(Patch(facecolor=OUTLIER, label="outlier"))
    if 0 < outliers.sum() <= FEW_OUTLIERS:
        y, x = np.nonzero(outliers)
        places = [
            (cells + 0.5) * specimen.attrs[f"spacing_{axis}"] / size
            for cells, axis in ((x, "x"), (y, "y"))
        ]
        axes.plot(*places, "o", ms=4, mfc="none", mec=OUTLIER, mew=0.7)
    axes.add_patch(window_outline(specimen, size, lw=1))
    for axis, start in zip("yx", _middle(specimen), strict=True):
        at = (start + 0.5) * specimen.attrs[f"spacing_{axis}"] / size
        (axes.axhline if axis == "y" else axes.axvline)(at, color="0.4", lw=0.6, ls=":")
    return marks


def _middle(specimen):
    """Row and column through the middle of the window."""
    return tuple((cells.start + cells.stop) // 2 for cells in window_slices(specimen))


# -- heights ---------------------------------------------------------------------------------------


def _draw_histogram(axes, quality, faces):
    unit, size = length_unit(float(np.ptp(quality["edge"].values)))
    for face in faces:
        of_face = quality.sel(face=face)
        axes.stairs(
            of_face["density"].values * size,
            quality["edge"].values / size,
            color=FACE_COLOURS[face],
            lw=1,
        )
    first = quality.sel(face=faces[0])
    rms, z = first["rms"].item() / size, quality["edge"].values / size
    axes.plot(
        z, np.exp(-((z / rms) ** 2) / 2) / rms / np.sqrt(2 * np.pi), color="0.6", lw=0.8, ls="--"
    )
    axes.set(xlabel=f"height ({unit})", ylabel=f"fraction of cells (1/{unit})", ylim=(0, None))
    words = "\n".join(
        f"{face}: rms {length_words(q['rms'])}\nskew {q['skewness']:.2f}, kurt. {q['kurtosis']:.1f}"
        for face, q in ((face, quality.sel(face=face)) for face in faces)
    )
    axes.text(0.02, 0.97, words, transform=axes.transAxes, va="top", fontsize=6)
    axes.set_ylim(top=(1.2 + 0.3 * len(faces)) * axes.get_ylim()[1])  # room for the words


def _profile(specimen, face, axis):
    """Place (mm) and height (mm) along one axis, through the middle of the window."""
    row, column = _middle(specimen)
    z = specimen[face].values
    z = z[row] if axis == "x" else z[:, column]
    return (np.arange(z.size) + 0.5) * specimen.attrs[f"spacing_{axis}"], z


def _draw_profile(axes, specimen, faces, axis):
    place_unit, place = length_unit(max(scan_extent(specimen)))
    profiles = {face: _profile(specimen, face, axis) for face in faces}
    heights = np.concatenate([z for _, z in profiles.values()])
    span = np.ptp(heights[np.isfinite(heights)]) if np.isfinite(heights).any() else 1.0
    unit, size = length_unit(span)
    for face, (x, z) in profiles.items():
        axes.plot(x / place, z / size, color=FACE_COLOURS[face], lw=0.7)
    cells = dict(zip("yx", window_slices(specimen), strict=True))[axis]
    spacing = specimen.attrs[f"spacing_{axis}"] / place
    axes.axvspan(cells.start * spacing, cells.stop * spacing, color="0.93", zorder=0)
    axes.set(xlabel=f"${axis}$ ({place_unit})", ylabel=f"height ({unit})")
    axes.margins(x=0)


# -- spectra ---------------------------------------------------------------------------------------


def _draw_spectrum(axes, quality, face):
    """Spectra of profiles of one face with their models, floor and end; resolutions on top."""
    found = quality.sel(face=face)
    for axis in AXES:
        of_axis, colour = found.sel(axis=axis), AXIS_COLOURS[axis]
        waves, level = of_axis["wavelength"].values, of_axis["spectrum"].values
        axes.loglog(waves, level, "os"[AXES.index(axis)], ms=2.5, color=colour, mfc="none", mew=0.7)
        axes.loglog(waves, of_axis["spectrum_model"].values, color=colour, lw=0.9)
        known = np.isfinite(waves)
        if not known.any() or not any(of_axis["form"].values.ravel()):
            continue
        line = of_axis["line_level"].item() * waves ** of_axis["line_exponent"].item()
        axes.loglog(waves, line, color=colour, lw=0.7, ls=":")
        if np.isfinite(of_axis["noise_rms"]):
            shortest = _spacing(quality, axis)
            axes.axhline(of_axis["noise_rms"].item() ** 2 * shortest, color=colour, lw=0.8, ls="--")
    _mark_range(axes, quality)
    measured = found["spectrum"].values[found["spectrum"].values > 0]
    if measured.size:
        axes.set_ylim(measured.min() / 4, measured.max() * 4)
    else:
        axes.text(0.5, 0.5, "too small for a spectrum", ha="center", transform=axes.transAxes)
    axes.set(xlabel="wavelength (mm)", ylabel="spectrum of profiles (mm³)")
    label_short_span(axes.xaxis)


def _spacing(quality, axis):
    return quality.attrs[f"spacing_{axis}"]


def _mark_range(axes, quality):
    """The end of the fractal range, and 2 s of every resolution at the upper edge."""
    end = quality["range_end"].item()
    if np.isfinite(end):
        axes.axvline(end, color="0.3", lw=0.8, ls="-.")
    for side, below in zip(
        quality["resolution"].values, quality["below_range"].values, strict=True
    ):
        axes.plot(
            2 * side,
            0.985,
            "v",
            ms=5,
            transform=axes.get_xaxis_transform(),
            clip_on=False,
            color=OUTLIER if below else COLOURS[3],
            mfc="none" if below else COLOURS[3],
            zorder=5,
        )


def _draw_radial(axes, quality, faces):
    """Radially averaged spectra, with the floor that the profiles have."""
    for face in faces:
        found = quality.sel(face=face)
        waves, level = found["radial_wavelength"].values, found["radial_spectrum"].values
        axes.loglog(
            waves, level, "o-", ms=2.5, mfc="none", mew=0.7, color=FACE_COLOURS[face], lw=0.8
        )
        noise = found["noise_rms"].values
        if np.isfinite(noise).all():
            area = _spacing(quality, "x") * _spacing(quality, "y")
            axes.axhline(np.min(noise) ** 2 * area, color=FACE_COLOURS[face], lw=0.8, ls="--")
    _mark_range(axes, quality)
    if not np.isfinite(quality["radial_spectrum"]).any():
        axes.text(0.5, 0.5, "too small for a spectrum", ha="center", transform=axes.transAxes)
    axes.set(xlabel="wavelength (mm)", ylabel="radial spectrum (mm⁴)")
    label_short_span(axes.xaxis)


def _spectrum_entries(quality, faces):
    """Entries of the legend for what stands in the lower panels."""
    entries = [
        Line2D([], [], color=FACE_COLOURS[face], lw=1, label=f"{face} face") for face in faces
    ]
    entries += [
        Line2D(
            [],
            [],
            color=AXIS_COLOURS[axis],
            marker="os"[i],
            ms=3,
            mfc="none",
            lw=0.9,
            label=f"profiles along ${axis}$, model",
        )
        for i, axis in enumerate(AXES)
    ]
    entries.append(Line2D([], [], color="0.3", ls=":", lw=0.8, label="self-affine line"))
    if quality["noise_rms"].notnull().any():
        entries.append(Line2D([], [], color="0.3", ls="--", lw=0.8, label="noise floor"))
    if quality["range_end"].notnull():
        entries.append(
            Line2D([], [], color="0.3", ls="-.", lw=0.8, label="end of the fractal range")
        )
    below = quality["below_range"].values
    for which, label in ((False, "2 $s$ of a resolution"), (True, "2 $s$, below the range")):
        if (below == which).any():
            colour = OUTLIER if which else COLOURS[3]
            entries.append(
                Line2D(
                    [],
                    [],
                    ls="none",
                    marker="v",
                    color=colour,
                    label=label,
                    mfc="none" if which else colour,
                )
            )
    return entries


# -- words and numbers -----------------------------------------------------------------------------


def _text_lines(specimen, quality, faces):
    """What was done and found, broken into lines; the warning first."""
    warning = quality.attrs["warning"]
    paragraphs = [f"WARNING: {warning}."] if warning else []
    paragraphs += _found_words(specimen, quality, faces)
    paragraphs += history(specimen, faces)
    return [line for text in paragraphs for line in textwrap.wrap(text, LETTERS)]


def _found_words(specimen, quality, faces):
    """A sentence a face on noise and range, and one on cells missing and outlying."""
    sentences = []
    for face in faces:
        words = "; ".join(filter(None, (noise_words(quality, face), range_words(quality, face))))
        sentences.append(f"{face.capitalize()} face: {words}.")
    return [*sentences, _cells_words(specimen, quality, faces)]


def _cells_words(specimen, quality, faces):
    """A sentence on cells missing, outlying and filled."""
    missing = ", ".join(percent(quality["missing_share"].sel(face=f)) for f in faces)
    cells = f"{missing} of the cells missing"
    if "outlier_count" in specimen.attrs:
        treated = {"keep": "kept", "mask": "masked"}.get(specimen.attrs.get("outliers"), "")
        cells += f", {specimen.attrs['outlier_count']} outliers {treated}".rstrip()
    if specimen.attrs.get("filled_count"):
        cells += f", {specimen.attrs['filled_count']} cells filled"
    return f"{cells}."


def _caption(label, specimen, quality):
    faces = [str(face) for face in quality["face"].values]
    end = quality.attrs["warning"] or "all resolutions of the study lie within the fractal range"
    return (
        f"{supplementary('quality of the scan', label)} Relief, mask, heights, profiles and "
        "spectra, with the noise floor, the end of the fractal range and the shortest wave 2 s of "
        f"each resolution s where they exist. {_cells_words(specimen, quality, faces)} "
        f"{end[0].upper()}{end[1:]}."
    )


def _table(specimen, quality, faces):
    """One row a point drawn: x and y of each panel, units in their names."""
    parts = []
    for face in faces:
        found = quality.sel(face=face)
        edges = quality["edge"].values
        parts.append(
            pd.DataFrame(
                {
                    "panel": "histogram",
                    "face": face,
                    "height_mm": (edges[1:] + edges[:-1]) / 2,
                    "density_per_mm": found["density"].values,
                }
            )
        )
        for axis in AXES:
            place, z = _profile(specimen, face, axis)
            parts.append(
                pd.DataFrame(
                    {
                        "panel": "profile",
                        "face": face,
                        "axis": axis,
                        "place_mm": place,
                        "height_mm": z,
                    }
                )
            )
            of_axis = found.sel(axis=axis)
            parts.append(
                pd.DataFrame(
                    {
                        "panel": "spectrum",
                        "face": face,
                        "axis": axis,
                        "wavelength_mm": of_axis["wavelength"].values,
                        "spectrum_mm3": of_axis["spectrum"].values,
                        "model_mm3": of_axis["spectrum_model"].values,
                    }
                )
            )
        parts.append(
            pd.DataFrame(
                {
                    "panel": "radial",
                    "face": face,
                    "wavelength_mm": found["radial_wavelength"].values,
                    "spectrum_mm4": found["radial_spectrum"].values,
                }
            )
        )
    table = pd.concat(parts, ignore_index=True)
    drawn = table["height_mm"].notna() | table["wavelength_mm"].notna()
    return table[drawn].reset_index(drop=True)
