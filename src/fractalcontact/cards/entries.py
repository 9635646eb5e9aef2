"""Entries of a card, from the register of published numbers."""

import math
from collections.abc import Mapping
from typing import Any

from ..core import text
from ..core.subject import Subject
from ..report.published import (
    UNITS_AT,
    Number,
    Row,
    array_of,
    fitted_over,
    is_of_law,
    read,
    shown_in,
)

#: Sections of a card, in their order.
SECTIONS = ("material", "roughness", "stiffness", "contact", "aperture", "strength", "tests")
#: Significant digits of the numbers of a card.
_DIGITS = 6


def entries() -> list[Row]:
    """Quantities of a card, in their order."""
    return sorted(shown_in("section"), key=lambda row: SECTIONS.index(row.section))


def entry_of(row: Row, subject: Subject, model: str) -> dict[str, Any]:
    """Entry of a card: a number where no dimension is left, else a curve with ``values``.

    ``model`` is the contact model of the card.
    """
    found: dict[str, Any] = {"title": row.title, "section": row.section, "unit": row.unit}
    found["model"] = model if row.model == "contact" else row.model
    found |= {key: getattr(row, key) for key in ("law", "interval") if getattr(row, key)}
    if over := fitted_over(row, subject):
        low, high, unit = over
        found["range"] = {"low": rounded(low), "high": rounded(high), "unit": unit}
    if not row.print:
        found["print"] = False
    numbers = read(row, subject)
    if not numbers:
        return found | {"missing": row.missing}
    if not numbers[0].at:
        return found | number(row, subject, numbers[0])
    at = [{key: _label(value) for key, value in one.at.items()} for one in numbers]
    found["at_units"] = {key: UNITS_AT[key] for key in at[0]}
    return found | {
        "values": [
            {"at": place, **number(row, subject, one)}
            for place, one in zip(at, numbers, strict=True)
        ]
    }


def row_at(curve: Mapping[str, Any], pressure: float) -> dict[str, Any]:
    """Row of an entry at a pressure, MPa, or its absence with the reason."""
    rows = (row for row in curve.get("values", ()) if row["at"].get("pressure") == pressure)
    return next(rows, {"missing": curve.get("missing", "not solved there")})


def jrc_of_law(card: Mapping[str, Any]) -> dict[str, Any]:
    """Row of the JRC by Barton's law along the sliding; empty where the card has none."""
    rows = card["entries"]["jrc"].get("values", ())
    return next((row for row in rows if is_of_law(row["at"], card["direction"])), {})


def reference_of(card: Mapping[str, Any]) -> float:
    """Reference pressure of a card, MPa; NaN where it has no contact."""
    return float(card["geometry"].get("reference_pressure", {}).get("value", math.nan))


def number(row: Row, subject: Subject, published: Number) -> dict[str, Any]:
    """Number as a card writes it, with its ends and errors, or why it is missing."""
    if published.missing:
        return {"missing": published.missing}
    written: dict[str, Any] = dict(
        zip(("value", "low", "high"), map(rounded, published.estimate.ends), strict=True)
    )
    if row.range or not published.determined:
        written["determined"] = published.determined
    if published.estimate.reason or (row.by_scan and not published.determined):
        written["note"] = str(published.estimate.reason) or published.remark
    for key, value in (("of_its_population", published.population), ("hardest", published.hardest)):
        if math.isfinite(value):
            written[key] = rounded(value)
    misfit = array_of(row, subject, row.misfit)
    if misfit is not None and published.determined:
        written["note"] = f"misses the curve by {text.percent(misfit.item())}"
    return written


def rounded(value: float) -> float | None:
    """Number with the digits of a card; None where it is not finite."""
    return text.rounded(value, _DIGITS) if math.isfinite(value) else None


def _label(value: Any) -> Any:
    return value if isinstance(value, str) else rounded(value)
