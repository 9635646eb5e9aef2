"""Measured contact maps: contact of two faces as films and casts of real joints show it.

A map is a file like a scan, a matrix of stresses or of 0 and 1, whose sidecar says
``kind: contact-map``. It has no heights, so nothing is solved: it goes straight to the analysis of
contact domains.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled, titled
from ..core.errors import InputError
from ..core.estimate import names_of, rows_of
from ..core.labels import cf_attrs
from ..core.units import load as read_load
from ..gridding.outline import outline_mask, outline_warning
from ..scan.coordinates import read_coordinates
from ..scan.options import CONTACT_MAP, WRITING_KEYS, coordinate_files, parse_options
from ..scan.read import read_matrix
from .analysis import DOMAIN_FIELDS, analyse_domains
from .null_models import null_models

#: Keys of a sidecar that only maps have.
MAP_KEYS = ("kind", "threshold", "load", "cells", "outline", "series", "x", "y")
#: Options for a file of coordinates, other than the form of its numbers.
COORDINATES_ALONE = {
    "kind": CONTACT_MAP,
    "axes": "none",
    "unit": "mm",
    "spacing": "1 mm",
    "first_row": "bottom",
    "missing": "none",
}
#: Meanings of a cell in contact, and the value of ``whole_cells`` for each.
CELLS = {"any contact": True, "contact at the centre": False}

_OVER_THRESHOLDS = "over the thresholds stated"
#: Variables of a map other than the numbers of its contact domain.
_VARIABLES = {
    "in_contact": (("y", "x"), "1", "cell in contact"),
    "measured": (("y", "x"), "1", "cell within the outline where something was measured"),
    "nominal_area": ((), "mm2", "nominal area A_0 of the cells measured"),
    "area": ((), "mm2", "real contact area A_r"),
    "area_share": ((), "1", "real contact area A_r / A_0"),
    "threshold_delta_sigma": (
        "threshold",
        "1",
        "box-counting dimension Delta_sigma of the cells above a threshold",
    ),
    "threshold_area_share": (
        "threshold",
        "1",
        "real contact area A_r / A_0 of the cells above a threshold",
    ),
    "delta_sigma_least": ((), "1", f"least Delta_sigma {_OVER_THRESHOLDS}"),
    "delta_sigma_most": ((), "1", f"largest Delta_sigma {_OVER_THRESHOLDS}"),
    **{
        of: ((), *row)
        for of, row in rows_of(
            "delta_sigma_random", "1", "Delta_sigma of as many cells at random, mean and 95 % band"
        ).items()
    },
    "null_verdict": ((), "1", "null models from which the local slopes differ"),
}
#: Variables that come from :func:`domain.null_models.null_models`.
_OF_NULLS = (*names_of("delta_sigma_random"), "null_verdict")
#: Variables of the load of a map.
_LOADS = {
    "force": ((), "N", "normal force F on the map"),
    "nominal_pressure": ((), "MPa", "nominal pressure sigma_0 = F / A_0"),
}


@titled("measured contact maps, one group per map")
def read_contact_map(path: Path | str, options: Mapping[str, Any], *, label: str) -> xr.Dataset:
    """Contact domain of a map with its dimension and its clusters.

    Parameters
    ----------
    path : path-like
        A matrix file as :func:`scan.read.read_scan` takes it; NaN where nothing was measured.
    options : mapping
        Keys of the sidecar: those of a scan, and :data:`MAP_KEYS`. Cells above ``threshold`` are in
        contact; of several thresholds the middle one counts. ``load`` is a force on the whole map
        or its nominal pressure. ``cells`` is one of :data:`CELLS`; without it the box counts
        decide, see :func:`domain.box_dimension.box_dimension`. ``outline`` is that of
        :func:`gridding.outline.outline_mask`.
    label : str
        Name of the map in words.

    Returns
    -------
    xr.Dataset
        ``in_contact`` and ``measured`` (y, x); the numbers of
        :data:`domain.analysis.DOMAIN_FIELDS`; areas, ``force`` and ``nominal_pressure``,
        NaN if no load is stated; Delta_sigma with its ends and area over ``threshold``. Attributes
        ``label``, ``series`` and ``warning``, which may be empty.

    Raises
    ------
    InputError
        If the file is no matrix, the threshold is missing or nothing lies above it, or the outline
        or the coordinates are none.
    """
    values, y, x, provenance = _read(Path(path), options)
    outline, where = options.get("outline"), f"sidecar of {path}"
    measured = outline_mask(outline, values, y, x, f"{where}: outline") & np.isfinite(values)
    thresholds = _thresholds(values[measured], options.get("threshold"), path)
    touching = measured & (np.nan_to_num(values) > thresholds[:, np.newaxis, np.newaxis])
    _require_contact(touching, thresholds, values[measured], path)
    stands_for = options.get("cells")
    dy, dx = y[1] - y[0], x[1] - x[0]
    main = (len(thresholds) - 1) // 2
    result = _analysed(touching, measured, main, (dy, dx), CELLS.get(str(stands_for)))
    nominal = measured.sum() * dx * dy
    pressure = _pressure(options.get("load"), nominal, f"{where}: load")
    loads = {"force": pressure * nominal, "nominal_pressure": pressure}
    result = result.assign(labelled(_LOADS, loads)).assign_coords(
        y=("y", y, cf_attrs("mm", "y of the cell's centre")),
        x=("x", x, cf_attrs("mm", "x of the cell's centre")),
        threshold=("threshold", thresholds, cf_attrs("1", "threshold, in the unit of the map")),
    )
    result.attrs = {
        "label": label,
        "series": options.get("series", ""),
        "threshold": float(thresholds[main]),
        "binary": int(_is_binary(values[measured])),
        "outline": json.dumps(outline or "rectangle"),
        "warning": outline_warning(values, touching[main], outline, thresholds[main]),
        "integral": float(np.nansum(np.where(measured, values, 0.0)) * dx * dy),
        "spacing_y": dy,
        "spacing_x": dx,
        **({"cells": stands_for} if stands_for else {}),
        **provenance,
    }
    return result


def _read(
    path: Path, options: Mapping[str, Any]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, dict]:
    """Values (ny, nx) of a map, its coordinates y and x in mm, and its source."""
    reading = {key: value for key, value in options.items() if key not in MAP_KEYS}
    files = coordinate_files(path, options)
    written = {key: reading[key] for key in WRITING_KEYS if key in reading}
    alone = parse_options({**COORDINATES_ALONE, **written}, str(path))
    axes = read_coordinates(files, options.get("unit_xy", options.get("unit")), alone)
    if axes:
        reading |= {"first_row": "bottom"}
        steps = [float(abs(np.diff(axes[key]).mean())) for key in "xy"]
        reading |= {"spacing": [f"{step:.12g} mm" for step in steps]}
    # The values are no lengths; "mm" takes them over unchanged.
    values, (dx, dy), provenance = read_matrix(
        path, reading | {"unit_z": "mm", "kind": CONTACT_MAP}
    )
    ny, nx = values.shape
    if not axes:
        return values, dy * (np.arange(ny) + 0.5), dx * (np.arange(nx) + 0.5), provenance
    for key, n in (("x", nx), ("y", ny)):
        if len(axes[key]) != n:
            raise InputError(
                f"{files[key]}: {len(axes[key])} coordinates {key}, but {path.name} has "
                f"{ny} rows of {nx} cells"
            )
    ascending = {key: 1 if line[-1] > line[0] else -1 for key, line in axes.items()}
    values = values[:: ascending["y"], :: ascending["x"]].copy()
    provenance["coordinates"] = ", ".join(file.name for file in files.values())
    return values, axes["y"][:: ascending["y"]], axes["x"][:: ascending["x"]], provenance


def _analysed(
    touching: np.ndarray,
    measured: np.ndarray,
    main: int,
    sides: tuple[float, float],
    whole_cells: bool | None,
) -> xr.Dataset:
    """Variables of a map for its thresholds, without loads; ``main`` is the main one's index."""
    spacing = float(np.sqrt(np.prod(sides)))
    dims = ("direction", "offset", "normal_force", "y_1", "x_1")
    # The analysis of domains takes the thresholds as loads of one joint.
    coords = {"direction": ["none"], "offset": [0.0], "normal_force": np.arange(len(touching))}
    domains = xr.Dataset({"in_contact_1": (dims, touching[np.newaxis, np.newaxis])}, coords)
    table = analyse_domains(domains, spacing, whole_cells=whole_cells)
    table = table.squeeze(["direction", "offset", "resolution"], drop=True)
    dimensions = table["delta_sigma"].values
    of_main = table[[*DOMAIN_FIELDS, "reason"]].isel(normal_force=main, drop=True)
    nulls = null_models(touching[[main]], spacing, mask=measured, whole_cells=whole_cells).squeeze(
        "normal_force"
    )
    nominal, shares = measured.sum() * np.prod(sides), touching.sum(axis=(1, 2)) / measured.sum()
    several = len(touching) > 1
    variables = {
        "in_contact": touching[main],
        "measured": measured,
        "nominal_area": nominal,
        "area": shares[main] * nominal,
        "area_share": shares[main],
        "threshold_delta_sigma": dimensions,
        "threshold_area_share": shares,
        "delta_sigma_least": np.fmin.reduce(dimensions) if several else np.nan,
        "delta_sigma_most": np.fmax.reduce(dimensions) if several else np.nan,
    }
    variables |= {name: nulls[name].item() for name in _OF_NULLS}
    return of_main.assign(labelled(_VARIABLES, variables))


