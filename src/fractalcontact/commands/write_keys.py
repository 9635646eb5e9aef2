"""Write what is made from the classes of keys and the register: schemas, and tables in documents.

python -m fractalcontact.commands.write_keys
"""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..core.atomic import atomic_write
from ..core.keys import schema_of
from ..report.published import PLACES, published
from ..scan.keys import ScanKeys
from ..study import keys, laboratory_keys

#: Sections of one key of a study, whose keys stand in its table as ``solver.rtol``.
_INSIDE = {"solver": keys.SolverKeys, "grain": keys.GrainKeys}
#: Keys of contact maps, which scans/README.md explains in a section of their own.
OF_MAPS = ("threshold", "outline", "series", "x", "y", "cells", "load")
_MARKS = "<!-- keys: {name} -->\n", "<!-- end of keys -->"


def schemas() -> dict[str, str]:
    """Text of each schema by its file."""
    sections = {"study": keys.StudyKeys, "sidecar": keys.SidecarKeys}
    draft = {"$schema": "https://json-schema.org/draft/2020-12/schema"}
    return {
        f"config/schema/{name}.schema.json": json.dumps(
            draft | schema_of(section, with_texts=True), indent=1, ensure_ascii=False
        )
        + "\n"
        for name, section in sections.items()
    }


def tables() -> dict[str, dict[str, str]]:
    """Tables of keys and of published numbers in Markdown, by document and name."""
    laboratory = {
        "roll_off": keys.RollOffKeys,
        "area_slope": keys.AreaSlopeKeys,
        "size_effect": keys.SizeEffectKeys,
        "size_strength": keys.SizeStrengthKeys,
        "speed": keys.SpeedKeys,
        "convergence": keys.ConvergenceKeys,
        "stability": keys.StabilityKeys,
    }
    two, three = ("key", "what it is"), ("key", "what it is", "if left out")
    study = {
        "study": _table(three, _study_rows()),
        "material": _table(three, _rows(keys.MaterialKeys)),
        "embedded": _table(two, _rows(keys.EmbeddedKeys)),
        "settings": _table(three, _rows(keys.SettingsKeys)),
        "measured": _table(("key", "what it is", "of"), _test_rows()),
        **{name: _table(two, _rows(section)) for name, section in laboratory.items()},
    }
    scan = (row for row in _rows(ScanKeys) if row[0] not in OF_MAPS)
    maps = (row for row in _rows(ScanKeys) if row[0] in OF_MAPS)
    scans = {"scan": _table(("key", "meaning"), scan)}
    return {
        "scans/README.md": scans,
        "docs/keys.md": {**study, **scans, "map": _table(("key", "meaning"), maps)},
        "docs/atlas.md": {
            "published": _table(("variable", "unit", "what it is", "shown"), _published_rows())
        },
    }


def written(document: str, tables: dict[str, str]) -> str:
    """Text of a document with its tables between their marks."""
    for name, table in tables.items():
        start, end = (mark.format(name=name) for mark in _MARKS)
        before, _, rest = document.partition(start)
        _, mark, after = rest.partition(end)
        if not mark:
            raise ValueError(f"no place for the table {name!r}")
        document = f"{before}{start}{table}{mark}{after}"
    return document


def main() -> int:
    """Write all files."""
    for path, text in schemas().items():
        _write(path, text)
    for path, table in tables().items():
        _write(path, written(Path(path).read_text(encoding="utf-8"), table))
    return 0


def _write(path: str, text: str) -> None:
    with atomic_write(Path(path)) as temporary:
        temporary.write_text(text, encoding="utf-8")


def _rows(section: Any, above: str = "") -> Iterator[tuple[str, str, str]]:
    """Key, its text or words, and what holds without it."""
    schema = schema_of(section, with_texts=True)
    for name, node in schema["properties"].items():
        words = node.get("markdownDescription", node.get("description", ""))
        unsaid = node.get("x-unsaid") or _unsaid(section.model_fields[name], node)
        yield f"{above}{name}", words, unsaid


def _unsaid(field: Any, node: dict[str, Any]) -> str:
    """Value that holds for a key that is left out, by its default."""
    if field.is_required():
        return "required"
    value = node.get("default", field.default)
    if isinstance(value, str | int):
        return f"`{value}`" if isinstance(value, str) else str(value)
    is_auto = any(form.get("const") == "auto" for form in node.get("anyOf", ()))
    return "`auto`" if is_auto else "none"


def _study_rows() -> Iterator[tuple[str, str, str]]:
    for row in _rows(keys.StudyKeys):
        if row[0] in _INSIDE:
            yield from _rows(_INSIDE[row[0]], f"{row[0]}.")
        else:
            yield row


def _published_rows() -> Iterator[tuple[str, ...]]:
    """Variables of the atlas that the register names, their units, titles and places."""
    for row in published():
        if row.stage != "settings":
            shown = ", ".join(words for key, words in PLACES.items() if getattr(row, key))
            shown += f": {row.shown}" if row.shown else ""
            cells = (row.unit, row.title, shown)
            yield row.source, *(re.sub(r"([*|_])", r"\\\1", cell) for cell in cells)


def _test_rows() -> Iterator[tuple[str, str, str]]:
    """Keys of laboratory tests, and the kinds that have each."""
    kinds = {kind: schema_of(of, with_texts=True) for kind, of in laboratory_keys.KINDS.items()}
    for name in dict.fromkeys(name for schema in kinds.values() for name in schema["properties"]):
        having = [kind for kind, schema in kinds.items() if name in schema["properties"]]
        nodes = [kinds[kind]["properties"][name] for kind in having]
        text = next(node["markdownDescription"] for node in nodes if "markdownDescription" in node)
        unsaid = nodes[0].get("x-unsaid", "")
        of = "all" if len(having) == len(kinds) else ", ".join(having)
        is_required = all(name in kinds[kind]["required"] for kind in having)
        yield name, text, f"{of}{', required' * is_required}{unsaid and f'; unsaid, {unsaid}'}"


def _table(head: tuple[str, ...], rows: Iterator[tuple[str, ...]]) -> str:
    lines = [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
    lines += [f"| {' | '.join((f'`{row[0]}`', *row[1:])[: len(head)])} |" for row in rows]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
