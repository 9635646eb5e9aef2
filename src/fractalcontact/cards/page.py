"""Printed page of a card: its entries in tables, one unit a column, from the card alone."""

import math
from collections.abc import Collection, Mapping
from typing import Any

from ..core.text import MISSING, measured, percent, short
from ..core.verdicts import UNDETERMINED
from ..pages.summary import STRENGTH_RULES
from ..report.caveats import aperture_caveat
from ..report.published import row_of
from .entries import row_at

#: Tables of curves over pressure, by title: the sections that share one.
_AGAINST_PRESSURE = {
    "Closure, contact and aperture": ("contact", "aperture"),
    "Shear strength": ("strength",),
}
_UNITS = {"1": "%", "degree": "°"}
#: Column head: range of the strength over all rules.
_RULES_HEAD = "peak τ, range of all rules"


def page_of(card: Mapping[str, Any], block: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Values of the template ``card.html``; ``block`` has the first numbers of a joint."""
    entries = card["entries"]
    printed = {key: entry for key, entry in entries.items() if entry.get("print", True)}
    stiffness = [entries[key] for key in ("tangent_stiffness", "reload_stiffness")]
    return {
        "card": card,
        "block": block or {},
        "stiffness": over_pressure(stiffness),
        "tables": list(_tables(printed)),
        "tests": tests_of(entries),
        "grasselli": grasselli_rows(entries),
        "jrc": jrc_table(entries["jrc"], entries["jrc_by_fit"]),
        # An elastic joint has no hardness to state.
        "missing": missing_of({key: entry for key, entry in printed.items() if key != "hardness"}),
        "hardest": entries.get("hardest_hardness", {}).get("value", math.nan),
        "permeability": permeability_words(entries),
        "caveat": aperture_caveat(entries.get("shifted_ratio", {}).get("value", math.nan)),
        # The change with the hardness has a column of its own.
        "errors": errors_of(card, without=("model",)),
        "number": lambda value, digits=2: MISSING if value is None else short(value, digits),
        "words": in_words,
        "ends": ends_in_words,
    }


def _tables(printed):
    """Title, heads with units and rows of the tables over pressure that have any number."""
    for title, sections in _AGAINST_PRESSURE.items():
        curves = {
            key: entry
            for key, entry in printed.items()
            if entry["section"] in sections and has_values(entry)
        }
        heads = [
            (row_of(key).head or entry["title"], _UNITS.get(entry["unit"], entry["unit"]))
            for key, entry in curves.items()
        ]
        rows = over_pressure(list(curves.values()))
        rules = [i for i, key in enumerate(curves) if key in STRENGTH_RULES]
        if len(rules) > 1:
            heads.insert(0, (_RULES_HEAD, "MPa"))
            rows = [(at, [_over_rules([cells[i] for i in rules]), *cells]) for at, cells in rows]
        if curves:
            yield title, heads, rows


def _over_rules(cells):
    """Range of the strength over its rules: the error of a rule is not that of the strength."""
    values = [cell["value"] for cell in cells if "value" in cell]
    spread = {"value": min(values), "to": max(values)} if values else {"missing": "no rule applies"}
    return {"unit": "MPa"} | spread


def tests_of(entries: Mapping[str, Any]) -> list[tuple[str, str, Mapping[str, Any]]]:
    """Quantity, test and computed over measured value of each laboratory test."""
    return [
        (entry["title"], row["at"]["test"], row | {"unit": ""})
        for entry in entries.values()
        if entry["section"] == "tests"
        for row in entry.get("values", ())
        if "value" in row
    ]


def grasselli_rows(entries: Mapping[str, Any]) -> list[dict[str, str]]:
    """Direction, theta*_max, C, A_0 and roughness of Grasselli's law, in words."""
    names = ("grasselli_theta_max", "grasselli_c", "grasselli_a_0", "grasselli")
    by_direction: dict[str, dict[str, str]] = {}
    for name in names:
        for row in entries.get(name, {}).get("values", ()):
            if "value" in row:
                by_direction.setdefault(row["at"]["direction"], {})[name] = short(row["value"])
    return [{"direction": direction} | values for direction, values in by_direction.items()]


def has_values(entry: Mapping[str, Any]) -> bool:
    """True if a curve has any number."""
    return any("value" in row for row in entry.get("values", ()))


def over_pressure(curves: list[Mapping[str, Any]]) -> list[tuple[float, list[dict[str, Any]]]]:
    """Rows of a table: pressure, MPa, and a number of each curve there, with its unit."""
    pressures = sorted(
        {row["at"]["pressure"] for curve in curves for row in curve.get("values", ())}
    )
    return [
        (pressure, [row_at(curve, pressure) | {"unit": curve["unit"]} for curve in curves])
        for pressure in pressures
    ]


def permeability_words(entries: Mapping[str, Any]) -> str:
    """Constants of the permeability over pressure by branch, and their range; empty without any."""
    curves = [entries.get(f"permeability_{name}", {}) for name in ("k_0", "alpha")]
    by_branch = {
        k_0["at"]["branch"]: [_constant(one) for one in (k_0, alpha)]
        for k_0, alpha in zip(*(curve.get("values", ()) for curve in curves), strict=True)
        if "value" in k_0
    }
    # Unloading and reloading are one curve.
    by_branch.pop("unload", None)
    if not by_branch:
        return ""
    words = "; ".join(
        f"on {branch}ing k_0 = {k_0}, alpha = {alpha}" for branch, (k_0, alpha) in by_branch.items()
    )
    ends = curves[0]["range"]
    over = f"{short(ends['low'])} to {short(ends['high'])} {ends['unit']}"
    return (
        f"Permeability k = k_0 exp(-alpha sigma') along the sliding from {over}, k_0 in mm2, alpha "
        f"per MPa: {words} (fit alone)."
    )


def _constant(number: Mapping[str, Any]) -> str:
    """Constant of a fit with its interval, or that it is undetermined."""
    if not number["determined"]:
        return UNDETERMINED
    return f"{short(number['value'])} {ends_in_words(number)}".rstrip()


def jrc_table(*entries: Mapping[str, Any]) -> dict[str, Any]:
    """JRC by step (rows, mm) and fit (columns), in each direction; nothing where no fit has one."""
    by_step: dict[float, dict[str, dict[str, float]]] = {}
    for row in (row for entry in entries for row in entry.get("values", ()) if "value" in row):
        at = row["at"]
        fit = at.get("fit", "Tse and Cruden 1979").partition(", ")[0]
        step = at.get("step", at.get("fit_step"))
        by_step.setdefault(step, {}).setdefault(fit, {})[at["direction"]] = row["value"]
    cells = [numbers for fits in by_step.values() for numbers in fits.values()]
    directions = sorted({name for numbers in cells for name in numbers})
    return {
        "directions": directions,
        "fits": sorted({fit for fits in by_step.values() for fit in fits}),
        "rows": {
            short(step): {
                fit: " / ".join(short(numbers.get(name, math.nan)) for name in directions)
                for fit, numbers in by_step[step].items()
            }
            for step in sorted(by_step)
        },
    }


def missing_of(entries: Mapping[str, Any]) -> dict[str, list[str]]:
    """Titles of quantities without a number, or without one at some places, by the reason."""
    by_reason: dict[str, list[str]] = {}
    for entry in entries.values():
        title = f"{entry['title']} (in part)" if has_values(entry) else entry["title"]
        for row in (entry, *entry.get("values", ())):
            titles = by_reason.setdefault(row["missing"], []) if "missing" in row else None
            if titles is not None and title not in titles:
                titles.append(title)
    return by_reason


def errors_of(card: Mapping[str, Any], without: Collection[str] = ()) -> dict[str, Any]:
    """Rows of the table of errors, of quantities that have a value, and the sources of any."""
    rows = [row for row in card["errors"] if row["value"] is not None]
    sources = dict.fromkeys(source for row in rows for source, error in row["sources"].items())
    return {"rows": rows, "sources": [of for of in sources if of not in without]}


def in_words(number: Mapping[str, Any]) -> str:
    """Number of a table, fractions in per cent; a dash where there is none."""
    if "value" not in number:
        return MISSING
    if "to" in number:
        return " to ".join(dict.fromkeys((short(number["value"]), short(number["to"]))))
    value = number["value"]
    # With fewer digits than its interval a value would seem to lie outside.
    digits = 2 if number.get("low") is None else 3
    return percent(value, digits).removesuffix(" %") if number.get("unit") == "1" else short(value)


def ends_in_words(number: Mapping[str, Any], factor: float = 1.0) -> str:
    """Interval of a number in brackets; empty without one, or if it is narrower than it prints."""
    low, high = number.get("low"), number.get("high")
    if low is None or high is None or "value" not in number:
        return ""
    words = [measured(factor * end) for end in (low, high)]
    return f"[{words[0]}, {words[1]}]" if words[0] != words[1] else ""
