"""Printed page of a card: its entries in tables, one unit a column, from the card alone."""

import math
from collections.abc import Collection, Mapping
from typing import Any

from ..core.text import MISSING, measured, percent, short, with_unit
from ..pages.captions import symbols
from ..pages.first_screen import (
    STRENGTH_RULES,
    facts_of,
    hardnesses_of,
    offset_of,
    row_at,
    window_of,
)
from ..report.caveats import aperture_caveat
from ..report.published import row_of

#: Tables of curves over pressure, by title: the sections that share one.
_AGAINST_PRESSURE = {
    "Closure, contact and aperture": ("contact", "aperture"),
    "Shear strength": ("strength",),
}
_UNITS = {"1": "%", "degree": "°"}
#: Head of the column of the range over the rules for the strength.
_RULES_HEAD = "peak τ, range of all rules"


def page_of(card: Mapping[str, Any]) -> dict[str, Any]:
    """Values of the template ``card.html``.

    Parameters
    ----------
    card : mapping
        Of ``card.schema.json``.
    """
    entries = card["entries"]
    printed = {key: one for key, one in entries.items() if one.get("print", True)}
    stiffness = [entries[key] for key in ("tangent_stiffness", "reload_stiffness")]
    return {
        "card": card,
        "facts": facts_of(card) if card["kind"] == "joint" else [],
        "window": window_of(card) if card["kind"] == "joint" else "",
        "offset": offset_of(card) if card["kind"] == "joint" else "",
        "stiffness": over_pressure(stiffness),
        "tables": list(_tables(printed)),
        "tests": tests_of(entries),
        "grasselli": grasselli_rows(entries),
        "jrc": jrc_table(entries["jrc"], entries["jrc_by_fit"]),
        # An elastic joint has no hardness to state.
        "missing": missing_of({key: one for key, one in printed.items() if key != "hardness"}),
        "hardest": hardnesses_of(card)[1],
        "caveat": aperture_caveat(entries.get("shifted_ratio", {}).get("value", math.nan)),
        # What harder contacts change stands in a column of its own.
        "errors": errors_of(card, without=("model",)),
        "number": lambda value, digits=2: MISSING if value is None else short(value, digits),
        "words": in_words,
        "ends": ends_in_words,
        "short": short,
        "with_unit": with_unit,
        "symbols": symbols,
    }


def _tables(printed):
    """Title, heads with units and rows of the tables over pressure that have any number."""
    for title, sections in _AGAINST_PRESSURE.items():
        curves = {
            key: one
            for key, one in printed.items()
            if one["section"] in sections and has_values(one)
        }
        heads = [
            (row_of(key).head or one["title"], _UNITS.get(one["unit"], one["unit"]))
            for key, one in curves.items()
        ]
        rows = over_pressure(list(curves.values()))
        rules = [i for i, key in enumerate(curves) if key in STRENGTH_RULES]
        if len(rules) > 1:
            heads.insert(0, (_RULES_HEAD, "MPa"))
            rows = [(at, [_over_rules([cells[i] for i in rules]), *cells]) for at, cells in rows]
        if curves:
            yield title, heads, rows


def _over_rules(cells):
    """Range of the strength over its rules: none of their errors is that of the strength."""
    values = [one["value"] for one in cells if "value" in one]
    found = {"value": min(values), "to": max(values)} if values else {"missing": "no rule applies"}
    return {"unit": "MPa"} | found


def tests_of(entries: Mapping[str, Any]) -> list[tuple[str, str, Mapping[str, Any]]]:
    """Quantity, test and computed over measured value of each laboratory test."""
    return [
        (one["title"], row["at"]["test"], row | {"unit": ""})
        for one in entries.values()
        if one["section"] == "tests"
        for row in one.get("values", ())
        if "value" in row
    ]


