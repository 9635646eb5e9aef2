"""All measures of a contact domain and its pressure: of one state, and of all map states."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.arrays import padded
from ..core.datasets import labelled
from ..core.estimate import Estimate, rows_of
from ..core.labels import cf_attrs
from .box_counts import mean_count, window_sizes
from .box_dimension import dimension_of_domain, local_slopes
from .correlation import correlation_dimension
from .isotropy import LAG_FIELDS, contact_at_lag
from .multifractal import ORDERS, generalised_dimensions, lacunarity
from .slope_curves import window_counts

#: Measures of a domain that are slopes, with their long names.
SLOPES = {
    "delta_sigma": "box-counting dimension Delta_sigma",
    "correlation_dimension": "correlation dimension of the nodes in contact",
}


def order_name(q: float) -> str:
    """Name of D_q in a table: "d_2", "d_minus_1"."""
    return f"d_{'minus_' if q < 0 else ''}{abs(q):g}".replace(".", "_")


def domain_measures(
    domain: np.ndarray,
    spacing: float,
    pressure: np.ndarray,
    fit_range: tuple[float, float] | None = None,
) -> dict[str, float]:
    """Every measure of a contact domain as one row of a table.

    Parameters
    ----------
    domain : (ny, nx) bool ndarray
        Nodes in contact.
    spacing : float
        mm.
    pressure : (ny, nx) ndarray
        MPa, or whatever the generalised dimensions are to weigh nodes by.
    fit_range : (float, float), optional
        Smallest and largest box of Delta_sigma, mm; by default all between the cut-offs.

    Returns
    -------
    dict of str to float
        :data:`SLOPES` and D_q (:func:`order_name`) of :data:`domain.multifractal.ORDERS`: each
        the value, ``_low``, ``_high``, ``_r_min``, ``_r_max`` (mm) and ``_n`` scales. NaN and 0
        where there is none.
    """
    box = dimension_of_domain(domain, spacing, fit_range=fit_range)
    slopes = {
        "delta_sigma": box,
        "correlation_dimension": correlation_dimension(domain, spacing),
        **{order_name(q): slope for q, slope in generalised_dimensions(pressure, spacing).items()},
    }
    row: dict[str, float] = {}
    for name, slope in slopes.items():
        lengths = {f"{name}_r_min": slope.over[0], f"{name}_r_max": slope.over[1]}
        row |= slope.columns(name) | lengths | {f"{name}_n": slope.n}
    return {name: float(value) for name, value in row.items()}


def measures_of_map_states(
    states: xr.Dataset,
    spacing: float,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """:func:`measures_of_states` of the states that are looked at closely.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`mechanics.states.map_states`.
    spacing : float
        Of the scan, mm.
    fit_range : (float, float), optional
        Smallest and largest box of the dimensions, mm; by default all between the cut-offs.

    Returns
    -------
    xr.Dataset
        With the scalars ``direction``, ``offset`` and ``resolution``, and over load the
        probabilities of :data:`domain.isotropy.LAG_FIELDS`.
    """
    pressures, factor = states["pressure"].values, int(states["resolution"])
    side, forces = spacing * factor, states["normal_force"].values
    measures = measures_of_states(pressures > 0, pressures, side, forces, fit_range)
    lags = [contact_at_lag(p > 0, str(states["direction"].item())) for p in pressures]
    by_load = {name: ("normal_force", *words) for name, words in LAG_FIELDS.items()}
    values = {name: [row[name] for row in lags] for name in LAG_FIELDS}
    measures = measures.assign(labelled(by_load, values))
    place = {name: states[name] for name in ("direction", "offset", "resolution")}
    return measures.assign_coords(place)


def measures_of_states(
    domains: ArrayLike,
    pressures: ArrayLike,
    spacing: float,
    forces: ArrayLike,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Measures of one joint's contact under every load: dataset of the stage domain_measures.

    Parameters
    ----------
    domains : (normal_force, ny, nx) bool array_like
    pressures : (normal_force, ny, nx) array_like
        MPa.
    spacing : float
        mm.
    forces : (normal_force,) array_like
        F, N.
    fit_range : (float, float), optional
        Smallest and largest box of Delta_sigma, mm; by default all between the cut-offs.

    Returns
    -------
    xr.Dataset
        Over load: the measures of :func:`domain_measures` but D_q, with ``_low``, ``_high``,
        ``_r_min``, ``_r_max`` and ``_n``. ``generalised_dimension`` over (normal_force, order),
        likewise, and ``dimensions_fall`` over load. ``local_slope`` of the box counts over
        (normal_force, slope_side); ``lacunarity`` with ``_low`` and ``_high`` over (normal_force,
        gliding_side). Sides in mm are coordinates.

    Raises
    ------
    ValueError
        If there are not as many domains, pressures and forces.
    """
    domains, pressures = np.asarray(domains, dtype=bool), np.asarray(pressures, dtype=float)
    forces = np.asarray(forces, dtype=float)
    if domains.shape != pressures.shape or len(domains) != forces.size:
        raise ValueError(
            f"domains {domains.shape}, pressures {pressures.shape} and {forces.size} forces "
            "do not belong together"
        )
    curves = [lacunarity(domain, spacing) for domain in domains]
    states = zip(domains, pressures, strict=True)
    rows = [domain_measures(domain, spacing, p, fit_range) for domain, p in states]
    side, local = _local_slopes(domains, spacing)
    variables: dict[str, Any] = {}
    for name, long_name in SLOPES.items():
        variables |= _slope_variables("normal_force", name, long_name, rows, [name])
    variables |= _slope_variables(
        ("normal_force", "order"),
        "generalised_dimension",
        "generalised dimension D_q of the pressure",
        rows,
        [order_name(q) for q in ORDERS],
    )
    curve_values = {
        "local_slope": local,
        **Estimate.stack(curves, (len(curves), -1)).columns("lacunarity"),
    }
    coords = {
        "normal_force": ("normal_force", forces, cf_attrs("N", "normal force F")),
        "order": ("order", np.array(ORDERS), cf_attrs("1", "order q")),
        "slope_side": ("slope_side", side, cf_attrs("mm", "middle of the doubling")),
        "gliding_side": ("gliding_side", curves[0].r, cf_attrs("mm", "side of the gliding box")),
    }
    measures = xr.Dataset(variables | labelled(_CURVES, curve_values), coords=coords)
    return measures.assign(dimensions_fall=_dimensions_fall(measures))


