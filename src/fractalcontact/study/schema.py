"""Validation of a file by its schema, with errors that tell the user what to write."""

import difflib
from collections.abc import Iterable, Mapping

import jsonschema

from ..core.errors import InputError

_LONGEST_QUOTE = 80  # characters of what the user wrote, in a message


def validate(document: object, schema: Mapping, source: str) -> None:
    """Check a document against a JSON schema.

    Parameters
    ----------
    document : object
        As read from YAML.
    schema : mapping
    source : str
        The file it came from, for errors.

    Raises
    ------
    InputError
        For the first thing that is wrong: the file, the key, what was expected.
    """
    errors = list(_Validator(schema).iter_errors(document))
    if not errors:
        return
    first = min(errors, key=lambda error: [str(part) for part in error.absolute_path])
    others = f" ({len(errors) - 1} more to see after this one)" if len(errors) > 1 else ""
    raise InputError(f"{source}: {_explain(first)}{others}")


def shortened(text: object) -> str:
    """A text of any length and content as one that fits into a message."""
    text = str(text) if str(text).isprintable() else ascii(text)
    return text if len(text) <= _LONGEST_QUOTE else f"{text[:_LONGEST_QUOTE]}..."


def nearest(word: object, known: Iterable) -> str:
    """Hint at the nearest known word, or at all words if none is near."""
    near = difflib.get_close_matches(str(word), [str(k) for k in known], n=1)
    return f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(map(str, known))}"


def _is_integer(_checker, value):
    """True if a value is an integer; for JSON 512.0 is one, for numpy it is no number of nodes."""
    return isinstance(value, int) and not isinstance(value, bool)


_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine("integer", _is_integer),
)


def _explain(error):
    """Sentence for one schema error: the key, the expected value, the nearest known key."""
    key = ".".join(str(part) for part in error.absolute_path)
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        unknown = sorted(set(error.instance) - set(known), key=str)[0]
        full = f"{key}.{unknown}" if key else unknown
        return f"unknown key '{shortened(full)}'{nearest(unknown, known)}"
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in error.instance)
        full = f"{key}.{missing}" if key else missing
        expected = error.schema["properties"].get(missing, {})
        return f"missing key '{full}'{_expected(expected)}"
    if error.validator == "anyOf" and isinstance(error.instance, dict | list):
        # What is wrong within a mapping or a list says more than that it is none of the forms.
        of_mappings = [found for found in error.context if found.validator not in ("type", "const")]
        inner = max(of_mappings, key=lambda found: len(found.absolute_path), default=error)
        deeper = len(inner.absolute_path) > len(error.absolute_path)
        if deeper or inner.validator == "additionalProperties":
            return _explain(inner)
    return f"{key}: {shortened(repr(error.instance))} is not right{_expected(error.schema)}"


def _expected(schema):
    if schema.get("$ref", "").endswith("quantity"):
        return "; expected a number with its unit, such as 20 mm, 10 kN or 25 GPa"
    return f"; expected {schema['description']}" if "description" in schema else ""
