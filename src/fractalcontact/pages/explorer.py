"""Explorer of the contact states of a study: maps and curves of every state on one page."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import xarray as xr
from matplotlib import colormaps
from matplotlib.colors import to_hex

from .packed_states import packed_states
from .templating import write_page

#: Colours of pressures and gaps, distinguished by colour-blind readers and in grey.
COLOUR_MAP = "cividis"
#: Steps of the colour map that the page gets; it interpolates between them.
COLOURS = 33
#: Stages that the page shows.
NEEDS = (
    "specimens",
    "joints",
    "contact",
    "closure",
    "dilatancy",
    "domains",
    "scaling",
    "error_budget",
)


def write_explorer(atlas: xr.DataTree, path: Path | str) -> None:
    """Write the page on all contact states of a study: one file that needs no other.

    Parameters
    ----------
    atlas : xr.DataTree
        From :func:`study.atlas.read_atlas`, with the stages :data:`NEEDS`.
    path : path-like
        ``explorer.html`` beside the atlas and the result page, to which it links.

    Raises
    ------
    OutputError
        If the disk is full or the folder cannot be written to.
    """
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
        label = str(attrs.get("label") or name)
        yield {"name": name, "label": label, "states": packed_states(atlas, name)}


def _colours() -> list[str]:
    return [to_hex(colour) for colour in colormaps[COLOUR_MAP].resampled(COLOURS).colors]
