"""Keys of a sidecar that determine how a scan file is read."""

import math
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ..core.errors import InputError
from ..core.keys import validate
from ..core.units import length_factor, quantity
from .keys import ScanKeys


class ScanOptions(SimpleNamespace):
    """Statements of a sidecar about a scan file: each key of `ScanKeys`, None where not stated.

    A file that describes itself needs none of them; any other is read only as they state, see
    :mod:`scan.stated`. They are not changed; :meth:`but` makes others.
    """

    def __init__(self, **stated: Any):
        if unknown := sorted(stated.keys() - ScanKeys.model_fields.keys()):
            raise TypeError(f"{unknown[0]!r} is not a key of a scan")
        super().__init__(**dict.fromkeys(ScanKeys.model_fields) | stated)

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError("statements are not changed; make others with `but`")

    def stated(self) -> dict[str, Any]:
        """Values of the keys that are stated."""
        return {key: value for key, value in vars(self).items() if value is not None}

    def but(self, **changes: Any) -> "ScanOptions":
        """The same statements, some of them changed."""
        return ScanOptions(**{**vars(self), **changes})

    @property
    def marks(self) -> tuple[float, ...]:
        """Numbers stated to mark missing cells, and those outside an outline."""
        outside = self.outline.get("mask") if isinstance(self.outline, dict) else None
        every = self._missing if outside is None else (*self._missing, outside)
        return tuple(mark for mark in every if not isinstance(mark, str))

    @property
    def missing_words(self) -> tuple[str, ...]:
        """Words stated to mark missing cells of a text."""
        words = (mark for mark in self._missing if isinstance(mark, str))
        return tuple(word for word in words if word != NO_MARK)

    @property
    def _missing(self) -> tuple:
        if self.missing is None:
            return ()
        return self.missing if isinstance(self.missing, tuple) else (self.missing,)


CONTACT_MAP = "contact-map"
#: Keys that say how the numbers of a text are written.
WRITING_KEYS = ("delimiter", "decimal", "thousands", "header")
#: Signs between numbers by the key `delimiter`; a blank is white space of any length.
DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "blank": " "}
#: Value of the key `missing` where every number is a height, however it looks.
NO_MARK = "none"
#: Keys that say how two faces lie to each other.
PAIR_KEYS = ("registration", "mirror_upper")
#: Keys of statements on one face alone.
FACES = ("lower", "upper")
#: Keys that name the files of the coordinates, where x, y and z are three files.
COORDINATE_KEYS = ("x", "y")
#: Keys that mean nothing for the other layout, and what is meant by them.
MATRIX_KEYS = ("spacing", "first_row", "axes")
POINT_KEYS = ("columns", "grid")


def parse_options(options: Mapping | None, where: str) -> ScanOptions:
    """Statements on the file ``where``, from keys of `ScanKeys` but ``lower`` and ``upper``.

    An unknown key, and a value of the wrong kind, are refused.
    """
    document = {key: _as_list(value) for key, value in (options or {}).items()}
    allowed = [key for key in ScanKeys.model_fields if key not in FACES]
    if unknown := sorted(set(document) - set(allowed), key=str):
        raise InputError(f"{where}: unknown scan key {unknown[0]!r}; known: {', '.join(allowed)}")
    stated = {key: value for key, value in document.items() if value is not None}
    validate(ScanKeys, stated, where)
    for key in ("unit", "unit_xy", "unit_z"):
        if key in stated:
            length_factor(stated[key], f"{where}: {key}")
    _refuse_one_mark_for_two(stated, where)
    return ScanOptions(
        **{key: tuple(value) if isinstance(value, list) else value for key, value in stated.items()}
    )


def _as_list(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def of_face(options: Mapping | None, face: str) -> dict[str, Any]:
    """Keys of one face of a pair: those of both, then those under ``lower`` or ``upper``."""
    common = {key: value for key, value in (options or {}).items() if key not in FACES}
    return {**common, **((options or {}).get(face) or {})}


def _refuse_one_mark_for_two(options: dict, where: str) -> None:
    decimal = options.get("decimal")
    taken = {"decimal mark": decimal, "delimiter": DELIMITERS.get(str(options.get("delimiter")))}
    for name, mark in taken.items():
        if mark is not None and mark == options.get("thousands"):
            raise InputError(
                f"{where}: {mark!r} is both the {name} and the thousands mark; write 'thousands' "
                "only where digits are grouped"
            )
    if decimal == "," and options.get("delimiter") == "comma":
        raise InputError(
            f"{where}: a comma is both the decimal mark and the delimiter; export it with decimal "
            "points, or with semicolons between the numbers"
        )


def coordinate_files(path: Path, options: Mapping[str, Any]) -> dict[str, Path]:
    """Files of the coordinates of the matrix at ``path``, by key; empty if its sidecar names none.

    A file of x without one of y is refused, and so is a name that is not that of another file in
    the same folder.
    """
    named = {key: str(options[key]) for key in COORDINATE_KEYS if options.get(key) is not None}
    if not named:
        return {}
    if missing := [key for key in COORDINATE_KEYS if key not in named]:
        raise InputError(f"sidecar of {path}: key '{missing[0]}' is missing; x and y are two files")
    for key in ("spacing", "first_row"):
        if options.get(key) is not None:
            raise InputError(f"sidecar of {path}: remove '{key}': the files of x and y state it")
    for key, name in named.items():
        # Sidecars are untrusted input: nothing outside the folder is read.
        if Path(name).name != name or "\\" in name or name.startswith(".") or name == path.name:
            raise InputError(
                f"sidecar of {path}: {key}: {name!r}; write the plain name of another file beside "
                "it"
            )
    return {key: path.with_name(name) for key, name in named.items()}


def length_mm(value: Any, unit_xy: str | None, where: str) -> float:
    """Spacing in mm: a text with its own unit, or a number in ``unit_xy``, above zero."""
    if isinstance(value, str):
        length = quantity(value, "length", where)
    elif not _is_number(value):
        raise InputError(f"{where}: {value!r} is no length; write for example '0.1 mm'")
    elif unit_xy is None:
        raise InputError(f"{where}: {value!r} has no unit; write for example '{value} mm'")
    else:
        length = value * length_factor(unit_xy, where)
    if not (math.isfinite(length) and length > 0):
        raise InputError(f"{where}: {value!r} must be a finite length above zero")
    return length


def spacing_mm(spacing: Any, unit_xy: str | None, where: str) -> tuple[float, float]:
    """Read one spacing, or a pair (dx, dy), in mm."""
    pair = spacing if isinstance(spacing, tuple) else (spacing, spacing)
    if len(pair) != 2:
        raise InputError(f"{where}: expected one spacing or a pair [dx, dy], not {list(pair)!r}")
    dx, dy = (length_mm(value, unit_xy, where) for value in pair)
    return dx, dy


def has_own_units(spacing: Any) -> bool:
    """True if a spacing, or each of a pair, is a text such as "0.1 mm"."""
    pair = spacing if isinstance(spacing, tuple) else (spacing,)
    return all(isinstance(step, str) for step in pair)


def _is_number(value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
