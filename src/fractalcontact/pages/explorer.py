"""Explorer of the contact states of a study: maps and curves of every state on one page."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib import colormaps
from matplotlib.colors import to_hex

from ..core.labels import printable
from ..report.published import stages_of
from ..study.atlas_parts import Trees
from .packed_states import packed_states
from .templating import write_page

#: Colours of pressures and gaps, distinguished by colour-blind readers and in grey.
COLOUR_MAP = "cividis"
#: Colours of the map that the page gets; it interpolates between them.
COLOURS = 33
#: Most letters of a specimen's label.
MAX_LABEL = 100
#: Stages that the page shows.
NEEDS = stages_of("explorer") | {"contact"}


def write_explorer(
    atlas_path: Path | str, path: Path | str, names: Sequence[str] | None = None
) -> None:
    """Write ``explorer.html``, all contact states of specimens, beside atlas and result page.

    It is one file that needs no other. ``names`` are all specimens by default.

    Raises
    ------
    OutputError
        If the disk is full or the folder cannot be written to.
    """
    trees = Trees(atlas_path, NEEDS)
    study = trees.root.attrs["study"]
    shown = trees.names if names is None else names
    specimens = [_specimen(trees.of(name)[0], name) for name in shown]
    values = {
        "title": f"Explorer of the study {study}",
        "study": study,
        "index": {
            "study": study,
            "specimens": [
                {key: specimen[key] for key in ("name", "label")} for specimen in specimens
            ],
            "colours": _colours(),
        },
        "specimens": specimens,
    }
    write_page(path, "explorer.html", values)


def _specimen(atlas, name) -> dict[str, Any]:
    """Name, label and states of a specimen."""
    label = printable(atlas[f"specimens/{name}"].attrs.get("label") or name, MAX_LABEL)
    return {"name": name, "label": label, "states": packed_states(atlas, name)}


def _colours() -> list[str]:
    colours = colormaps[COLOUR_MAP]
    return [to_hex(colours(i / (COLOURS - 1))) for i in range(COLOURS)]
