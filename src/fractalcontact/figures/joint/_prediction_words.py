"""Predictions for the whole window in words: the best and the worst of all predictors."""

from typing import Any

import numpy as np
import xarray as xr

from ..kit.words import short

PREDICTORS = {
    "power_law": "power law of small parts",
    "eq6_area": "eq. 6, $A_r(s)$",
    "eq6_box": "eq. 6, box counting",
    "eq6_box_sizes": "eq. 6, occupied windows",
    "no_size_effect": "no size effect",
}


def caption_values(test: xr.Dataset, load: int | None) -> dict[str, Any]:
    """Best and worst prediction at the load that the caption speaks of, else ranges of all."""
    errors = {"closure": "closure_error", "contact area": "area_error"}
    if load is not None:
        here = test.isel(normal_force=load).sel(predictor=list(PREDICTORS))
        found = {words: _best_and_worst(1 + here[error]) for words, error in errors.items()}
        pressure = float(here["nominal_pressure"])
        return {"pressure": pressure, "beyond": bool(here["beyond_study"]), "found": found}
    # Within the study's loads, else beyond them.
    of_study = test.where(~test["beyond_study"].astype(bool))
    inside = any(np.isfinite(of_study[error]).any() for error in errors.values())
    drawn = (of_study if inside else test).sel(predictor=list(PREDICTORS))
    ratios = {words: 1 + drawn[error].values for words, error in errors.items()}
    known = {words: ratio[np.isfinite(ratio)].tolist() for words, ratio in ratios.items()}
    found = {words: values for words, values in known.items() if values}
    return {"pressure": np.nan, "beyond": not inside, "found": found}


def _best_and_worst(ratios):
    """Best and worst ratio of predicted and solved, each with all its predictors."""
    away = abs(np.log(ratios.values))
    names = [PREDICTORS[key].replace("$", "") for key in ratios["predictor"].values]
    return {
        float(ratios[i]): [
            name for name, one in zip(names, away, strict=True) if np.isclose(one, away[i])
        ]
        for i in (int(away.argmin()), int(away.argmax()))
    }


def ends_words(test: xr.Dataset, quantity: str, load: int) -> str:
    """Best and worst ratio under the load of the caption, for a panel's title."""
    ratios = 1 + test[f"{quantity}_error"].sel(predictor=list(PREDICTORS))[..., load].values
    away = abs(np.log(ratios))
    best, worst = (short(float(ratios[end])) for end in (away.argmin(), away.argmax()))
    pressure = short(float(test["nominal_pressure"][load]))
    return f"\nat {pressure} MPa: {best} (best) to {worst} (worst)"
