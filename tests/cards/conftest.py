"""Cards of a small study: a scanned pair and a surface against a plane."""

import pytest
from page_study import write_study

from fractalcontact.cards.write import read_card, write_cards


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("cards") / "results/tiny"
    write_study(folder)
    assert write_cards(folder / "atlas.nc", folder) == ["flat.1", "pair"]
    return folder


@pytest.fixture(scope="session")
def cards(folder):
    return {name: read_card(folder / f"cards/{name}.yaml") for name in ("flat.1", "pair")}
