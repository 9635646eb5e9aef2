"""Errors and seconds of models cheaper than elastic contact at full resolution."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.figures.kit.axes import label_short_span
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing
from fractalcontact.figures.kit.titles import letter

from ...accuracy.speed import DEFAULT_RTOL, ERRORS, MODEL, MODELS, OURS
from ._speed import AXES, OURS_STYLE, legend_of, scenes_of, styles, table_of, values_of

TITLE = "Errors and wall time of models cheaper than elastic contact"
SUBJECT = "study"
NEEDS = ("speed",)
KEY = "speed"
ORDER = 80

#: Good enough means no more error than this: relative, and in Delta_sigma as it is.
GOOD_ENOUGH = {
    "force_error": 0.1,
    "area_error": 0.1,
    "delta_error": 0.05,
    "pressure_error": 0.1,
}
#: Errors of zero are drawn here.
LEAST = 1e-5
_COSTS = (("seconds", "wall time (s)", 1.0), ("memory", "peak memory (MB)", 1e6))


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """A panel for each quantity and one for the time, over the largest test problems."""
    scenes = scenes_of(atlas)
    looks = styles(scenes)
    size = values_of(scenes, "size")[-1]
    largest = [scene for scene in scenes.values() if scene.attrs["size"] == size]
    figure = Figure(figsize=(WIDTH, 7.4))
    panels = figure.subplots(3, 2, sharex=True).ravel()
    places = np.arange(len(largest))
    for axes, quantity in zip(panels, ERRORS, strict=False):
        for model in MODELS:
            values = [_of(scene, model)[quantity].item() for scene in largest]
            axes.plot(places, np.maximum(values, LEAST), **looks[model], label=model)
        axes.axhline(GOOD_ENOUGH[quantity], color="0.5", lw=0.6, ls=":", label="good enough")
        axes.set_ylabel(AXES[quantity])
    for axes, (name, label, scale) in zip(panels[4:], _COSTS, strict=True):
        for model in MODELS:
            values = [_of(scene, model)[name].item() / scale for scene in largest]
            axes.plot(places, values, **looks[model])
        ours = [_default(scene)[name].item() / scale for scene in largest]
        axes.plot(places, ours, **OURS_STYLE, label=f"{OURS} at its default")
        axes.set_ylabel(label)
    labels = [scene.attrs["scene"].split(", ", 1)[1] for scene in largest]
    for axes, which in zip(panels, "abcdef", strict=True):
        axes.set_yscale("log")
        axes.set_xticks(places, labels, rotation=60, ha="right")
        label_short_span(axes.yaxis)
        letter(axes, which, f"{size} x {size} nodes")
    legend_of(figure, panels)
    models = {
        name: scene.isel(point=np.flatnonzero(scene["kind"] == MODEL))
        for name, scene in scenes.items()
    }
    return Drawing(figure, table_of(models), caption(__name__, **_numbers(scenes)))


def _of(scene, model):
    """The one point of a model."""
    return scene.isel(point=np.flatnonzero(scene["method"] == model)[0])


def _default(scene):
    """The point of ours at its default tolerance, or the tightest it was tried at before."""
    own = scene.isel(point=np.flatnonzero(scene["method"] == OURS))
    own = own.isel(point=np.flatnonzero(own["tolerance"] >= DEFAULT_RTOL))
    return own.isel(point=int(own["tolerance"].values.argmin()))


def _numbers(scenes):
    """On how many test problems a model's force is good enough, and how much faster it is."""
    models = []
    for model in MODELS:
        of_model = [_of(scene, model) for scene in scenes.values()]
        errors = np.array([one["force_error"].item() for one in of_model])
        seconds = [_default(scene)["seconds"].item() for scene in scenes.values()]
        ratios = np.array(seconds) / [one["seconds"].item() for one in of_model]
        within = np.count_nonzero(errors <= GOOD_ENOUGH["force_error"])
        good = within if np.isfinite(errors).any() else "none defined"
        models.append((model, good, np.median(ratios)))
    limit = f"{GOOD_ENOUGH['force_error']:g}"
    return {"problems": len(scenes), "limit": limit, "ours": OURS, "models": models}
