"""The quality sheet: what it draws is in the atlas, what was done to the file stands in it."""

import json
import shutil

import netCDF4
import numpy as np
import pytest
import xarray as xr
from cases import representative
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from fractalcontact.core.labels import printable
from fractalcontact.figures.draw import draw_figures
from fractalcontact.figures.joint.quality import draw
from fractalcontact.figures.kit.drawing import print_style, save
from fractalcontact.roughness.quality import scan_quality
from fractalcontact.roughness.quality_words import statements

SPECIMENS = ("sliding", "flat", "pair")
REGISTRATION = {
    "mode": "rigid",
    "applied": True,
    "shift_x_mm": 0.45,
    "shift_y_mm": 0.01,
    "rotation_degrees": 0.1,
    "tilt_x_degrees": 0.0,
    "tilt_y_degrees": 0.02,
    "gap_sd_before_mm": 0.363,
    "gap_sd_after_mm": 0.349,
    "gap_mean_before_mm": 0.637,
    "gap_mean_after_mm": 0.637,
    "correlation_before": 0.972,
    "correlation_after": 0.974,
}


def drawn(atlas, name):
    with print_style():
        return draw(atlas, name)


def with_specimen(atlas, name, change):
    """The atlas with one specimen changed by a function of its dataset."""
    changed = atlas.copy()
    specimen = changed[f"specimens/{name}"].to_dataset().copy(deep=True)
    change(specimen)
    changed[f"specimens/{name}"] = xr.DataTree(specimen)
    quality = changed[f"quality/{name}"].to_dataset()
    changed[f"quality/{name}"] = xr.DataTree(quality.assign_attrs(statements(specimen, quality)))
    return changed


def words_of(drawing):
    return "\n".join(text.get_text() for text in drawing.figure.findobj(Text))


@pytest.mark.parametrize("name", representative(SPECIMENS))
def test_the_points_drawn_are_those_of_the_atlas(atlas, name):
    table = drawn(atlas, name).data
    quality = atlas[f"quality/{name}"]
    specimen = atlas[f"specimens/{name}"]
    for face in quality["face"].values:
        for axis in ("x", "y"):
            points = table.query("face == @face and axis == @axis and spectrum_mm3.notna()")
            known = quality["spectrum"].sel(face=face, axis=axis).values
            known = known[np.isfinite(known)]
            assert known.size > 5
            np.testing.assert_allclose(points["spectrum_mm3"], known)
            profile = table.query("face == @face and axis == @axis and height_mm.notna()")
            assert 0 < len(profile) <= specimen.sizes[axis]
            assert profile["height_mm"].max() <= float(specimen[face].max())


def test_a_warning_stands_in_the_sheet_and_in_no_caption(atlas_file, atlas, tmp_path):
    changed = atlas.copy()
    changed["quality/sliding"].attrs["warning"] = (
        "spacings of 0.1 mm are finer than the scan resolves"
    )
    sheet = drawn(changed, "sliding")
    assert "WARNING: spacings of 0.1 mm" in words_of(sheet)
    assert "1 warning stands below the panels." in sheet.caption
    path = shutil.copy(atlas_file, tmp_path)
    with netCDF4.Dataset(path, "a") as file:
        file["quality/sliding"].warning = changed["quality/sliding"].attrs["warning"]
    names = ["fig02_relief", "fig08_prefractals"]
    captions = draw_figures(path, "sliding", tmp_path, names).captions
    assert not any("WARNING" in caption for caption in captions.values())


def test_overlap_and_the_load_on_it_are_drawn_and_said(atlas):
    changed = atlas.copy()
    closure = changed["closure/pair"].to_dataset().copy(deep=True)
    closure["suspect_load_share"][...] = 0.75
    closure.attrs["warning"] = "suspicious cells of the scans carry up to 75% of the reference load"
    changed["closure/pair"] = xr.DataTree(closure)

    def change(specimen):
        deep = specimen["upper"].values.copy()
        deep[40, 40] -= 2.0
        specimen["upper"] = (("y", "x"), deep)
        specimen["overlap"][40, 40] = True

    changed = with_specimen(changed, "pair", change)
    specimen = changed["specimens/pair"].to_dataset()
    quality = scan_quality(specimen, [1])
    changed["quality/pair"] = xr.DataTree(quality)
    depth = float(specimen["lower"][40, 40] - specimen["upper"][40, 40])
    assert float(quality["overlap_depth"].sel(region="window")) == pytest.approx(depth)
    assert int(quality["overlap_cells"].sel(region="scan")) == 1
    drawing = drawn(changed, "pair")
    words = " ".join(words_of(drawing).split())
    assert "WARNING: suspicious cells of the scans carry up to 75% of the reference load." in words
    assert "the faces overlap as scanned in 1 cell of the window" in words
    assert "warning" in drawing.caption
    table = drawing.data
    gap = (specimen["upper"] - specimen["lower"]).values
    assert table["gap_cells"].sum() == np.isfinite(gap).sum()
    assert table.query("gap_mm < 0")["gap_cells"].sum() == 1
    assert (table["suspect_load_share"].dropna() == 0.75).all()


