"""History of the files of a specimen: on its page, beside the figure of the scan's quality."""

import json
import shutil

import netCDF4
import pytest
from cases import representative
from page_study import write_pages

from fractalcontact.core.labels import printable
from fractalcontact.core.limits import STEEP_TILT
from fractalcontact.pages.history import history
from fractalcontact.study.atlas import read_atlas

FACES = ("lower", "upper")
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


@pytest.fixture
def specimen(cards_folder):
    return read_atlas(cards_folder / "atlas.nc")["specimens/pair"].to_dataset().load()


def test_statistics_without_a_common_frame_are_unknown_and_notes_are_stated(specimen):
    unknown = dict.fromkeys(("gap_sd_before_mm", "gap_mean_before_mm", "correlation_before"))
    note = "upper face moved; NOTE: the search had not come to rest"
    specimen.attrs["registration"] = json.dumps(REGISTRATION | unknown | {"note": note})
    *_, text = history(specimen, FACES)
    assert "gap sd in mm unknown → 0.349, mean unknown → 0.637" in text
    assert "NOTE: the search had not come to rest" in text


def test_what_was_done_to_the_files_stands_in_words(specimen):
    scan = json.loads(specimen.attrs["lower_scan"])
    scan |= {"reader": "numpy", "overrides": "unit mm, the file says m", "points": 900}
    specimen.attrs |= {
        "lower_scan": json.dumps(scan | {"duplicated_points": 3, "levelled_degrees": 12.5}),
        "registration": json.dumps(REGISTRATION),
        "cleaning": "4 outliers kept",
    }
    text = " ".join(history(specimen, FACES))
    for words in (
        "SHA-256",
        "The sidecar overrides: unit mm, the file says m",
        "900 points, 3 of them repeated",
        "Turned by 12.5 degrees",
        "moved by 0.45 mm in x",
        "gap sd in mm 0.363 → 0.349",
        "4 outliers kept",
        "Levelled: least-squares plane of the mean of both faces",
    ):
        assert words in text


@pytest.mark.parametrize(("beyond", "steep"), [(1.0, True), (-1.0, False)])
def test_heights_of_a_steep_face_are_not_normal_to_its_plane(specimen, beyond, steep):
    specimen.attrs["tilt_degrees"] = STEEP_TILT + beyond
    assert ("heights are not normal to the plane" in history(specimen, FACES)[-1]) == steep


@pytest.mark.parametrize(
    ("name", "shown"),
    representative(
        [
            ("two\nlines\x1b[31m<b>" + "x" * 180 + ".csv", r"two\nlines\x1b[31m&lt;b&gt;xxx"),
            ("x" * 200 + ".csv", "x" * 29 + "…" + "x" * 25 + ".csv"),
            ("a$b$^_{\\.npy", "a$b$^_{\\.npy"),
        ]
    ),
)
def test_a_strange_file_name_stands_on_the_page_as_text(cards_folder, tmp_path, name, shown):
    folder = tmp_path / "results/tiny"
    shutil.copytree(cards_folder, folder)
    with netCDF4.Dataset(folder / "atlas.nc", "a") as file:
        group = file["specimens/pair"]
        group.lower_scan = json.dumps(json.loads(group.lower_scan) | {"source": name})
    write_pages(folder)
    page = (folder / "pages/pair.html").read_text(encoding="utf-8")
    section = page[page.index('<div id="history">') :].split("</div>")[0]
    assert section.count("<p") == 3
    assert shown in section
    assert "\x1b" not in section


def test_names_are_shown_on_one_line():
    assert printable("a\nb\x1b\u202e\udcff") == r"a\nb\x1b\u202e\udcff"
    assert printable("Zürich 岩") == "Zürich 岩"
    assert printable("abcdefghij", 5) == "ab…ij"
