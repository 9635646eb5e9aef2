"""Keys of a study and its sidecars: types of values with units, and errors with the remedy.

A section is a pydantic class. Its fields are keys with type, unit, bounds, default and words, and
below each the text that explains it; schemas, tables of keys and errors are made from them.
"""

import ast
import difflib
import inspect
import itertools
import re
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PlainValidator,
    ValidationError,
    WithJsonSchema,
)
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import PydanticCustomError

from .errors import InputError
from .units import load_of, magnitude, share_of

_MAX_QUOTE = 80  # characters of what the user wrote, in a message
#: Most nodes per side of a surface, and cells of a map: making one takes some 35 GB.
MAX_NODES_PER_SIDE = 16384


class Section(BaseModel):
    """Base of all sections: closed, frozen, nothing converted but quantities."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


S = TypeVar("S", bound=Section)


def key(
    words: str | None = None,
    *,
    unsaid: str = "",
    default: Any = None,
    fill: str = "",
    only: str = "",
    **bounds: Any,
) -> Any:
    """Words on a key. The text below a field is the cell of the key in tables of keys.

    Parameters
    ----------
    words : str, optional
        The expected value, in errors: "expected {words}"; by default those of its type.
    unsaid : str, optional
        The cell of what holds where the key is left out, if its default does not say it.
    default : optional
        Value, as the user would write it, of a key that is left out.
    fill : str, optional
        Question of a draft to its owner.
    only : {"contact map", "map", "heights", "pair", "sliding", ""}, optional
        The only files or specimens for which the key has a meaning.
    **bounds
        Bounds of :func:`pydantic.Field`.
    """
    extra = {"x-unsaid": unsaid, "default": default, "x-fill": fill, "x-only": only}
    stated = {name: value for name, value in extra.items() if value not in ("", None)}
    said: dict[str, Any] = {} if words is None else {"description": words}
    return Field(**said, json_schema_extra=stated, **bounds)


# -- types of values -------------------------------------------------------------------------------


def wrong(words: str = "") -> PydanticCustomError:
    """Error of a value of the wrong form, with the expected one if no description states it."""
    return PydanticCustomError("form", "{words}", {"words": words})


def _quantity(kind: str, low: float = -float("inf"), high: float = float("inf")) -> Any:
    """Validator of a quantity of a kind, between two values in the program's unit."""

    def read(value: Any) -> float:
        if not isinstance(value, str):
            raise wrong()
        number = magnitude(value, kind)
        if not low < number < high:
            below = f", an {kind} below {high:g}" if high < float("inf") else ""
            raise InputError(f"{value!r} must be positive{below}")
        return number

    return PlainValidator(read)


def _stated_as(words: str) -> WithJsonSchema:
    return WithJsonSchema({"type": "string", "description": words})


def _offset(value: Any) -> float:
    if not isinstance(value, str):
        raise wrong()
    number = magnitude(value, "length")
    if number < 0:
        raise InputError(f"{value!r} is negative; slide the other way")
    return number


def _load(value: Any) -> tuple[float, str]:
    if not isinstance(value, str):
        raise wrong()
    number, kind = load_of(value)
    if number <= 0:
        raise InputError(f"{value!r} must be positive")
    return number, kind


def _unique(values: list) -> list:
    if any(value in values[:n] for n, value in enumerate(values)):
        raise wrong()
    return values


def matching(pattern: str, words: str) -> BeforeValidator:
    """Validator of a text that a pattern matches whole."""

    def match(text: Any) -> str:
        if not (isinstance(text, str) and re.fullmatch(pattern, text)):
            raise wrong(words)
        return text

    return BeforeValidator(match)


_LENGTH = _stated_as("a length with its unit, such as 20 mm")
Length = Annotated[float, _quantity("length"), _LENGTH]
PositiveLength = Annotated[float, _quantity("length", 0.0), _LENGTH]
Offset = Annotated[float, PlainValidator(_offset), _LENGTH]
Pressure = Annotated[
    float, _quantity("pressure", 0.0), _stated_as("a pressure with its unit, such as 25 MPa")
]
Angle = Annotated[
    float, _quantity("angle", 0.0, 90.0), _stated_as("an angle with its unit, such as 30 deg")
]
Load = Annotated[
    tuple[float, str], PlainValidator(_load), _stated_as("a force or a pressure, 10 kN or 25 MPa")
]
Share = Annotated[
    float,
    PlainValidator(share_of),
    WithJsonSchema({"type": ["string", "number"], "description": "a share, such as 1 % or 0.01"}),
]
#: Validators of a list of distinct values.
different = (AfterValidator(_unique), Field(json_schema_extra={"uniqueItems": True}))


