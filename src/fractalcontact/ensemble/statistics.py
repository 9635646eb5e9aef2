"""Statistics of an ensemble: trends with load of each realisation, means, intervals and bands."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.estimate import IN_PLANE
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.limits import NEAR_FULL
from ..domain.random_nodes import band_of

#: Bounds of quantities; others have none.
_BOUNDS = {
    **dict.fromkeys(
        (
            *("nodes", "interface_closure", "closure_from_common_seat", "mean_gap"),
            *("area_corrected_share", "interface_stiffness"),
        ),
        (0.0, np.inf),
    ),
    **dict.fromkeys(
        (
            *("delta_sigma", "delta_sigma_random", "delta_sigma_area"),
            *("local_slope", "local_slope_random", "local_slope_cut"),
        ),
        IN_PLANE,
    ),
}
#: Quantities with a band: figures draw those of the slopes, the error budget takes the others.
_BANDS = {
    *("delta_sigma", "delta_sigma_area", "local_slope"),
    *("interface_closure", "mean_gap", "area_corrected_share", "interface_stiffness"),
}
#: Trends with the load: quantity, and what the trend is of.
TRENDS = {
    "delta_sigma_trend": ("delta_sigma", "Delta_sigma by boxes"),
    "departure_trend": (
        "delta_sigma_cut_difference",
        "Delta_sigma by boxes less that of the bearing-area cut",
    ),
    "delta_sigma_area_trend": ("delta_sigma_area", "Delta_sigma by A_r(s)"),
}


def add_trends(result: xr.Dataset) -> None:
    """Slopes per decade of load of every realisation, into ``result``.

    ``result`` is over (realisation, normal_force). It gets :data:`TRENDS` with their statistics,
    and ``NAME_used`` (normal_force). Loads at which a realisation has no value are left out of all:
    realisations would else be compared over different loads. What is compared with the cut is so
    where that is no more than near 2: beyond, both tend to 2, and what began lower would seem to
    rise faster. Two loads are enough for a slope, for its error is that of the mean over the
    realisations.
    """
    decades = np.log10(result["normal_force"].values)
    for name, (quantity, words) in TRENDS.items():
        values = result[quantity]
        if quantity == "delta_sigma_cut_difference":
            values = values.where(result["delta_sigma"] - values <= NEAR_FULL)
        rows = values.transpose("realisation", "normal_force").values
        used = np.isfinite(rows).all(axis=0)
        slopes = np.full(len(rows), np.nan)
        if used.sum() > 1:
            lever = decades[used] - decades[used].mean()
            slopes = rows[:, used] @ lever / (lever @ lever)
        attrs = cf_attrs("1", f"slope of {words} per decade of load")
        result[name] = ("realisation", slopes, attrs)
        attrs = cf_attrs("1", f"load that {name} is fitted over: every realisation has a value")
        result[f"{name}_used"] = ("normal_force", used, attrs)
    add_statistics(result, list(TRENDS))


def add_statistics(result: xr.Dataset, names: Sequence[str]) -> None:
    """Mean with its 95 % interval, band and number of realisations, into ``result``.

    Of each name it gets ``NAME_mean`` with ``_low`` and ``_high``, by Student's t of the mean;
    ``NAME_n``, the realisations that have a value; and of :data:`_BANDS` ``NAME_band_low`` and
    ``NAME_band_high``, between which one more realisation lies with 95 % probability. Intervals and
    bands end at the bounds of the quantity.
    """
    added: dict[str, tuple | xr.DataArray] = {}
    for name in names:
        values = result[name].transpose("realisation", ...)
        units, words = values.attrs["units"], values.attrs["long_name"]
        dims = values.dims[1:]
        bounds = _BOUNDS.get(name, (-np.inf, np.inf))
        mean = mean_interval(values.values).within(*bounds)
        added |= mean.variables(f"{name}_mean", dims, units, f"{words}, mean over realisations")
        if name in _BANDS:
            band = band_of(values.values).within(*bounds)
            for end, of_end, of_band in (("low", "lower", band.low), ("high", "upper", band.high)):
                attrs = cf_attrs(units, f"{words}, {of_end} end of the 95 % band of one more")
                added[f"{name}_band_{end}"] = (dims, of_band, attrs)
        attrs = cf_attrs("1", f"{words}, number of realisations with a value")
        added[f"{name}_n"] = (dims, mean.n, attrs)
    # Variables are added together: each single assignment makes xarray check the whole dataset.
    result.update(added)
