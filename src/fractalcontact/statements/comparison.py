"""Comparison of specimens and groups: values with errors, and spread of groups.

Of every specimen one row is kept, small whatever its scan: the comparison of a thousand specimens
reads a thousand rows and none of their fields.
"""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset, titled
from ..core.estimate import Estimate, rows_of
from ..core.intervals import t_quantile
from ..core.labels import cf_attrs
from ..core.reported import Reported
from ..core.text import percent
from ..core.window import nominal_area

#: Compared quantities, each with its 95 % interval: unit and long name; once a specimen, and under
#: every load.
ONCE = {"delta_g": ("1", "surface dimension Delta_g, the recommended estimate")}
UNDER_LOAD = {
    "stiffness": ("MPa/mm", "tangent stiffness d sigma_0 / d w_int at the map offset"),
    "delta_sigma": ("1", "Delta_sigma by box counting at the map offset"),
    "dilatancy": ("mm", "elastic dilatancy delta at the largest offset"),
    "size_exponent": ("1", "exponent of corrected A_r/A_0 against b at equal sigma_0"),
}
COMPARED_QUANTITIES = ONCE | UNDER_LOAD
#: Group of specimens for which the study states none.
UNGROUPED = "no group"
#: Digits to which nominal pressures must agree that specimens are compared under one.
_DIGITS = 4
#: Largest relative difference of nominal pressures of several specimens that count as one.
ALIKE = 0.05


def _table(prefix=(), names=COMPARED_QUANTITIES):
    """Variables of the quantities with the ends of their intervals, over ``prefix`` and loads."""
    return {
        of: ((*prefix, *(() if name in ONCE else ("load",))), *words)
        for name, of_name in names.items()
        for of, words in rows_of(name, *of_name).items()
    }


def specimen_row(stages: Mapping[str, xr.Dataset], settings: Mapping) -> xr.Dataset:
    """Compared quantities of a specimen, each with its 95 % interval.

    Over (load,) there are ``nominal_pressure`` (MPa) and :data:`UNDER_LOAD`, in the first direction
    that was solved; NaN where there is none. Attributes ``group``, ``label``, ``opposite``.
    """
    closure, surface = stages["closure"], stages["surface_dimension"]
    reported = Reported.read(closure)
    pressures = closure["normal_force"].values / nominal_area(stages["specimens"])
    values = {
        **Estimate.read(surface, "recommended_dimension").columns("delta_g"),
        **_stiffness(reported.states(closure), stages["error_budget"]),
        **Estimate.read(reported.states(stages["domains"]), "delta_sigma").columns("delta_sigma"),
        **_dilatancy(stages["dilatancy"], reported.direction, pressures.size),
        **_size_exponent(stages["size_test"], pressures),
    }
    table = _table() | {"nominal_pressure": ("load", "MPa", "nominal pressure sigma_0 = F/A_0")}
    row = labelled_dataset(table, values | {"nominal_pressure": pressures})
    return row.assign_attrs(
        group=settings.get("group") or UNGROUPED,
        label=str(settings["label"]),
        opposite=str(stages["specimens"].attrs["opposite"]),
    )


def _around(name, value, half_width):
    return Estimate(value, value - half_width, value + half_width).columns(name)


def _stiffness(states, budget):
    error = budget["total"].sel(quantity="stiffness")
    if error.size != states.sizes["normal_force"]:
        raise ValueError("the error budget has other loads than the closure")
    return _around("stiffness", states["interface_stiffness"].values, error.values)


def _dilatancy(dilatancy, direction, n_loads):
    """Elastic dilatancy at the largest offset; missing against a plane."""
    if direction == "none":
        return _around("dilatancy", *np.full((2, n_loads), np.nan))
    last = dilatancy.sel(contact_direction=direction).isel(offset=-1)
    error = last["elastic_dilatancy_error"].values + np.nan_to_num(last["left_out_error"].values)
    return _around("dilatancy", last["elastic_dilatancy"].values, error)


