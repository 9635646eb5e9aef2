"""Entries of a card, from the register of published numbers."""

import math
from typing import Any

from ..core import text
from ..core.subject import Subject
from ..report.published import UNITS_AT, Number, Row, array_of, fitted_over, read, shown_in

#: Sections of a card, in their order.
SECTIONS = ("material", "roughness", "stiffness", "contact", "aperture", "strength", "tests")
#: Significant digits of the numbers of a card.
_DIGITS = 6


def entries() -> list[Row]:
    """Quantities of a card, in their order."""
    return sorted(shown_in("section"), key=lambda row: SECTIONS.index(row.section))


def entry_of(row: Row, subject: Subject, model: str) -> dict[str, Any]:
    """Entry of a card with its values.

    Parameters
    ----------
    row : Row
    subject : Subject
    model : str
        What the contact was solved as.

    Returns
    -------
    dict
        Of ``card.schema.json``: a number where no dimension is left, else a curve with ``values``.
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


def number(row: Row, subject: Subject, found: Number) -> dict[str, Any]:
    """A number as the card writes it, with its ends and errors, or why it is missing."""
    if found.missing:
        return {"missing": found.missing}
    written: dict[str, Any] = dict(
        zip(("value", "low", "high"), map(rounded, found.estimate.ends), strict=True)
    )
    if row.range or not found.determined:
        written["determined"] = found.determined
    if found.estimate.reason or (row.by_scan and not found.determined):
        written["note"] = str(found.estimate.reason) or found.remark
    for key, value in (("of_its_population", found.population), ("hardest", found.hardest)):
        if math.isfinite(value):
            written[key] = rounded(value)
    misfit = array_of(row, subject, row.misfit)
    if misfit is not None and found.determined:
        written["note"] = f"misses the curve by {text.percent(misfit.item())}"
    return written


def rounded(value: float) -> float | None:
    """A number with the digits of a card; None where it is not finite."""
    return text.rounded(value, _DIGITS) if math.isfinite(value) else None


def _label(value: Any) -> Any:
    return value if isinstance(value, str) else rounded(value)
