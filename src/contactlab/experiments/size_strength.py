"""Size effect of the strength of mated joints that slide, at equal v and at equal v/b.

At equal v no length of the ensemble is the side b, and there should be no size effect. At equal
v/b larger joints slide farther, and their strength should follow from v alone, through the
height-difference function S(v). Both are decided here, for elastic and for capped
(elastic-perfectly plastic) contact, with the dilatancy angle not truncated.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled_dataset, titled
from fractalcontact.core.errors import InputError
from fractalcontact.core.labels import cf_attrs
from fractalcontact.states.states import SCALARS
from fractalcontact.states.sweep import load_steps
from roughcontact.contact.corrected_area import corrected_area
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace

from .mated_faces import (
    face_class,
    height_difference,
    mated_composite,
    sliding_face,
)
from .strength_exponents import strength_exponents
from .units import E_STAR, SPACING

#: Largest KKT residual: a rate is a difference of two separations, each a part of the closure.
RTOL = 1e-5

_STATE = ("surface", "law", "offset", "reduced_pressure")
#: Stored variables of every state: dimensions, unit and long name.
STATES: dict[str, tuple] = {
    "separation": (_STATE, "mm", "separation of the mean planes of the faces (mean gap)"),
    "corrected_share": (_STATE, "1", "real contact area A_r / A_0, corrected for the perimeter"),
    "nodes": (_STATE, "1", "nodes in contact"),
    "yielded": (_STATE, "1", "fraction of the nodes in contact that carry the hardness"),
    **{name: (_STATE, *SCALARS[name]) for name in ("residual", "energy_error")},
}
#: Stored variables of every surface, and of every spectrum.
SURFACES: dict[str, tuple] = {
    "of_hurst": ("surface", "1", "Hurst exponent H"),
    "of_size": ("surface", "1", "nodes per side"),
    "number": ("surface", "1", "number of the surface in its class"),
    "composite_rms": (("surface", "offset"), "mm", "rms height of the composite topography"),
    "height_difference": (
        ("hurst", "offset"),
        "mm2",
        "height-difference function S(v) of the spectrum",
    ),
}


@titled("strength of sliding mated joints over their side, at equal v and at equal v/b")
def size_strength(recipe: Mapping[str, Any], rtol: float = 1e-6) -> xr.Dataset:
    """Strength, contact area and separation of sliding mated joints over their side.

    Parameters
    ----------
    recipe : mapping
        ``hurst``; ``loads``, values of p / (E* h'_rms); ``cut_off`` and ``roll_off`` in nodes;
        ``rms_slope`` of a face; ``basic_friction_angle`` in degrees; ``offsets`` v in nodes;
        ``sizes`` in nodes per side and as many numbers of ``surfaces``; and optionally
        ``hardness``, H / (E* h'_rms), for the capped law.
    rtol : float
        Tolerance of the solves, where it is tighter than :data:`RTOL`.

    Returns
    -------
    xr.Dataset
        :data:`STATES` over (surface, law, offset, reduced_pressure), :data:`SURFACES`, and the
        results of :func:`experiments.strength_exponents.strength_exponents`.

    Raises
    ------
    NotConverged
        If a state could not be verified; the message names it.
    InputError
        If there is not one number of surfaces for each size.

    Notes
    -----
    h'_rms is that of the composite of uncorrelated faces, sqrt(2) times that of a
    face, so that the pressure is one for all sizes and displacements.
    """
    return strength_exponents(sliding_states(recipe, rtol), recipe)


def sliding_states(recipe: Mapping[str, Any], rtol: float) -> xr.Dataset:
    """States of all surfaces: :data:`STATES`, :data:`SURFACES` and S(v).

    Parameters are those of :func:`size_strength`.
    """
    if len(recipe["sizes"]) != len(recipe["surfaces"]):
        raise InputError(
            f"size_strength: {len(recipe['sizes'])} sizes and {len(recipe['surfaces'])} numbers of "
            "surfaces; write one number for each size"
        )
    rows: list[dict[str, Any]] = []
    hursts, offsets = np.unique(recipe["hurst"]), np.unique(recipe["offsets"])
    classes = {float(hurst): face_class(float(hurst), recipe) for hurst in hursts}
    for hurst, faces in classes.items():
        for size, surfaces in zip(recipe["sizes"], recipe["surfaces"], strict=True):
            for number in range(surfaces):
                face = sliding_face(faces, size, int(offsets[-1]), number)
                where = f"mated faces, H = {hurst:g}, {size} nodes, surface {number}"
                joint = sliding_joint(face, recipe, min(rtol, RTOL), where)
                rows.append({"of_hurst": hurst, "of_size": size, "number": number} | joint)
    values = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    values["height_difference"] = np.array(
        [height_difference(offsets * SPACING, faces) for faces in classes.values()]
    )
    pressures = np.unique(recipe["loads"])
    coords = {
        "hurst": ("hurst", hursts, cf_attrs("1", "Hurst exponent H")),
        "law": list(_laws(recipe)),
        "offset": ("offset", offsets * SPACING, cf_attrs("mm", "shear displacement v")),
        "reduced_pressure": ("reduced_pressure", pressures, cf_attrs("1", "p / (E* h'_rms)")),
    }
    return labelled_dataset(STATES | SURFACES, values, coords)


def _laws(recipe: Mapping[str, Any]) -> dict[str, float]:
    """H / (E* h'_rms) of the laws, infinite for elastic contact."""
    return {"elastic": np.inf} | ({"capped": recipe["hardness"]} if "hardness" in recipe else {})


def sliding_joint(
    face: np.ndarray, recipe: Mapping[str, Any], rtol: float, where: str
) -> dict[str, np.ndarray]:
    """States of one face that slides over its copy: :data:`STATES` and ``composite_rms`` (offset).

    The face (n, n + reach) is in mm, the recipe that of :func:`size_strength`; ``where`` names the
    joint in errors.
    """
    size = len(face)
    area = (size * SPACING) ** 2
    space = HalfSpace((size, size), (SPACING, SPACING), E_STAR)
    unit = E_STAR * np.sqrt(2) * recipe["rms_slope"]
    offsets, pressures, laws = np.unique(recipe["offsets"]), recipe["loads"], _laws(recipe)
    forces = np.unique(pressures) * unit * area
    values = {name: np.full((len(laws), len(offsets), len(forces)), np.nan) for name in STATES}
    rms = np.zeros(len(offsets))
    for j, offset in enumerate(offsets):
        composite = mated_composite(face, int(offset))
        rms[j] = np.sqrt(np.mean(composite**2))
        for i, (law, hardness) in enumerate(laws.items()):
            solving = {"rtol": rtol} | ({"hardness": hardness * unit} if law == "capped" else {})
            of_state = f"{where}, v = {offset:g} nodes, {law}"
            for k, state in enumerate(load_steps(composite, space, forces, solving, of_state)):
                for name, value in _numbers_of(state, area).items():
                    values[name][i, j, k] = value
    return values | {"composite_rms": rms}


def _numbers_of(state: ContactState, area: float) -> dict[str, float]:
    """:data:`STATES` of one state."""
    domain = state.in_contact
    return {
        # The gap is negative where material has yielded: the planes come closer by as much.
        "separation": float(state.gap.mean()),
        "corrected_share": float(corrected_area(domain, state.space.spacing)) / area,
        "nodes": int(np.count_nonzero(domain)),
        "yielded": float(np.mean(state.pressure[domain] >= state.hardness)),
        "residual": state.residual,
        "energy_error": state.energy_error,
    }
