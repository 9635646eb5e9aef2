"""Memory and time requested by jobs, from models over the nodes of their grids.

A job asks for :data:`ROOM` times what the model says. ``docs/scaling.md`` has the measurements
beside what is asked for. A scheduler counts more than the script of a job: Snakemake runs twice
around it, once to start the step of the job and once in it (:data:`AROUND`).
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.directions import slides
from ..core.settings import JointSettings, SpecimenSettings
from ..core.units import quantity

#: Least megabytes and minutes that a job asks for. The interpreter, its libraries and two processes
#: of Snakemake start before the first second of work, on a busy file system.
MIN_MEMORY, MIN_TIME = 300, 5
#: Megabytes of the two processes of Snakemake that start the script of a job on a cluster.
AROUND = 280
#: Requested memory and time over those of the models: other computers are slower, and the cost of
#: contact differs between surfaces.
ROOM, ROOM_OF_TIME = 1.6, 5.0


@dataclass(frozen=True)
class Cost:
    """Resources of the job of a rule: ``start`` and ``seconds`` do not depend on its grid.

    Attributes
    ----------
    start : float
        Megabytes.
    bytes_per_node : float
    seconds : float
        Seconds of the clock on a core of its own.
    us_per_node : float
        Microseconds.
    state : float
        Bytes kept of each node of each state.
    solve : float
        Microseconds for each node of each state.
    """

    start: float
    bytes_per_node: float
    seconds: float
    us_per_node: float
    state: float = 0.0
    solve: float = 0.0


#: Costs by rule. Memory is fitted to grids of 128 to 2048 nodes per side. Seconds are fitted to a
#: surface against a plane with 256, 512 and 1024 nodes per side and to a joint of 520 states
#: (``docs/scaling.md``). States of ``ensemble`` are realisations. Nodes are those of the window,
#: for ``roughness_and_composite`` of a face. ``specimen_atlas`` joins the stages of one specimen.
COSTS = {
    "synthetic_scan": Cost(80, 130, 0.5, 0.4),
    "roughness_and_composite": Cost(270, 100, 4, 3.5),
    "contact": Cost(210, 380, 2.5, 2.5, 1, 0.2),
    "closure_and_box_counts": Cost(190, 450, 8, 9, 5, 0.3),
    "flow": Cost(190, 1200, 4, 60, 5, 1),
    "windows": Cost(420, 620, 6, 55),
    "ensemble": Cost(420, 620, 5, 0, 0, 25),
    "strength": Cost(190, 10, 2.5, 0),
    "figures": Cost(480, 300, 15, 4, 8),
    "specimen_atlas": Cost(190, 180, 3, 1, 1),
    "size_effect_part": Cost(170, 1000, 10, 50),
}
#: Nodes of the finer grids on which the analysis solves states again, over those of the scan; most
#: nodes of such a grid; and bytes of each node.
FINER, MAX_FINER, OF_FINER = 16, 1024**2, 320

#: Bytes of memory for each byte of a file of plain numbers. 12 million points x, y, z (315 MB as
#: text, 288 MB as binary numbers) take some 2 GB; those of a scattered cloud take more.
_PLAIN = 8
#: Bytes of memory for each byte of any other file, whose heights take two bytes, or one if packed.
_PACKED = 60
_PLAIN_ENDINGS = {".asc", ".csv", ".dat", ".npy", ".obj", ".ply", ".stl", ".tsv", ".txt", ".xyz"}
#: Bytes of a file for each of its nodes by ending, three numbers a point, and for other endings.
_NODE = {".npy": 4, ".xyz": 20, ".ply": 12, ".stl": 25, ".obj": 25}
_PLAIN_NODE, _PACKED_NODE = 6, 4


def memory(rule: str, nodes: float, states: int = 1) -> int:
    """Requested memory, MB, of the job of a rule on a grid of some nodes that keeps some states."""
    cost = COSTS[rule]
    finer = OF_FINER * min(FINER * nodes, MAX_FINER) if rule == "closure_and_box_counts" else 0.0
    of_grid = finer + nodes * (cost.bytes_per_node + cost.state * states)
    needed = AROUND + cost.start + of_grid / 1e6
    return max(MIN_MEMORY, round(ROOM * needed))


def seconds(rule: str, nodes: float, states: int = 1) -> float:
    """Seconds that the job of a rule takes on a core of its own by the model."""
    cost = COSTS[rule]
    return cost.seconds + nodes * (cost.us_per_node + cost.solve * states) / 1e6


def minutes(rule: str, nodes: float, states: int = 1) -> int:
    """Requested time of the job of a rule, minutes."""
    needed = seconds(rule, nodes, states=states) / 60
    return max(MIN_TIME, round(ROOM_OF_TIME * needed))


def reading_memory(files: Iterable[Path | str]) -> int:
    """Requested memory, MB, to read, grid, clean and describe the one or two faces of a specimen.

    Missing files, which the job explains, count as empty.
    """
    files = list(map(Path, files))
    read = sum(_size(path) * (_PLAIN if _is_plain(path) else _PACKED) for path in files) / 1e6
    described = memory("roughness_and_composite", nodes_of_files(files))
    least = ROOM * AROUND + 2 * COSTS["roughness_and_composite"].start
    return max(described, round(least + read))


def nodes_of_files(files: Iterable[Path | str]) -> float:
    """Most nodes that one of some scan files may hold, by their sizes: nothing is opened."""
    most = 0.0
    for path in map(Path, files):
        unsaid = _PLAIN_NODE if _is_plain(path) else _PACKED_NODE
        most = max(most, _size(path) / _NODE.get(path.suffix.lower(), unsaid))
    return most


def nodes_of_recipe(recipe: Mapping[str, Any]) -> float:
    """Nodes of an embedded specimen, from :func:`study.configuration.resolve_embedded`."""
    return float(round(recipe["size"] / recipe["spacing"]) ** 2)


def nodes_of_window(settings: SpecimenSettings, spacing: object, of_face: float) -> float:
    """Most nodes of the window of a specimen, which is a part of its face.

    ``spacing`` is in mm, or as a sidecar states it; None where the file alone states it.
    """
    window = settings.window
    if window is None:
        # The window has half the side of the largest square without holes, so that it can slide;
        # against a plane it has all of it.
        return of_face / 4 if slides(settings.opposite) else of_face
    if spacing is None:
        return of_face
    length = quantity(spacing, "length", "spacing") if isinstance(spacing, str) else spacing
    if not isinstance(length, int | float) or length <= 0:  # two spacings, of x and y
        return of_face
    sides = window if isinstance(window, list) else [window, window]
    return min(of_face, sides[0] * sides[1] / length**2)


def states_of(settings: JointSettings, n_offsets: int) -> int:
    """Most contact states of a specimen: directions, offsets and loads."""
    return len(settings.contact_directions) * n_offsets * len(settings.loads)


def _is_plain(path):
    return path.suffix.lower() in _PLAIN_ENDINGS


def _size(path):
    return path.stat().st_size if path.is_file() else 0
