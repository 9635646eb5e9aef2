"""Pages and cards of an atlas in parts: those of one file, for any number of specimens."""

import json

import numpy as np
import pandas as pd
import pytest
from page_study import write_pages

from fractalcontact.cards.write import write_cards
from fractalcontact.core.subject import configuration_of
from fractalcontact.pages import result_page
from fractalcontact.pages.explorer import write_explorer
from fractalcontact.study.atlas import read_atlas, write_atlas

NAMES = ["flat.1", "pair"]


@pytest.fixture(scope="module")
def parts(results, tmp_path_factory):
    """The same study, its atlas in one file a specimen, with the states of one to explore."""
    folder = tmp_path_factory.mktemp("parts") / "results/tiny"
    (folder / "atlas").mkdir(parents=True)
    whole = read_atlas(results / "atlas.nc")
    stated = configuration_of(whole)
    stated["study"] |= {"atlas": "parts", "explorer": ["pair"]}
    for name in NAMES:
        stages = {
            stage: {name: group[name].to_dataset()}
            for stage, group in whole.children.items()
            if name in group.children
        }
        own = {"study": {"study": "tiny"}, "settings": {name: stated["settings"][name]}}
        write_atlas(stages, folder / f"atlas/{name}.nc", study="tiny", configuration=own)
    write_atlas(
        {"study_comparison": {"study": whole["study_comparison/study"].to_dataset()}},
        folder / "atlas.nc",
        study="tiny",
        configuration=stated,
        parts_in={name: f"atlas/{name}.nc" for name in NAMES},
        checksums=json.loads(whole.attrs["scan_checksums"]),
    )
    write_explorer(folder / "atlas.nc", folder / "explorer.html", ["pair"])
    assert write_cards(folder / "atlas.nc", folder) == NAMES
    assert write_pages(folder) == NAMES
    return folder


@pytest.mark.parametrize("table", ["summary.csv", "curves.csv"])
def test_tables_are_those_of_one_file(results, parts, table):
    pd.testing.assert_frame_equal(pd.read_csv(parts / table), pd.read_csv(results / table))


@pytest.mark.parametrize("name", NAMES)
def test_cards_are_those_of_one_file(results, parts, name):
    one, other = (
        json.loads((folder / f"cards/{name}.json").read_text(encoding="utf-8"))
        for folder in (results, parts)
    )
    assert one == other


def test_the_table_leads_to_the_card_of_each_and_to_the_states_of_chosen_ones(parts):
    html = (parts / "index.html").read_text(encoding="utf-8")
    for name in NAMES:
        assert f'href="cards/{name}.html"' in html
        assert f'href="pages/{name}.html"' in html
        page = (parts / f"pages/{name}.html").read_text(encoding="utf-8")
        shown = f"#specimen={name}"
        assert ((shown in html), (shown in page)) == ((name == "pair"),) * 2
        # An aperture map of each of a thousand is written for who asks for it.
        assert "../apertures/" not in page
    states = (parts / "explorer.html").read_text(encoding="utf-8")
    assert 'id="states-0"' in states
    assert 'id="states-1"' not in states


def test_verdicts_of_many_specimens_are_counted(results, parts, monkeypatch):
    monkeypatch.setattr(result_page, "_COLUMNS", 1)
    monkeypatch.setattr(result_page, "_BLOCKS", 1)
    result_page.write_index(result_page.Place.of(parts), ["pair"])
    html = (parts / "index.html").read_text(encoding="utf-8")
    assert "<template" not in html
    assert 'class="joint"' not in html
    cells = html.partition('class="matrix"')[2].partition("</table>")[0]
    counts = [int(cell.partition("</td>")[0] or 0) for cell in cells.split("<td>")[1:]]
    table = pd.read_csv(results / "statements.csv", keep_default_na=False)
    assert np.sum(counts) == table["counted"][table["specimen"] != ""].sum() > 10
