"""Specimens at the edge of what a study can be given: every figure is drawn, or says why not."""

import os

import pytest
from chain import atlas_of_scan, draw_scan
from extremes import EXTREMES, write_extreme
from places import SCANS
from stated import ARRAY, CORONA, GRANITE, NANOVEA, SURFDIFF

from fractalcontact.core.errors import InputError
from fractalcontact.figures import draw
from fractalcontact.figures.draw import ENDINGS, draw_figures, drawer_of
from fractalcontact.figures.kit.drawing import print_style, save
from fractalcontact.laws.closure import FULL_CONTACT
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.figure_list import figures_of

#: Of the made ones, those that no study can use; and those that may be taken for no scan.
REFUSED = {"exactly_level"}
DOUBTFUL = {"plane", "plane_against_plane", "plane_of_bits", "constant_of_bits", "huge_tilt"}
#: A smooth step half-way, as between two tables: taken for two unless the sidecar says otherwise.
DOUBTFUL |= {"fine_step"}
#: The whole chain takes some ten seconds a specimen.
in_full = pytest.mark.skipif(
    os.environ.get("EXTREMES") != "all", reason="`make extremes` runs them: many minutes"
)
OF_THE_INTERFACE = ("fig04_05_closure", "compliance", "conductance")


def texts(drawing):
    return [
        text.get_text().replace("\n", " ") for axes in drawing.figure.axes for text in axes.texts
    ]


def require_whole(drawn, folder, opposite):
    """No figure failed, and each has its files."""
    assert drawn.failures == {}
    files = {path.name for path in folder.iterdir()}
    assert files == {f"{name}.{ending}" for name in figures_of(opposite) for ending in ENDINGS}


def test_faces_in_full_contact_have_figures_that_say_so(tmp_path):
    lower, upper, options, settings = write_extreme(tmp_path, EXTREMES["polished"](), "polished")
    # A free window: full contact of a mirrored one has a closure, that of the mean planes.
    settings = settings | {"boundary": "free"}
    path, _ = atlas_of_scan(lower, upper, options, tmp_path, settings)
    atlas = read_atlas(path)
    curves = atlas["closure/specimen"]
    # Full contact at two loads of three: nothing of the interface is left to measure.
    heavy = curves["interface_closure"].sel(resolution=1)[:, :, 1:]
    assert heavy.isnull().all()
    assert "contact is so full" in curves.attrs["warning"]
    with print_style():
        for name in OF_THE_INTERFACE:
            drawing = drawer_of(name)(atlas, "specimen")
            assert FULL_CONTACT in texts(drawing)
            save(drawing, tmp_path / "figures", name)
    names = {path.name for path in (tmp_path / "figures").iterdir()}
    assert names == {f"{name}.{ending}" for name in OF_THE_INTERFACE for ending in ENDINGS}


def test_a_figure_that_fails_leaves_words_and_keeps_no_other_from_being_drawn(
    atlas_file, tmp_path, monkeypatch
):
    def failing(atlas, name):
        raise ZeroDivisionError("a $bad {error}\nof two lines")

    broken = {"fig02_relief": failing}
    monkeypatch.setattr(draw, "drawer_of", lambda name: broken.get(name) or drawer_of(name))
    names = ["fig02_relief", "conductance"]
    drawn = draw_figures(atlas_file, "sliding", tmp_path, names)
    assert list(drawn.failures) == ["fig02_relief"]
    assert "ZeroDivisionError" in drawn.failures["fig02_relief"]
    assert drawn.captions["fig02_relief"].startswith("Not drawn: Fig. 2")
    assert "ZeroDivisionError: a $bad {error}" in (tmp_path / "fig02_relief.txt").read_text()
    assert "not_drawn_because" in (tmp_path / "fig02_relief.csv").read_text()
    assert drawn.captions["conductance"].startswith("Supplementary figure")
    files = {path.name for path in tmp_path.iterdir()}
    assert files == {f"{name}.{ending}" for name in names for ending in ENDINGS}


