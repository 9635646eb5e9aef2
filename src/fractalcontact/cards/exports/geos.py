"""Constants for GEOS: hydraulic aperture models of a fracture, as XML, in SI units.

``BartonBandis`` has h = a_0 / (1 + 9 sigma / sigma_ref), ``referenceAperture`` a_0 and
``referenceNormalStress`` sigma_ref. The opening v_m - d of the hyperbola is this law with
a_0 = v_m and sigma_ref = 9 k_ni v_m. A table of hydraulic against mechanical aperture comes first
where the card has both, and is the law to take: a comment says so, and how far the laws differ.
"""

from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree as xml

from ...core.text import exact, short
from ..entries import reference_of, row_at
from ._xml import comment, headed, text_of_element
from .constants import Constants

ENDING = "xml"


def constants_of(card: Mapping[str, Any]) -> Constants:
    """Attributes of ``BartonBandis`` that a card has a number for."""
    entries, constants = card["entries"], Constants()
    k_ni, v_m = entries["k_ni"], entries["v_m"]
    constants.add("referenceAperture", v_m, v_m, "v_m of the hyperbola, from zero load")
    # Added to learn whether k_ni is a result: the attribute is made of k_ni and v_m.
    constants.add("referenceNormalStress", k_ni, k_ni, "k_ni of the hyperbola")
    if {"referenceAperture", "referenceNormalStress"} <= set(constants.values):
        constants.values["referenceNormalStress"] = 9e6 * k_ni["value"] * v_m["value"]
        constants.notes["referenceNormalStress"] = "Pa; 9 k_ni v_m, at which 90 % of v_m is closed"
        return constants
    left = {
        key: constants.left_out.get(key, "needs k_ni and v_m")
        for key in ("referenceAperture", "referenceNormalStress")
    }
    return Constants(left_out=left)


def apertures_of(card: Mapping[str, Any]) -> list[tuple[float, float]]:
    """Mechanical and hydraulic aperture at the pressures where a card has both, m, ascending."""
    mean, hydraulic = (
        {
            row["at"]["pressure"]: row["value"]
            for row in card["entries"][key].get("values", ())
            if "value" in row
        }
        for key in ("mean_gap", "hydraulic_aperture")
    )
    return sorted((1e-3 * mean[at], 1e-3 * hydraulic[at]) for at in mean if at in hydraulic)


def choice_of(card: Mapping[str, Any], constants: Constants) -> str:
    """Law to take of the two, with their ratio under the reference load; empty with one alone."""
    name, pressure = card["name"], reference_of(card)
    row = row_at(card["entries"]["hydraulic_aperture"], pressure)
    if not constants.values or "value" not in row or not apertures_of(card):
        return ""
    closing = 1 + 9 * 1e6 * pressure / constants.values["referenceNormalStress"]
    ratio = 1e3 * constants.values["referenceAperture"] / closing / row["value"]
    return (
        f"take ONE of the two laws: {name}_table, solved as flow through the gap; the aperture of "
        f"{name}, BartonBandis, is {short(ratio)} times that at {short(pressure)} MPa and stands "
        "here for models that have no mechanical aperture"
    )


def text_of(card: Mapping[str, Any]) -> str:
    """Parts of a problem file: the aperture law of a fracture and, where known, its table."""
    root = headed("Problem", card, "GEOS")
    laws, constants = xml.SubElement(root, "Constitutive"), constants_of(card)
    if choice := choice_of(card, constants):
        laws.append(comment(choice))
    if rows := apertures_of(card):
        name = f"{card['name']}_aperture_table"
        laws.append(
            xml.Element(
                "HydraulicApertureTable", name=f"{card['name']}_table", apertureTableName=name
            )
        )
        functions = xml.SubElement(root, "Functions")
        columns = [
            f"{{ {', '.join(f'{exact(end)}' for end in column)} }}"
            for column in zip(*rows, strict=True)
        ]
        xml.SubElement(
            functions, "TableFunction", name=name, coordinates=columns[0], values=columns[1]
        )
    else:
        laws.append(
            comment(
                "no table of hydraulic against mechanical aperture: the card "
                "has no mean gap and hydraulic aperture under one pressure"
            )
        )
    if constants.values:
        attributes = {key: exact(value) for key, value in constants.values.items()}
        laws.append(
            comment(
                "takes the mechanical for the hydraulic aperture, which is "
                "smaller, and the joint to close at infinite pressure"
            )
        )
        laws.append(xml.Element("BartonBandis", {"name": card["name"], **attributes}))
    for key, words in (constants.notes | constants.left_out).items():
        laws.append(comment(f"{key}: {words}"))
    return text_of_element(root)
