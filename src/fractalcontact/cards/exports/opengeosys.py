"""Constants for OpenGeoSys: parts of a project file with ``fracture_model``, in SI units.

Its normal stress is K_n w (1 + ln^2(a / a_0)): a logarithmic penalty and no hyperbola. K_n is the
tangent stiffness at the initial aperture a_0, so that under the card's reference load is
given, with the mean gap there.
"""

from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree as xml

from ...core.text import exact, short
from ..entries import reference_of, row_at
from ._xml import comment, headed, text_of_element
from .constants import Constants, over_pressure

ENDING = "xml"


def constants_of(card: Mapping[str, Any]) -> Constants:
    """Parameters of ``fracture_model`` and ``fracture_properties`` that a card has a number for."""
    entries, constants = card["entries"], Constants()
    pressure = reference_of(card)
    for key, name, words in (
        ("normal_stiffness", "interface_stiffness", "tangent stiffness"),
        ("initial_aperture", "mean_gap", "mean gap"),
    ):
        row = row_at(entries[name], pressure)
        constants.add(key, entries[name], row, f"{words} at {short(pressure)} MPa")
    constants.left_out.update(
        shear_stiffness="no shear stiffness is computed",
        friction_angle=f"one number there; peak strength here: "
        f"{over_pressure(entries['peak_strength'])}",
        dilatancy_angle=f"one number there; here: {over_pressure(entries['peak_dilatancy_angle'])}",
        cohesion="the joint has no cohesion",
        penalty_aperture_cutoff="a setting of the solution, no property of a joint",
    )
    return constants


def text_of(card: Mapping[str, Any]) -> str:
    """Parts of a project file: a fracture model without tension, and the parameters it names."""
    constants = constants_of(card)
    root = headed("OpenGeoSysProject", card, "OpenGeoSys")
    model = xml.SubElement(root, "fracture_model")
    xml.SubElement(model, "type").text = "LinearElasticIsotropic"
    properties = xml.SubElement(root, "fracture_properties")
    parameters = xml.SubElement(root, "parameters")
    for key, value in constants.values.items():
        name = f"{card['name']}_{key}"
        where = model if key == "normal_stiffness" else properties
        xml.SubElement(where, key).text = name
        parameter = xml.SubElement(parameters, "parameter")
        parameter.append(comment(constants.notes[key]))
        for tag, text in (("name", name), ("type", "Constant"), ("value", exact(value))):
            xml.SubElement(parameter, tag).text = text
    xml.SubElement(model, "tension_cutoff").text = "1"
    for key, why in constants.left_out.items():
        model.append(comment(f"{key}: {why}"))
    return text_of_element(root)