class StatedAs:
    """Mark of the form in which a user states a value of another type."""

    def __init__(self, form: Any):
        self.form = form

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return handler.generate_schema(self.form)


def auto(form: Any) -> StatedAs:
    """Mark of a value that is stated in a form, or as "auto", which is None."""
    none_for_auto = AfterValidator(lambda value: None if value == "auto" else value)
    return StatedAs(Annotated[Literal["auto"] | form, none_for_auto])


Range = Annotated[
    tuple[float, float] | None,
    auto(Annotated[list[Length], Field(min_length=2, max_length=2), AfterValidator(tuple)]),
    key("auto, or two lengths [smallest, largest] such as [0.2 mm, 2 mm]"),
]
Natural = Annotated[int, Field(ge=1, description="a whole number from 1")]
Direction = Annotated[Literal["E", "N", "W", "S"], Field(description="E, N, W or S")]
#: Text of one line without dollar signs, between which figures would read mathematics.
LINE = r"^[^$\x00-\x1f\x7f-\x9f]{1,%d}$"
LABEL_WORDS = "what it is, in up to 200 characters on one line, without $"
Label = Annotated[str, Field(pattern=LINE % 200, description=LABEL_WORDS)]


# -- validation ------------------------------------------------------------------------------------


def validate(section: type[S], document: Mapping, source: str, above: str = "") -> S:
    """Section, of a class, of a document as read from YAML.

    ``source`` is the name of the file, ``above`` are the keys that the section stands under, such
    as "embedded.NAME", for errors. InputError for the first fault: the file, the key, its value,
    the expected value.
    """
    try:
        return section.model_validate(document)
    except ValidationError as error:
        faults = _faults(section, document, error.errors(include_url=False), above)
        others = f" ({len(faults) - 1} more to see after this one)" if len(faults) > 1 else ""
        raise InputError(f"{source}: {faults[0]}{others}") from None


def shortened(text: object) -> str:
    """Text of any length and content, shortened to fit into a message."""
    text = str(text) if str(text).isprintable() else ascii(text)
    return text if len(text) <= _MAX_QUOTE else f"{text[:_MAX_QUOTE]}..."


def nearest(word: object, words: Iterable) -> str:
    """Hint at the nearest known word, or at all words if none is near."""
    near = difflib.get_close_matches(str(word), [str(k) for k in words], n=1)
    return f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(map(str, words))}"


class _Schema(GenerateJsonSchema):
    """JSON schema with the defaults that :func:`key` states, not those that stand for None.

    Keys of a section without words of their own get those of its class.
    """

    def default_schema(self, schema: Any) -> Any:
        return self.generate_inner(schema["schema"])

    def generate(self, schema: Any, mode: Any = "validation") -> dict[str, Any]:
        document = super().generate(schema, mode)
        for section in (document, *document.get("$defs", {}).values()):
            for name, node in section["properties"].items():
                if "description" not in node and (form := _section(document, node)):
                    words = {"description": _mapping_words(form)}
                    section["properties"][name] = dict(sorted((node | words).items()))
        return document


def _mapping_words(form: Mapping) -> str:
    """Words for a section: its keys, those that may be left out last."""
    needed = [name for name in form["properties"] if name in form.get("required", ())]
    optional = [name for name in form["properties"] if name not in needed]
    if not optional:
        return f"a mapping with {' and '.join(filter(None, (', '.join(needed[:-1]), needed[-1])))}"
    if not needed:
        return f"a mapping with any of {', '.join(optional)}"
    return f"a mapping with {', '.join(needed)} and, if wanted, {', '.join(optional)}"


class _WithTexts(_Schema):
    """JSON schema of :class:`_Schema` with the texts below the fields of the classes."""

    def model_schema(self, schema: Any) -> Any:
        document = super().model_schema(schema)
        for name, text in texts_of(schema["cls"]).items():
            if name in document["properties"]:
                document["properties"][name]["markdownDescription"] = text
        return document


@cache
def schema_of(section: type[Section], *, with_texts: bool = False) -> dict[str, Any]:
    """JSON schema of a section; with the texts below its fields, which tables and editors show."""
    return section.model_json_schema(schema_generator=_WithTexts if with_texts else _Schema)


def texts_of(section: type) -> dict[str, str]:
    """Texts below the fields of a class and its bases, a line each, read from their sources."""
    texts: dict[str, str] = {}
    for base in section.__mro__:
        if "texts_of" in vars(base):  # made from another class, without a source of its own
            texts = texts_of(base.texts_of) | texts  # type: ignore[attr-defined]
        elif base.__module__.partition(".")[0] not in ("builtins", "pydantic"):
            texts = _own_texts(base) | texts
    return texts


