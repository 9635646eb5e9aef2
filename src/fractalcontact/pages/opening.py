"""Opening sentences of a result page: findings of the study in numbers and verdicts.

Numbers are those of the summary, verdicts those of the statements and of the elastic model.
"""

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence

from markupsafe import Markup, escape

from ..core.claims import claims_of
from ..core.verdicts import FAILS, GOOD, HOLDS, ILL_POSED, IN_PART, PARTLY, POOR, UNDETERMINED
from .captions import symbols
from .common_loads import CommonLoad
from .matrix import Row
from .summary import AtLoad, Specimen
from .words import measured, percent, short, with_unit

#: Names listed one by one; more are counted.
_LISTED = 3
#: Statements that are quoted by name: on eq. 6, the contact domain, the plateau of the dilatancy.
_EQ6 = "size_effect_follows"
_FRACTAL, _LACUNAR = "domains_are_fractal", "area_is_lacunar"
_PLATEAUS = ("dilatancy_flattens", "dilatancy_flattens_in_two")
_VERDICTS = {
    HOLDS: "holds",
    PARTLY: "holds in part",
    FAILS: "does not hold",
    UNDETERMINED: "is undetermined",
}
_ANSWERS = {HOLDS: "yes", PARTLY: "partly", FAILS: "no", UNDETERMINED: "unknown"}
_MODEL = {GOOD: "good", IN_PART: "partly good", POOR: "poor"}
_KINDS = {"level": "levels off", "rising": "keeps rising", "falling": "falls"}

_At = Sequence[tuple[Specimen, AtLoad]]


def opening_of(
    specimens: Sequence[Specimen], load: CommonLoad | None, rows: Sequence[Row]
) -> list[Markup]:
    """Up to five sentences on the findings of the study.

    Parameters
    ----------
    specimens : sequence of Specimen
    load : CommonLoad or None
        Under which they are compared.
    rows : sequence of Row
        Of the paper's statements.
    """
    if load is None:
        return []
    found = [(one, at) for one in specimens if (at := one.at(load.numbers.get(one.name)))]
    under = f"Under {short(load.pressure)} MPa"
    sentences = (
        _closure(found, under, len(specimens)),
        _model(found, under),
        _dilatancy(specimens, rows),
        _dimensions(found, under, rows),
        _size_effect(rows),
    )
    return [sentence for sentence in sentences if sentence]


def _closure(found: _At, under: str, total: int) -> Markup | None:
    """Closure and tangent stiffness, without specimens decided by suspicious cells."""
    sure = [(one, at) for one, at in found if not at.decided_by_scan]
    closure = _ends(sure, lambda at: at.quantities["closure"].value)
    if not closure:
        return None
    ends = [
        Markup("{} ({}{})").format(with_unit(value, "mm"), one.name, _error(at))
        for value, one, at in closure
    ]
    known = sum(at.quantities["closure"].known for _, at in sure)
    counted = _all(total) if known == total else f"{known} of {total}"
    whose = "" if total == 1 else f" of {counted} specimens"
    words = Markup(" to ").join(ends)
    said = Markup("{} the interface{} has closed by {} since first touch")
    text = said.format(under, whose, words)
    stiffness = _ends(sure, lambda at: at.quantities["stiffness"].value)
    if stiffness:
        text += Markup("; its tangent stiffness is {}").format(
            _range([value for value, _, _ in stiffness], lambda v: with_unit(v, "MPa/mm"))
        )
    return text + "."


def _error(at):
    closure = at.quantities["closure"]
    whose = {"surface": "for this surface", "population": "for the whole joint"}
    known = {of: error for of, error in closure.errors.items() if math.isfinite(error)}
    return "".join(f", ± {closure.error_words(known[of])} {whose[of]}" for of in known)


def _ends(found, value_of):
    """Least and largest known value with their specimens; one entry if only one is known."""
    known = [(value_of(at), one, at) for one, at in found if math.isfinite(value_of(at))]
    if not known:
        return []
    known.sort(key=lambda entry: entry[0])
    return known[:1] if len(known) == 1 else [known[0], known[-1]]


