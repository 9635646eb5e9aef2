"""The quality sheet: what it draws is in the atlas, and what it finds stands below."""

import shutil

import netCDF4
import numpy as np
import pytest
import xarray as xr
from cases import representative
from matplotlib.text import Text

from fractalcontact.core.window import window_slices
from fractalcontact.figures.draw import draw_figures
from fractalcontact.figures.joint.quality import draw
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.roughness.quality import scan_quality
from fractalcontact.roughness.quality_words import statements

SPECIMENS = ("sliding", "flat", "pair")


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
def test_profiles_run_through_the_middle_of_the_window(atlas, name):
    drawing, specimen = drawn(atlas, name), atlas[f"specimens/{name}"].to_dataset()
    panels = [axes for axes in drawing.figure.axes if axes.get_title(loc="left")]
    assert len(panels) == 7 + 5 * (name == "pair")
    for panel, across, cells in zip("de", "yx", window_slices(specimen), strict=True):
        rows = drawing.data[drawing.data["panel"] == panel]
        for face, profile in rows.groupby("face"):
            line = specimen[face].isel({across: (cells.start + cells.stop) // 2})
            np.testing.assert_array_equal(profile["height_mm"], line)
            np.testing.assert_allclose(np.diff(profile["place_mm"]), 0.1)


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


def test_marked_cells_are_drawn_and_the_files_are_left_to_the_page(atlas):
    def change(specimen):
        specimen.attrs |= {"outliers": "keep", "outlier_count": 4, "filled_count": 6}
        mask = np.zeros(specimen["lower"].shape, bool)
        for variable, rows in (("outlier", slice(40, 42)), ("filled", slice(60, 63))):
            marked = mask.copy()
            marked[rows, 50:52] = True
            specimen[variable] = ("y", "x"), marked

    drawing = drawn(with_specimen(atlas, "pair", change), "pair")
    assert "4 outliers kept, 6 cells filled" in drawing.caption
    words = words_of(drawing)
    assert {"outlier", "filled", "not measured"} <= set(words.splitlines())
    for origin in ("SHA-256", "read by", "Registration", "Levelled"):
        assert origin not in words
