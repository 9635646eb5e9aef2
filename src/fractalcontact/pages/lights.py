"""Five lights of a specimen: scan, fit of the faces, nodes, convergence in the grid, the model.

Each repeats what a stage of the atlas says; the limits are those that the stages use.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ..core.limits import CORRECTED_NODES, FRICTION_FACTORS, NEARLY, RESOLVED_NODES
from ..core.subject import Subject
from ..core.text import compact, number, short, with_unit
from ..core.validity import SLOPE, Validity
from ..core.verdicts import GOOD, HARDNESS, IN_PART, NOT_JUDGED, POOR, STRENGTH, USUAL

#: Remedies for lights that are not good.
FINER_SCAN = "points measured closer together, heights without the instrument's filter, less noise"
MARKS = (
    "faces scanned with common marks; or the same joint with 'outliers: fill' in its sidecar, "
    "where the change of the numbers shows the error of the scans"
)
#: The same of a pair whose suspicious cells are filled already.
FILLED = "faces scanned with common marks: suspicious cells are filled already"
LIGHTER = "lighter loads, under which less of the window touches"
STEEP = "a laboratory test beside the computed curve; a finer scan would not help"
CRUSH = "a 'hardness' in the material, such as the joint wall strength, at which contacts crush"
STATE = "'joint_wall_strength' of the rock in its material, at which contacts then crush"

#: Sign of each verdict, so that no colour is needed.
SIGNS = {GOOD: "●", IN_PART: "◐", POOR: "○", NOT_JUDGED: "–"}


@dataclass(frozen=True)
class Light:
    """Light of a specimen: its key in the summary, its title on the page, and its verdict.

    ``word`` is :data:`GOOD`, :data:`IN_PART`, :data:`POOR` or :data:`NOT_JUDGED`, ``reason`` what
    decided it, ``help`` what would make it better: empty where it is good or not judged.
    """

    key: str
    title: str
    word: str
    reason: str
    help: str = ""

    @property
    def sign(self) -> str:
        """Sign of the light."""
        return SIGNS[self.word]


def lights_of(subject: Subject) -> list[Light]:
    """The five lights of a specimen."""
    return [_scan(subject), _faces(subject), _nodes(subject), _grid(subject), _model(subject)]


def validity_at(subject: Subject, number: int) -> Validity:
    """Verdict on the elastic model under the load of this number, with its real pressure."""
    return Validity.of(subject.states("elastic_model").isel(normal_force=number))


def _is_pair(subject):
    return int(subject["specimens"].attrs["faces"]) == 2


def _scan(subject):
    """Light of the scan; of one face it includes the force on suspicious cells."""
    quality, load = (
        str(subject[stage].attrs.get("warning", "")) for stage in ("quality", "closure")
    )
    if _is_pair(subject):
        load = ""
    warnings = [text for text in (quality, load) if text]
    if not warnings:
        reason = "all resolutions lie within the fractal range; suspicious cells carry little force"
        return Light("scan", "Scan", GOOD, reason)
    helps = "'outliers: mask' leaves suspicious cells out" if load else FINER_SCAN
    # The noise or the filter of the instrument decides at all resolutions, or at the finer ones.
    below = subject["quality"]["below_range"].values
    word = POOR if below.all() or load else IN_PART
    return Light("scan", "Scan", word, "; ".join(warnings), helps)


def _faces(subject):
    key, title = "faces", "Fit of the faces"
    if not _is_pair(subject):
        return Light(key, title, NOT_JUDGED, "no second face was scanned")
    overlap = str(subject["quality"].attrs["overlap"])
    helps = FILLED if subject["specimens"].attrs.get("outliers") == "fill" else MARKS
    load = str(subject["closure"].attrs.get("warning", ""))
    if load:
        return Light(key, title, POOR, f"{load}; {overlap}", helps)
    touching = subject["quality"].sel(region="window")["overlap_cells"].item()
    return Light(key, title, *((IN_PART, overlap, helps) if touching else (GOOD, overlap)))


def _nodes(subject):
    nodes = subject.state("closure")["nodes"].item()
    # A state that was not solved has NaN nodes: both comparisons are false, and it is poor.
    word = GOOD if nodes >= CORRECTED_NODES else IN_PART if nodes >= RESOLVED_NODES else POOR
    reason = (
        f"{number(nodes, 0)} nodes are in contact under the reference load; fits need "
        f"{RESOLVED_NODES} nodes, area corrections {CORRECTED_NODES}"
    )
    helps = ""
    if word != GOOD:
        helps = "a finer scan, or heavier loads"
        if nodes > 0:
            enough = float(subject.reported.force) * CORRECTED_NODES / nodes
            helps += f" (about {with_unit(enough, 'N')})"
    return Light("nodes", "Contact nodes", word, reason, helps)


def _grid(subject):
    """Error of the closure beside the accuracy that the study requests.

    Of the closure from the seat, which is published first; from first touch where there is none.
    """
    key, title = "grid", "Convergence in the grid"
    asked = float(subject["choices"]["closure_accuracy"])
    budget = subject.state("error_budget")
    seated = float(subject.state("closure")["seated_closure"]) > 0
    start = "the seat" if seated else "first touch"
    errors = budget.sel(quantity="separation" if seated else "closure")
    error = float(errors["relative_error"].sel(source="numerical"))
    if seated:
        error = _without_scan(subject)
    if math.isnan(error):
        why = str(errors["reason"].sel(source="numerical").item()) or "no finer grid was solved"
        return Light(key, title, NOT_JUDGED, why)
    word = GOOD if error <= asked else IN_PART if error <= NEARLY else POOR
    reason = (
        f"closure from {start} under the reference load is uncertain by "
        f"{compact(100 * error, 2)} % "
        f"({compact(100 * asked, 2)} % requested, usable up to {number(100 * NEARLY, 0)} %)"
    )
    helps = "" if word == GOOD else _finer(subject, error / asked, float(errors["observed_order"]))
    return Light(key, title, word, reason, helps)


def _without_scan(subject):
    """Relative error of the closure from the seat without the scans', which no grid changes."""
    budget, closure = (subject.state(stage) for stage in ("error_budget", "closure"))
    total, scan = (float(budget[f"seated_closure_{of}"]) for of in ("total", "scan"))
    return (total - scan) / float(closure["seated_closure"])


