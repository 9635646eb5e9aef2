"""The figures: one module each, drawn from an atlas and nothing else.

A module has ``draw(atlas, name)``: the atlas as an xarray DataTree and a specimen's name in, a
:class:`fractalcontact.figures.common.Drawing` out.
"""

import importlib

from ..store import open_atlas
from .common import print_style, save

#: Figures of a joint that slides, and of a surface against a plane: module names, in order.
FIGURES = (
    "fig02_relief",
    "fig03_composite",
    "fig04_05_closure",
    "fig06_07_dilatancy",
    "fig08_prefractals",
    "fig09_box_counting",
    "fig10_scaling",
    "fig12_evolution",
    "fig13_size_effect",
)
_NEEDS_SLIDING = ("fig03_composite", "fig06_07_dilatancy")

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
    captions = {}
    with open_atlas(atlas_path) as atlas, print_style():
        for name in names:
            drawing = importlib.import_module(f".{name}", __package__).draw(atlas, specimen)
            save(drawing, folder, name)
            captions[name] = drawing.caption
    return captions
