"""Captions: Jinja templates of ``captions.yaml``, filled with the numbers of a figure.

An entry of ``PACKAGE/figures/GROUP/captions.yaml`` has the name of a figure and up to three parts:

``shows``
    What is drawn.
``finds``
    Sentences on what is found, in order; one that comes out empty is left out.
``heading``
    What the figure finds, without numbers in brackets, for the card of the result page; without it
    the card has the figure's title.
"""

from functools import cache
from pathlib import Path
from typing import Any

import yaml
from jinja2 import Environment, StrictUndefined

from ...core.packages import SOURCES
from ...core.text import compact, force_label, number, percent, pressure_label
from .words import PAPER


class Caption(str):
    """A caption in one line, with its parts: heading, what is shown, what is found.

    Each part is whole sentences. The heading is empty where the card has the figure's title.
    """

    heading: str
    shows: str
    finds: tuple[str, ...]

    def __new__(cls, heading: str, shows: str, finds: tuple[str, ...]) -> "Caption":
        """Caption of these parts."""
        whole = super().__new__(cls, " ".join((shows, *finds)))
        whole.heading, whole.shows, whole.finds = heading, shows, finds
        return whole

    @property
    def text(self) -> str:
        """Text of the caption's file: the heading, an empty line, one line for each part."""
        return "\n".join((self.heading, "", self.shows, *self.finds))


def caption(module: str, **values: Any) -> Caption:
    """Caption of a figure, by ``__name__`` of its module and the values that its templates name.

    Raises
    ------
    jinja2.UndefinedError
        If a template names a value that is not given.
    """
    file = SOURCES / f"{module.replace('.', '/')}.py"
    entry = _templates(file.with_name("captions.yaml"))[file.stem]

    def filled(template: str) -> str:
        return " ".join(_environment().from_string(template).render(values).split())

    finds = (filled(template) for template in entry.get("finds", ()))
    heading = filled(entry.get("heading", "")).removesuffix(".")
    return Caption(heading, filled(entry["shows"]), tuple(filter(None, finds)))


@cache
def _templates(path: Path) -> dict[str, dict[str, Any]]:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


@cache
def _environment() -> Environment:
    environment = Environment(undefined=StrictUndefined, autoescape=False)  # plain text
    environment.globals["paper"] = PAPER
    environment.filters |= {
        "short": compact,
        "number": number,
        "percent": percent,
        "force": force_label,
        "pressure": pressure_label,
        "text": lambda estimate, unit="": estimate.text(unit),
    }
    return environment