def _range(values: Sequence[float], words: Callable[[float], str]) -> str:
    """Least to largest value in words, with a common unit written once."""
    low, high = words(min(values)), words(max(values))
    if low == high:
        return low
    number, _, unit = low.partition(" ")
    return f"{number if unit and high.endswith(f' {unit}') else low} to {high}"


def _model(found: _At, under: str) -> Markup | None:
    """Contact fraction, real pressure, and the verdict on the elastic model."""
    known = [(one, at) for one, at in found if at.model.verdict in _MODEL]
    if not known:
        return None
    shares = [at.contact_share for _, at in known]
    text = (
        f"{under}, {_range(shares, percent)} of the window is in contact at a real mean pressure "
        f"of {_range([at.model.pressure for _, at in known], _pressure)}. {_tested(known, found)}"
    )
    return Markup(escape(text))


def _tested(known: _At, found: _At) -> str:
    """Verdicts on specimens without a hardness, then the names of those that are not judged."""
    tested = [(one, at) for one, at in known if not at.model.capped]
    capped = [one.name for one, at in known if at.model.capped]
    few = [one.name for one, at in found if at.model.verdict not in _MODEL]
    parts = []
    if tested:
        verdicts = _counted([at.model.verdict for _, at in tested], _MODEL)
        slopes = [one.rms_slope for one, _ in tested if math.isfinite(one.rms_slope)]
        judged = " judged" if capped or few else ""
        parts.append(
            f"The elastic model is {verdicts}{judged} ({_limits(tested)}{_slopes(slopes)})."
        )
    if few:
        parts.append(f"Too few nodes of {_listed(few)} touch to judge it.")
    if capped:
        parts.append(f"In {_listed(capped)} the hardness bounds the pressure.")
    return " ".join(parts)


def _limits(tested: _At) -> str:
    """Limits of the pressures: strengths that are stated, or usual ones."""
    stated = [at.model.limits.good_to for _, at in tested if at.model.stated]
    usual = [at.model.limits.good_to for _, at in tested if not at.model.stated]
    parts = [f"joint wall strength {_range(stated, _pressure)}"] if stated else []
    if usual:
        parts.append(f"no strength stated, usual ones from {_range(usual, _pressure)}")
    return ", ".join(parts)


def _pressure(value):
    return with_unit(value, "MPa")


def _slopes(values):
    return f", rms slope {_range(values, short)}" if values else ""


def _counted(verdicts: Sequence[str], words: Mapping[str, str]) -> str:
    """Verdicts with the numbers of their specimens: "good for 1 and poor for 4 of 5 specimens"."""
    total, counts = len(verdicts), Counter(verdicts)
    given = [verdict for verdict in words if counts[verdict]]
    if len(given) == 1:
        whom = f"{_all(total)} specimens" if total > 1 else "the specimen"
        return f"{words[given[0]]} for {whom}"
    parts = [f"{words[verdict]} for {counts[verdict]}" for verdict in given]
    return f"{_listed(parts, len(parts))} of {total} specimens"


def _all(total: int) -> str:
    return "both" if total == 2 else f"all {total}"


def _dilatancy(specimens: Sequence[Specimen], rows: Sequence[Row]) -> Markup | None:
    """Trends of the dilatancy, without joints that repeat another with a hardness."""
    asked = {name for row in rows if row.name in _of_the_surface() for name in row.cells}
    parts = []
    for kind, words in _KINDS.items():
        named = [
            f"{one.name} ({_level(one.dilatancy)}, towards {one.direction})"
            for one in specimens
            if one.dilatancy.kind == kind and not one.dilatancy.undecided and one.name in asked
        ]
        if named:
            parts.append(f"{words} for {_listed(named)}")
    open_ones = [one.name for one in specimens if one.dilatancy.undecided and one.name in asked]
    if open_ones:
        parts.append(f"is undecided for {_listed(open_ones)}, whose faces still correlate")
    if not parts:
        return None
    plateaus = [row.cells for row in rows if row.name in _PLATEAUS]
    chosen = sorted(name for cells in plateaus for name in cells if cells[name].circular)
    be = "were" if len(chosen) > 1 else "was"
    note = f" {_listed(chosen)} {be} chosen to show this: no evidence." if chosen else ""
    text = f"Over the second half of the offsets the rigid dilatancy {' and '.join(parts)}.{note}"
    return Markup(escape(text))


