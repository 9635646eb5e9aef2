"""Methods paragraph of a card, with the numbers of its run."""

import json
from collections.abc import Mapping
from typing import Any

import xarray as xr

from ..core.labels import BOUNDARIES
from ..core.text import percent, short, with_unit
from ..core.window import window_fraction
from .entries import jrc_of_law

#: Sources that the paragraph may name.
_SOURCES = (
    "Borri-Brunetto, M., Carpinteri, A., Chiaia, B. (1999): Scaling phenomena due to fractal "
    "contact in concrete and rock fractures. Int. J. Fracture 95, 221-238.",
    "Bandis, S. C., Lumsden, A. C., Barton, N. R. (1983): Fundamentals of rock joint deformation. "
    "Int. J. Rock Mech. Min. Sci. 20, 249-268.",
    "Barton, N., Choubey, V. (1977): The shear strength of rock joints in theory and practice. "
    "Rock Mech. 10, 1-54.",
    "Tse, R., Cruden, D. M. (1979): Estimating joint roughness coefficients. "
    "Int. J. Rock Mech. Min. Sci. 16, 303-307.",
    "Yastrebov, V. A., Anciaux, G., Molinari, J.-F. (2017): On the accurate computation of the "
    "true contact-area in mechanical contact of random rough surfaces. Tribol. Int. 114, 161-171.",
)


#: Treatments of outlying cells in words.
_TREATED = {"keep": "kept", "mask": "left out", "fill": "filled"}


def methods_of(card: Mapping[str, Any], scan: str = "") -> str:
    """Methods paragraph, ready to be quoted, of a card without its ``methods``.

    ``scan`` is the sentence of :func:`scan_words`.
    """
    parts = _faces(card), scan, _contact(card), _laws(card), _strength(card)
    return " ".join(filter(None, (*parts, _versions(card["versions"]))))


def scan_words(specimen: xr.Dataset, outliers: str) -> str:
    """Sentence on the part of the scan used, its outliers and the registration of two faces."""
    part = percent(window_fraction(specimen))
    words = f"The window is {part} of the scan; outlying cells were {_TREATED[outliers]}"
    record = json.loads(specimen.attrs.get("registration") or "{}")
    if not record:
        return f"{words}."
    if not record["applied"]:
        return f"{words}; the faces were not registered."
    return (
        f"{words}; the upper face was registered to the lower one ({record['mode']}) by moving it "
        f"by {short(record['shift_x_mm'])} mm in x and {short(record['shift_y_mm'])} mm in y and "
        f"turning it by {short(record['rotation_degrees'])} degrees."
    )


def references_of(methods: str) -> list[str]:
    """Sources that a methods paragraph names, each once, by their first author."""
    return [source for source in _SOURCES if source.partition(",")[0] in methods]


def _faces(card):
    where = {name: one.get("value") for name, one in card["geometry"].items()}
    surface = "synthetic surface" if card["synthetic"] else "scanned surface"
    offset = with_unit(where["offset"], "mm") if where["offset"] else "zero"
    slid = "" if card["direction"] == "none" else f" at a shear offset of {offset}"
    return (
        f"A window of {short(where['window_x'])} x {short(where['window_y'])} mm of the {surface} "
        f"({card['faces']}; spacing {with_unit(where['spacing'], 'mm')}) was compressed{slid}."
    )


def _contact(card):
    stated = card["entries"]
    modulus, poisson = (stated[key].get("value") for key in ("modulus", "poisson"))
    capped = "without a bound on the pressure"
    if card["model"] != "elastic":
        wall, hardness = (stated[key].get("value") for key in ("joint_wall_strength", "hardness"))
        reason = "the joint wall strength" if wall == hardness else "stated for this joint"
        hardness_words = card["model"].partition("= ")[2]
        capped = f"with the pressure bounded by the hardness, {hardness_words}, {reason}"
    constants = f"(E = {with_unit(modulus, 'MPa')}, Poisson's ratio {short(poisson)})"
    boundary = card["boundary"]
    blocks = (
        f"Both blocks are elastic half-spaces {constants}, {capped}."
        if boundary == BOUNDARIES["free"]
        else f"Both blocks are elastic {constants}, {capped}. The window is {boundary}, so that "
        "the blocks do not settle as a whole (w_b = 0): closure is the approach of the mean planes."
    )
    return (
        f"{blocks} The frictionless normal contact problem was solved at "
        "every node of the scan until the complementarity conditions held, after Borri-Brunetto "
        "et al. (1999). Contact areas are corrected for their perimeter (Yastrebov et al. 2017)."
    )


def _laws(card):
    laws = {"hyperbola": card["entries"]["k_ni"], "logarithm": card["entries"]["chi"]}
    fitted = [name for name, law in laws.items() if "value" in law]
    if not fitted:
        return f"No closure law was fitted: {laws['hyperbola']['missing']}."
    span = laws[fitted[0]]["range"]
    return (
        f"A {' and a '.join(fitted)} (Bandis et al. 1983) {'was' if len(fitted) == 1 else 'were'} "
        f"fitted by least squares to the closure from a seat of {with_unit(span['low'], 'MPa')} "
        f"to {with_unit(span['high'], 'MPa')}; intervals are at 95 %."
    )


def _strength(card):
    if "missing" in card["entries"]["jrc"]:
        return "Nothing slides here, so there is no strength."
    return (
        "Shear strength is sigma tan(phi_b + i) with the dilatancy angle i of the computed "
        "states. It is compared with Barton's law (Barton and Choubey 1977) with JRC from Z2 of "
        f"the whole face (Tse and Cruden 1979){_jrc_step(card)}."
    )


def _jrc_step(card):
    """Step of the JRC of Barton's law, in words; empty without one."""
    jrc = jrc_of_law(card)
    return f" at a step of {with_unit(jrc['at']['step'], 'mm')}" if jrc else ""


def _versions(versions):
    return f"Computed with {', '.join(f'{name} {which}' for name, which in versions.items())}."
