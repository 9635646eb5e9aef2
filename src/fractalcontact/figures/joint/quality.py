"""Quality sheet of a scan: relief, mask, histogram, profiles, spectra and processing.

Of two faces also their gap, where they overlap, and how much of the load rests on such cells.
"""

import textwrap

import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.window import face_words
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing
from ..kit.maps import scan_extent
from ..kit.panel import Panel, rows
from ..kit.relief import draw_faces
from ..kit.titles import headline, letter
from ._history import history
from ._quality_pair import draw_gap, draw_gap_heights, draw_load_share, pair_entries
from ._quality_panels import draw_histogram, draw_mask, draw_profile, profile
from ._quality_spectra import draw_radial, draw_spectrum, spectrum_entries

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
    subject = Subject.of(atlas, name)
    specimen, quality = subject["specimens"], subject["quality"]
    faces = [str(face) for face in quality["face"].values]
    sides = scan_extent(specimen)
    warnings = [quality.attrs["warning"], subject["closure"].attrs.get("warning", "")]
    warnings = [warning for warning in warnings if warning]
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
    for axes, axis in zip(middle[1:], "xy", strict=True):
        draw_profile(axes, specimen, faces, axis)
    for axes, face in zip(last[:-1], faces, strict=True):
        draw_spectrum(axes, quality, face)
    draw_radial(last[-1], quality, faces)
    table = _table(specimen, quality, faces)
    if pair:
        marks += draw_gap(panels, pair[0], specimen, sides) + pair_entries()
        draw_gap_heights(pair[1], quality)
        shares = Panel(pair[2])
        draw_load_share(shares, subject.curves())
        table.append(rows(quality, "gap", "gap_cells", panel="gap").drop(columns="gap_bin"))
        table += [record.assign(panel="load share") for record in shares.records]
    named = {face: face_words(specimen, face) for face in faces}
    titles = [*named.values(), "mask", "heights", "along $x$", "along $y$"]
    titles += [*(f"spectra, {words}" for words in named.values()), "radial spectrum"]
    titles += ["gap", "distribution of the gap", "load on suspicious cells"][: len(pair)]
    for which, (axes, title) in enumerate(zip([*top, *middle, *last, *pair], titles, strict=True)):
        letter(axes, "abcdefghijkl"[which], title)
    entries = [outline, *marks, *spectrum_entries(quality, named)]
    panels.legend(handles=entries, loc="outside lower center", ncols=4)
    headline(panels, subject.label)
    style = {"va": "top", "fontsize": 7, "linespacing": 1.2, "parse_math": False}
    below.text(0.01, 1, "\n".join(lines), **style)
    words = {key: quality.attrs[key] for key in ("cells", "overlap")}
    words |= {"warnings": len(warnings), "pair": bool(pair)}
    return Drawing(figure, pd.concat(table, ignore_index=True), caption(__name__, **words))


def _text_lines(specimen, quality, faces, warnings):
    """History and findings of a scan, broken into lines; the warnings first."""
    paragraphs = [f"WARNING: {warning}." for warning in warnings]
    paragraphs += [
        f"{face_words(specimen, face).capitalize()}: {quality.attrs[f'{face}_face']}."
        for face in faces
    ]
    paragraphs.append(f"{quality.attrs['cells']}.")
    if overlap := quality.attrs["overlap"]:
        mean, sd = (float(quality[f"gap_{key}"].sel(region="window")) for key in ("mean", "sd"))
        paragraphs.append(f"Gap in the window: mean {mean:.3g} mm, sd {sd:.3g} mm; {overlap}.")
    paragraphs += history(specimen, faces)
    return [line for text in paragraphs for line in textwrap.wrap(text, LETTERS)]


def _table(specimen, quality, faces):
    """One row a point drawn, of each panel its own columns."""
    parts = []
    heights = quality[["bin_height", "density"]].rename(bin_height="height")
    radial = quality[["radial_wavelength", "radial_spectrum"]].rename(
        radial_wavelength="wavelength"
    )
    for face in faces:
        parts.append(rows(heights.sel(face=face), "height", "density", panel="histogram"))
        for axis in "xy":
            line = rows(profile(specimen, face, axis), "place", "height", panel="profile")
            parts.append(line.assign(face=face, axis=axis).dropna(subset="height_mm"))
            names = ("wavelength", "spectrum", "spectrum_model")
            of_axis = quality.sel(face=face, axis=axis)
            parts.append(rows(of_axis, *names, panel="spectrum").dropna(subset="wavelength_mm"))
        names = ("wavelength", "radial_spectrum")
        of_face = rows(radial.sel(face=face), *names, panel="radial")
        parts.append(of_face.dropna(subset="wavelength_mm"))
    places = ["bin", "node", "wave", "radial_wave"]
    return [part.drop(columns=places, errors="ignore") for part in parts]
