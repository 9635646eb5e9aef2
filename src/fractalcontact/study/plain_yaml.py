"""YAML of studies and sidecars, read as plain data by one loader, so that both mean the same.

Words and numbers mean what they look like: ``1e-3`` is a number; ``no``, ``1:30`` and
``2020-01-01`` are words; ``010`` is ten. Keys are texts, each stated once. Tags and endless nesting
are refused. Anchors and aliases are for studies alone.
"""

import re
from pathlib import Path
from typing import Any, ClassVar

import yaml

from ..core.errors import InputError

MAX_DEPTH = 20  # nested lists or mappings
_MAX_DIGITS = 18  # of an integer; a longer one is a number like any other

_STANDARD = "tag:yaml.org,2002:"
#: The core schema of YAML 1.2; PyYAML's own is that of 1.1.
_WORDS = (
    ("null", r"~|null|Null|NULL|"),
    ("bool", r"true|True|TRUE|false|False|FALSE"),
    ("int", r"[-+]?[0-9]+"),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.inf|\.nan"),
)
#: Key that merges the keys of another mapping into its own, ``<<: *anchor``.
_MERGE = "<<"


def load_yaml(text: str | bytes, source: Path | str, *, anchors: bool = False) -> Any:
    """Plain data of a text in YAML: texts, numbers, truth values, None, lists and mappings.

    ``anchors`` allows anchors, aliases and merged mappings (``<<``), which untrusted files have no
    use for.

    Raises
    ------
    InputError
        With the line, if the text is no such YAML, or a mapping has a key twice.
    """
    try:
        return yaml.load(text, _AnchorLoader if anchors else _Loader)
    except yaml.YAMLError as error:
        raise _unreadable(source, error) from error


def _unreadable(source: Path | str, error: yaml.YAMLError) -> InputError:
    if isinstance(error, yaml.MarkedYAMLError):
        line = f"line {error.problem_mark.line + 1}: " if error.problem_mark else ""
        problem = f"{line}{error.problem}"
    else:
        problem = f"{error.reason} at character {error.position}; save it as plain text in UTF-8"
    return InputError(f"{source}: not readable as YAML: {problem}")


class _Loader(yaml.SafeLoader):
    """PyYAML's safe loader, reduced to plain data without anchors."""

    yaml_implicit_resolvers: ClassVar[dict] = {}
    allows_anchors = False
    depth = 0

    def compose_node(self, parent, index):
        event = self.peek_event()
        if not self.allows_anchors and (isinstance(event, yaml.AliasEvent) or event.anchor):
            raise _refusal("anchors (&) and aliases (*) have no use here; write it out", event)
        if getattr(event, "tag", None):
            problem = f"{event.tag[:40]!r} has no use here; write plain words and numbers"
            raise _refusal(problem, event)
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise _refusal(f"nested more than {MAX_DEPTH} deep", event)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node

    def compose_mapping_node(self, anchor):
        """Mapping whose keys are texts, each stated once."""
        node = super().compose_mapping_node(anchor)
        lines: dict[str, int] = {}
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise _refusal("a list or a mapping as a key, which is no word", key)
            if key.value in lines:
                problem = (
                    f"the key {key.value[:40]!r} stands here a second time, after line "
                    f"{lines[key.value]}; keep one of them"
                )
                raise _refusal(problem, key)
            lines[key.value] = key.start_mark.line + 1
            merges = self.allows_anchors and key.value == _MERGE
            key.tag = _STANDARD + ("merge" if merges else "str")
        return node

    def construct_yaml_int(self, node):
        """Decimal integer, also with a leading zero; a float if it has many digits."""
        of = int if len(node.value) <= _MAX_DIGITS else float
        return of(node.value)


class _AnchorLoader(_Loader):
    """:class:`_Loader` with anchors, aliases and merged mappings."""

    allows_anchors = True


def _refusal(problem: str, where: Any) -> yaml.MarkedYAMLError:
    return yaml.constructor.ConstructorError(problem=problem, problem_mark=where.start_mark)


for _name, _pattern in _WORDS:
    _Loader.add_implicit_resolver(_STANDARD + _name, re.compile(rf"(?:{_pattern})\Z"), None)
_Loader.add_constructor(_STANDARD + "int", _Loader.construct_yaml_int)
# PyYAML copies the resolvers and constructors of a class when one is added, not when a class is
# derived. The derived class therefore takes those of its base here.
_AnchorLoader.yaml_implicit_resolvers = _Loader.yaml_implicit_resolvers
_AnchorLoader.yaml_constructors = _Loader.yaml_constructors
