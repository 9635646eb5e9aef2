"""The file of a study, read as plain data, and the study's name."""

import re
from collections.abc import Mapping
from pathlib import Path

import yaml

from ..core.errors import InputError
from ..core.keys import shortened
from .plain_yaml import load_yaml

_TEMPLATE = "__use_yte__"
_MAX_VALUES = 100_000


def read_study(path: Path | str) -> dict:
    """Mapping in the file of a study: all of YAML, since its user wrote it.

    Raises
    ------
    InputError
        If it cannot be read, is no mapping, or is more than plain data: Snakemake would run Python
        code in a study that asks for it, and studies come from colleagues and supplements.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not text in UTF-8 ({error.reason}); save it as that") from error
    document = load_yaml(text, path, anchors=True)
    try:
        yaml.safe_load(text)  # as Snakemake does before it lets the workflow read the study
    except ValueError as error:  # a day that no month has, an integer of thousands of digits
        raise InputError(f"{path}: an invalid date or number ({error})") from error
    if not isinstance(document, dict):
        raise InputError(f"{path}: expected 'key: value' lines, found {type(document).__name__}")
    if _TEMPLATE in document:
        raise InputError(
            f"{path}: the key '{_TEMPLATE}' makes Snakemake run text of the file as Python; a "
            "study is plain data, so remove the key and write the values"
        )
    if _expanded(document) > _MAX_VALUES:
        raise InputError(
            f"{path}: more than {_MAX_VALUES} values once its aliases (*) are written out; a "
            "study is no longer than a few pages"
        )
    return document


def study_name(document: Mapping, source: Path | str) -> str:
    """Name of a study and of the folder of its results; refused where it could lead elsewhere."""
    name = document.get("study")
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,99}", name):
        raise InputError(
            f"{source}: key 'study': found {shortened(repr(name))}, expected the study's name: up "
            "to 100 letters, digits, _ and -"
        )
    return name


def _expanded(value, counts=None):
    """Number of values of a document with every alias written out."""
    counts = {} if counts is None else counts
    if not isinstance(value, (dict, list)):
        return 1
    if id(value) not in counts:
        counts[id(value)] = 1  # an alias of itself adds nothing more
        parts = value.values() if isinstance(value, dict) else value
        counts[id(value)] = 1 + sum(_expanded(part, counts) for part in parts)
    return counts[id(value)]
