"""Files of the cards of a study: YAML and JSON for programs, one printed page for people."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml
from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

from ..core.atomic import atomic_write
from ..core.errors import InputError
from ..core.labels import printable
from ..core.subject import Subject, configuration_of
from ..pages.files import APERTURE, APERTURE_ENDINGS, CARD
from ..pages.first_screen import block_of, is_synthetic
from ..pages.templating import write_page
from ..study.atlas_parts import Trees
from .apertures import aperture_at, write_aperture
from .card import FORM, STAGES, card_of, made_of
from .page import page_of

#: Description of a card, as JSON Schema.
SCHEMA = Path(__file__).with_name("card.schema.json")


#: Stages that the cards and the aperture maps read.
NEEDS = STAGES | {"contact"}


def write_cards(
    path: Path | str, folder: Path | str, apertures: bool = True, trees: Trees | None = None
) -> list[str]:
    """Specimens of an atlas, whose cards ``cards/NAME.yaml``, ``.json``, ``.html`` are written.

    Parameters
    ----------
    path : path-like
        The atlas of a study, or of one specimen.
    folder : path-like
        Of the results.
    apertures : bool
        Whether to write ``apertures/NAME.csv``, ``.nc``, ``.vtk`` at the reference load too; never
        of an atlas in parts.
    trees : Trees, optional
        The atlas with at least the stages of :data:`NEEDS`, where it is read already.
    """
    trees = trees or Trees(path, NEEDS)
    study, made = configuration_of(trees.root)["study"], made_of(trees.root.attrs)
    for name in trees.names:
        tree = trees.of(name, without={"contact"})[0]
        subject = Subject.of(tree, name)
        block = block_of(subject, is_synthetic(name, study))
        write_card(card_of(subject, study, made), folder, block)
        if trees.parts or not apertures:
            continue
        contact = trees.root[f"contact/{name}"].to_dataset()[["map_gap"]]
        aperture = aperture_at(contact, None, name, folder)
        for ending in APERTURE_ENDINGS:
            write_aperture(aperture, Path(folder) / APERTURE.format(specimen=name, ending=ending))
    return trees.names


def write_card(
    card: Mapping[str, Any], folder: Path | str, block: Mapping[str, Any] | None = None
) -> None:
    """Write the three files of a card, each whole or not at all; the printed one with a block."""
    texts = {
        "yaml": yaml.safe_dump(dict(card), sort_keys=False, allow_unicode=True, width=100),
        "json": json.dumps(card, indent=1, allow_nan=False, ensure_ascii=False) + "\n",
    }
    for ending, text in texts.items():
        with atomic_write(Path(folder) / CARD.format(specimen=card["name"], ending=ending)) as file:
            file.write_text(text, encoding="utf-8")
    page = Path(folder) / CARD.format(specimen=card["name"], ending="html")
    write_page(page, "card.html", page_of(card, block))


def read_card(path: Path | str) -> dict[str, Any]:
    """Card from its YAML or JSON.

    Raises
    ------
    InputError
        If the file is missing, is neither, or is no card of this form.
    """
    path = Path(path)
    try:
        # A YAML parser reads JSON too.
        card = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise InputError(
            f"{path}: cannot be read ({type(error).__name__}); expected a card, such as "
            "results/paper/cards/sandstone_twin.yaml"
        ) from None
    if not isinstance(card, dict) or card.get("form") != FORM or "entries" not in card:
        raise InputError(
            f"{path}: no card of form {FORM}; expected 'form: {FORM}' and 'entries', as in "
            "results/paper/cards/sandstone_twin.yaml"
        )
    schema = Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8")))
    if wrong := best_match(schema.iter_errors(card)):
        key = ".".join(map(str, wrong.absolute_path))
        raise InputError(
            f"{path}: no whole card: {key and f'{key}: '}{printable(wrong.message, 120)}; mend "
            "that, or let the study write its cards again (make)"
        )
    return card