def _dimensions_fall(measures):
    """Fall of the dimensions of the pressure with their order; none for a monofractal."""
    first, last = (
        Estimate.read(measures.sel(order=q), "generalised_dimension") for q in _COMPARED_ORDERS
    )
    attrs = cf_attrs("1", "whether the interval of D_4 lies below that of D_0")
    return "normal_force", last.high < first.low, attrs


#: D_q of these orders are compared: of the support, and of the largest pressures.
_COMPARED_ORDERS = (0.0, 4.0)


#: Measures of a domain that are curves over a box side.
_CURVES = {
    "local_slope": (
        ("normal_force", "slope_side"),
        "1",
        "local slope of the mean box counts over a doubling of the box side",
    ),
    **{
        name: (("normal_force", "gliding_side"), *words)
        for name, words in rows_of("lacunarity", "1", "gliding-box lacunarity").items()
    },
}


def _slope_variables(dims, name, long_name, rows, keys):
    """A slope with its interval and range as variables of a dataset.

    ``keys`` are those of the slopes in the rows, along the last dimension where there are many.
    """
    table = {
        **rows_of(name, "1", long_name),
        f"{name}_r_min": ("mm", f"{long_name}: smallest length fitted"),
        f"{name}_r_max": ("mm", f"{long_name}: largest length fitted"),
        f"{name}_n": ("1", f"{long_name}: lengths fitted"),
    }
    values = {
        of: np.array(
            [[row[f"{key}{of.removeprefix(name)}"] for key in keys] for row in rows], float
        )
        for of in table
    }
    if isinstance(dims, str):
        values = {key: value[:, 0] for key, value in values.items()}
    return labelled({of: (dims, *words) for of, words in table.items()}, values)


def _local_slopes(domains, spacing):
    """Local slopes of all domains' mean box counts at the window's box sizes; NaN without a node.

    As :mod:`domain.slope_curves` takes them, over every doubling of these sizes.
    """
    sizes = window_sizes(domains.shape[1:])
    r, whole = sizes * float(spacing), window_counts(domains.shape[1:], sizes)
    rows = []
    for domain in domains:
        count = mean_count(domain, sizes).ravel()
        middle, slope = local_slopes(r, np.where(count > 0, count / whole, np.nan))
        rows.append(2 + slope)
    return middle, padded(rows)
