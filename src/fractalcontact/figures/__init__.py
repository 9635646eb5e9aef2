"""The figures: one module each, drawn from an atlas and nothing else.

A module has ``draw(atlas, name)``: the atlas as an xarray DataTree and a specimen's name in, a
:class:`fractalcontact.figures.common.Drawing` out.
"""

import importlib
from dataclasses import replace

from ..store import STAGES, read_atlas
from .common import print_style, save, uncollected

#: Figures of a joint that slides, and of a surface against a plane: module names, in order.
FIGURES = (
    "fig01_strength",
    "fig02_relief",
    "quality",
    "fig03_composite",
    "fig04_05_closure",
    "area_theories",
    "compliance",
    "conductance",
    "window_size",
    "fig06_07_dilatancy",
    "strength",
    "clusters",
    "fig08_prefractals",
    "fig09_box_counting",
    "domain_measures",
    "fig10_scaling",
    "size_test",
    "fig11_slope_angle",
    "fig12_evolution",
    "fig13_size_effect",
    "statements",
    "choices",
)
_NEEDS_SLIDING = (
    "fig11_slope_angle",
    "fig01_strength",
    "fig03_composite",
    "compliance",
    "fig06_07_dilatancy",
    "strength",
    "clusters",
)

#: Of the scan itself, not of contact at the resolutions a warning is about.
_OF_THE_SCAN = ("fig02_relief", "quality")

#: Experiments on made surfaces that a study may ask for, with the figure of each: stage and key of
#: the configuration to module name. Their ``draw(atlas, names)`` takes all specimens of the study.
EXPERIMENTS = {
    "roll_off": "plateau",
    "area_slope": "area_slope",
    "dimension_test": "dimension_test",
    "estimator_bias": "estimator_bias",
}
#: Measurements of accuracy and speed that a study may ask for, with the figures of each: key of the
#: configuration to module names. They are drawn from an atlas of their own, as EXPERIMENTS are.
ACCURACY = {
    "speed": ("error_time", "error_time_fields", "time_size", "cheaper_models"),
    "convergence": ("convergence",),
    "stability": ("stability", "elimination"),
}
#: Stages that figures of a whole study draw: to read the others takes long.
_OF_A_STUDY = {"specimens", "joints", *EXPERIMENTS, *ACCURACY, "speed_growth", "elimination"}

#: Files written for each figure: two pictures, the numbers in them, the caption.
ENDINGS = ("png", "svg", "csv", "txt")


def figures_of(opposite):
    """Names of the figures that make sense for a specimen.

    Parameters
    ----------
    opposite : str
        "flat" for a surface against a plane; anything else slides.
    """
    return [name for name in FIGURES if opposite != "flat" or name not in _NEEDS_SLIDING]


def study_figures_of(experiments):
    """Names of the figures of a whole study.

    Parameters
    ----------
    experiments : container of str
        Those of :data:`EXPERIMENTS` it asks for, other names do not matter: its configuration.
    """
    return [figure for experiment, figure in EXPERIMENTS.items() if experiment in experiments]


def accuracy_figures_of(measurements):
    """Names of the figures of accuracy and speed.

    Parameters
    ----------
    measurements : container of str
        Those of :data:`ACCURACY` it asks for, other names do not matter: its configuration.
    """
    asked = [figures for key, figures in ACCURACY.items() if key in measurements]
    return [name for figures in asked for name in figures]


def draw_figures(atlas_path, specimen, folder, names):
    """Draw figures of one specimen and write each as PNG, SVG, CSV and caption.

    Parameters
    ----------
    atlas_path : path-like
    specimen : str
    folder : path-like
    names : sequence of str
        From :func:`figures_of`.

    Returns
    -------
    dict
        Figure name to caption.
    """
    atlas = read_atlas(atlas_path)
    return _draw(atlas, specimen, folder, names, atlas[f"quality/{specimen}"].attrs["warning"])


def draw_study_figures(atlas_path, specimens, folder, names):
    """Draw figures of a whole study, as :func:`draw_figures` does those of one specimen.

    Parameters
    ----------
    atlas_path : path-like
    specimens : sequence of str
    folder : path-like
    names : sequence of str
        From :func:`study_figures_of`.

    Returns
    -------
    dict
        Figure name to caption.
    """
    atlas = read_atlas(atlas_path, without=STAGES.keys() - _OF_A_STUDY)
    return _draw(atlas, list(specimens), folder, names)


def _draw(atlas, subject, folder, names, warning=""):
    captions = {}
    with print_style():
        for name in names:
            with uncollected():
                drawing = importlib.import_module(f".{name}", __package__).draw(atlas, subject)
                if warning and name not in _OF_THE_SCAN:
                    drawing = replace(drawing, caption=f"{drawing.caption} WARNING: {warning}.")
                save(drawing, folder, name)
            captions[name] = drawing.caption
    return captions
