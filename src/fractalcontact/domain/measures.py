"""Measures of a contact domain and its pressure other than the box dimension."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..core.estimate import Estimate
from ..core.labels import cf_attrs
from .correlation import correlation_dimension
from .isotropy import INTERVAL_FIELDS, WAYS, interval_dimensions
from .multifractal import ORDERS, generalised_dimensions, lacunarity

#: D_q of these orders are compared: of the support, and of the largest pressures.
_COMPARED_ORDERS = (0.0, 4.0)


def measures_of_map_states(states: xr.Dataset, spacing: float) -> xr.Dataset:
    """Measures of the map states, :func:`states.states.map_states`, spacing in mm.

    Those of :func:`measures_of_states` with the scalars ``direction``, ``offset`` and
    ``resolution``, and over load the exponents of :data:`domain.isotropy.INTERVAL_FIELDS`.
    """
    pressures, factor = states["pressure"].values, int(states["resolution"])
    measures = measures_of_states(pressures, spacing * factor, states["normal_force"].values)
    direction, sides = str(states["direction"].item()), (spacing * factor, spacing * factor)
    ways = [interval_dimensions(p > 0, sides, direction) for p in pressures]
    by_load = {name: ("normal_force", *words) for name, words in INTERVAL_FIELDS.items()}
    values: dict[str, Any] = {}
    for way, found in zip(WAYS, zip(*ways, strict=True), strict=True):
        values |= Estimate.stack(found).columns(f"interval_dimension_{way}")
    measures = measures.assign(labelled(by_load, values))
    place = {name: states[name] for name in ("direction", "offset", "resolution")}
    return measures.assign_coords(place)


def measures_of_states(pressures: ArrayLike, spacing: float, forces: ArrayLike) -> xr.Dataset:
    """Measures of one joint's contact under every load: dataset of the stage domain_measures.

    Parameters
    ----------
    pressures : (normal_force, ny, nx) array_like
        MPa, above 0 at the nodes in contact.
    spacing : float
        mm.
    forces : (normal_force,) array_like
        F, N.

    Returns
    -------
    xr.Dataset
        Over load ``correlation_dimension``, over (normal_force, order) ``generalised_dimension``:
        each the value, ``_low``, ``_high``, and ``_r_min``, ``_r_max`` (mm) and ``_n`` of the
        lengths fitted; NaN and 0 where there is none. ``dimensions_fall`` over load.
        ``lacunarity`` with its interval over (normal_force, gliding_side), mm.

    Raises
    ------
    ValueError
        If there are not as many pressures and forces.
    """
    pressures, forces = np.asarray(pressures, dtype=float), np.asarray(forces, dtype=float)
    if len(pressures) != forces.size:
        raise ValueError(
            f"pressures {pressures.shape} and {forces.size} forces do not belong together"
        )
    curves = [lacunarity(pressure > 0, spacing) for pressure in pressures]
    pairs = Estimate.stack(correlation_dimension(pressure > 0, spacing) for pressure in pressures)
    spectra = [generalised_dimensions(pressure, spacing) for pressure in pressures]
    spectrum = Estimate.stack(
        (spectrum[q] for spectrum in spectra for q in ORDERS), (len(spectra), len(ORDERS))
    )
    first, last = (spectrum[:, ORDERS.index(q)] for q in _COMPARED_ORDERS)
    words = cf_attrs("1", "whether the interval of D_4 lies below that of D_0")
    variables: dict[str, Any] = {
        **_slope_variables(
            "normal_force",
            "correlation_dimension",
            "correlation dimension of the nodes in contact",
            pairs,
        ),
        **_slope_variables(
            ("normal_force", "order"),
            "generalised_dimension",
            "generalised dimension D_q of the pressure",
            spectrum,
        ),
        **Estimate.stack(curves, (len(curves), -1)).variables(
            "lacunarity", ("normal_force", "gliding_side"), "1", "gliding-box lacunarity"
        ),
        "dimensions_fall": ("normal_force", last.high < first.low, words),
    }
    coords = {
        "normal_force": ("normal_force", forces, cf_attrs("N", "normal force F")),
        "order": ("order", np.array(ORDERS), cf_attrs("1", "order q")),
        "gliding_side": ("gliding_side", curves[0].r, cf_attrs("mm", "side of the gliding box")),
    }
    return xr.Dataset(variables, coords=coords)


def _slope_variables(dims, name, long_name, slope: Estimate) -> dict[str, Any]:
    """Slopes with their intervals and the lengths they were fitted over, as variables."""
    table = {
        f"{name}_r_min": (dims, "mm", f"{long_name}: smallest length fitted"),
        f"{name}_r_max": (dims, "mm", f"{long_name}: largest length fitted"),
        f"{name}_n": (dims, "1", f"{long_name}: lengths fitted"),
    }
    values = dict(zip(table, (*slope.over, slope.n), strict=True))
    return slope.variables(name, dims, "1", long_name) | labelled(table, values)
