"""Errors and seconds of models cheaper than elastic contact at full resolution."""

import numpy as np
from matplotlib.figure import Figure

from ..speed import DEFAULT_RTOL, ERRORS, MODEL, MODELS, OURS
from ._speed import AXES, OURS_STYLE, scenes_of, styles, table_of, values_of
from .common import WIDTH, Drawing, entries, letter

#: Good enough means no more error than this: relative, and in Delta_sigma as it is.
GOOD_ENOUGH = {
    "force_error": 0.1,
    "area_error": 0.1,
    "delta_error": 0.05,
    "pressure_error": 0.1,
}
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
    for axes, which, quantity in zip(panels, "abcd", ERRORS, strict=False):
        for model in MODELS:
            values = [_of(scene, model)[quantity].item() for scene in largest]
            axes.plot(places, np.maximum(values, 1e-6), **looks[model], label=model)
        good = GOOD_ENOUGH[quantity]
        axes.axhline(good, color="0.5", lw=0.6, ls=":", label="good enough")
        axes.set_ylabel(AXES[quantity])
        letter(axes, which, f"{size} x {size} nodes")
    for model in MODELS:
        panels[4].plot(
            places, [_of(scene, model)["seconds"].item() for scene in largest], **looks[model]
        )
    panels[4].plot(places, [_default(scene) for scene in largest], **OURS_STYLE, label=OURS)
    panels[4].set_ylabel("wall time (s)")
    letter(panels[4], "e", f"{OURS} at its default beside them")
    labels = [scene.attrs["scene"].split(", ", 1)[1] for scene in largest]
    for axes in panels[:5]:
        axes.set_yscale("log")
        axes.set_xticks(places, labels, rotation=60, ha="right")
        axes.tick_params(labelbottom=axes in panels[3:5])
    panels[5].axis("off")
    panels[5].legend(handles=[*entries(panels[0]), *entries(panels[4])], loc="center")
    models = {
        name: scene.isel(point=np.flatnonzero(scene["kind"] == MODEL))
        for name, scene in scenes.items()
    }
    return Drawing(figure, table_of(models), _caption(scenes))


def _of(scene, model):
    """The one point of a model."""
    return scene.isel(point=np.flatnonzero(scene["method"] == model)[0])


def _default(scene):
    """Seconds of ours at its default tolerance, or at the tightest it got to before."""
    own = scene.isel(point=np.flatnonzero(scene["method"] == OURS))
    own = own.isel(point=np.flatnonzero(own["tolerance"] >= DEFAULT_RTOL * (1 - 1e-9)))
    return own["seconds"].sel(point=own["tolerance"].argmin()).item()


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
        ratio = [_default(scene) / _of(scene, model)["seconds"].item() for scene in scenes.values()]
        faster = f"{np.median(ratio):.2g} times as fast as {OURS} at its default in the median"
        told.append(f"{model}: {', '.join(good)}; {faster}")
    return (
        "In no figure of the paper: models cheaper than elastic contact at full resolution, at the "
        "closure of the reference. The bearing area cuts the surface with the plane and knows no "
        "force without a hardness; the Winkler foundation has the modulus with which the uniformly "
        "loaded window settles; the coarse grid keeps every second node, and every fourth for the "
        "extrapolation. " + ". ".join(told) + "."
    )
