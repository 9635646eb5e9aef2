"""Errors and seconds of models cheaper than elastic contact at full resolution."""

import numpy as np
from matplotlib.figure import Figure

from ...accuracy.speed import DEFAULT_RTOL, ERRORS, MODEL, MODELS, OURS
from ..kit.drawing import WIDTH, Drawing, label_short_span, letter
from ..kit.words import short
from ._speed import AXES, OURS_STYLE, legend_of, scenes_of, styles, table_of, values_of

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
_WORDS = {"force_error": "F", "area_error": "A_r", "delta_error": "Delta_sigma"}
_WORDS |= {"pressure_error": "the pressure field"}


def draw(atlas, names):
    """A panel for each quantity and one for the time, over the scenes of the largest size.

    Parameters
    ----------
    atlas : xr.DataTree
    names : list of str
        Not used: the scenes are the study's own.

    Returns
    -------
    Drawing
    """
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
    return Drawing(figure, table_of(models), _caption(scenes))


def _of(scene, model):
    """The one point of a model."""
    return scene.isel(point=np.flatnonzero(scene["method"] == model)[0])


def _default(scene):
    """The point of ours at its default tolerance, or the tightest it was tried at before."""
    own = scene.isel(point=np.flatnonzero(scene["method"] == OURS))
    own = own.isel(point=np.flatnonzero(own["tolerance"] >= DEFAULT_RTOL))
    return own.isel(point=int(own["tolerance"].values.argmin()))


def _caption(scenes):
    told = []
    for model in MODELS:
        good = []
        for quantity, limit in GOOD_ENOUGH.items():
            values = np.array([_of(scene, model)[quantity].item() for scene in scenes.values()])
            if not np.isfinite(values).any():
                good.append(f"{_WORDS[quantity]} not defined")
                continue
            within = np.count_nonzero(values <= limit)
            good.append(
                f"{_WORDS[quantity]} within {limit:g} on {within} of {values.size} scenes "
                f"(median {np.nanmedian(values):.2g}, worst {np.nanmax(values):.2g})"
            )
        ratio = [
            (_default(scene)["seconds"] / _of(scene, model)["seconds"]).item()
            for scene in scenes.values()
        ]
        faster = f"{short(np.median(ratio))} times as fast as {OURS} at its default in the median"
        told.append(f"{model}: {', '.join(good)}; {faster}")
    return (
        "In no figure of the paper: models cheaper than elastic contact at full resolution, at the "
        "closure of the reference. The bearing area cuts the surface with the plane and knows no "
        "force without a hardness; the Winkler foundation has the modulus with which the uniformly "
        "loaded window settles; the coarse grid keeps every second node, and every fourth for the "
        "extrapolation. " + ". ".join(told) + "."
    )
