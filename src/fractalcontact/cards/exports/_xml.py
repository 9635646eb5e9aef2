"""Elements, comments and text of the exports in XML."""

from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree as xml

from .constants import head_of


def headed(tag: str, card: Mapping[str, Any], code: str) -> xml.Element:
    """Root element that begins with the first lines of an export, as comments."""
    root = xml.Element(tag)
    root.extend(comment(line) for line in head_of(card, code))
    return root


def comment(text: str) -> Any:
    """Comment on one line; two hyphens would end it."""
    return xml.Comment(f" {' '.join(text.split()).replace('--', '- -').rstrip('-')} ")


def text_of_element(root: xml.Element) -> str:
    """Indented text of an element; indents the element."""
    xml.indent(root)
    return xml.tostring(root, encoding="unicode") + "\n"
