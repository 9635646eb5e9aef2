"""Apertures for dfnWorks: lines of Python for ``DFN.set_fracture_hydraulic_values``, in m."""

from collections.abc import Mapping
from typing import Any

from ...core.text import short
from ..entries import reference_of, row_at
from .constants import Constants, head_of

ENDING = "py"
_KEY = "aperture"


def constants_of(card: Mapping[str, Any]) -> Constants:
    """Hydraulic aperture under the reference load: dfnWorks takes k = b^2 / 12 from it."""
    entry, constants, pressure = (
        card["entries"]["hydraulic_aperture"],
        Constants(),
        reference_of(card),
    )
    row = row_at(entry, pressure)
    constants.add(_KEY, entry, row, f"hydraulic aperture at {short(pressure)} MPa")
    return constants


def by_pressure(card: Mapping[str, Any]) -> dict[float, float]:
    """Hydraulic aperture, m, by the nominal pressure, MPa, where it is determined."""
    return {
        row["at"]["pressure"]: 1e-3 * row["value"]
        for row in card["entries"]["hydraulic_aperture"].get("values", ())
        if "value" in row and row.get("determined", True)
    }


def text_of(card: Mapping[str, Any]) -> str:
    """Lines of Python that give fractures of a network the aperture of the joint."""
    constants = constants_of(card)
    lines = [f"# {line}" for line in head_of(card, "dfnWorks")]
    lines += [
        f"# left out: {key}: {' '.join(why.split())}" for key, why in constants.left_out.items()
    ]
    if constants.values:
        note = constants.notes[_KEY]
        lines.append(f"{_KEY} = {constants.values[_KEY]!r}  # {note}")
    lines.append(f"apertures = {by_pressure(card)!r}  # hydraulic, m, by nominal pressure, MPa")
    lines += [
        "# fractures = [1, 2]  # numbers of the fractures, from 1",
        f'# DFN.set_fracture_hydraulic_values("{_KEY}", fractures, [{_KEY}] * len(fractures))',
    ]
    return "\n".join(lines) + "\n"
