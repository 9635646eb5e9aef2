"""The figures: one module each, drawn from an atlas and nothing else.

A module has ``draw(atlas, name)``: the atlas as an xarray DataTree and a specimen's name in, a
:class:`figures.kit.drawing.Drawing` out.
"""

import importlib
from dataclasses import replace
from pathlib import Path

from ..study.atlas import STAGES, read_atlas
from ..study.figure_list import ACCURACY, EXPERIMENTS
from .kit.drawing import print_style, save, uncollected

#: Of the scan itself, not of contact at the resolutions a warning is about.
_OF_THE_SCAN = ("fig02_relief", "quality")

#: Stages that figures of a whole study draw: to read the others takes long.
_OF_A_STUDY = {"specimens", "joints", *EXPERIMENTS, *ACCURACY, "speed_growth", "elimination"}

#: Files written for each figure: two pictures, the numbers in them, the caption.
ENDINGS = ("png", "svg", "csv", "txt")


def drawer_of(name):
    """The function that draws a figure, by the figure's name.

    Parameters
    ----------
    name : str
        Of its module.

    Returns
    -------
    callable
        ``draw(atlas, subject)``, which gives a :class:`figures.kit.drawing.Drawing`.
    """
    (path,) = Path(__file__).parent.glob(f"*/{name}.py")
    return importlib.import_module(f".{path.parent.name}.{name}", __package__).draw


def draw_figures(atlas_path, specimen, folder, names):
    """Draw figures of one specimen and write each as PNG, SVG, CSV and caption.

    Parameters
    ----------
    atlas_path : path-like
    specimen : str
    folder : path-like
    names : sequence of str
        From :func:`study.figure_list.figures_of`.

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
        From :func:`study.figure_list.study_figures_of`.

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
                drawing = drawer_of(name)(atlas, subject)
                if warning and name not in _OF_THE_SCAN:
                    drawing = replace(drawing, caption=f"{drawing.caption} WARNING: {warning}.")
                save(drawing, folder, name)
            captions[name] = drawing.caption
    return captions
