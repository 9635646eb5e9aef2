"""Constants of a joint of Coulomb's law for the codes of Itasca: UDEC, 3DEC, FLAC3D, in SI units.

Friction and dilation are those under the reference load. The codes take one number each, and the
strength of the joint is no straight line over the pressure: the tables have what it is elsewhere.

Sources: docs/other_codes.md, "Constants for the codes of Itasca".
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...core.limits import JRC_RANGE
from ...core.text import exact, short
from ..entries import jrc_of_law, reference_of, row_at
from .constants import TO_SI, Constants, head_of, in_words

#: Rule for the shear stiffness, which no contact state has. One public program quotes the
#: displacement of Barton and Bandis, L in m; their papers were not read.
_SHEAR_RULE = (
    "peak strength over the peak displacement L/500 (JRC/L)^0.33 of Barton and Bandis, "
    "as quoted, not read in the source"
)


@dataclass(frozen=True)
class Names:
    """Names of the constants in one code."""

    code: str
    normal: str
    shear: str
    friction: str
    dilation: str
    cohesion: str
    table: str = "table"
    """Command of a table, which later versions know by its name."""


def constants_of(card: Mapping[str, Any], names: Names) -> Constants:
    """Constants under the reference load: SI units, angles in degrees."""
    entries, constants, at = card["entries"], Constants(), reference_of(card)
    where = f"at {short(at)} MPa"
    stiffness = entries["interface_stiffness"]
    row = row_at(stiffness, at)
    constants.add(names.normal, stiffness, row, f"tangent stiffness {where}")
    strength = row_at(entries["peak_strength"], at)
    if "value" in strength:
        constants.values[names.friction] = math.degrees(math.atan(strength["value"] / at))
        constants.notes[names.friction] = (
            f"degrees; secant angle of the peak strength by dilatancy {where}, "
            f"{in_words(entries['peak_strength'], strength)}"
        )
        constants.values[names.cohesion] = 0.0
        constants.notes[names.cohesion] = "Pa; a secant angle has no cohesion"
    else:
        reason = f"peak strength {where}: {strength['missing']}"
        constants.left_out.update({names.friction: reason, names.cohesion: reason})
    angle = row_at(entries["peak_dilatancy_angle"], at)
    if "value" in angle:
        constants.values[names.dilation] = angle["value"]
        constants.notes[names.dilation] = f"degrees; largest dilatancy angle {where}"
    else:
        constants.left_out[names.dilation] = f"dilatancy angle {where}: {angle['missing']}"
    _add_shear_stiffness(card, names, constants, strength)
    return constants


def _add_shear_stiffness(card, names, constants, strength):
    """Shear stiffness by an empirical rule, where the card has what the rule needs."""
    jrc = jrc_of_law(card).get("value", -1.0)
    in_range = JRC_RANGE[0] < jrc <= JRC_RANGE[1]
    if not in_range or "value" not in strength:
        lacks = "a peak strength" if in_range else "a JRC of Barton's range"
        constants.left_out[names.shear] = f"not computed; the empirical rule needs {lacks}"
        return
    window = card["geometry"]
    length = 1e-3 * math.sqrt(window["window_x"]["value"] * window["window_y"]["value"])
    displacement = length / 500 * (jrc / length) ** 0.33
    constants.values[names.shear] = 1e6 * strength["value"] / displacement
    constants.notes[names.shear] = (
        f"Pa/m; NOT COMPUTED but by an empirical rule, {_SHEAR_RULE}, with JRC {short(jrc)} and "
        f"L = {short(1e3 * length)} mm, the window; it falls with L"
    )


def tables_of(card: Mapping[str, Any]) -> dict[str, list[tuple[float, float]]]:
    """Curves over the nominal pressure (Pa): normal stiffness (Pa/m), friction angle (degrees)."""
    entries, tables = card["entries"], {}
    tables["normal_stiffness"] = [
        (1e6 * row["at"]["pressure"], row["value"] * TO_SI["MPa/mm"])
        for row in entries["interface_stiffness"].get("values", ())
        if "value" in row and row.get("determined", True)
    ]
    tables["friction_angle"] = [
        (
            1e6 * row["at"]["pressure"],
            math.degrees(math.atan(row["value"] / row["at"]["pressure"])),
        )
        for row in entries["peak_strength"].get("values", ())
        if "value" in row and row["at"]["pressure"] > 0
    ]
    return {name: sorted(pairs) for name, pairs in tables.items() if len(pairs) > 1}


def text_of(card: Mapping[str, Any], names: Names, before: str, command: str) -> str:
    """Commands of a code: ``before``, constants behind ``command``, tables over pressure."""
    constants = constants_of(card, names)
    lines = [f"; {line}" for line in head_of(card, names.code)]
    lines += [f"; {key}: {note}" for key, note in constants.notes.items()]
    lines += [
        f"; left out: {key}: {' '.join(why.split())}" for key, why in constants.left_out.items()
    ]
    if constants.values:
        assigned = " ".join(f"{key} {exact(value)}" for key, value in constants.values.items())
        lines += [*filter(None, [before]), f"{command} {assigned}"]
    for name, pairs in tables_of(card).items():
        unit = "Pa/m" if name == "normal_stiffness" else "degrees"
        lines.append(f"; {name} ({unit}) over the nominal pressure (Pa), for a FISH function")
        points = " ".join(f"({exact(x)},{exact(y)})" for x, y in pairs)
        lines.append(f"{names.table} '{card['name']}_{name}' add {points}")
    return "\n".join(lines) + "\n"
