"""Errors against time on the largest rough test problems, with the Pareto front."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing
from fractalcontact.figures.kit.titles import letter

from ...accuracy.speed import FRONTS, LEADS_BELOW, MODEL, OURS, ahead_of_ours
from ._speed import legend_of, middle_contact, rough, scenes_of, styles, values_of

TITLE = "Errors of force, contact area, Delta_sigma and pressure against wall time"
SUBJECT = "study"
NEEDS = ("speed",)
KEY = "speed"
ORDER = 50

#: Label of each quantity at an axis.
AXES = {
    "force_error": "error of $F$ (1)",
    "area_error": "error of $A_r$ (1)",
    "delta_error": r"error of $\Delta_\sigma$ (1)",
    "pressure_error": "error of $p$, rms (1)",
}
#: Smallest error drawn; errors of zero are drawn there.
SMALLEST = 1e-14


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Rows of quantities, a column for each H, at the largest size and the middle contact."""
    all_problems = scenes_of(atlas)
    scenes = rough(all_problems)
    looks = styles(scenes)
    size, contact = values_of(scenes, "size")[-1], middle_contact(scenes)
    wanted = {"size": size, "contact": contact}
    shown = [problem for problem in scenes.values() if wanted.items() <= problem.attrs.items()]
    figure = Figure(figsize=(WIDTH, 8.8))
    panels = figure.subplots(len(AXES), len(shown), sharex=True, sharey="row", squeeze=False)
    letters = iter("abcdefghijklmnopqrstuvwxyz")
    for (i, quantity), (j, scene) in product(enumerate(AXES), enumerate(shown)):
        _draw_points(panels[i, j], scene, quantity, looks)
        letter(panels[i, j], next(letters), rf"$H$ = {scene.attrs['hurst']:g}")
        panels[i, 0].set_ylabel(AXES[quantity])
        panels[-1, j].set_xlabel("wall time (s)")
    legend_of(figure, panels.flat)
    words = caption(__name__, size=size, share=f"{100 * contact:g}", **_words(scenes))
    return Drawing(figure, _table(all_problems), words)


def _draw_points(axes: Axes, scene: xr.Dataset, quantity: str, looks: dict[str, dict]) -> None:
    """Every method's error against its seconds, the front, and the reference's own error."""
    for method, look in looks.items():
        own = scene.isel(point=np.flatnonzero(scene["method"] == method))
        finite = np.isfinite(own[quantity].values) & np.isfinite(own["seconds"].values)
        error = np.maximum(own[quantity].values[finite], SMALLEST)
        if finite.any():
            axes.plot(own["seconds"].values[finite], error, **look, label=method, ms=3)
    for name in (name for name, error in FRONTS.items() if error == quantity):
        front = scene.isel(point=np.flatnonzero(scene[name])).sortby("seconds")
        error = np.maximum(front[quantity].values, SMALLEST)
        look = {"color": "0.75", "lw": 4, "zorder": 0}
        axes.step(front["seconds"], error, where="post", label="Pareto front", **look)
    if quantity == "force_error":
        known_to = max(scene.attrs["reference_error"], SMALLEST)
        axes.axhspan(SMALLEST / 10, known_to, color="0.92", lw=0, label="error of the reference")
        axes.axhline(LEADS_BELOW, color="0.5", lw=0.6, ls=":", label=f"error {LEADS_BELOW:g}")
    axes.set(xscale="log", yscale="log", ylim=(SMALLEST / 3, 30))


def _words(scenes: dict[str, xr.Dataset]) -> dict[str, Any]:
    """Counts of the problems on whose front our solver is at every error below `LEADS_BELOW`."""
    leads = {
        quantity: sum(
            not ahead_of_ours(scene, quantity=quantity, models=False).sizes["point"]
            for scene in scenes.values()
        )
        for quantity in FRONTS.values()
    }
    ahead = [ahead_of_ours(scene, quantity="force_error") for scene in scenes.values()]
    first, *_ = scenes.values()
    return {
        "ours": OURS,
        "below": f"{LEADS_BELOW:g}",
        "problems": len(scenes),
        "leads": leads,
        "models": sum(bool((solvers["kind"] == MODEL).any()) for solvers in ahead),
        "alike": max(scene.attrs["resolvable_error"] for scene in scenes.values()),
        "threads": first.attrs["threads"],
    }


def _table(scenes: dict[str, xr.Dataset]) -> pd.DataFrame:
    """Table of all test problems, also those not drawn, with one row for each point."""
    columns = ["method", "kind", "tolerance", *AXES, "seconds", "seconds_low", "seconds_high"]
    columns += ["runs", "memory", "on_front", "on_pressure_front", "said"]
    tables = [scene[columns].to_dataframe().assign(test_problem=n) for n, scene in scenes.items()]
    units = {"seconds": "seconds_s", "memory": "memory_B"}
    return pd.concat(tables, ignore_index=True).rename(columns=units)