def _thresholds(
    values: np.ndarray, stated: float | Sequence[float] | None, path: Path | str
) -> np.ndarray:
    """Thresholds above which a cell is in contact, ascending; 0.5 for a binary map."""
    if stated is not None:
        return np.sort(np.atleast_1d(np.asarray(stated, float)))
    if _is_binary(values):
        return np.array([0.5])
    raise InputError(
        f"{path}: this contact map holds other numbers than 0 and 1; write the number above which "
        "a cell is in contact into its sidecar, for example 'threshold: 5'"
    )


def _is_binary(values: np.ndarray) -> bool:
    return bool(np.isin(values, (0, 1)).all())


def _require_contact(touching, thresholds, values, path):
    """Refuse a threshold that nothing lies above."""
    for domain, threshold in zip(touching, thresholds, strict=True):
        if not domain.any():
            largest = f"{values.max():g}" if values.size else "nothing"
            raise InputError(
                f"{path}: no cell lies above the threshold of {threshold:g} (the largest holds "
                f"{largest}); write a lower 'threshold' in its sidecar"
            )


def _pressure(text, area, where):
    """Nominal pressure of a load on an area in mm2, MPa; NaN without a load."""
    if text is None:
        return np.nan
    value, kind = read_load(text, where)
    return value / area if kind == "force" else value