def _of_the_surface():
    """Names of the statements that a hardness cannot change."""
    return {name for name, claim in claims_of().items() if not claim.plastic}


def _level(dilatancy):
    if dilatancy.kind == "level":
        return with_unit(dilatancy.level, "mm")
    return f"slope {short(dilatancy.slope)}"


def _listed(names: Sequence[str], most: int = _LISTED) -> str:
    """Some names one by one; more are counted."""
    if len(names) > most:
        return f"{len(names)} specimens"
    return " and ".join((", ".join(names[:-1]), names[-1])) if len(names) > 1 else names[0]


#: What the paper's number is an exponent of.
_OF_THE_PAPER = "The paper's 1.39 is a box count, printed under a picture of areas A_r(s)."


def _dimensions(found: _At, under: str, rows: Sequence[Row]) -> Markup:
    """Delta_sigma by both estimators where it is determined, and the verdict beside nulls."""
    verdicts = {row.name: {n: cell.verdict for n, cell in row.cells.items()} for row in rows}
    # Where all that touches yields, A_r(s) has the dimension 2 by construction.
    yielded = {name for name, one in verdicts.get(_LACUNAR, {}).items() if one == ILL_POSED}
    by_boxes = _determined([(at.delta_sigma_boxes, at.nulls) for _, at in found])
    areas = [at.delta_sigma_areas for one, at in found if one.name not in yielded]
    by_areas = _determined([(one, {}) for one in areas])
    text = f"{under} Delta_sigma is {by_boxes} by box counting and {by_areas} by A_r(s)"
    by_construction = [one.name for one, _ in found if one.name in yielded]
    if by_construction:
        text += f". Where all contacts yield ({_listed(by_construction)}), A_r(s) gives 2"
    beside = [one for one in verdicts.get(_FRACTAL, {}).values() if one in _ANSWERS]
    question = ""
    if beside:
        answer = _counted(beside, _ANSWERS).capitalize()
        question = f" Is the contact a fractal set under its reference load? {answer}."
    return symbols(f"{text}. {_OF_THE_PAPER}{question}")


def _determined(estimates):
    """Range of the estimates that are determined, each end with its interval and its null models.

    And how many are determined. ``estimates`` are pairs of estimate and null models.
    """
    known = [one for one in estimates if one[0].determined]
    if not known:
        return "undetermined"
    known.sort(key=lambda one: one[0].value)
    some = len(known) < len(estimates)
    counted = f" ({len(known)} of {len(estimates)} determined)" if some else ""
    return (
        " to ".join(dict.fromkeys(_beside_nulls(*one) for one in (known[0], known[-1]))) + counted
    )


def _beside_nulls(estimate, nulls):
    """A dimension with its interval, and those of the null models: a range shows no pattern."""
    beside = ", ".join(
        f"{words} {measured(value)}" for words, value in nulls.items() if math.isfinite(value)
    )
    interval = f"[{measured(estimate.low)}, {measured(estimate.high)}]"
    return f"{measured(estimate.value)} {interval}{f' ({beside})' if beside else ''}"


def _size_effect(rows: Sequence[Row]) -> Markup | None:
    found = [cell.verdict for row in rows if row.name == _EQ6 for cell in row.cells.values()]
    asked = [verdict for verdict in found if verdict in _VERDICTS]
    if not asked:
        return (
            Markup("Eq. 6 predicts nothing here: contacts crush, and their area is F/H.")
            if found
            else None
        )
    verdicts = _counted(asked, _VERDICTS)
    if len(asked) > 1 and set(asked) == {FAILS}:  # not "does not hold for all": for some it might
        verdicts = f"holds for none of {len(asked)} specimens"
    return symbols(f"The size effect of eq. 6 {verdicts} (windows within one joint).")
