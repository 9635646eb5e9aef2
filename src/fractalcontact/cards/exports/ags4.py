"""Constants for AGS4, the exchange of site investigations: group DISC of edition 4.1.1.

The keys of a discontinuity are its place in a borehole, which a card does not know: the location
is the name of the specimen, its depth empty. Wavelength and amplitude (``DISC_WAVE``, ``DISC_AMP``)
are of the joint in the field, not of a window: left out.
"""

import datetime
from collections.abc import Mapping, Sequence
from typing import Any

from ...core.limits import JRC_RANGE
from ...core.text import exact, number
from ..entries import jrc_of_law, reference_of, row_at
from .constants import contact_of, in_words

ENDING = "ags"
_EDITION = "4.1.1"


def discontinuity_of(card: Mapping[str, Any]) -> dict[str, tuple[str, str, str]]:
    """Headings of DISC with unit, type and text."""
    entries, name = card["entries"], str(card["name"])
    jrc = jrc_of_law(card)
    if not JRC_RANGE[0] <= jrc.get("value", -1) <= JRC_RANGE[1]:
        jrc = {}
    gap, wall = row_at(entries["mean_gap"], reference_of(card)), entries["joint_wall_strength"]
    remarks = [f"contact {contact_of(card)}", f"trust {card['trust']['word']}"]
    if jrc:
        remarks.append(
            f"JRC of Tse and Cruden 1979, step {exact(jrc['at']['step'])} mm, "
            f"towards {card['direction']}"
        )
    if "value" in gap:
        remarks.append(f"aperture: mean gap at {exact(gap['at']['pressure'])} MPa")
    k_ni = entries["k_ni"]
    if k_ni.get("determined"):
        remarks.append(f"k_ni {in_words(k_ni, k_ni)}")
    return {
        "LOCA_ID": ("", "ID", name),
        "DISC_TOP": ("m", "2DP", ""),
        "DISC_BASE": ("m", "2DP", ""),
        "FRAC_SET": ("", "X", ""),
        "DISC_NUMB": ("", "X", "1"),
        "DISC_JRC": ("", "0DP", number(jrc["value"], 0) if jrc else ""),
        "DISC_APT": ("mm", "XN", exact(gap["value"], 3) if "value" in gap else ""),
        "DISC_STR": ("MPa", "0DP", number(wall["value"], 0) if "value" in wall else ""),
        "DISC_REM": ("", "X", "; ".join(remarks)),
    }


def text_of(card: Mapping[str, Any]) -> str:
    """An AGS4 file: the discontinuity, its location, and the groups that every file has."""
    disc = discontinuity_of(card)
    groups = {
        "PROJ": {"PROJ_ID": ("", "ID", str(card["study"]))},
        "TRAN": {
            "TRAN_ISNO": ("", "X", "1"),
            "TRAN_DATE": ("yyyy-mm-dd", "DT", datetime.date.today().isoformat()),
            "TRAN_PROD": ("", "X", "fractalcontact"),
            "TRAN_STAT": ("", "X", "Computed from a scan"),
            "TRAN_AGS": ("", "X", _EDITION),
            "TRAN_RECV": ("", "X", "not stated"),
            "TRAN_DLIM": ("", "X", "|"),
            "TRAN_RCON": ("", "X", "+"),
        },
        "LOCA": {"LOCA_ID": ("", "ID", str(card["name"]))},
        "DISC": disc,
    }
    units = sorted({unit for one in groups.values() for unit, _, _ in one.values() if unit})
    types = sorted({kind for one in groups.values() for _, kind, _ in one.values()} | {"X"})
    lines = [line for name, one in groups.items() for line in _group(name, one)]
    lines += _list("UNIT", ("UNIT_UNIT", "UNIT_DESC"), [(unit, unit) for unit in units])
    lines += _list("TYPE", ("TYPE_TYPE", "TYPE_DESC"), [(kind, kind) for kind in types])
    return "\r\n".join(lines) + "\r\n"


def _group(name: str, headings: Mapping[str, tuple[str, str, str]]) -> list[str]:
    """Lines of a group of one row."""
    units, types, texts = zip(*headings.values(), strict=True)
    rows = [("GROUP", name), ("HEADING", *headings), ("UNIT", *units), ("TYPE", *types)]
    return [*map(_line, rows), _line(("DATA", *texts)), ""]


def _list(name: str, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Lines of a group of texts."""
    blank, texts = [""] * len(headings), ["X"] * len(headings)
    head = [("GROUP", name), ("HEADING", *headings), ("UNIT", *blank), ("TYPE", *texts)]
    return [*map(_line, [*head, *(("DATA", *row) for row in rows)]), ""]


def _line(fields: Sequence[str]) -> str:
    """Fields in quotes, ASCII only; a quote within a field is doubled."""
    plain = (" ".join(text.split()).encode("ascii", "replace").decode() for text in fields)
    return ",".join('"' + text.replace('"', '""') + '"' for text in plain)
