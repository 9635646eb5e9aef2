"""Keys that the owner of a file must state, because the file itself does not: nothing is guessed.

A file that describes itself (instruments' files, X3P, netCDF by the CF conventions, text whose
columns are named x, y and z with a unit each) needs none of them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..core.directions import APERTURE
from ..core.errors import InputError
from ..core.file_names import split_file_name
from .draft import OPENING, Hints, draft_lines, drafted_options
from .options import CONTACT_MAP, ScanOptions, has_own_units
from .raw import IncompleteSidecar
from .tables import choose_array


@dataclass(frozen=True)
class Needs:
    """Needs of a file that does not describe itself."""

    text: bool = False  # lines of numbers, whose writing is to be stated
    table: bool = False  # rows and columns that may be a matrix or points
    grid: bool = False  # a matrix whose format gives spacing, first row and missing cells
    arrays: Sequence[str] = ()  # arrays, channels or pages of which `variable` names one


def require_stated(
    path: Path, options: ScanOptions, needs: Needs, hints: Callable[[], Hints]
) -> None:
    """Refuse a profile, and a file whose sidecar lacks a statement needed to read it.

    The error of a lacking statement holds a draft; ``hints`` is called for it only then.
    """
    if options.kind == "profile":
        raise InputError(
            f"{path}: its sidecar says that it holds a profile and no surface; export the whole "
            "surface"
        )
    if needs.table and not needs.text and (options.variable is not None or not needs.arrays):
        choose_array(list(needs.arrays), options.variable, path)
    if not (lacks := lacking(options, needs)):
        return
    clues = hints()
    if word := OPENING.search(path.stem):
        if word[0].lower().startswith(APERTURE):
            clues.state("kind", APERTURE, f"its name says {word[0]!r}")
        else:
            clues.ask("kind", f"its name says {word[0]!r}")
    clues.ask_openings()
    complete = drafted_options(options, clues)
    required = set(required_keys(complete, needs))
    # A layout that only the draft knows asks for keys of its own.
    draft = "\n".join(draft_lines(options, clues, required, needs.arrays))
    stated = options.but(registration=None, mirror_upper=None, grid=None)
    states_some = stated != ScanOptions()
    name, _ = split_file_name(path.name)
    sidecar = path.with_name(f"{name}.yaml")
    what = f"its sidecar lacks {', '.join(lacks)}" if states_some else "it has no sidecar"
    raise IncompleteSidecar(
        f"{path}: such a file is read only with a complete sidecar, and {what}. Write into "
        f"{sidecar} and look at each line ('make describe FILE={path}' draws what would be read):",
        draft,
    )


def lacking(options: ScanOptions, needs: Needs) -> list[str]:
    """Keys that are required and not stated."""
    return [key for key in required_keys(options, needs) if getattr(options, key) is None]


def required_keys(options: ScanOptions, needs: Needs) -> list[str]:
    """Keys that must be stated of a file, given those that are: in the order of a sidecar."""
    is_map = options.kind == CONTACT_MAP
    layout = options.layout if needs.table and not is_map else "matrix"
    keys = ["kind"]
    if needs.text:
        keys += ["delimiter", "decimal", "header"]
    if needs.table and not is_map:
        keys += ["layout"]
    if len(needs.arrays) > 1:
        keys += ["variable"]
    if layout == "points":
        keys += ["columns"]
    elif needs.table and layout == "matrix":
        keys += ["axes"]
    keys += _units(options, layout, is_map)
    has_coordinates = needs.grid or (options.axes == "both" and options.spacing is None)
    if layout == "matrix" and not has_coordinates:
        keys += ["spacing", "first_row"]
    if layout == "points" and options.spacing is not None:
        keys += ["first_row"]
    if not is_map and options.kind != APERTURE:
        keys += ["heights"]
    return keys if needs.grid else [*keys, "missing"]


def _units(options: ScanOptions, layout: str | None, is_map: bool) -> list[str]:
    """Required keys of units: ``unit`` alone where it can hold for all axes."""
    if options.unit is not None:
        return []
    by_unit_xy = options.unit_xy is None and not has_own_units(options.spacing)
    by_unit_z = options.unit_z is None and not is_map
    if by_unit_xy and by_unit_z:
        return ["unit"]
    return ["unit_xy"] * by_unit_xy + ["unit_z"] * by_unit_z
