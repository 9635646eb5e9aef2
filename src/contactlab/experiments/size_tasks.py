"""Jobs of the experiment on the size effect: the surfaces that each of them makes and solves.

This module imports little, because the workflow reads it. A job takes seeds of one arm, one Hurst
exponent, one size and one short cut-off, as many as last for minutes.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from fractalcontact.core.errors import InputError

#: Arms of the experiment with the limit of the long waves of their surfaces. R varies the short
#: cut-off at one size; S1, S2, S3 and W vary the size at one short cut-off; G the construction.
ARMS = {
    "R": "roll-off in proportion to the size",
    "S1": "roll-off fixed",
    "S2": "roll-off in proportion to the size",
    "S3": "no roll-off",
    "W": "windows cut from surfaces without a roll-off",
    "G": "other constructions of known dimension",
}

#: Nodes of all surfaces of one job together, about.
NODES_A_JOB = 2**24
#: Largest task, nodes, that shares a job with others of its arm and H, and largest such job: small
#: jobs would spend most of their time on their start.
SMALL_TASK, NODES_SHARED = 2**21, 2**22


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
    """Number of surfaces."""
    whole: int | None = None
    """Nodes per side of the surface that windows of ``size`` are cut from; None without windows."""
    construction: str = ""
    """Construction of :mod:`surface.embedded`; empty for a spectrum between the cut-offs."""

    @property
    def name(self) -> str:
        """Name of the task's file."""
        name = f"{self.arm}_{self.hurst:g}_{self.size}_{self.cut_off}_{self.first}"
        return f"{name}_{self.construction}" if self.construction else name

    @property
    def nodes(self) -> int:
        """Number of nodes to be solved."""
        return self.surfaces * (self.whole or self.size) ** 2


def size_tasks(recipe: Mapping[str, Any]) -> list[SizeTask]:
    """All jobs of a recipe, the longest first.

    Parameters
    ----------
    recipe : mapping
        ``hurst``; ``cut_off`` and ``roll_off`` in nodes, ``roll_off_fraction`` of the side;
        ``arms``, by name ``sizes`` (nodes per side) and as many numbers of ``surfaces``, that of R
        with ``cut_offs`` and that of G with ``constructions``, too. The windows of arm W are
        cut from surfaces of its largest size.

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
                # Other constructions have no cut-off but the grid's.
                shortest = 2 if arm == "G" else recipe["cut_off"]
                for cut_off in stated.get("cut_offs", [shortest]):
                    for construction in stated.get("constructions", [""]):
                        of_class = arm, hurst, size, cut_off, construction
                        tasks += _of_class(*of_class, surfaces, recipe)
    return sorted(tasks, key=lambda task: -task.nodes)


def size_jobs(recipe: Mapping[str, Any]) -> dict[str, list[SizeTask]]:
    """Tasks of every job of a recipe by its name: one, or small ones of one arm and H together."""
    jobs: list[list[SizeTask]] = []
    shared: dict[tuple, list[SizeTask]] = {}
    for task in size_tasks(recipe):
        together = shared.get((task.arm, task.hurst), [])
        nodes = task.nodes + sum(task_in_job.nodes for task_in_job in together)
        if task.nodes < SMALL_TASK and together and nodes <= NODES_SHARED:
            together.append(task)
            continue
        jobs.append([task])
        if task.nodes < SMALL_TASK:
            shared[task.arm, task.hurst] = jobs[-1]
    return {tasks[0].name: tasks for tasks in jobs}


def _of_class(arm, hurst, size, cut_off, construction, surfaces, recipe):
    """Tasks of the surfaces of one class."""
    if construction == "cantor-punch":  # it has 3^n nodes per side, at most the requested number
        size = 3 ** int(math.log(size, 3) + 1e-9)
    whole = max(recipe["arms"][arm]["sizes"]) if arm == "W" else None
    step = max(1, NODES_A_JOB // (whole or size) ** 2)
    roll_off = _roll_off(arm, size, recipe)
    if roll_off is not None and roll_off < cut_off:
        raise InputError(
            f"size_effect: arm {arm}, {size} nodes: the roll-off of {roll_off:g} nodes is shorter "
            f"than the cut-off of {cut_off}; write larger sizes or shorter cut-offs"
        )
    finest = min(recipe["arms"][arm].get("cut_offs", [cut_off]))
    of_class = SizeTask(
        arm, hurst, size, cut_off, finest, roll_off, 0, surfaces, whole, construction
    )
    return [
        of_class._replace(first=first, surfaces=min(step, surfaces - first))
        for first in range(0, surfaces, step)
    ]


def _roll_off(arm, size, recipe):
    """Roll-off of an arm at a size, in nodes."""
    if arm in ("S3", "W", "G"):
        return None
    return float(recipe["roll_off"]) if arm == "S1" else size * recipe["roll_off_fraction"]