def _size_exponent(size_test, pressures):
    """Exponents of the size test under the loads of the study, which it goes beyond."""
    tested = size_test["nominal_pressure"].values
    same = np.isclose(tested[:, None], pressures[None, :], rtol=10.0**-_DIGITS)
    rows, columns = np.nonzero(same)

    def on_loads(tested: np.ndarray) -> np.ndarray:
        values = np.full(pressures.size, np.nan)
        values[columns] = tested[rows]
        return values

    return Estimate.read(size_test, "area_exponent").mapped(on_loads).columns("size_exponent")


@titled("specimens side by side, and how groups of them spread")
def compare_specimens(rows: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Rows of all specimens side by side, and how the quantities spread within each group.

    ``rows`` are by specimen, from :func:`specimen_row`. Behind the last load of specimens that have
    fewer, values are NaN. Of each quantity, over (group_name,) and under every pressure of
    :func:`compared_pressures` (group_name, pressure), there are :data:`_STATISTICS`, the interval
    of the mean by Student's t: NaN of one specimen. Besides :func:`with_common_pressure`.
    """
    names = sorted(rows)
    most = max((rows[name].sizes["load"] for name in names), default=0)
    groups = [str(rows[name].attrs["group"]) for name in names]
    table = _table(("specimen",)) | {
        "nominal_pressure": (("specimen", "load"), "MPa", "nominal pressure sigma_0 = F/A_0"),
        "compared_pressure": (
            ("specimen", "load"),
            "MPa",
            f"nominal pressure under which specimens are compared, one within {percent(ALIKE)}",
        ),
        "group": ("specimen", "1", "group of the specimen"),
        "label": ("specimen", "1", "label of the specimen"),
    }
    values: dict = {
        name: np.array([_filled(rows[one][name].values, most) for one in names])
        for name in table
        if name not in ("group", "label", "compared_pressure")
    }
    values["compared_pressure"] = compared_pressures(values["nominal_pressure"])
    values["group"] = np.array(groups, dtype=object)
    values["label"] = np.array([str(rows[name].attrs["label"]) for name in names], dtype=object)
    side_by_side = labelled_dataset(table, values, {"specimen": names})
    return with_common_pressure(side_by_side.merge(_group_statistics(side_by_side)))


def with_common_pressure(comparison: xr.Dataset) -> xr.Dataset:
    """Comparison with every quantity under the pressure under which most specimens are loaded.

    ``common_pressure`` (MPa) is of several the largest, NaN without any;
    ``NAME_at_common_pressure`` (specimen,) is NaN where a specimen was not loaded so.
    """
    counts = comparison[["stiffness_n", "delta_sigma_n"]].sum("group_name")
    values = (counts["stiffness_n"] + counts["delta_sigma_n"]).values[::-1]
    pressures = comparison["pressure"].values[::-1]
    common = float(pressures[np.argmax(values)]) if len(pressures) else np.nan
    attrs = cf_attrs("MPa", "nominal pressure under which most specimens are loaded")
    result = comparison.assign(common_pressure=((), common, attrs))
    compared = comparison["compared_pressure"].transpose("specimen", "load").values
    for name, (unit, long_name) in UNDER_LOAD.items():
        estimate = Estimate.read(comparison.transpose("specimen", "load", ...), name)
        under = estimate.mapped(lambda ends: _at(np.array([common]), compared, ends)[:, 0])
        under_words = f"{long_name}, under the common pressure"
        of = f"{name}_at_common_pressure"
        result = result.assign(under.variables(of, "specimen", unit, under_words))
    return result


def _filled(values, n):
    """Values over loads, padded with NaN; a scalar is returned unchanged."""
    values = np.asarray(values, float)
    return (
        values if values.ndim == 0 else np.pad(values, (0, n - values.size), constant_values=np.nan)
    )


def rounded_pressures(pressures: np.ndarray) -> np.ndarray:
    """Nominal pressures to the digits to which they must agree to be compared, MPa."""
    pressures = np.asarray(pressures, float)
    size = 10.0 ** np.floor(np.log10(pressures, where=pressures > 0, out=np.zeros(pressures.shape)))
    return np.round(pressures / size, _DIGITS - 1) * size


def compared_pressures(pressures: np.ndarray) -> np.ndarray:
    """Nominal pressures under which specimens are compared, MPa (specimen, load).

    Windows of one nominal size differ a little in area, and a load in N is then another pressure:
    each is the median of those within :data:`ALIKE` of the least. Two loads of one specimen stay
    two. NaN where a specimen has fewer loads.
    """
    rounded = rounded_pressures(pressures)
    places = np.argwhere(np.isfinite(rounded))
    places = places[np.argsort(rounded[tuple(places.T)], kind="stable")]
    groups: list[list[np.ndarray]] = []
    specimens: set[int] = set()
    for place in places:
        far = not groups or rounded[tuple(place)] > rounded[tuple(groups[-1][0])] * (1 + ALIKE)
        if far or int(place[0]) in specimens:
            groups.append([])
            specimens = set()
        groups[-1].append(place)
        specimens.add(int(place[0]))
    compared = np.full(rounded.shape, np.nan)
    for members in groups:
        at = tuple(np.array(members).T)
        compared[at] = rounded_pressures(np.median(rounded[at]))
    return compared


#: Statistics of each quantity within a group: ending, words before its long name, whether in its
#: unit.
_STATISTICS = {
    "_mean": "mean over specimens of ",
    "_mean_low": "lower end of the 95 % interval of the mean over specimens of ",
    "_mean_high": "upper end of the 95 % interval of the mean over specimens of ",
    "_deviation": "standard deviation between specimens of ",
    "_error": "median over specimens of the half-width of the 95 % interval of ",
    "_n": "specimens that have ",
}


def _group_statistics(rows: xr.Dataset) -> xr.Dataset:
    groups = sorted(set(rows["group"].values))
    rounded = rows["compared_pressure"].values
    known = np.unique(rounded[np.isfinite(rounded)])
    pressures = (
        known[np.concatenate([[True], np.diff(known) > 1e-9 * known[1:]])] if known.size else known
    )
    member = rows["group"].values[:, None] == np.array(groups, dtype=object)[None, :]
    table, values = {}, {}
    for name, (unit, words) in COMPARED_QUANTITIES.items():
        dims = ("group_name",) if name in ONCE else ("group_name", "pressure")
        estimate = Estimate.read(rows, name)
        if name in UNDER_LOAD:
            estimate = estimate.mapped(partial(_at, pressures, rounded))
        statistics = [_statistics(*estimate[chosen].ends) for chosen in member.T]
        for i, (ending, before) in enumerate(_STATISTICS.items()):
            table[f"{name}{ending}"] = (dims, "1" if ending == "_n" else unit, before + words)
            values[f"{name}{ending}"] = np.array([row[i] for row in statistics])
    coords = {
        "group_name": groups,
        "pressure": (
            "pressure",
            pressures,
            {"units": "MPa", "long_name": "nominal pressure sigma_0"},
        ),
    }
    return labelled_dataset(table, values, coords)


def _at(pressures, of_specimens, values):
    """Values over (specimen, load) brought to (specimen, pressure), NaN where it is no load."""
    same = np.isclose(of_specimens[:, :, None], pressures, rtol=1e-9)
    sums = np.where(same & np.isfinite(values)[:, :, None], values[:, :, None], 0.0).sum(axis=1)
    return np.where((same & np.isfinite(values)[:, :, None]).any(axis=1), sums, np.nan)


def _statistics(value, low, high) -> Sequence[np.ndarray]:
    """Mean, its interval, deviation, error and number, over the first axis."""
    n = np.isfinite(value).sum(axis=0)
    known = np.maximum(n, 1)
    mean = np.where(n > 0, np.nansum(value, axis=0) / known, np.nan)
    squares = np.nansum((value - mean) ** 2, axis=0)
    deviation = np.sqrt(np.where(n > 1, squares / np.maximum(n - 1, 1), np.nan))
    half = t_quantile(np.maximum(n - 1, 1)) * deviation / np.sqrt(known)
    widths = np.ma.masked_invalid((high - low) / 2)
    error = np.ma.median(widths, axis=0) if widths.shape[0] else np.full(np.shape(mean), np.nan)
    return mean, mean - half, mean + half, deviation, np.ma.filled(error, np.nan), n
