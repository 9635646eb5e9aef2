"""Cards of figures: heading, caption, numbers, files, and the lines that draw one again."""

import struct
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from markupsafe import Markup

from ..study.figure_list import Figure, all_figures
from .captions import symbols, take_apart

#: Sections of a specimen's page, in order, by name and title.
SECTIONS = {
    "scan": "Scan",
    "joint": "Joint",
    "closure": "Closure",
    "dilatancy": "Dilatancy and strength",
    "flow": "Aperture and flow",
    "domains": "Contact domains",
    "size effect": "Size effect",
    "trust": "How far to trust it",
}
#: Section of a figure by the stages that it needs: the first with any of them.
_BY_STAGE = (
    ("trust", ("choices", "error_budget")),
    ("size effect", ("windows", "window_states", "size_test")),
    ("domains", ("domains", "domain_measures", "scaling")),
    ("dilatancy", ("dilatancy", "strength")),
    ("scan", ("quality", "surface_dimension")),
    ("closure", ("closure", "area")),
    ("joint", ("joints",)),
)
#: Endings of the files of a figure that a page offers, and their names on it.
FILES = {"png": "PNG", "svg": "SVG", "pdf": "PDF", "csv": "CSV"}
_PNG = b"\x89PNG\r\n\x1a\n"


@dataclass(frozen=True)
class Card:
    """Figure as a page shows it; addresses are relative to the page."""

    name: str
    title: str
    heading: Markup
    text: list[Markup]
    numbers: list[Markup]
    image: str
    width: int
    height: int
    files: dict[str, str]
    code: str


def section_of(figure: Figure) -> str:
    """Section of a specimen's page that a figure belongs to."""
    if figure.section:
        return figure.section
    return next((name for name, stages in _BY_STAGE if set(stages) & set(figure.needs)), "trust")


def cards_of(
    names: Sequence[str],
    folder: Path,
    address: str,
    *,
    atlas: str,
    groups: Collection[str],
    specimen: str = "",
) -> list[Card]:
    """Cards of the figures whose files exist in a folder.

    ``address`` is that of the folder, relative to the page; ``atlas`` and ``groups`` are the path
    of the atlas as a user would type it, and the names of its groups. ``specimen`` is empty of
    figures of a whole study.
    """
    cards = []
    for name in names:
        picture, caption = folder / f"{name}.png", folder / f"{name}.txt"
        if not (picture.is_file() and caption.is_file()):
            continue
        parts = take_apart(caption.read_text(encoding="utf-8"))
        width, height = png_size(picture)
        title = all_figures()[name].title
        start = f"{quote(address)}/{quote(name)}"
        cards.append(
            Card(
                name=name,
                title=title,
                heading=symbols(parts.finding or title),
                text=[symbols(sentence) for sentence in parts.text],
                numbers=[symbols(sentence) for sentence in parts.rest],
                image=f"{start}.png",
                width=width,
                height=height,
                files={
                    words: f"{start}.{ending}"
                    for ending, words in FILES.items()
                    if (folder / f"{name}.{ending}").is_file()
                },
                code=redrawn(name, specimen, atlas, groups),
            )
        )
    return cards


def redrawn(name: str, specimen: str, atlas: str, groups: Collection[str]) -> str:
    """Lines of Python that read the stages of a figure with xarray, and draw it again.

    Stages that are none of the ``groups`` of the atlas are left out. ``specimen`` is empty for a
    figure of a study.
    """
    stages = all_figures()[name].needs
    subject = repr(specimen)
    if not specimen:
        # A study of synthetic surfaces alone, or of measured maps alone, has no specimens.
        of_specimens = "specimens" in stages
        subject = "sorted(atlas['specimens'].children)" if of_specimens else "[]"
    of_stages = {stage: _group_of(stage, specimen) for stage in stages}
    read = [f"{stage} = atlas['{group}']" for stage, group in of_stages.items() if group in groups]
    return "\n".join(
        [
            "import xarray as xr",
            "from fractalcontact.figures.draw import draw_figure",
            "",
            f"atlas = xr.open_datatree({atlas!r})",
            *read,
            "",
            "own = {}  # or your font and size: {'font.family': 'serif', 'font.size': 9}",
            f"drawing = draw_figure(atlas, {name!r}, {subject}, style=own)",
            f"drawing.figure.savefig({name + '.pdf'!r})",
            "drawing.data  # the numbers, a table",
        ]
    )


def _group_of(stage, specimen):
    """Group of a stage: that of the specimen, if there is one; measured maps have their own."""
    return f"{stage}/{specimen}" if specimen and stage != "contact_maps" else stage


def png_size(path: Path) -> tuple[int, int]:
    """Width and height of a PNG file in pixels, so that a page keeps its place before it loads.

    Raises
    ------
    ValueError
        If it is no PNG file.
    """
    with open(path, "rb") as file:
        head = file.read(24)
    if len(head) < 24 or not head.startswith(_PNG):
        raise ValueError(f"{path}: no PNG file")
    width, height = struct.unpack(">II", head[16:24])
    return width, height
