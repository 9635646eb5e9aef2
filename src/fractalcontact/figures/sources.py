"""Digests of what figures are drawn from, by which a figure that would not change is kept."""

import hashlib
import json
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from xarray import DataTree

from ..core.atomic import atomic_write
from ..core.settings import Friction
from ..core.subject import configuration_of
from ..study.figure_list import all_figures

#: Settings that no figure reads: those of the stage `strength` follow from them.
_UNREAD = frozenset(Friction.__dataclass_fields__)


class Source(NamedTuple):
    """Digest of what a figure was drawn from, and the statements whose verdicts it quotes."""

    digest: str
    statements: tuple[str, ...]


def source_of(
    atlas: DataTree, figure: str, specimen: str, statements: Collection[str], code: str
) -> Source:
    """Source of a figure of one specimen: stages it needs, quoted statements, settings and code."""
    settings = dict(configuration_of(atlas)["settings"][specimen])
    material = settings.pop("material", {})
    settings["material"] = {key: material[key] for key in material.keys() - _UNREAD}
    quoted = tuple(sorted(statements))
    digest = hashlib.sha256()
    digest.update(json.dumps([code, settings, quoted], sort_keys=True).encode())
    for stage in all_figures()[figure].needs:
        members = atlas[stage].children if stage in atlas.children else {}
        for name in [specimen] if specimen in members else sorted(members):
            data = members[name].to_dataset()
            if stage == "statements":
                data = data.sel(statement=[one for one in quoted if one in data["statement"]])
            digest.update(f"{stage}/{name}".encode())
            _add(digest, data)
    return Source(digest.hexdigest(), quoted)


def _add(digest: Any, data: xr.Dataset) -> None:
    """Add names, dimensions, values and attributes of a dataset to a digest."""
    digest.update(_text(data.attrs))
    for name, variable in sorted(data.variables.items(), key=lambda item: str(item[0])):
        values = np.asarray(variable.values)
        digest.update(f"{name} {variable.dims} {values.shape} {values.dtype}".encode())
        digest.update(_text(variable.attrs))
        is_text = values.dtype == object
        digest.update(_text(values.tolist()) if is_text else np.ascontiguousarray(values).data)


def _text(data: Any) -> bytes:
    """Plain data and arrays as text, the same for the same content."""
    return json.dumps(data, sort_keys=True, default=_plain).encode()


def _plain(data: Any) -> Any:
    """Array, or number of numpy, as plain data."""
    return data.tolist() if hasattr(data, "tolist") else str(data)


def read_sources(path: Path | str | None) -> dict[str, Source]:
    """Sources by figure that :func:`write_sources` wrote; none without such a file."""
    if path is None or not Path(path).is_file():
        return {}
    rows = [line.split(" ") for line in Path(path).read_text(encoding="utf-8").splitlines()]
    return {name: Source(digest, tuple(quoted)) for name, digest, *quoted in rows}


def write_sources(sources: Iterable[tuple[str, Source]], path: Path | str) -> None:
    """Write a line for each figure: its name, its digest, the statements that it quotes."""
    lines = (" ".join((name, one.digest, *one.statements)) + "\n" for name, one in sources)
    with atomic_write(path) as temporary:
        temporary.write_text("".join(lines), encoding="utf-8")
