"""Text of a sidecar: a reduced YAML, since it is untrusted input.

Words and numbers mean what they look like: ``1e-3`` is a number, ``no``, ``1:30`` and
``2020-01-01`` are words, ``010`` is ten. Anchors, tags, keys written twice and nesting without end
are refused; so is a file far longer than any sidecar.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, ClassVar

import yaml

from ..core.errors import InputError
from ..scan.options import CONTACT_MAP

LARGEST_SIDECAR = 64 * 1024  # bytes
DEEPEST_SIDECAR = 10  # lists within mappings within ...
_LONGEST_INTEGER = 18  # digits; a longer one is a number like any other

_STANDARD = "tag:yaml.org,2002:"
#: The core schema of YAML 1.2; PyYAML's own is that of 1.1.
_WORDS = (
    ("null", r"~|null|Null|NULL|"),
    ("bool", r"true|True|TRUE|false|False|FALSE"),
    ("int", r"[-+]?[0-9]+"),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.inf|\.nan"),
)


def is_contact_map(scan_options: Mapping) -> bool:
    """True if a sidecar says that its file is a map of contact, not of heights."""
    return scan_options.get("kind") == CONTACT_MAP


def sidecar_of_matrix(spacing: float) -> dict[str, str]:
    """Scan keys of an array of heights in mm, its rows ascending in y: all that must be stated.

    Parameters
    ----------
    spacing : float
        Distance of two cells, mm.
    """
    return {
        "kind": "face",
        "layout": "matrix",
        "axes": "none",
        "unit": "mm",
        "spacing": f"{spacing:.12g} mm",
        "first_row": "bottom",
        "heights": "up",
        "missing": "none",
    }


def read_yaml(path: Path | str) -> dict:
    """Mapping in a YAML file.

    Returns
    -------
    dict
        Keys are texts; values texts, numbers, truth values, None, lists or such mappings.

    Raises
    ------
    InputError
        If the file is too long, no YAML, or not a mapping.
    """
    try:
        with open(path, "rb") as stream:
            content = stream.read(LARGEST_SIDECAR + 1)
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    if len(content) > LARGEST_SIDECAR:
        raise InputError(
            f"{path}: longer than the {LARGEST_SIDECAR // 1024} kB of a sidecar; write only the "
            "keys listed in scans/README.md"
        )
    try:
        document = yaml.load(content, _Loader)
    except yaml.YAMLError as error:
        raise unreadable(path, error) from error
    if document is None:
        return {}
    if not isinstance(document, dict):
        raise InputError(f"{path}: expected 'key: value' lines, found {type(document).__name__}")
    return document


def plain_value(text: str, where: str) -> Any:
    """One value as a sidecar would have it behind its key: "20 mm", "[1, 2]", "true".

    Parameters
    ----------
    text : str
    where : str
        For errors.

    Raises
    ------
    InputError
        If it is no such value.
    """
    try:
        return yaml.load(text[:LARGEST_SIDECAR], _Loader)
    except yaml.YAMLError as error:
        raise unreadable(where, error) from error


def unreadable(path: Path | str, error: yaml.YAMLError) -> InputError:
    """Sentence on an error in YAML.

    Parameters
    ----------
    path : path-like
    error : yaml.YAMLError
    """
    if isinstance(error, yaml.MarkedYAMLError):
        line = f"line {error.problem_mark.line + 1}: " if error.problem_mark else ""
        problem = f"{line}{error.problem}"
    else:
        problem = f"{error.reason} at character {error.position}; save it as plain text in UTF-8"
    return InputError(f"{path}: not readable as YAML: {problem}")


class _Loader(yaml.SafeLoader):
    """PyYAML's safe loader, reduced to the needs of a sidecar."""

    yaml_implicit_resolvers: ClassVar[dict] = {}
    depth = 0

    def compose_node(self, parent, index):
        event = self.peek_event()
        if isinstance(event, yaml.AliasEvent) or event.anchor:
            raise _refusal("anchors (&) and aliases (*) have no use here; write it out", event)
        if event.tag:
            problem = f"{event.tag[:40]!r} has no use here; write plain words and numbers"
            raise _refusal(problem, event)
        self.depth += 1
        if self.depth > DEEPEST_SIDECAR:
            raise _refusal(f"nested more than {DEEPEST_SIDECAR} deep", event)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def construct_mapping(self, node, deep=False):
        found = set()
        for key, _ in node.value:
            if not key.tag.endswith(":str"):
                raise _refusal(f"the key {str(key.value)[:40]!r} is no word", key)
            if key.value in found:
                raise _refusal(f"the key {key.value[:40]!r} stands here a second time", key)
            found.add(key.value)
        return super().construct_mapping(node, deep)

    def construct_yaml_int(self, node):
        """Decimal, also with a zero in front; one of many digits is a number like any other."""
        of = int if len(node.value) <= _LONGEST_INTEGER else float
        return of(node.value)


def _refusal(problem: str, where) -> yaml.MarkedYAMLError:
    return yaml.constructor.ConstructorError(problem=problem, problem_mark=where.start_mark)


for _name, _pattern in _WORDS:
    _Loader.add_implicit_resolver(_STANDARD + _name, re.compile(rf"(?:{_pattern})\Z"), None)
_Loader.add_constructor(_STANDARD + "int", _Loader.construct_yaml_int)
