"""The page of a study of measured contact maps, which has no specimens."""

import re

import numpy as np
import pandas as pd
import pytest
from page_study import write_pages
from stated import MAP

from fractalcontact.domain.measured_map import read_contact_map
from fractalcontact.stages.atlas import join_stages
from fractalcontact.study.atlas import read_atlas

LOADS = (120, 24, 3, 12)  # MPa


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Results of four films of one series and of two of unknown load."""
    folder = tmp_path_factory.mktemp("maps")
    film = np.random.default_rng(0).random((24, 24))
    maps = {}

    def add(name, threshold, **keys):
        np.save(folder / f"{name}.npy", film)
        options = {**MAP, "unit": "mm", "spacing": 0.5, "threshold": threshold}
        label = f"=film, {name.replace('_', ' ')}"
        maps[name] = read_contact_map(folder / f"{name}.npy", options | keys, label=label)

    for load in LOADS:
        add(f"film_{load}", 0.95 - load / 200, load=f"{load} MPa", series="films")
    for number in (10, 9):
        add(f"cast_{number}", 0.5)
    study = {"study": "maps", "scans": "scans"}
    join_stages(
        {"contact_maps": maps}, folder / "atlas.nc", {"study": study, "settings": {}}, made_with={}
    )
    assert write_pages(folder) == []
    return folder


def test_maps_are_listed_by_pressure_and_by_the_numbers_in_their_names(folder):
    page = (folder / "index.html").read_text(encoding="utf-8")
    found = re.findall(r"<li>=film, (\w+ \d+)</li>", page)
    assert found == ["film 3", "film 12", "film 24", "film 120", "cast 9", "cast 10"]


def test_the_summary_has_a_row_for_each_map_and_the_page_offers_it(folder):
    table = pd.read_csv(folder / "summary.csv")
    assert list(table["map"]) == ["film_3", "film_12", "film_24", "film_120", "cast_9", "cast_10"]
    assert set(table["study"]) == {"maps"}
    assert table["nominal_pressure_MPa"].dropna().tolist() == sorted(LOADS)
    maps = read_atlas(folder / "atlas.nc")["contact_maps"]
    for column in ("area_share", "delta_sigma", "delta_sigma_low"):
        stored = [maps[name][column].item() for name in table["map"]]
        np.testing.assert_allclose(table[column], stored, rtol=1e-6)
    assert all(label.startswith("'=") for label in table["label"])  # no formula of a spreadsheet
    assert 'href="summary.csv"' in (folder / "index.html").read_text(encoding="utf-8")