def test_statistics_without_a_common_frame_are_unknown_and_notes_are_stated(atlas):
    def change(specimen):
        unknown = dict.fromkeys(("gap_sd_before_mm", "gap_mean_before_mm", "correlation_before"))
        note = "upper face moved; NOTE: the search had not come to rest"
        specimen.attrs["registration"] = json.dumps(REGISTRATION | unknown | {"note": note})

    text = " ".join(words_of(drawn(with_specimen(atlas, "pair", change), "pair")).split())
    assert "gap sd in mm unknown → 0.349, mean unknown → 0.637" in text
    assert "NOTE: the search had not come to rest" in text


def test_what_was_done_to_the_files_stands_in_words(atlas):
    def change(specimen):
        scan = json.loads(specimen.attrs["lower_scan"])
        scan |= {"reader": "numpy", "overrides": "unit mm, the file says m", "points": 900}
        specimen.attrs |= {
            "lower_scan": json.dumps(scan | {"duplicated_points": 3, "levelled_degrees": 12.5}),
            "registration": json.dumps(REGISTRATION),
            "cleaning": "4 outliers kept",
            "outliers": "keep",
            "outlier_count": 4,
            "filled_count": 6,
        }
        mask = np.zeros(specimen["lower"].shape, bool)
        for variable, rows in (("outlier", slice(40, 42)), ("filled", slice(60, 63))):
            marked = mask.copy()
            marked[rows, 50:52] = True
            specimen[variable] = ("y", "x"), marked

    drawing = drawn(with_specimen(atlas, "pair", change), "pair")
    text = " ".join(words_of(drawing).split())
    for words in (
        "The sidecar overrides: unit mm, the file says m",
        "900 points, 3 of them repeated",
        "Turned by 12.5 degrees",
        "moved by 0.45 mm in x",
        "gap sd in mm 0.363 → 0.349",
        "4 outliers kept",
        "6 cells filled",
        "Levelled: least-squares plane of the mean of both faces",
    ):
        assert words in text
    assert "4 outliers kept, 6 cells filled" in drawing.caption
    legend = [text.get_text() for text in drawing.figure.findobj(Text)]
    assert {"outlier", "filled", "not measured"} <= set(legend)


@pytest.mark.parametrize(
    "name",
    representative(
        ["two\nlines\x1b[31m" + "x" * 180 + ".csv", "x" * 200 + ".csv", "a$b$^_{\\.npy"]
    ),
)
def test_a_strange_file_name_breaks_nothing(atlas, name, tmp_path):
    def change(specimen):
        scan = json.loads(specimen.attrs["lower_scan"]) | {"source": name}
        specimen.attrs["lower_scan"] = json.dumps(scan)

    drawing = drawn(with_specimen(atlas, "flat", change), "flat")
    with print_style():
        save(drawing, tmp_path, "quality")
    width = drawing.figure.get_window_extent().width
    renderer = FigureCanvasAgg(drawing.figure).get_renderer()
    for text in drawing.figure.findobj(Text):
        if len(text.get_text()) > 40:  # sentences; labels of ticks may lie beyond an axis
            assert text.get_window_extent(renderer).x1 <= width * 1.001
    assert "\x1b" not in drawing.caption


def test_names_are_shown_on_one_line():
    assert printable("a\nb\x1b\u202e\udcff") == r"a\nb\x1b\u202e\udcff"
    assert printable("Zürich 岩") == "Zürich 岩"
    assert printable("abcdefghij", 5) == "ab…ij"
