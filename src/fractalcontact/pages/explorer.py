"""Explorer of the contact states of a study: maps and curves of every state on one page."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from matplotlib import colormaps
from matplotlib.colors import to_hex

from ..core.labels import printable
from ..study.atlas import read_atlas
from ..study.stages import STAGES
from .packed_states import packed_states
from .templating import write_page

#: Colours of pressures and gaps, distinguished by colour-blind readers and in grey.
COLOUR_MAP = "cividis"
#: Colours of the map that the page gets; it interpolates between them.
COLOURS = 33
#: Letters of a specimen's label that are shown.
MAX_LABEL = 100
#: Stages that the page shows.
NEEDS = (
    "specimens",
    "contact",
    "closure",
    "flow",
    "dilatancy",
    "domains",
    "scaling",
    "error_budget",
)


def write_explorer(atlas_path: Path | str, path: Path | str) -> None:
    """Write the page on all contact states of a study: one file that needs no other.

    Parameters
    ----------
    atlas_path : path-like
        Atlas of the study.
    path : path-like
        ``explorer.html`` beside the atlas and the result page, to which it links.

    Raises
    ------
    OutputError
        If the disk is full or the folder cannot be written to.
    """
    atlas = read_atlas(atlas_path, without=STAGES.keys() - set(NEEDS))
    specimens = list(_specimens(atlas))
    values = {
        "title": f"Explorer of the study {atlas.attrs['study']}",
        "study": atlas.attrs["study"],
        "index": {
            "study": atlas.attrs["study"],
            "specimens": [{key: one[key] for key in ("name", "label")} for one in specimens],
            "colours": _colours(),
        },
        "specimens": specimens,
    }
    write_page(path, "explorer.html", values)


def _specimens(atlas) -> Iterator[dict[str, Any]]:
    """Names, labels and states of all specimens that have contact states."""
    groups = atlas["closure"].children if "closure" in atlas.children else ()
    for name in groups:
        attrs = atlas[f"specimens/{name}"].attrs
        label = printable(attrs.get("label") or name, MAX_LABEL)
        yield {"name": name, "label": label, "states": packed_states(atlas, name)}


def _colours() -> list[str]:
    colours = colormaps[COLOUR_MAP]
    return [to_hex(colours(i / (COLOURS - 1))) for i in range(COLOURS)]
