"""Heights of embedded specimens: synthetic surfaces by their recipes.

Embedded specimens are twins of specimens whose scans are not public, or mathematical joints.
"""

from collections.abc import Callable, Mapping

import numpy as np

from .known_dimension import (
    cantor_punch,
    extruded,
    random_midpoint,
    weierstrass_mandelbrot,
)
from .synthesis import disc_outline, self_affine


def embedded_surface(recipe: Mapping) -> np.ndarray:
    """Heights of an embedded specimen, NaN outside its outline.

    Parameters
    ----------
    recipe : mapping
        ``size``, ``spacing``, ``rms`` and ``roll_off`` (or None) in mm, ``dimension`` Delta_g,
        ``outline`` ("square" or "disc"), ``construction`` (a key of the schema; a spectrum by
        default), ``anisotropy``, ``intermittency`` and ``seed``, as
        :func:`study.configuration.resolve_embedded` gives them.

    Returns
    -------
    (n, n) float64 ndarray
        mm.
    """
    n = round(recipe["size"] / recipe["spacing"])
    heights = _CONSTRUCTIONS[recipe.get("construction", "spectrum")]((n, n), recipe)
    if recipe["outline"] == "disc":
        inside = disc_outline((n, n), recipe["spacing"], recipe["size"])
        heights = np.where(inside, heights, np.nan)
    return heights


def _self_affine(shape: tuple[int, int], recipe: Mapping) -> np.ndarray:
    return self_affine(
        shape,
        recipe["spacing"],
        3 - recipe["dimension"],
        seed=recipe["seed"],
        roll_off=recipe["roll_off"],
        rms=recipe["rms"],
        anisotropy=recipe.get("anisotropy", 1.0),
        intermittency=recipe.get("intermittency", 0.0),
    )


def _without_roll_off(make: Callable[..., np.ndarray]) -> Callable[..., np.ndarray]:
    """A construction of :mod:`surface.known_dimension` from a recipe."""

    def made(shape: tuple[int, int], recipe: Mapping) -> np.ndarray:
        spacing, hurst = recipe["spacing"], 3 - recipe["dimension"]
        return make(shape, spacing, hurst, rms=recipe["rms"], seed=recipe["seed"])

    return made


def _cantor_punch(shape: tuple[int, int], recipe: Mapping) -> np.ndarray:
    """Extruded punch of two parts and three nodes a generation, with Delta_g of ``recipe``.

    The dimension of the profile is 1 + ln(2/lowering)/ln 3, see
    :func:`surface.known_dimension.cantor_punch`.
    """
    lowering = 2 / 3 ** (recipe["dimension"] - 2)
    profile = cantor_punch(round(np.log(shape[1]) / np.log(3)), lowering=lowering)
    heights = extruded(profile, shape[0])
    return heights * (recipe["rms"] / heights.std())


_CONSTRUCTIONS: dict[str, Callable[..., np.ndarray]] = {
    "spectrum": _self_affine,
    "weierstrass-mandelbrot": _without_roll_off(weierstrass_mandelbrot),
    "random-midpoint": _without_roll_off(random_midpoint),
    "cantor-punch": _cantor_punch,
}
