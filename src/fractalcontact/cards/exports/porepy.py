"""Constants for PorePy: the keywords of ``SolidConstants``, in SI units.

Its class ``BartonBandis`` has the hyperbola of Bandis et al. (1983): ``fracture_normal_stiffness``
is k_ni and ``maximum_elastic_fracture_opening`` v_m.
"""

from collections.abc import Mapping
from typing import Any

from ...core.text import exact
from .constants import Constants, head_of, over_pressure

ENDING = "py"


def constants_of(card: Mapping[str, Any]) -> Constants:
    """Keywords of ``porepy.SolidConstants`` that a card has a number for."""
    entries, constants = card["entries"], Constants()
    k_ni, v_m = entries["k_ni"], entries["v_m"]
    constants.add("fracture_normal_stiffness", k_ni, k_ni, "k_ni of the hyperbola, at zero load")
    constants.add(
        "maximum_elastic_fracture_opening", v_m, v_m, "v_m of the hyperbola, from zero load"
    )
    modulus, poisson = entries["modulus"], entries["poisson"]
    if "value" in modulus and "value" in poisson:
        young, nu = modulus["value"] * 1e6, poisson["value"]
        of = f"Pa; intact rock, E = {exact(modulus['value'])} MPa, Poisson's ratio {exact(nu)}"
        constants.values["shear_modulus"] = young / (2 * (1 + nu))
        constants.values["lame_lambda"] = young * nu / ((1 + nu) * (1 - 2 * nu))
        constants.notes.update(dict.fromkeys(("shear_modulus", "lame_lambda"), of))
    angles, strength = entries["peak_dilatancy_angle"], entries["peak_strength"]
    constants.left_out.update(
        dilation_angle="PorePy takes one number; here it depends on pressure: "
        + over_pressure(angles),
        friction_coefficient="PorePy takes one number; here peak strength over pressure falls with "
        "the pressure: " + over_pressure(strength),
        fracture_tangential_stiffness="no shear stiffness is computed",
        fracture_gap="zero where displacement counts from the joint under no load, whose "
        "opening v_m the class adds itself",
        residual_aperture="the aperture that stays open to flow; hydraulic aperture: "
        + over_pressure(entries["hydraulic_aperture"]),
    )
    return constants


def text_of(card: Mapping[str, Any]) -> str:
    """A Python file that makes the ``SolidConstants`` of a card."""
    constants = constants_of(card)
    lines = [f"# {line}" for line in head_of(card, "PorePy")]
    lines += ["import porepy as pp", "", "constants = {"]
    lines += [
        f'    "{key}": {value!r},  # {constants.notes[key]}'
        for key, value in constants.values.items()
    ]
    lines += ["}", "# Left out, to be given from elsewhere:"]
    lines += [f"#   {key}: {' '.join(why.split())}" for key, why in constants.left_out.items()]
    lines += [f"solid = pp.SolidConstants(name={card['name']!r}, **constants)"]
    return "\n".join(lines) + "\n"