def _own_texts(section: type) -> dict[str, str]:
    statements: Any = ast.parse(inspect.getsource(section)).body[0]
    texts = {}
    for pair in itertools.pairwise(statements.body):
        match pair:
            case ast.AnnAssign(target=ast.Name(name)), ast.Expr(ast.Constant(str(text))):
                texts[name] = " ".join(text.split())
    return texts


#: Kinds of errors of a value with several forms, from the least to the most specific.
_RANKS = ("other", "value_error", "missing", "extra_forbidden")


def _faults(section: type[Section], document: Mapping, errors: list, above: str) -> list[str]:
    """Sentences on the faults of a document, in the order of their keys.

    A value that may have several forms gives an error for each form; the error farthest inside says
    most.
    """
    groups: dict[tuple, list] = {}
    for error in errors:
        place, path = _place(document, error)
        groups.setdefault(place, []).append((path, error))
    chosen = []
    for place, group in groups.items():
        path, error = max(group, key=lambda fault: (_rank(fault[1]), len(fault[0])))
        says_little = _rank(error) == 0 and len(group) > 1
        chosen.append((place if says_little and len(path) <= len(place) else path, error))
    chosen.sort(key=lambda fault: [str(part) for part in fault[0]])
    return [_sentence(section, document, path, error, above) for path, error in chosen]


def _rank(error: Mapping) -> int:
    return _RANKS.index(error["type"]) if error["type"] in _RANKS else 0


def _place(document: Any, error: Mapping) -> tuple[tuple, tuple]:
    """Keys down to the value with several forms in which an error lies, and down to the error."""
    place: tuple = ()
    path: tuple = ()
    value, several = document, False
    for part in error["loc"]:
        inside = isinstance(value, Mapping) and part in value
        inside |= isinstance(value, list) and isinstance(part, int) and part < len(value)
        if inside:
            path, value = (*path, part), value[part]
        elif part == "[key]":
            path, value = path[:-1], None
        else:
            several = True
        place = place if several else path
    if error["type"] == "missing":
        path = (*path, error["loc"][-1])
        place = place if several else path
    return place, path


def _sentence(
    section: type[Section], document: Any, path: tuple, error: Mapping, above: str
) -> str:
    """Sentence on one error: the key, what stands there, the expected value, the nearest key."""
    name = ".".join(filter(None, (above, *map(str, path))))
    if error["type"] == "extra_forbidden":
        allowed = _nodes(section, path[:-1])[-1].get("properties", {})
        return f"unknown key '{shortened(name)}'{nearest(path[-1], allowed)}"
    words = next((node["description"] for node in reversed(_nodes(section, path)[1:])
                  if "description" in node), "")  # fmt: skip
    if error["type"] == "missing":
        own = _nodes(section, path)[-1].get("description", "")
        return f"missing key '{name}'" + (f"; expected {own}" if own else "")
    if error["type"] == "missing_key":
        return error["msg"]
    if error["type"] == "value_error":
        return f"{name}: {error['ctx']['error']}"
    is_key = error["loc"][-1] == "[key]"
    value = error["input"] if is_key else _value(document, path)
    words = error["msg"] if error["type"] == "form" and error["msg"] else words
    return f"{name}: {shortened(repr(value))} is not right" + (f"; expected {words}" * bool(words))


def _value(document: Any, path: tuple) -> Any:
    for part in path:
        document = document[part]
    return document


def _nodes(section: type[Section], path: tuple) -> list[dict]:
    """Parts of the schema of a section along the keys of a path."""
    schema = schema_of(section)
    nodes = [schema]
    for part in path:
        below = [child for form in _forms(schema, nodes[-1]) if (child := _child(form, part))]
        if not below:
            return nodes
        nodes.append(below[0] | {"properties": _section(schema, below[0]).get("properties", {})})
    return nodes


def _forms(schema: dict, node: dict) -> list[dict]:
    """Forms that a value may have: itself, and each of ``anyOf``, references followed."""
    if "$ref" in node:
        return _forms(schema, schema["$defs"][node["$ref"].rpartition("/")[2]])
    return [
        node,
        *(form for form_node in node.get("anyOf", ()) for form in _forms(schema, form_node)),
    ]


def _child(form: dict, part: Any) -> dict | None:
    if isinstance(part, int):
        return form.get("items")
    more = form.get("additionalProperties")
    return form.get("properties", {}).get(part) or (more if isinstance(more, dict) else None)


def _section(schema: dict, node: dict) -> dict:
    """Form of a value that is a section; empty if there is none."""
    return next((form for form in _forms(schema, node) if form.get("properties")), {})