def _finer(subject, excess, order):
    """Spacing at which the numerical error reaches the requested one, by its observed order."""
    if not order > 0:
        return "a finer scan"
    spacing = float(subject["specimens"].attrs["spacing_x"]) / excess ** (1 / order)
    return f"a spacing of {with_unit(spacing, 'mm')} or finer"


def _model(subject):
    validity = validity_at(subject, subject.reported.reference)
    reason = f"under the reference load, {validity.reason}"
    by_pressure = {HARDNESS: LIGHTER, STRENGTH: CRUSH, USUAL: STATE}[validity.limits.criterion]
    helps = {"": "", SLOPE: STEEP}.get(validity.decided_by, by_pressure)
    return Light("model", "Validity of the model", validity.verdict, reason, helps)


#: Trust in a specimen by its worst light.
_TRUST = {POOR: "low", IN_PART: "limited", GOOD: "good"}


class Trust(NamedTuple):
    """Trust in a specimen.

    ``word`` is "low", "limited" or "good"; ``reason`` is that of the first of its worst lights,
    causes before their symptoms, and which others there are; ``help`` would help against it.
    """

    word: str
    reason: str
    help: str


def trust_of(lights: Sequence[Light]) -> Trust:
    """Trust in a specimen by its worst light."""
    worst = next((word for word in _TRUST if any(light.word == word for light in lights)), GOOD)
    if worst == GOOD:
        return Trust(_TRUST[GOOD], "every light that applies is good", "")
    of_worst = [light for light in lights if light.word == worst]
    first, *others = deciding = sorted(of_worst, key=_place)
    reason = f"{first.title}: {first.reason}"
    if others:
        alike = "partly good" if worst == IN_PART else worst
        reason += f". Also {alike}: {', '.join(light.key for light in others)}"
    helps = [light.help for light in deciding if light.help not in ("", STEEP)]
    return Trust(_TRUST[worst], reason, helps[0] if helps else first.help)


def _place(light):
    """Place of a light among causes: errors of the scans decide too few nodes and poor grids."""
    return ("faces", "scan", "model", "nodes", "grid").index(light.key)


def trust_in(subject: Subject, synthetic: bool = False) -> Trust:
    """Trust in a specimen; what helps begins with phi_b where its strength rests on an assumed one.

    A synthetic surface has no rock to be tested. Tests differ from a strength with an assumed phi_b
    by more than any other error of it.
    """
    trust = trust_of(lights_of(subject))
    material = subject.settings["material"]
    is_stated = math.isfinite(material.get("basic_friction_angle") or math.nan)
    is_assumed = material.get("basic_friction_angle_is") == "assumed"
    if synthetic or subject.direction == "none" or not (is_stated and is_assumed):
        return trust
    low, high = FRICTION_FACTORS["assumed"]
    tests = f"tests had {short(low)} to {short(high)} times the strength by Barton's law"
    measure = f"measure phi_b on flat faces (assumed: {tests})"
    return trust._replace(help="; ".join(filter(None, (measure, trust.help))))
