"""Measured contact maps: where two faces touched, as films and casts of real joints show it.

A map is a file like a scan, a matrix of stresses or of 0 and 1, whose sidecar says
``kind: contact-map``. It has no heights, so nothing is solved: it goes straight to the analysis of
contact domains.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.errors import InputError
from ..core.units import load as read_load
from ..scan.read import read_matrix
from .analysis import DOMAIN_FIELDS, analyse_domains

#: Keys of a sidecar that only maps have.
MAP_KEYS = ("kind", "threshold", "load", "cells")
#: What a cell in contact stands for, and whether it is one of those that hold any contact at all.
CELLS = {"any contact": True, "contact at the centre": False}

#: What a map holds beside the numbers of its contact domain.
_VARIABLES = {
    "in_contact": (("y", "x"), "1", "cell in contact"),
    "measured": (("y", "x"), "1", "cell where something was measured"),
    "area_share": ((), "1", "real contact area A_r / A_0"),
    "nominal_pressure": ((), "MPa", "nominal pressure F / A_0"),
}


def read_contact_map(path: Path | str, options: Mapping[str, Any], *, label: str) -> xr.Dataset:
    """The contact domain of a map, its dimension and its clusters.

    Parameters
    ----------
    path : path-like
        A matrix file as :func:`scan.read.read_scan` takes it; NaN where nothing was
        measured.
    options : mapping
        Scan keys of the sidecar; ``unit`` (of x and y) and ``spacing`` as for a scan,
        ``threshold``: cells above it are in contact (not needed for a map of 0 and 1), ``load``:
        the force on the whole map or its nominal pressure, ``cells``: what a cell in contact
        stands for (:data:`CELLS`), else its counts decide, see
        :func:`domain.box_dimension.box_dimension`.
    label : str
        What it is, in words.

    Returns
    -------
    xr.Dataset
        ``in_contact`` and ``measured`` (y, x); the numbers of
        :data:`domain.analysis.DOMAIN_FIELDS`; ``area_share``; ``nominal_pressure`` in MPa,
        NaN if no load is stated. Attribute ``label``.

    Raises
    ------
    InputError
        If the file is no matrix, the threshold is missing or nothing lies above it.
    """
    reading = {key: value for key, value in options.items() if key not in MAP_KEYS}
    # What the cells hold is no length: in mm it is taken over as it stands.
    values, (dx, dy), provenance = read_matrix(path, reading | {"unit_z": "mm"})
    threshold = _threshold(values, options.get("threshold"), path)
    measured = np.isfinite(values)
    touching = measured & (np.nan_to_num(values) > threshold)
    if not touching.any():
        raise InputError(
            f"{path}: no cell lies above the threshold of {threshold:g} (the largest holds "
            f"{np.nanmax(values):g}); write a lower 'threshold' in its sidecar"
        )
    dims = ("direction", "offset", "normal_force", "y_1", "x_1")
    domains = xr.Dataset(
        {"in_contact_1": (dims, touching[np.newaxis, np.newaxis, np.newaxis])},
        coords={"direction": ["none"], "offset": [0.0], "normal_force": [0.0]},
    )
    stands_for = options.get("cells")
    whole_cells = CELLS.get(str(stands_for))
    spacing = float(np.sqrt(dx * dy))
    table = analyse_domains(domains, spacing, whole_cells=whole_cells).squeeze(drop=True)
    nominal = measured.sum() * dx * dy
    variables = {
        "in_contact": touching,
        "measured": measured,
        "area_share": touching.sum() / measured.sum(),
        "nominal_pressure": _pressure(options.get("load"), nominal, f"sidecar of {path}: load"),
    }
    result = table[[*DOMAIN_FIELDS, "reason"]].assign(labelled(_VARIABLES, variables))
    result.attrs = {
        "label": label,
        "threshold": float(threshold),
        "spacing_y": dy,
        "spacing_x": dx,
        **({"cells": stands_for} if stands_for else {}),
        **provenance,
    }
    return result


def _threshold(values, threshold, path):
    """Above what a cell is in contact: as stated, or between the 0 and 1 of a binary map."""
    if threshold is not None:
        return float(threshold)
    if np.isin(values[np.isfinite(values)], (0, 1)).all():
        return 0.5
    raise InputError(
        f"{path}: this contact map holds other numbers than 0 and 1; write above which of them a "
        "cell is in contact, for example 'threshold: 5', in its sidecar"
    )


def _pressure(text, area, where):
    """Nominal pressure of a load on an area in mm2, MPa; NaN without a load."""
    if text is None:
        return np.nan
    value, kind = read_load(text, where)
    return value / area if kind == "force" else value
