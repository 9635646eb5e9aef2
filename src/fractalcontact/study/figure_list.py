"""Register of the figures, which the workflow reads before anything is drawn.

A figure registers itself: its module ``PACKAGE/figures/GROUP/NAME.py`` states, each in a line that
begins with the constant's name and holds literals alone,

``TITLE``
    Title of the figure, for the report.
``SUBJECT``
    Subject: "specimen" for every specimen, "joint" for those that slide, "study" for
    a study as a whole.
``NEEDS``
    Stages of the atlas that it reads.
``ORDER``
    Place among the figures of the same subjects.
``KEY``
    Key of the configuration that asks for the figure; of figures of a study alone.
``SECTION``
    Section of the result page, where it does not follow from the stages; may be left out.
``JOINT_STUDY``
    True if `figures: joint` draws it, for the owner of a joint; may be left out.

The constants are read without importing the module, which would bring matplotlib and xarray into
every process that reads the workflow.
"""

import ast
import re
from collections.abc import Container
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..core.directions import slides
from ..core.packages import SOURCES, installed

#: Folders of the figures, each with a folder a group; :mod:`figures.kit` is shared code.
FOLDERS = [SOURCES / name / "figures" for name in installed()]
_SHARED = "kit"

SPECIMEN, JOINT, STUDY = "specimen", "joint", "study"

#: A constant and its value, which may continue in indented lines and end in a closing bracket.
_CONSTANT = re.compile(
    r"^(TITLE|SUBJECT|NEEDS|ORDER|KEY|SECTION|JOINT_STUDY) = "
    r"(.*\n(?:(?:[ \t]+.*|[)\]}].*)\n)*)",
    re.MULTILINE,
)


@dataclass(frozen=True)
class Figure:
    """Statements of a figure's module, and ``module``, its path below ``src`` without ending."""

    name: str
    module: str
    title: str
    subject: str
    needs: tuple[str, ...]
    order: float
    key: str = ""
    section: str = ""
    joint_study: bool = False


def read_figure(path: Path | str) -> Figure:
    """Statements of a figure's module ``GROUP/NAME.py``, read without importing it.

    Raises
    ------
    ValueError
        If a constant is missing or no literal, or the subject is unknown.
    """
    path = Path(path)
    stated = {}
    for name, value in _CONSTANT.findall(path.read_text(encoding="utf-8")):
        try:
            stated[name.lower()] = ast.literal_eval(value.strip())
        except (ValueError, SyntaxError) as error:
            raise ValueError(f"{path}: {name} is no literal") from error
    wanted = ["title", "subject", "needs", "order"]
    if stated.get("subject") == STUDY:
        wanted.append("key")
    missing = [name.upper() for name in wanted if name not in stated]
    if missing:
        raise ValueError(f"{path}: a figure states {', '.join(missing)}")
    if stated["subject"] not in (SPECIMEN, JOINT, STUDY):
        raise ValueError(f"{path}: SUBJECT {stated['subject']!r} is unknown")
    module = "/".join((*path.parts[-4:-1], path.stem))
    return Figure(path.stem, module, **stated)


@cache
def all_figures() -> dict[str, Figure]:
    """Every figure by name, in order; ValueError if two have one name."""
    paths = [
        path
        for folder in FOLDERS
        for path in folder.glob("*/[!_]*.py")
        if path.parent.name != _SHARED
    ]
    figures = sorted(map(read_figure, paths), key=lambda figure: (figure.order, figure.name))
    named = {figure.name: figure for figure in figures}
    for figure in figures:
        if named[figure.name] is not figure:
            modules = f"{figure.module}.py and {named[figure.name].module}.py"
            raise ValueError(f"{modules}: two figures of one name; rename one")
    return named


def figures_of(opposite: str) -> list[str]:
    """Names of the figures that make sense for a specimen with this opposite face."""
    subjects = {SPECIMEN, JOINT} if slides(opposite) else {SPECIMEN}
    return [name for name, figure in all_figures().items() if figure.subject in subjects]


def study_figures_of(experiments: Container[str]) -> list[str]:
    """Names of the figures of a whole study whose keys are among those of its configuration."""
    return [
        name
        for name, figure in all_figures().items()
        if figure.subject == STUDY and figure.key in experiments
    ]
