"""Statements of the paper on several joints together, judged for a study."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..core.claims import all_claims, claims_of
from ..core.datasets import titled
from ..core.directions import slides
from ..core.estimate import Estimate
from ..core.fitting import fit_line, slope_error
from ..core.text import number
from ..core.verdicts import UNDETERMINED
from ..roughness.recommended import best_dimension
from .evidence import evidence_of
from .findings import Finding, Joint, beyond_margin, by_sign, difference_of, margin_words
from .judge import material_of, table_of


@titled("the paper's statements on several joints together, and their verdicts")
def judge_study(
    stages: Mapping[str, Mapping[str, xr.Dataset]],
    settings: Mapping[str, Mapping],
) -> xr.Dataset:
    """Judge the statements that need several specimens, as :func:`judge.table_of` has it.

    ``stages`` and ``settings`` are by specimen, with ``surface_dimension``, without specimens that
    only repeat another under a hardness, or whose contact is known.
    """
    joints = {name: Joint(dict(parts), dict(settings[name])) for name, parts in stages.items()}
    return table_of(
        {name: _RULES[name] for name in claims_of("several")}, joints, {}, "the specimens"
    )


def size_exponent_grows_with_dimension(joints: Mapping[str, Joint]) -> Finding:
    """Exponent 2 - Delta_sigma by A_r(s) at the reference load, against Delta_g of the faces.

    The paper calls this exponent the size effect; no size is varied here. At least three surfaces
    against a plane are compared, whose composite topography is the face itself. Where each has
    realisations, their means are compared; where three have, those alone.
    """
    flat = [joint for joint in joints.values() if not slides(joint.settings["opposite"])]
    of_kind = [joint for joint in flat if joint.realised]
    if len(of_kind) >= 3:
        flat = of_kind
    if len(flat) < 3:
        return Finding(UNDETERMINED, "fewer than three surfaces against a plane")
    dimension = np.array([best_dimension(j["surface_dimension"]).value for j in flat])
    of_kinds = all(joint.realised for joint in flat)
    if of_kinds:
        delta = Estimate.stack(evidence_of(joint).area_dimension() for joint in flat)
        effect, error = 2 - delta.value, delta.width / 2
        slope = _slope(dimension, effect, error)
    else:
        effect = np.array([2 - float(joint.state("scaling")["delta_sigma"]) for joint in flat])
        slope = fit_line(dimension, effect).slope
    order = np.argsort(dimension)
    if not slope.known:
        return Finding(UNDETERMINED, "fewer than three surfaces with Delta_g and Delta_sigma")
    pairs = ", ".join(f"{number(effect[i])} for Delta_g = {number(dimension[i])}" for i in order)
    return Finding(
        by_sign(slope, rising=True),
        f"2 - Delta_sigma is {pairs}",
        "at light load this is the growth of the slopes h'_rms with resolution",
        "realisations of each" if of_kinds else "",
    )


def _slope(x: np.ndarray, y: np.ndarray, error: np.ndarray) -> Estimate:
    """Least-squares slope, with its interval from those of y (half-widths ``error``)."""
    about = x - x.mean()
    slope, half = float(about @ y / (about @ about)), slope_error(x, error)
    return Estimate(slope, slope - half, slope + half, x.size)


def area_falls_more_in_concrete(joints: Mapping[str, Joint]) -> Finding:
    """Exponent of A_r against v, concrete's minus rock's, beyond the margin.

    Synthetic surfaces of one recipe hold no difference of materials: it is then undetermined.
    """
    found = _by_material(joints, _area_exponent)
    return _compared(found, "area_falls_more_in_concrete", "A_r ~ v^x", rising=False)


def contact_localises_more_in_concrete(joints: Mapping[str, Joint]) -> Finding:
    """Exponent of Morisita's index against v, concrete's minus rock's, beyond the margin.

    Synthetic surfaces of one recipe hold no difference of materials: it is then undetermined.
    """
    found, name = _by_material(joints, _localisation), "contact_localises_more_in_concrete"
    return _compared(found, name, "Morisita's index ~ v^x", rising=True)


def _localisation(joint):
    """Exponent of Morisita's index over v at the reference load."""
    return joint.localisation[0]


def _area_exponent(joint):
    """Exponent of A_r over v at the reference load."""
    chosen = (joint.offsets > 0) & (joint.area_fraction > 0)
    return fit_line(np.log(joint.offsets[chosen]), np.log(joint.area_fraction[chosen])).slope


def _by_material(joints, exponent_of):
    """Exponent of the first joint of each material that has one, and whether it is synthetic."""
    exponents: dict[str, tuple[Estimate, bool]] = {}
    for joint in joints.values():
        material = material_of(joint.settings)
        if not slides(joint.settings["opposite"]) or material in exponents or not material:
            continue
        exponent = exponent_of(joint)
        if exponent.known:
            exponents[material] = exponent, joint.realised
    return exponents


def _compared(exponents, name, law, *, rising):
    """Verdict on concrete's exponent less rock's, whose errors are independent."""
    if exponents.keys() != {"rock", "concrete"}:
        return Finding(UNDETERMINED, "a joint of each material needed")
    (rock, of_recipe), (concrete, also) = exponents["rock"], exponents["concrete"]
    less = difference_of(concrete, rock)
    verdict = beyond_margin(less, all_claims()[name].margin, rising=rising)
    one_recipe = "; both are synthetic surfaces of one recipe" if of_recipe and also else ""
    return Finding(
        UNDETERMINED if one_recipe else verdict,
        f"{law}: x = {number(concrete)} in concrete, {number(rock)} in rock{one_recipe}",
        f"difference {number(less, 2, '+')}; {margin_words(name)}",
    )


#: Rules by the names of their statements.
_RULES = {
    rule.__name__: rule
    for rule in (
        area_falls_more_in_concrete,
        contact_localises_more_in_concrete,
        size_exponent_grows_with_dimension,
    )
}