def grasselli_rows(entries: Mapping[str, Any]) -> list[dict[str, str]]:
    """Direction, theta*_max, C, A_0 and roughness of Grasselli's law, in words."""
    names = ("grasselli_theta_max", "grasselli_c", "grasselli_a_0", "grasselli")
    found: dict[str, dict[str, str]] = {}
    for name in names:
        for row in entries.get(name, {}).get("values", ()):
            if "value" in row:
                found.setdefault(row["at"]["direction"], {})[name] = short(row["value"])
    return [{"direction": direction} | values for direction, values in found.items()]


def has_values(entry: Mapping[str, Any]) -> bool:
    """True if a curve has any number."""
    return any("value" in row for row in entry.get("values", ()))


def over_pressure(curves: list[Mapping[str, Any]]) -> list[tuple[float, list[dict[str, Any]]]]:
    """Rows of a table: pressure, MPa, and a number of each curve there, with its unit."""
    pressures = sorted({row["at"]["pressure"] for one in curves for row in one.get("values", ())})
    return [(at, [row_at(one, at) | {"unit": one["unit"]} for one in curves]) for at in pressures]


def jrc_table(*entries: Mapping[str, Any]) -> dict[str, Any]:
    """JRC by step (rows, mm) and fit (columns), in each direction; nothing where no fit has one."""
    found: dict[float, dict[str, dict[str, float]]] = {}
    for row in (row for one in entries for row in one.get("values", ()) if "value" in row):
        at = row["at"]
        fit = at.get("fit", "Tse and Cruden 1979").partition(", ")[0]
        step = at.get("step", at.get("fit_step"))
        found.setdefault(step, {}).setdefault(fit, {})[at["direction"]] = row["value"]
    each = [numbers for fits in found.values() for numbers in fits.values()]
    directions = sorted({name for numbers in each for name in numbers})
    return {
        "directions": directions,
        "fits": sorted({fit for fits in found.values() for fit in fits}),
        "rows": {
            short(step): {
                fit: " / ".join(short(numbers.get(name, math.nan)) for name in directions)
                for fit, numbers in found[step].items()
            }
            for step in sorted(found)
        },
    }


def missing_of(entries: Mapping[str, Any]) -> dict[str, list[str]]:
    """Titles of quantities without a number, or without one at some places, by the reason."""
    found: dict[str, list[str]] = {}
    for one in entries.values():
        title = f"{one['title']} (in part)" if has_values(one) else one["title"]
        for row in (one, *one.get("values", ())):
            titles = found.setdefault(row["missing"], []) if "missing" in row else None
            if titles is not None and title not in titles:
                titles.append(title)
    return found


def errors_of(card: Mapping[str, Any], without: Collection[str] = ()) -> dict[str, Any]:
    """Rows of the table of errors, of quantities that have a value, and the sources of any."""
    rows = [one for one in card["errors"] if one["value"] is not None]
    sources = dict.fromkeys(source for one in rows for source, error in one["sources"].items())
    return {"rows": rows, "sources": [of for of in sources if of not in without]}


def in_words(number: Mapping[str, Any]) -> str:
    """A number of a table, fractions in per cent; a dash where there is none."""
    if "value" not in number:
        return MISSING
    if "to" in number:
        return " to ".join(dict.fromkeys((short(number["value"]), short(number["to"]))))
    value = number["value"]
    # As many digits as its interval has, if there is one: it would seem to lie outside.
    digits = 2 if number.get("low") is None else 3
    return percent(value, digits).removesuffix(" %") if number.get("unit") == "1" else short(value)


def ends_in_words(number: Mapping[str, Any], factor: float = 1.0) -> str:
    """Interval of a number in brackets; empty without one, or if it is narrower than it prints."""
    low, high = number.get("low"), number.get("high")
    if low is None or high is None or "value" not in number:
        return ""
    words = [measured(factor * end) for end in (low, high)]
    return f"[{words[0]}, {words[1]}]" if words[0] != words[1] else ""
