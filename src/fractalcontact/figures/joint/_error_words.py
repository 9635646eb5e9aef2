"""Errors of the published quantities in words: totals of a panel, values of the caption."""

from typing import Any

import numpy as np
import xarray as xr

from ...core.labels import REALISATIONS, TWINS
from ..kit.words import length_unit, percent, short

#: Quantities: title of the panel, and its word in the caption.
QUANTITIES = {
    "closure": ("interface closure", "closure"),
    "separation": ("separation", "separation"),
    "area_corrected": ("contact area", "area"),
    "stiffness": ("tangent stiffness", "stiffness"),
    "delta_sigma": ("$\\Delta_\\sigma$ by boxes", "Δσ"),
}
SOURCES = {
    "solver": "solver",
    "numerical": "numerical (same surface, finer grid)",
    "secant": "scatter of a secant, where nodes yield",
    "counting": "counting of contacts",
    "window": "other windows of the scan",
    "registration": "registration of the faces",
    "resolution": "every second node: another surface, in no total",
    "model": "three times the hardness: another model, in no total",
    "estimator": "ordinary box-counting slope: another estimator, in no total",
    TWINS: "spread of twins of the scan (replaces counting and windows)",
    REALISATIONS: "spread of its realisations (replaces counting and windows)",
}
TOTALS = {
    "total": ("total for this very surface\n(solver, numerical, secant)", "-"),
    "total_of_population": (
        "total for any surface of its kind\n(also counting or windows, registration)",
        "--",
    ),
}
#: Totals less than this factor apart lie on each other.
_APART = 1.05


def _error_words(errors, error):
    """An error of a quantity in words: a fraction of the value, or in the unit."""
    value = float(errors["published"])
    if value and not errors["absolute"]:
        return percent(error / abs(value))
    if str(errors["unit"].values) != "mm":
        return short(error, 2)
    unit, size = length_unit(error)
    return f"{short(error / size, 2)} {unit}"


def totals_words(errors: xr.Dataset) -> str:
    """Both totals at the reference load, for the title of a panel, and the model's error."""
    model = float(errors["error"].sel(source="model"))
    beside = f", model {_error_words(errors, model)}" if np.isfinite(model) else ""
    return _both_totals(errors) + beside


def _both_totals(errors):
    own, kind = (float(errors[key]) for key in TOTALS)
    if not np.isfinite(own):
        return "total not known"
    words = [_error_words(errors, error) for error in (own, kind)]
    if not np.isfinite(kind):
        return f"total {words[0]}"
    if not _apart(own, kind):
        return f"both totals {' to '.join(dict.fromkeys(words))}"
    return f"totals {', '.join(words)}"


def _apart(own, kind):
    """True if both totals are known and their lines are apart."""
    return bool(np.isfinite([own, kind]).all() and kind >= _APART * own)


def caption_values(here: xr.Dataset) -> dict[str, Any]:
    """Values of the caption: both totals, and the panels in which they are apart."""
    totals, letters, added = [], [], []
    for which, (quantity, (_, words)) in zip("abcde", QUANTITIES.items(), strict=True):
        errors = here.sel(quantity=quantity)
        own, kind = (float(errors[key]) for key in TOTALS)
        if np.isfinite(own):
            source = str(errors["largest_source"].values)
            totals.append((words, _error_words(errors, own), source))
        source = str(errors["largest_source_of_population"].values)
        if source and _apart(own, kind):
            letters.append(which)
            added.append(SOURCES[source])
    run = len(letters) > 2 and "".join(letters) in "abcde"
    larger = f"({letters[0]}) to ({letters[-1]})" if run else ", ".join(f"({x})" for x in letters)
    values = {"totals": totals, "larger": larger, "added": list(dict.fromkeys(added))}
    return values | {"force": float(here["normal_force"])}
