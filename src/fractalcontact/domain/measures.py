"""Measures of a contact domain and its pressure other than the box dimension."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.estimate import Estimate
from ..core.labels import cf_attrs
from ..core.per_curve import stacked
from .correlation import correlation_dimension
from .isotropy import INTERVALS, interval_dimensions
from .multifractal import ORDERS, generalised_dimensions, lacunarity

#: D_q of these orders are compared: of the support, and of the largest pressures.
_COMPARED_ORDERS = (0.0, 4.0)


def measures_of_map_states(states: xr.Dataset, spacing: float) -> xr.Dataset:
    """Measures of the map states, :func:`states.states.map_states`, spacing in mm.

    Variables of :func:`measures_of_states` with the scalars ``direction``, ``offset`` and
    ``resolution``, and over load the exponents of :data:`domain.isotropy.INTERVALS`.
    """
    factor = int(states["resolution"])
    direction, sides = str(states["direction"].item()), (spacing * factor, spacing * factor)
    measures = measures_of_states(states["pressure"], spacing * factor, states["normal_force"])
    rows = [
        dict(zip(INTERVALS, interval_dimensions(pressure > 0, sides, direction), strict=True))
        for pressure in states["pressure"].values
    ]
    place = {name: states[name] for name in ("direction", "offset", "resolution")}
    return measures.assign(stacked(rows, INTERVALS, ("normal_force",), (len(rows),))).assign_coords(
        place
    )


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
    rows = [_measures(pressure, spacing) for pressure in pressures]
    sides = rows[0]["lacunarity"].r
    coords = {
        "normal_force": ("normal_force", forces, cf_attrs("N", "normal force F")),
        "order": ("order", np.array(ORDERS), cf_attrs("1", "order q")),
        "gliding_side": ("gliding_side", sides, cf_attrs("mm", "side of the gliding box")),
    }
    return xr.Dataset(stacked(rows, _MEASURES, ("normal_force",), (len(rows),)), coords)


def _slope_rows(name: str, long_name: str, *own: str) -> dict[str, tuple[str, ...]]:
    """Variables of a slope with its interval and the lengths that it is fitted over."""
    return {
        name: ("1", long_name, *own),
        f"{name}_r_min": ("mm", f"{long_name}: smallest length fitted", *own),
        f"{name}_r_max": ("mm", f"{long_name}: largest length fitted", *own),
        f"{name}_n": ("1", f"{long_name}: lengths fitted", *own),
    }


#: Variables of each load: unit, long name, further dimensions.
_MEASURES = {
    **_slope_rows("correlation_dimension", "correlation dimension of the nodes in contact"),
    **_slope_rows("generalised_dimension", "generalised dimension D_q of the pressure", "order"),
    "lacunarity": ("1", "gliding-box lacunarity", "gliding_side"),
    "dimensions_fall": ("1", "whether the interval of D_4 lies below that of D_0"),
}


def _measures(pressure: np.ndarray, spacing: float) -> dict[str, Any]:
    """Values of :data:`_MEASURES` under one load."""
    spectrum = Estimate.stack(generalised_dimensions(pressure, spacing).values())
    slopes = {
        "correlation_dimension": correlation_dimension(pressure > 0, spacing),
        "generalised_dimension": spectrum,
    }
    row: dict[str, Any] = {"lacunarity": lacunarity(pressure > 0, spacing)}
    for name, slope in slopes.items():
        row |= {name: slope, f"{name}_r_min": slope.over[0], f"{name}_r_max": slope.over[1]}
        row[f"{name}_n"] = slope.n
    first, last = (spectrum[ORDERS.index(q)] for q in _COMPARED_ORDERS)
    return row | {"dimensions_fall": last.high < first.low}
