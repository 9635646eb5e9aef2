"""All measures of a contact domain and its pressure: of one state, and of all map states."""

import numpy as np
import xarray as xr

from ..core.arrays import padded
from ..core.labels import cf_attrs
from ..core.slope_of_sums import NO_SLOPE
from .box_counts import box_count, box_sizes
from .box_dimension import box_dimension, local_slopes
from .correlation import correlation_dimension
from .multifractal import ORDERS, generalised_dimensions, lacunarity

#: Measures of a domain that are slopes, with their long names.
SLOPES = {
    "box_dimension": "box-counting dimension Delta_sigma",
    "correlation_dimension": "correlation dimension of the nodes in contact",
    "lacunarity_slope": "slope of log lacunarity against log box side",
}


def order_name(q):
    """Name of D_q in a table: "d_2", "d_minus_1"."""
    return f"d_{'minus_' if q < 0 else ''}{abs(q):g}".replace(".", "_")


def domain_measures(domain, spacing, pressure=None):
    """Every measure of a contact domain as one row of a table.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact.
    spacing : float
        mm.
    pressure : (ny, nx) array_like, optional
        MPa; without it the generalised dimensions are those of the nodes, each of the same mass.

    Returns
    -------
    dict of str to float
        :data:`SLOPES` and D_q (:func:`order_name`) of :data:`domain.multifractal.ORDERS`: each
        the value, ``_low``, ``_high``, ``_r_min``, ``_r_max`` (mm) and ``_n`` scales. NaN and 0
        where there is none.
    """
    domain = np.asarray(domain, dtype=bool)
    return _row(domain, spacing, lacunarity(domain, spacing), pressure)


def _row(domain, spacing, gliding, pressure):
    """:func:`domain_measures` of a domain whose lacunarity is known."""
    box = box_dimension(domain, spacing)
    slopes = {
        "box_dimension": (box.dimension, box.low, box.high, box.r_min, box.r_max, box.n),
        "correlation_dimension": correlation_dimension(domain, spacing),
        "lacunarity_slope": gliding.slope if domain.any() else NO_SLOPE,
    }
    mass = domain if pressure is None else pressure
    for q, slope in generalised_dimensions(mass, spacing).items():
        slopes[order_name(q)] = slope
    ends = ("", "_low", "_high", "_r_min", "_r_max", "_n")
    return {
        f"{name}{end}": float(value)
        for name, slope in slopes.items()
        for end, value in zip(ends, slope, strict=True)
    }


def measures_of_map_states(states, spacing):
    """:func:`measures_of_states` of the states that are looked at closely.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`mechanics.states.map_states`.
    spacing : float
        Of the scan, mm.

    Returns
    -------
    xr.Dataset
        With the scalars ``direction``, ``offset`` and ``resolution``.
    """
    pressures = states["pressure"].values
    side = spacing * int(states["resolution"])
    measures = measures_of_states(pressures > 0, pressures, side, states["load"].values)
    place = {name: states[name] for name in ("direction", "offset", "resolution")}
    return measures.assign_coords(place)


def measures_of_states(domains, pressures, spacing, forces):
    """Measures of one joint's contact under every load: dataset of the stage domain_measures.

    Parameters
    ----------
    domains : (load, ny, nx) bool array_like
    pressures : (load, ny, nx) array_like
        MPa.
    spacing : float
        mm.
    forces : (load,) array_like
        F, N.

    Returns
    -------
    xr.Dataset
        Over load: the measures of :func:`domain_measures` but D_q, with ``_low``, ``_high``,
        ``_r_min``, ``_r_max`` and ``_n``. ``generalised_dimension`` over (load, order), likewise.
        ``local_slope`` of the box counts over (load, slope_side); ``lacunarity`` with ``_low`` and
        ``_high`` over (load, gliding_side). Sides in mm are coordinates.

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
    rows = [_row(d, spacing, *of) for d, *of in zip(domains, curves, pressures, strict=True)]
    side, slopes = _local_slopes(domains, spacing)
    variables = {}
    for name, long_name in SLOPES.items():
        variables |= _slope_variables("load", name, long_name, lambda key: [r[key] for r in rows])
    variables |= _slope_variables(
        ("load", "order"),
        "generalised_dimension",
        "generalised dimension D_q of the pressure",
        lambda key: [
            [row[key.replace("generalised_dimension", order_name(q))] for q in ORDERS]
            for row in rows
        ],
    )
    variables["local_slope"] = (
        ("load", "slope_side"),
        slopes,
        cf_attrs("1", "local slope of log N(r) over a doubling of the box side"),
    )
    for end, words in (("", ""), ("_low", ", lower end"), ("_high", ", upper end")):
        values = [getattr(curve, end.removeprefix("_") or "value") for curve in curves]
        variables[f"lacunarity{end}"] = (
            ("load", "gliding_side"),
            np.array(values),
            cf_attrs("1", f"gliding-box lacunarity{words and words + ' of the 95 % interval'}"),
        )
    return xr.Dataset(
        variables,
        coords={
            "load": ("load", forces, cf_attrs("N", "normal force F")),
            "order": ("order", np.array(ORDERS), cf_attrs("1", "order q")),
            "slope_side": ("slope_side", side, cf_attrs("mm", "middle of the doubling")),
            "gliding_side": (
                "gliding_side",
                curves[0].r,
                cf_attrs("mm", "side of the gliding box"),
            ),
        },
    )


def _slope_variables(dims, name, long_name, values):
    """A slope with its interval and range as variables of a dataset."""
    ends = {
        "": ("1", long_name),
        "_low": ("1", f"{long_name}, lower end of the 95 % interval"),
        "_high": ("1", f"{long_name}, upper end of the 95 % interval"),
        "_r_min": ("mm", f"{long_name}: smallest length fitted"),
        "_r_max": ("mm", f"{long_name}: largest length fitted"),
        "_n": ("1", f"{long_name}: lengths fitted"),
    }
    return {
        f"{name}{end}": (dims, np.array(values(f"{name}{end}"), float), cf_attrs(*label))
        for end, label in ends.items()
    }


def _local_slopes(domains, spacing):
    """Local slopes of all domains' box counts at the window's box sizes; NaN without a node."""
    r = box_sizes(domains.shape[1:]) * float(spacing)
    rows = []
    for domain in domains:
        count = box_count(domain, r / spacing).astype(float)
        middle, slope = local_slopes(r, np.where(count > 0, count, np.nan))
        rows.append(slope)
    return middle, padded(rows)
