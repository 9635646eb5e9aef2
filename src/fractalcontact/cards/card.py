"""Card of a joint: the numbers of one specimen, each with its interval and model."""

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from ..core.labels import OPPOSITE, printable
from ..core.subject import Subject
from ..pages.first_screen import boundary_of, is_synthetic, model_of
from ..pages.lights import lights_of, trust_in
from ..pages.summary import lengths_of
from ..report.published import read_at, row_of, shown_in, stages_of
from .entries import entries, entry_of, number, rounded
from .methods import methods_of, references_of, scan_words

#: Version of the form of a card; a change of ``card.schema.json`` that breaks readers raises it.
FORM = 1
#: Errors below this fraction of their quantity are rounding.
_ROUNDING = 1e-9
#: Licence of the numbers and sentences of a card.
LICENCE = "CC0-1.0"
#: Stages that a card reads, of those that a specimen has.
STAGES = stages_of("section", "errors") | {"quality", "choices", "elastic_model"}


def card_of(subject: Subject, study: Mapping[str, Any], made: Mapping[str, Any]) -> dict[str, Any]:
    """Card of a specimen, as plain data of ``card.schema.json``.

    ``study`` is as its user wrote it; ``made`` has ``versions`` by library and ``scan_checksums``
    by specimen, attributes of the atlas.
    """
    model = model_of(subject)
    lights = lights_of(subject)
    card: dict[str, Any] = {
        "form": FORM,
        "name": subject.name,
        "label": printable(subject.label),
        "study": str(study.get("study", "")),
        "kind": "joint",
        "synthetic": is_synthetic(subject.name, study),
        "faces": OPPOSITE[subject["specimens"].attrs["opposite"]],
        "material": printable(subject.settings["material"]["name"]),
        "model": model,
        "boundary": boundary_of(subject),
        "direction": subject.direction,
        "geometry": geometry_of(subject),
        "window": str(subject["specimens"].attrs["window_note"]),
        "entries": {row.name: entry_of(row, subject, model) for row in entries()},
        "errors": errors_of(subject),
        "lights": [asdict(light) for light in lights],
        "trust": trust_in(subject, is_synthetic(subject.name, study))._asdict(),
        "licence": LICENCE,
        "versions": dict(made["versions"]),
        "scan_checksums": dict(made["scan_checksums"].get(subject.name, {})),
    }
    scan = scan_words(subject["specimens"], subject.settings["outliers"])
    methods = methods_of(card, "" if card["synthetic"] else scan)
    return card | {"methods": methods, "references": references_of(methods)}


def made_of(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """Versions and scan checksums of an atlas."""
    return {key: json.loads(attributes.get(key, "{}")) for key in ("versions", "scan_checksums")}


def geometry_of(subject: Subject) -> dict[str, Any]:
    """Spacing, window, offset, seat and reference pressure: chosen, so without intervals."""
    lengths, row = lengths_of(subject), row_of("seating_pressure")
    names = ("spacing", "window_x", "window_y", "offset")
    return {name: {"value": rounded(lengths[name]), "unit": "mm"} for name in names} | {
        "seat": number(row, subject, read_at(row, subject)) | {"unit": row.unit},
        "reference_pressure": {"value": reference_pressure_of(subject), "unit": "MPa"},
    }


def reference_pressure_of(subject: Subject) -> float | None:
    """Nominal pressure of the reference load, MPa."""
    return rounded(float(subject["closure"]["nominal_pressure"][subject.reported.reference]))


def errors_of(subject: Subject) -> list[dict[str, Any]]:
    """Errors by source of the quantities under the reference load, half-widths at 95 %."""
    pressure, budget = reference_pressure_of(subject), subject.state("error_budget")
    rows = []
    for row in shown_in("errors"):
        number = read_at(row, subject)
        rows.append(
            {
                "quantity": row.budget,
                "title": row.page,
                "unit": row.unit,
                "pressure": pressure,
                "value": rounded(number.value),
                "of_this_surface": rounded(number.error),
                "of_its_population": rounded(number.population),
                "hardest": rounded(number.hardest),
                "sources": _by_source(budget, row.budget, abs(number.value)),
            }
        )
    return rows


def _by_source(budget, quantity, size):
    """Errors of a quantity by their source; those of rounding are zero."""
    if quantity not in budget["quantity"]:
        return {}
    errors = budget["error"].sel(quantity=quantity)
    return {
        str(source): rounded(error if error > _ROUNDING * size else 0.0)
        for source, error in zip(errors["source"].values, errors.values.tolist(), strict=True)
        if error >= 0
    }
