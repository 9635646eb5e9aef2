"""Cards of a small study: a scanned pair and a surface against a plane."""

import pytest

from fractalcontact.cards.write import read_card


@pytest.fixture(scope="session")
def folder(cards_folder):
    return cards_folder


@pytest.fixture(scope="session")
def cards(folder):
    return {name: read_card(folder / f"cards/{name}.yaml") for name in ("flat.1", "pair")}
