"""Quality sheet of a scan: relief, mask, histogram, profiles, spectra, findings, and gap."""

import textwrap

from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import compact
from ...core.window import face_words
from .. import kit
from ._quality_curves import (
    curve_entries,
    draw_gap_heights,
    draw_histogram,
    draw_load_share,
    draw_profile,
    draw_radial,
    draw_spectrum,
)
from ._quality_maps import draw_gap, draw_mask

TITLE = "Quality of the scan: relief, missing cells, spectra, noise and fractal range"
SUBJECT = "specimen"
NEEDS = ("specimens", "quality", "closure")
ORDER = 30
JOINT_STUDY = True

#: Length of a line of the text, letters, and its height, inches.
LETTERS, LINE = 126, 0.138


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Quality sheet of a specimen; its data are the spectra, histograms and profiles drawn."""
    subject = Subject.of(atlas, name)
    specimen, quality = subject["specimens"], subject["quality"]
    faces = [str(face) for face in quality["face"].values]
    sides = kit.scan_extent(specimen)
    warnings = [quality.attrs["warning"], subject["closure"].attrs.get("warning", "")]
    warnings = [warning for warning in warnings if warning]
    lines = _text_lines(specimen, quality, faces, warnings)

    pair, columns = len(faces) == 2, len(faces) + 1
    maps = min(max(kit.WIDTH / columns * 0.85 * sides[0] / sides[1], 1.3), 3.6) + 0.5
    heights = [maps, 1.9, 2.5] + [maps] * pair
    text = LINE * (len(lines) + 1)
    high = sum(heights) + 0.7
    figure = Figure(figsize=(kit.WIDTH, high + text))
    sheet, below = figure.subfigures(2, 1, height_ratios=[high, text])  # type: ignore[misc]  # an array
    grid = sheet.add_gridspec(len(heights), 6, height_ratios=heights)
    named = {face: face_words(specimen, face) for face in faces}
    titles = [*named.values(), "mask", "heights", "along $x$", "along $y$"]
    titles += [*(f"spectra, {words}" for words in named.values()), "radial spectrum"]
    titles += ["gap", "distribution of the gap", "load on suspicious cells"][: 3 * pair]
    width = 6 // columns
    cells = [
        grid[row, i : i + wide]
        for row, wide in zip(range(len(heights)), (width, 2, width, 2), strict=False)
        for i in range(0, 6, wide)
    ]
    panels = [
        kit.Panel(sheet.add_subplot(cell), which, title)
        for cell, which, title in zip(cells, "abcdefghijkl", titles, strict=False)
    ]
    reliefs, (mask, heights_of, along_x, along_y), rest = (
        panels[: len(faces)],
        panels[len(faces) : columns + 3],
        panels[columns + 3 :],
    )
    outline = kit.draw_faces(sheet, [panel.axes for panel in reliefs], specimen, faces, sides)
    marks = draw_mask(mask.axes, specimen, faces, sides)
    draw_histogram(heights_of, quality, faces)
    draw_profile(along_x, specimen, faces, "x")
    draw_profile(along_y, specimen, faces, "y")
    for panel, face in zip(rest, faces, strict=False):
        draw_spectrum(panel, quality, face)
    draw_radial(rest[len(faces)], quality, faces)
    if pair:
        gap, gap_heights, shares = rest[columns:]
        marks += draw_gap(sheet, gap.axes, specimen, sides)
        draw_gap_heights(gap_heights, quality)
        draw_load_share(shares, subject.curves())
    entries = [outline, *marks, *curve_entries(named, pair=pair)]
    sheet.legend(handles=entries, loc="outside lower center", ncols=4)
    kit.headline(sheet, subject.label)
    style = {"va": "top", "fontsize": 7, "linespacing": 1.2, "parse_math": False}
    below.text(0.01, 1, "\n".join(lines), **style)
    words = {key: quality.attrs[key] for key in ("cells", "overlap")}
    words |= {"warnings": len(warnings), "pair": pair}
    return kit.Drawing(figure, kit.table_of(*panels), kit.caption(__name__, **words))


def _text_lines(specimen, quality, faces, warnings):
    """Findings of a scan, broken into lines; the warnings first."""
    paragraphs = [f"WARNING: {warning}." for warning in warnings]
    paragraphs += [
        f"{face_words(specimen, face).capitalize()}: {quality.attrs[f'{face}_face']}."
        for face in faces
    ]
    paragraphs.append(f"{quality.attrs['cells']}.")
    if overlap := quality.attrs["overlap"]:
        mean, sd = (float(quality[f"gap_{key}"].sel(region="window")) for key in ("mean", "sd"))
        paragraphs.append(
            f"Gap in the window: mean {compact(mean)} mm, sd {compact(sd)} mm; {overlap}."
        )
    return [line for text in paragraphs for line in textwrap.wrap(text, LETTERS)]
