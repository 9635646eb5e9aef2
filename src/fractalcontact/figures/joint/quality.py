"""Quality sheet of a scan: relief, mask, histogram, profiles, spectra and what was done to it.

Of two faces also their gap, where they overlap, and how much of the load rests on such cells.
"""

import textwrap

import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...roughness.quality_words import (
    AXES,
    noise_words,
    overlap_words,
    range_words,
    suspect_words,
)
from ..kit.drawing import (
    WIDTH,
    Drawing,
    group,
    headline,
    letter,
    settings_of,
)
from ..kit.maps import scan_extent
from ..kit.relief import draw_faces
from ..kit.words import SUPPLEMENTARY, percent
from ._history import history
from ._quality_pair import draw_gap, draw_gap_heights, draw_load_share, pair_entries, pair_table
from ._quality_panels import (
    draw_histogram,
    draw_mask,
    draw_profile,
    draw_radial,
    draw_spectrum,
    profile,
    spectrum_entries,
)

TITLE = "Quality of the scan: relief, missing cells, spectra, noise and fractal range"
SUBJECT = "specimen"
NEEDS = ("specimens", "quality", "closure")
ORDER = 30

#: Letters in a line of the text, and inches a line is high.
LETTERS, LINE = 126, 0.138


def draw(atlas: DataTree, name: str) -> Drawing:
    """The quality sheet of a specimen.

    Its data are spectra, histograms and profiles drawn, by `panel` and face.
    """
    specimen = group(atlas, "specimens", name)
    quality = group(atlas, "quality", name)
    curves = group(atlas, "closure", name)
    label = settings_of(atlas, name)["label"]
    faces = [str(face) for face in quality["face"].values]
    sides = scan_extent(specimen)
    warnings = [quality.attrs["warning"], curves.attrs.get("warning", "")]
    lines = _text_lines(specimen, quality, faces, warnings)

    columns = len(faces) + 1
    maps = min(max(WIDTH / columns * 0.85 * sides[0] / sides[1], 1.3), 3.6) + 0.5
    heights = [maps, 1.9, 2.5] + [maps] * (len(faces) == 2)
    text = LINE * (len(lines) + 1)
    figure = Figure(figsize=(WIDTH, sum(heights) + text + 0.7))
    panels, below = figure.subfigures(2, 1, height_ratios=[sum(heights) + 0.7, text])  # type: ignore[misc]  # an array
    grid = panels.add_gridspec(len(heights), 6, height_ratios=heights)
    width = 6 // columns
    top, last, pair = (
        [panels.add_subplot(grid[row, i * width : (i + 1) * width]) for i in range(columns)]
        if row < len(heights)
        else []
        for row in (0, 2, 3)
    )
    middle = [panels.add_subplot(grid[1, 2 * i : 2 * i + 2]) for i in range(3)]

    outline = draw_faces(panels, top[:-1], specimen, faces, sides)
    marks = draw_mask(top[-1], specimen, faces, sides)
    draw_histogram(middle[0], quality, faces)
    for axes, axis in zip(middle[1:], AXES, strict=True):
        draw_profile(axes, specimen, faces, axis)
    for axes, face in zip(last[:-1], faces, strict=True):
        draw_spectrum(axes, quality, face)
    draw_radial(last[-1], quality, faces)
    if pair:
        marks += draw_gap(panels, pair[0], specimen, sides) + pair_entries()
        draw_gap_heights(pair[1], specimen)
        draw_load_share(pair[2], curves)
    titles = [*(f"{face} face" for face in faces), "mask", "heights", "along $x$", "along $y$"]
    titles += [*(f"spectra, {face} face" for face in faces), "radial spectrum"]
    titles += ["gap", "distribution of the gap", "load on suspicious cells"][: len(pair)]
    for which, (axes, title) in enumerate(zip([*top, *middle, *last, *pair], titles, strict=True)):
        letter(axes, "abcdefghijkl"[which], title)
    panels.legend(
        handles=[outline, *marks, *spectrum_entries(quality, faces)],
        loc="outside lower center",
        ncols=4,
    )
    headline(panels, label)
    below.text(
        0.01,
        1,
        "\n".join(lines),
        va="top",
        fontsize=7,
        linespacing=1.2,
        parse_math=False,
    )
    table = _table(specimen, quality, faces, curves)
    return Drawing(figure, table, _caption(specimen, quality, warnings))


# -- words and numbers -----------------------------------------------------------------------------


def _text_lines(specimen, quality, faces, warnings):
    """What was done and found, broken into lines; the warnings first."""
    paragraphs = [f"WARNING: {warning}." for warning in warnings if warning]
    paragraphs += _found_words(specimen, quality, faces)
    paragraphs += history(specimen, faces)
    return [line for text in paragraphs for line in textwrap.wrap(text, LETTERS)]


def _found_words(specimen, quality, faces):
    """A sentence a face on noise and range, and one on cells missing and outlying."""
    sentences = []
    for face in faces:
        words = "; ".join(filter(None, (noise_words(quality, face), range_words(quality, face))))
        sentences.append(f"{face.capitalize()} face: {words}.")
    sentences.append(_cells_words(specimen, quality, faces))
    if overlap := overlap_words(specimen, quality):
        gap = quality.sel(region="window")
        sentences.append(
            f"Gap in the window: mean {gap['gap_mean']:.3g} mm, sd {gap['gap_sd']:.3g} mm; "
            f"{overlap}."
        )
    return sentences


def _cells_words(specimen, quality, faces):
    """A sentence on cells missing, outlying and filled."""
    missing = ", ".join(percent(quality["missing_share"].sel(face=f)) for f in faces)
    cells = f"{missing} of the cells missing"
    if "outlier_count" in specimen.attrs:
        treated = {"keep": "kept", "mask": "masked", "fill": "filled"}.get(
            specimen.attrs.get("outliers"), ""
        )
        cells += f", {specimen.attrs['outlier_count']} outliers {treated}".rstrip()
    if specimen.attrs.get("filled_count"):
        cells += f", {specimen.attrs['filled_count']} cells filled"
    if suspicious := suspect_words(specimen):
        cells += f", {suspicious}"
    return f"{cells}."


def _caption(specimen, quality, warnings):
    faces = [str(face) for face in quality["face"].values]
    found = ["all resolutions of the study lie within the fractal range (shaded)"]
    if stated := sum(map(bool, warnings)):
        found = [f"{stated} warning{'s stand' if stated > 1 else ' stands'} below the panels"]
    found += filter(None, [overlap_words(specimen, quality)])
    ends = " ".join(f"{sentence[0].upper()}{sentence[1:]}." for sentence in found)
    what = ", gap, load on suspicious cells" if len(faces) == 2 else ""
    return (
        f"{SUPPLEMENTARY} Relief, mask, heights, profiles and spectra of the scan{what}. "
        f"{_cells_words(specimen, quality, faces)} {ends}"
    )


def _table(specimen, quality, faces, curves):
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
            place, z = profile(specimen, face, axis)
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
    of_pair = pair_table(specimen, curves) if len(faces) == 2 else []
    return pd.concat([table[drawn], *of_pair], ignore_index=True)
