"""Jobs of the experiment on the size effect: which surfaces each of them makes and solves.

Light, because the workflow reads it: a job takes seeds of one arm, one Hurst exponent, one size and
one short cut-off, so many that it lasts for minutes.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from ..core.errors import InputError

#: Arms of the experiment: what makes the long waves of the surfaces of each. In R the short cut-off
#: is varied at one size; in S1, S2 and S3 the size, at one short cut-off.
ARMS = {
    "R": "roll-off in proportion to the size",
    "S1": "roll-off fixed",
    "S2": "roll-off in proportion to the size",
    "S3": "no roll-off",
}

#: Nodes of all surfaces of one job together, about.
NODES_A_JOB = 2**24


class SizeTask(NamedTuple):
    """Surfaces that one job solves, under all loads."""

    arm: str
    hurst: float
    size: int
    """Nodes per side."""
    cut_off: int
    """Shortest wavelength in nodes."""
    finest: int
    """Shortest of all cut-offs of its arm, whose h'_rms the loads refer to, in nodes."""
    roll_off: float | None
    """Longest wavelength below which the surface is self-affine, in nodes; None without one."""
    first: int
    """Number of the first surface."""
    surfaces: int
    """How many."""

    @property
    def name(self) -> str:
        """Of its file."""
        return f"{self.arm}_{self.hurst:g}_{self.size}_{self.cut_off}_{self.first}"


def size_tasks(recipe: Mapping[str, Any]) -> list[SizeTask]:
    """All jobs of a recipe, the longest first.

    Parameters
    ----------
    recipe : mapping
        ``hurst``; ``cut_off`` and ``roll_off`` in nodes, ``roll_off_fraction`` of the side;
        ``arms``,
        by name ``sizes`` (nodes per side) and as many numbers of ``surfaces``, that of R with
        ``cut_offs`` beside them.

    Returns
    -------
    list of SizeTask

    Raises
    ------
    InputError
        If an arm has not one number of surfaces for each size, or no surface fits a cut-off.
    """
    tasks = []
    for arm, stated in recipe["arms"].items():
        if len(stated["sizes"]) != len(stated["surfaces"]):
            raise InputError(
                f"size_effect: arm {arm} has {len(stated['sizes'])} sizes and "
                f"{len(stated['surfaces'])} numbers of surfaces; write one number for each size"
            )
        for hurst in recipe["hurst"]:
            for size, surfaces in zip(stated["sizes"], stated["surfaces"], strict=True):
                for cut_off in stated.get("cut_offs", [recipe["cut_off"]]):
                    tasks += _jobs(arm, hurst, size, cut_off, surfaces, recipe)
    return sorted(tasks, key=lambda task: -task.surfaces * task.size**2)


def _jobs(arm, hurst, size, cut_off, surfaces, recipe):
    """Jobs of the surfaces of one class."""
    step = max(1, NODES_A_JOB // size**2)
    roll_off = _roll_off(arm, size, recipe)
    if roll_off is not None and roll_off < cut_off:
        raise InputError(
            f"size_effect: arm {arm}, {size} nodes: the roll-off of {roll_off:g} nodes is shorter "
            f"than the cut-off of {cut_off}; write larger sizes or shorter cut-offs"
        )
    finest = min(recipe["arms"][arm].get("cut_offs", [cut_off]))
    return [
        SizeTask(arm, hurst, size, cut_off, finest, roll_off, first, min(step, surfaces - first))
        for first in range(0, surfaces, step)
    ]


def _roll_off(arm, size, recipe):
    """Roll-off of an arm at a size, in nodes."""
    if arm == "S3":
        return None
    return float(recipe["roll_off"]) if arm == "S1" else size * recipe["roll_off_fraction"]
