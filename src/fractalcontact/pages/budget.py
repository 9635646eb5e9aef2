"""One error bar a quantity, split by source, and the solve plan behind the errors."""

import math
from dataclasses import dataclass

from ..core.labels import OF_SURFACE, TWINS
from ..core.subject import Subject
from .summary import Quantity, Specimen
from .words import MISSING, percent, with_unit


@dataclass(frozen=True)
class Part:
    """A source of an error.

    Attributes
    ----------
    source : str
    words : str
        Its half-width, or why it has none.
    share : float
        Of the squares of those that make the total, in per cent of the bar.
    counted, known : bool
        Whether it is in the total of this surface, and whether it is a number.
    """

    source: str
    words: str
    share: float
    counted: bool
    known: bool


@dataclass(frozen=True)
class Bar:
    """A quantity, its totals and its value for harder contacts in words, and its sources."""

    name: str
    meaning: str
    value: str
    surface: str
    population: str
    hardest: str
    parts: list[Part]


def bars_of(specimen: Specimen) -> list[Bar]:
    """Error bars of a specimen under the load of its contact maps."""
    return [_bar(quantity) for quantity in specimen.of_maps.quantities.values()]


@dataclass(frozen=True)
class Plan:
    """Solve plan of a specimen: how many of its states were solved, how exactly, and why.

    Attributes
    ----------
    asked : str
        Accuracy that the study asks for.
    solved, states : int
    choices : list of (str, str, str, str)
        Choice, value, reason and largest error in words.
    """

    asked: str
    solved: int
    states: int
    choices: list[tuple[str, str, str, str]]


def plan_of(subject: Subject) -> Plan:
    """Solve plan that the stage ``choices`` states of a specimen."""
    plan = subject["choices"]
    rows = (plan[key].values.tolist() for key in ("choice", "value", "reason", "error", "error_of"))
    choices = [
        (choice, value, why, f"{percent(error)} of the {of}" if math.isfinite(error) else MISSING)
        for choice, value, why, error, of in zip(*rows, strict=True)
    ]
    asked, solved, states = (plan.attrs[key] for key in ("asked", "states_solved", "states"))
    return Plan(asked, solved, states, choices)


def _bar(quantity: Quantity) -> Bar:
    known = {
        source: error
        for source, error in quantity.sources.items()
        if source in OF_SURFACE and math.isfinite(error)
    }
    squares = sum(error**2 for error in known.values())
    parts = [
        Part(
            source=source,
            words=_words(quantity, source),
            share=100 * known[source] ** 2 / squares if squares and source in known else 0.0,
            counted=source in OF_SURFACE,
            known=_is_known(quantity, source),
        )
        for source in quantity.sources
    ]
    return Bar(
        name=quantity.name,
        meaning=quantity.meaning,
        value=f"none ({quantity.missing})"
        if quantity.missing
        else with_unit(quantity.value, quantity.unit),
        surface=quantity.error_words(quantity.errors["surface"]),
        population=quantity.error_words(quantity.errors["population"]),
        hardest=with_unit(quantity.hardest, quantity.unit),
        parts=parts,
    )


def _words(quantity, source):
    note = quantity.reasons[source]
    if _is_known(quantity, source):
        beside = f" ({note})" if source in ("estimator", TWINS) and note else ""
        return quantity.error_words(quantity.sources[source]) + beside
    return note or "not known"


def _is_known(quantity, source):
    # A source that does not apply is zero, with a note that says so.
    error = quantity.sources[source]
    return math.isfinite(error) and not (error == 0 and bool(quantity.reasons[source]))