def test_what_is_wrong_with_the_disk_is_no_fault_of_a_figure(atlas_file, tmp_path):
    (tmp_path / "figures").write_text("a file where the folder should be")
    with pytest.raises(OSError, match="figures"):
        draw_figures(atlas_file, "sliding", tmp_path / "figures", ["conductance"])


@in_full
@pytest.mark.parametrize("name", EXTREMES)
def test_an_extreme_specimen_has_all_its_figures_or_is_refused(name, tmp_path):
    files = write_extreme(tmp_path, EXTREMES[name](), name)
    lower, upper, options, settings = files
    refusal = None
    try:
        path, opposite = atlas_of_scan(lower, upper, options, tmp_path, settings)
    except InputError as error:
        refusal = str(error)
    if refusal is not None:
        assert name in REFUSED | DOUBTFUL
        assert str(lower) in refusal
        return
    assert name not in REFUSED
    drawn = draw_scan(path, opposite, tmp_path / "figures")
    require_whole(drawn, tmp_path / "figures", opposite)


#: Real scans that are accepted: files below the folder, what their sidecars say.
REAL = {
    "granite": (
        "cnl_granite_pair/Extracted_M_CNL_SideA_bottom.txt",
        "cnl_granite_pair/Extracted_M_CNL_SideB_top.txt",
        GRANITE | {"grid": "1 mm"},
        {},
    ),
    "corona": (
        "corona_fault/coronaA_grids.npz",
        None,
        CORONA,
        {"window": "200 mm"},
    ),
    "grasselli": ("grasselli_joint/example_surface.stl", None, {"unit": "mm"}, {"window": "6 mm"}),
    "nanovea_1": ("nanovea/test1.txt", None, NANOVEA, {}),
    "nanovea_4": ("nanovea/test4.txt", None, NANOVEA, {}),
    "surfdiff": ("surfdiff_rock/BottomBlue.csv", "surfdiff_rock/TopRed.csv", SURFDIFF, {}),
}
_INSTRUMENTS = {
    "surfacetopography/al3d-1.al3d": "14 um",
    "surfacetopography/bcrf-1.bcrf": "60 um",
    "surfacetopography/frt-1.frt": "0.8 mm",
    "surfacetopography/matrix-3.txt": "1.2 um",
    "surfacetopography/metropro-1.dat": "35 um",
    "surfacetopography/mnt-1.mnt": "60 um",
    "surfacetopography/nms-1.nms": "10 um",
    "surfacetopography/plu-1.plu": "50 um",
    "surfacetopography/sur-2.sur": "110 um",
    "surfacetopography/tmd-1.tmd": "2 mm",
    "x3p/sample-land.x3p": "80 um",
    "x3p/surface_binary.x3p": "32 um",
    "x3p/surface_xml.x3p": "32 um",
    "x3p/surface_irregular_xml.x3p": "64 um",
}
REAL |= {
    name.replace("/", " "): (f"instruments/{name}", None, {}, {"window": window})
    for name, window in _INSTRUMENTS.items()
}
REAL["surfacetopography matrix-3.txt"] = (
    "instruments/surfacetopography/matrix-3.txt",
    None,
    ARRAY
    | {"delimiter": "tab", "decimal": ".", "header": 4, "first_row": "top"}
    | {"unit_z": "m", "spacing": "0.0390625 um"},
    {"window": "1.2 um"},
)
REAL["test.gwy"] = (
    "instruments/gwyfile/test.gwy",
    None,
    {"unit": "um", "spacing": 1},
    {"window": "32 um"},
)


@in_full
@pytest.mark.scans
@pytest.mark.skipif(not SCANS.is_dir(), reason="the folder of real scans is absent")
@pytest.mark.parametrize("name", REAL)
def test_a_real_scan_has_all_its_figures(name, tmp_path):
    lower, upper, options, settings = REAL[name]
    upper = None if upper is None else SCANS / upper
    path, opposite = atlas_of_scan(SCANS / lower, upper, options, tmp_path, settings)
    drawn = draw_scan(path, opposite, tmp_path / "figures")
    require_whole(drawn, tmp_path / "figures", opposite)
