"""Verdict on eq. 6 by the experiment that varies resolution, size and geometry one by one.

Arm R varies the short cut-off at one size, S1, S2 and S3 vary the size at one short cut-off, with a
fixed roll-off, one in proportion to the size, and none; W those of windows cut from one surface. G
has surfaces of other constructions. The prediction of the classical theory (Persson's) for each
comes from the mean spectrum of the surfaces of a class.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled, titled
from fractalcontact.core.estimate import Estimate, rows_of
from fractalcontact.core.labels import cf_attrs
from fractalcontact.laws.theory import (
    PERIODIC_AREAS,
    PERIODIC_SCATTER,
    PERIODIC_SLOPE,
    fudged_persson_area,
    persson_area,
)

from .size_decision import (
    MIN_ROLL_OFFS,
    PROBABILITY,
    UNKNOWN,
    Decision,
    Exponent,
    decide,
    differ,
    mean_exponent,
    overall,
    paired_exponent,
    size_exponent,
)

#: Arms that vary the size.
SIZE_ARMS = ("S1", "S2", "S3", "W")

#: Exponents over the side that every arm of sizes has: long name.
OVER_SIDE = {
    "alpha": "exponent of A_r/A_0 over the side b, corrected area",
    "central_alpha": "the same of the central half, over Persson's area at its own pressure",
    "theory_alpha": "the same of Persson's area, from h'_rms of the surfaces alone",
    "compliance_exponent": "exponent of the compliance of the interface over the side b",
    "separation_exponent": "exponent of the mean gap over the side b",
}
#: Numbers of arm R and of the largest surfaces of S1 that stand for a dimension.
DIMENSIONS = {
    "area_delta": "Delta_sigma by A_r(s), from the short cut-off",
    "theory_delta": "the same from h'_rms of the surfaces alone, by Persson",
    "box_delta": "Delta_sigma by box counts, largest surfaces of arm S1",
    "random_delta": "the same expected of as many random nodes over the boxes of each domain",
    "box_cut_delta": "the same of the bearing-area cut",
    "band_delta": "correlation dimension between cut-off and roll-off, finest surfaces of arm R",
    "cut_delta": "the same of the bearing-area cut",
}
#: Numbers of arm G.
GEOMETRY = {
    "geometry_delta": "correlation dimension of the contact domain, other constructions",
    "geometry_cut": "the same of the bearing-area cut",
}
_OF_SURFACE = ("hurst", "reduced_pressure")
_OF_CLASS = ("arm", *_OF_SURFACE)
#: All exponents: dimensions and long name.
_EXPONENTS: dict[str, tuple[tuple[str, ...], str]] = {
    **{name: (_OF_CLASS, words) for name, words in OVER_SIDE.items()},
    **{name: (_OF_SURFACE, words) for name, words in DIMENSIONS.items()},
    **{name: (("construction", *_OF_SURFACE), words) for name, words in GEOMETRY.items()},
}
_VERDICTS: dict[str, tuple] = {
    "verdict": (_OF_CLASS, "1", "verdict of alpha on eq. 6"),
    "reason": (_OF_CLASS, "1", "why"),
    "no_size_effect": (_OF_CLASS, "1", "the interval of alpha lies within 0.02 of zero"),
    "overall": (_OF_CLASS[:2], "1", "verdict of all loads together on eq. 6"),
    "published_pressure": ("published", "1", "p / (E* h'_rms) of published periodic areas"),
    "published_share": ("published", "1", "published A_r / A_0 of periodic surfaces, H = 0.8"),
}
#: Estimators of Delta_sigma in eq. 6: by the areas A_r(s), and by box counts.
_ESTIMATORS = ("area", "box")


@titled("which exponent carries the size effect: resolution, size and geometry one by one")
def size_effect_verdict(parts: Sequence[xr.Dataset], recipe: Mapping[str, Any]) -> xr.Dataset:
    """Exponents of every class of surfaces, and the verdict on eq. 6.

    Parameters
    ----------
    parts : sequence of xr.Dataset
        From :func:`experiments.size_states.solve_task`.
    recipe : mapping
        Of the study, key ``size_effect``.

    Returns
    -------
    xr.Dataset
        The states of all surfaces; :data:`OVER_SIDE` over (arm, hurst, reduced_pressure) and
        :data:`DIMENSIONS` over (hurst, reduced_pressure), each with ``_error``, ``_low`` and
        ``_high`` over surfaces (99 %), as are :data:`GEOMETRY` over (construction, hurst,
        reduced_pressure) where there is an arm G; ``verdict``, ``reason`` and ``no_size_effect``
        over (arm, hurst, reduced_pressure); ``overall`` over (arm, hurst).
    """
    samples = xr.concat(parts, "surface")
    order = ["of_arm", "of_construction", "of_hurst", "of_size", "of_cut_off", "number"]
    samples = samples.sortby(order)
    samples["persson_share"] = _persson(samples)
    hursts, loads = np.unique(samples["of_hurst"]), samples["reduced_pressure"].values
    arms = [arm for arm in SIZE_ARMS if (samples["of_arm"] == arm).any()]
    smallest = MIN_ROLL_OFFS * recipe["roll_off"]
    constructions = np.unique(samples["of_construction"].values[samples["of_arm"] == "G"])
    exponents = (
        _over_side(samples, arms, hursts, smallest)
        | _dimensions(samples, hursts)
        | _geometry(samples, constructions, hursts)
    )
    lengths = {
        "arm": len(arms),
        "construction": len(constructions),
        "hurst": len(hursts),
        "reduced_pressure": len(loads),
    }
    variables: dict[str, tuple] = {}
    for name, (dims, words) in _EXPONENTS.items():
        stacked = Exponent.stack(exponents[name], [lengths[dim] for dim in dims])
        variables |= stacked.variables(name, dims, "1", words)
    shape = len(arms), len(hursts), len(loads)
    alphas = dict(zip(np.ndindex(shape), exponents["alpha"], strict=True))
    wanted = [
        dict(zip(np.ndindex(shape[1:]), map(_prediction, exponents[f"{name}_delta"]), strict=True))
        for name in _ESTIMATORS
    ]
    decisions = {
        place: decide(alpha, *(prediction[place[1:]] for prediction in wanted))
        for place, alpha in alphas.items()
    }
    variables |= labelled(
        _VERDICTS,
        {
            **{
                name: np.reshape([getattr(of_load, name) for of_load in decisions.values()], shape)
                for name in ("verdict", "reason", "no_size_effect")
            },
            "overall": _overall(decisions, alphas, wanted[0], shape),
            "published_pressure": np.array(list(PERIODIC_AREAS)) / PERIODIC_SLOPE,
            "published_share": np.array(list(PERIODIC_AREAS.values())),
        },
    )
    coords = {
        "arm": arms,
        "construction": constructions,
        "hurst": ("hurst", hursts, cf_attrs("1", "Hurst exponent H")),
        "reduced_pressure": samples["reduced_pressure"],
    }
    result = samples.merge(xr.Dataset(variables, coords), join="exact")
    result.attrs = {
        "smallest_side": int(smallest),
        "published_scatter": PERIODIC_SCATTER,
        "cut_off": int(recipe["cut_off"]),
        "roll_off": float(recipe["roll_off"]),
    }
    return with_comparisons(with_resolution_law(result))


def with_comparisons(result: xr.Dataset) -> xr.Dataset:
    """Add the exponents by eq. 6, and the departures of domains from the bearing-area cut.

    ``eq6_exponent`` (hurst, reduced_pressure, delta_estimator) with its interval;
    ``domain_determined`` and ``domain_beyond_cut`` (hurst, reduced_pressure): whether both
    dimensions have intervals, and whether these are disjoint.
    """
    dims = ("hurst", "reduced_pressure")
    ordered = result.transpose(*dims, ...)
    predictions = [
        Estimate.read(ordered, f"{name}_delta").mapped(lambda d: d - 2) for name in _ESTIMATORS
    ]
    value, low, high = (
        np.stack(ends, axis=-1)
        for ends in zip(*(prediction.ends for prediction in predictions), strict=True)
    )
    wanted = Estimate(value, low, high)
    words = "exponent of A_r/A_0 over the side b by eq. 6"
    level = f"{100 * PROBABILITY:g} %"
    rows = rows_of("eq6_exponent", "1", words, level)
    table: dict[str, tuple] = {
        name: ((*dims, "delta_estimator"), *row) for name, row in rows.items()
    }
    values: dict[str, np.ndarray] = wanted.columns("eq6_exponent")
    domain, cut = (Estimate.read(result, name) for name in ("band_delta", "cut_delta"))
    determined = np.isfinite(domain.width) & np.isfinite(cut.width)
    beyond = determined & ((domain.low > cut.high) | (domain.high < cut.low))
    table |= {
        "domain_determined": (dims, "1", "dimensions of domain and cut have intervals"),
        "domain_beyond_cut": (dims, "1", "dimension of the domain differs from its cut's"),
    }
    values |= {"domain_determined": determined, "domain_beyond_cut": beyond}
    result = result.assign(labelled(table, values))
    attrs = cf_attrs("1", "source of Delta_sigma: the areas A_r(s), or box counts")
    return result.assign_coords(delta_estimator=("delta_estimator", list(_ESTIMATORS), attrs))


def with_resolution_law(result: xr.Dataset) -> xr.Dataset:
    """Add the area slopes of arm R over p / (E* h'_rms(s)), and the lines of Persson's theory.

    ``resolved_pressure`` and ``resolved_kappa`` (surface, reduced_pressure), NaN outside arm R;
    ``theory_pressure``, ``theory_kappa`` and ``weakened_kappa_low`` and ``_high`` (theory,).
    """
    steepest, slope = _slope_of_loads(result), result["rms_slope"]
    pressure = (result["reduced_pressure"] * steepest / slope).where(result["of_arm"] == "R")
    pressure = pressure.transpose("surface", "reduced_pressure")
    kappa = result["corrected_share"] / pressure
    solved = pressure.values[np.isfinite(pressure.values)]
    p = np.geomspace(solved.min(), solved.max(), _CURVE_POINTS) if solved.size else np.empty(0)
    low, high = (fudged_persson_area(p, 1.0, 1.0, g) / p for g in _WEAKENED)
    values = {
        "resolved_pressure": pressure.values,
        "resolved_kappa": kappa.transpose("surface", "reduced_pressure").values,
        "theory_pressure": p,
        "theory_kappa": persson_area(p, 1.0, 1.0) / p,
        "weakened_kappa_low": low,
        "weakened_kappa_high": high,
    }
    return result.assign(labelled(_RESOLUTION, values))


#: Fractions g of the elastic energy by computations without adhesion, and points of a curve.
_WEAKENED, _CURVE_POINTS = (0.45, 0.42), 60
_OF_STATES = ("surface", "reduced_pressure")
_WEAKENED_WORDS = "A_r/A_0 over pressure by Persson's theory with its elastic energy times g"
_RESOLUTION = {
    "resolved_pressure": (_OF_STATES, "1", "p / (E* h'_rms(s)) of the surface's own cut-off s"),
    "resolved_kappa": (_OF_STATES, "1", "area slope kappa, corrected area, over that pressure"),
    "theory_pressure": ("theory", "1", "p / (E* h'_rms) of the theories' curves"),
    "theory_kappa": ("theory", "1", "A_r/A_0 over pressure by Persson's theory"),
    "weakened_kappa_low": ("theory", "1", f"{_WEAKENED_WORDS} = {_WEAKENED[0]:g}"),
    "weakened_kappa_high": ("theory", "1", f"{_WEAKENED_WORDS} = {_WEAKENED[1]:g}"),
}


def _persson(samples: xr.Dataset) -> xr.DataArray:
    """Area by Persson's theory at every state, from the h'_rms of its surface."""
    pressure = samples["reduced_pressure"] * _slope_of_loads(samples)
    values = fudged_persson_area(pressure, 1.0, samples["rms_slope"].broadcast_like(pressure))
    attrs = cf_attrs("1", "A_r / A_0 by Persson's theory with g = 0.435")
    area = xr.DataArray(values, dims=pressure.dims, attrs=attrs)
    # Other constructions have no spectrum between cut-offs, and loads of their own.
    area = area.where(samples["of_construction"] == "")
    return area.transpose("surface", "reduced_pressure")


def _slope_of_loads(samples: xr.Dataset) -> xr.DataArray:
    """h'_rms in the unit of the loads of every surface: that of the shortest cut-off."""
    slopes = samples["rms_slope"].values
    keys = list(zip(*(samples[f"of_{k}"].values for k in ("arm", "hurst", "size")), strict=True))
    steepest: dict[tuple, float] = {}
    for key, slope in zip(keys, slopes, strict=True):
        steepest[key] = max(steepest.get(key, 0.0), float(slope))
    return xr.DataArray([steepest[key] for key in keys], dims="surface")


def _of(samples: xr.Dataset, **chosen: Any) -> xr.Dataset:
    """Surfaces of a class, chosen by the values of ``of_NAME``."""
    keep = np.ones(samples.sizes["surface"], bool)
    for name, value in chosen.items():
        keep &= samples[f"of_{name}"].values == value
    return samples.isel(surface=keep)


def _over_loads(column: xr.DataArray) -> np.ndarray:
    """Values of the surfaces of a class, one row for each load."""
    return column.transpose("reduced_pressure", "surface").values


def _over_side(samples, arms, hursts, smallest) -> dict[str, list[Exponent]]:
    """:data:`OVER_SIDE` of every class, in the order (arm, hurst, load)."""
    exponents: dict[str, list[Exponent]] = {name: [] for name in OVER_SIDE}
    for arm in arms:
        for hurst in hursts:
            surfaces = _of(samples, arm=arm, hurst=hurst)
            surfaces = surfaces.isel(surface=surfaces["of_size"].values >= smallest)
            sides = surfaces["of_size"].values
            central = surfaces["central_share"] / fudged_persson_area(
                surfaces["central_pressure"].values
                * _slope_of_loads(surfaces).values[:, np.newaxis],
                1.0,
                surfaces["rms_slope"].values[:, np.newaxis],
            )
            height = surfaces["rms_height"]
            columns = {
                "alpha": surfaces["corrected_share"],
                "central_alpha": central,
                "theory_alpha": surfaces["persson_share"],
                "compliance_exponent": surfaces["compliance"] * height,
                "separation_exponent": surfaces["separation"] * height,
            }
            for name, column in columns.items():
                rows = _over_loads(column)
                if arm == "W":  # windows of one surface are no independent surfaces
                    numbers = surfaces["number"].values
                    exponents[name] += [paired_exponent(sides, row, numbers) for row in rows]
                else:
                    exponents[name] += [size_exponent(sides, row) for row in rows]
    return exponents


def _geometry(samples, constructions, hursts) -> dict[str, list[Exponent]]:
    """:data:`GEOMETRY` of every construction, Hurst exponent and load."""
    exponents: dict[str, list[Exponent]] = {name: [] for name in GEOMETRY}
    for construction in constructions:
        for hurst in hursts:
            surfaces = _of(samples, arm="G", construction=construction, hurst=hurst)
            for name, column in zip(GEOMETRY, ("band_dimension", "cut_dimension"), strict=True):
                exponents[name] += [mean_exponent(row) for row in _over_loads(surfaces[column])]
    return exponents


def _dimensions(samples, hursts) -> dict[str, list[Exponent]]:
    """:data:`DIMENSIONS` of every Hurst exponent and load."""
    exponents: dict[str, list[Exponent]] = {name: [] for name in DIMENSIONS}
    for hurst in hursts:
        fine = _of(samples, arm="R", hurst=hurst)
        slopes = _cut_off_slopes(fine, "corrected_share"), _cut_off_slopes(fine, "persson_share")
        for name, of_surfaces in zip(("area_delta", "theory_delta"), slopes, strict=True):
            exponents[name] += [mean_exponent(2 - row) for row in of_surfaces]
        finest = fine.isel(surface=fine["of_cut_off"].values == fine["of_cut_off"].values.min())
        largest = _of(samples, arm="S1", hurst=hurst)
        largest = largest.isel(surface=largest["of_size"].values == largest["of_size"].values.max())
        for name, surfaces, column in (
            ("box_delta", largest, "box_dimension"),
            ("random_delta", largest, "random_dimension"),
            ("box_cut_delta", largest, "cut_box_dimension"),
            ("band_delta", finest, "band_dimension"),
            ("cut_delta", finest, "cut_dimension"),
        ):
            exponents[name] += [mean_exponent(row) for row in _over_loads(surfaces[column])]
    return exponents


def _cut_off_slopes(fine: xr.Dataset, name: str) -> np.ndarray:
    """Slope of log area over log cut-off of every surface, (load, surface)."""
    cut_offs = np.unique(fine["of_cut_off"])
    largest = fine["of_size"].values.max()
    fine = fine.isel(surface=fine["of_size"].values == largest)
    x = np.log(cut_offs) - np.log(cut_offs).mean()
    logs = np.array(
        [
            np.log(_of(fine, cut_off=k).sortby("number")[name].transpose("reduced_pressure", ...))
            for k in cut_offs
        ]
    )
    return np.tensordot(x, logs, axes=(0, 0)) / np.sum(x**2)


def _prediction(delta: Exponent) -> Exponent:
    """-(2 - Delta_sigma) of an estimate."""
    return delta.mapped(lambda value: value - 2) if delta.known else UNKNOWN


def _overall(
    decisions: Mapping[tuple[int, ...], Decision],
    alphas: Mapping[tuple[int, ...], Exponent],
    by_area: Mapping[tuple[int, ...], Exponent],
    shape: tuple[int, int, int],
) -> np.ndarray:
    """Verdict on every (arm, hurst), and on the change of alpha with H by eq. 6."""
    arms, hursts, loads = (range(n) for n in shape)
    follows = [_follows(alphas, by_area, arm, shape) for arm in arms]
    return np.array(
        [
            [overall([decisions[i, j, k] for k in loads], follows=follows[i]) for j in hursts]
            for i in arms
        ]
    )


def _follows(
    alphas: Mapping[tuple[int, ...], Exponent],
    by_area: Mapping[tuple[int, ...], Exponent],
    arm: int,
    shape: tuple[int, int, int],
) -> bool:
    """True if alpha changes with H as -(2 - Delta_sigma) by A_r(s) does, at every load."""
    _, hursts, loads = shape
    if hursts < 2:
        return False
    for load in range(loads):
        ends = [alphas[arm, j, load] for j in (0, hursts - 1)]
        wanted = [by_area[j, load] for j in (0, hursts - 1)]
        if not all(np.isfinite(exponent.error) for exponent in (*ends, *wanted)):
            return False
        if not differ(*wanted) or differ(*(of[1].less(of[0]) for of in (ends, wanted))):
            return False
    return True
