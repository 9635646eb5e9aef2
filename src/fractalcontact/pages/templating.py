"""Templates of the pages: one environment, in which every text is escaped."""

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from ..core.atomic import atomic_write
from ..core.labels import printable
from ..core.text import measured, percent, short, with_unit
from .captions import symbols

TEMPLATES = Path(__file__).parent / "templates"
#: Letters that end a script, open a comment or end a line of JavaScript, escaped as in JSON.
_IN_SCRIPT = {"<": "\\u003c", ">": "\\u003e", "&": "\\u0026", "\u2028": "\\u2028"}
_IN_SCRIPT |= {"\u2029": "\\u2029"}


@cache
def environment() -> Environment:
    """Environment of the templates, which escapes all text: labels are untrusted input."""
    templates = Environment(
        loader=FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters |= {"data": script_data, "printable": printable}
    numbers = {of.__name__: of for of in (measured, percent, short, with_unit, symbols)}
    templates.globals |= {"inlined": inlined, **numbers}
    return templates


def script_data(value: Any) -> Markup:
    """JSON of a value that may stand inside a ``script`` element.

    Raises
    ------
    ValueError
        If a number is not finite: JSON has none, missing is ``null``.
    """
    text = json.dumps(value, allow_nan=False, ensure_ascii=False, separators=(",", ":"))
    for sign, escaped in _IN_SCRIPT.items():
        text = text.replace(sign, escaped)
    return Markup(text)


def inlined(name: str) -> Markup:
    """Text of a style sheet or script of the templates, to stand inside its element."""
    return Markup((TEMPLATES / name).read_text(encoding="utf-8"))


def render(template: str, values: Mapping[str, Any]) -> str:
    """HTML of a template with these values."""
    return environment().get_template(template).render(**values)


def write_page(path: Path | str, template: str, values: Mapping[str, Any]) -> None:
    """Write the HTML of a template, whole or not at all."""
    text = render(template, values)
    with atomic_write(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
