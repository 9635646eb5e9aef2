"""Contact problems that are hard for their surface or for the depth of loading.

The module also has the parts of all kinds of `hard_problems`: shapes, rough heights, loads.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

#: Cells along a side, smallest and largest: direct elimination stays below a second.
SIDES = (20, 33)


@dataclass(frozen=True)
class HardProblem:
    """A contact problem of a kind that methods fail on.

    Attributes
    ----------
    kind : str
        A key of `hard_problems.KINDS`.
    height : (ny, nx) ndarray
        Composite topography, mm.
    space : HalfSpace
    load : mapping
        Keywords for a solver: ``closure`` (mm) or ``force`` (N), and where it matters ``hardness``
        (MPa) and ``start``.
    solvable : bool
        False where no state exists and a method must report that.
    """

    kind: str
    height: np.ndarray
    space: HalfSpace
    load: Mapping[str, Any] = field(default_factory=dict)
    solvable: bool = True


def draw_shape(generator: np.random.Generator) -> tuple[int, int]:
    """Cells (ny, nx) of a window, drawn at random."""
    ny, nx = generator.integers(*SIDES, size=2)
    return int(ny), int(nx)


def rough_heights(
    generator: np.random.Generator, shape: tuple[int, int], hurst: float = 0.8
) -> np.ndarray:
    """Self-affine heights (ny, nx) of about unit standard deviation."""
    n = max(*shape, 8)
    seed = int(generator.integers(2**31))
    return self_affine((n, n), 1.0, hurst, rms=1.0, seed=seed)[: shape[0], : shape[1]]


def scaled(height: np.ndarray, slope: float = 0.1, cell: float = 0.1) -> np.ndarray:
    """Heights with a mean step of ``slope`` times ``cell`` (mm) from node to node along x."""
    steps = np.abs(np.diff(height, axis=1)).mean() if height.shape[1] > 1 else 0.0
    return height * (slope * cell / steps) if steps > 0 else height


def rough_surface(generator: np.random.Generator) -> np.ndarray:
    """Scaled self-affine surface of a random window, mm: the start of most kinds."""
    return scaled(rough_heights(generator, draw_shape(generator)))


def half_space(
    shape: tuple[int, int], *, cell: float = 0.1, stretch: float = 1.0, modulus: float = 1e4
) -> HalfSpace:
    """Half-space under ``shape`` cells of side ``cell`` (mm), ``stretch`` times as long along y as
    along x.
    """
    return HalfSpace(shape, (cell * stretch, cell), modulus)


def closure_reaching(height: np.ndarray, fraction: float) -> float:
    """Closure, mm, at which a fraction of the nodes of an undeformed topography reaches the plane.

    Above zero unless all heights (mm) are equal.
    """
    depth = np.sort(height.max() - height, axis=None)
    reached = depth[min(int(fraction * depth.size), depth.size - 1)]
    return float(max(reached, depth[min(1, depth.size - 1)], 1e-3 * depth[-1]))


def loaded(
    kind: str,
    generator: np.random.Generator,
    height: np.ndarray,
    *,
    fraction: tuple[float, float] = (0.05, 0.6),
    space: HalfSpace | None = None,
    by_force: bool | None = None,
) -> HardProblem:
    """Problem loaded until the plane reaches a random fraction of its nodes.

    The fraction lies between the two given; heights are in mm. The load is a force if ``by_force``,
    by default at random.
    """
    space = half_space(height.shape) if space is None else space
    closure = closure_reaching(height, generator.uniform(*fraction))
    return HardProblem(kind, height, space, _load(generator, space, closure, by_force))


def _load(generator, space, closure, by_force=None):
    """A closure or, in half the cases, about its force: that of a punch as large as the window.

    Every force has a state of contact.
    """
    by_force = generator.random() < 0.5 if by_force is None else by_force
    if not by_force:
        return {"closure": closure}
    return {"force": space.modulus * np.sqrt(np.prod(space.shape)) * space.cell * closure}


# One difficulty a function, or one family of them -----------------------------------------------


def _rough_of(hurst):
    def problem(kind, generator):
        return loaded(
            kind, generator, scaled(rough_heights(generator, draw_shape(generator), hurst))
        )

    return problem


def _sloped(low, high):
    def problem(kind, generator):
        slope = 10 ** generator.uniform(low, high)
        return loaded(
            kind, generator, scaled(rough_heights(generator, draw_shape(generator)), slope)
        )

    return problem


def _first_touch(by_force):
    def problem(kind, generator):
        height = rough_surface(generator)
        second = np.sort(height, axis=None)[-2]
        space = half_space(height.shape)
        closure = (height.max() - second) * generator.uniform(1e-3, 0.9)
        load = {"closure": closure}
        if by_force:
            load = {"force": space.modulus * space.cell * closure}
        return HardProblem(kind, height, space, load)

    return problem


def _load_of(low, high):
    def problem(kind, generator):
        height = rough_surface(generator)
        space = half_space(height.shape)
        closure = np.ptp(height) * 10 ** generator.uniform(low, high)
        return HardProblem(kind, height, space, _load(generator, space, closure))

    return problem


def _no_load(kind, generator):
    height = rough_surface(generator)
    control = str(generator.choice(["closure", "force"]))
    return HardProblem(kind, height, half_space(height.shape), {control: 0.0})


def _peaks(places):
    """Single nodes above a rough surface; ``places`` chooses them from the shape."""

    def problem(kind, generator):
        height = rough_surface(generator)
        for place in places(generator, height.shape):
            height[place] = height.max() + np.ptp(height) * generator.uniform(0.5, 20)
        return loaded(kind, generator, height, fraction=(0.01, 0.3))

    return problem


def _anywhere(generator, shape):
    return [tuple(generator.integers(shape))]


def _corner(generator, shape):
    return [(int(generator.choice([0, -1])), int(generator.choice([0, -1])))]


def _edge(generator, shape):
    return [(0, int(generator.integers(shape[1])))]


def _several(generator, shape):
    return [tuple(generator.integers(shape)) for _ in range(5)]


def _twins(kind, generator):
    """Two equal peaks, which touch at the same moment."""
    height = rough_surface(generator)
    top = height.max() + np.ptp(height)
    height[0, 0] = height[-1, -1] = top
    return loaded(kind, generator, height, fraction=(0.01, 0.3))


def _spike_on_a_mirror(kind, generator):
    """A spike on a quantised surface far smoother, under a force with which it just sinks in.

    Under a given force all of its surroundings seem to touch, or none: observed on the scan of a
    polished surface with a grain of dust.
    """
    height = np.round(7 * generator.standard_t(4, size=draw_shape(generator))) * 1e-6
    height.flat[generator.integers(height.size)] = 1.3e-3 + height.std()
    space = half_space(height.shape, cell=0.024)
    closure = generator.uniform(1, 1.05) * (height.max() - np.quantile(height, 0.98))
    force = solve_contact(height, space, closure=closure).force
    return HardProblem(kind, height, space, {"force": force})


def _pits(kind, generator):
    height = rough_surface(generator)
    height.flat[generator.integers(height.size, size=6)] -= 20 * np.ptp(height)
    return loaded(kind, generator, height, fraction=(0.3, 0.9))


def _plateau(kind, generator):
    height = rough_surface(generator)
    height = np.minimum(height, np.quantile(height, generator.uniform(0.2, 0.95)))
    return loaded(kind, generator, height)


def _ties(kind, generator):
    height = np.round(3 * rough_heights(generator, draw_shape(generator))) / 300
    return loaded(kind, generator, height)


def _zero(by_force):
    def problem(kind, generator):
        height = np.zeros(draw_shape(generator))
        space = half_space(height.shape)
        load = {"force": 10 ** generator.uniform(-3, 3)}
        if not by_force:
            load = {"closure": 10 ** generator.uniform(-4, 0)}
        return HardProblem(kind, height, space, load)

    return problem


def _last_bit(kind, generator):
    """Heights that differ by one unit in the last place."""
    height = 1.0 + np.spacing(1.0) * generator.integers(0, 2, size=draw_shape(generator))
    space = half_space(height.shape)
    return HardProblem(kind, height, space, {"closure": 10 ** generator.uniform(-3, 0)})


def _shaped(make):
    """Kind of problem with heights ``make`` at (y, x), from -1 to 1 along the longer side."""

    def problem(kind, generator):
        shape = draw_shape(generator)
        longest = max(shape)
        y, x = ((np.arange(n) - (n - 1) / 2) * 2 / longest for n in shape)
        height = make(generator, y[:, None] + 0 * x, x[None, :] + 0 * y[:, None])
        return loaded(kind, generator, np.ascontiguousarray(0.05 * height))

    return problem


def _paraboloid(generator, y, x):
    centre = generator.uniform(-0.05, 0.05, size=2)
    return -((y - centre[0]) ** 2) - (x - centre[1]) ** 2


def _cone(generator, y, x):
    return -np.hypot(y - generator.uniform(-0.05, 0.05), x)


def _cylinder(generator, y, x):
    return -(x**2)


def _tilted(generator, y, x):
    return generator.uniform(0.2, 2) * x + generator.uniform(-1, 1) * y


def _egg_box(generator, y, x):
    waves = generator.integers(2, 6)
    return np.cos(np.pi * waves * x) * np.cos(np.pi * waves * y)


def _checkerboard(generator, y, x):
    return (np.indices(y.shape).sum(axis=0) % 2).astype(float)


def _comb(generator, y, x):
    return (np.indices(y.shape)[1] % generator.integers(2, 7) == 0).astype(float)


def _step(generator, y, x):
    return (y > generator.uniform(-0.5, 0.5)) * 1.0 + 1e-3 * generator.standard_normal(y.shape)


def _noise(generator, y, x):
    return generator.standard_normal(y.shape)


#: Kinds of problem, and functions that draw one from its kind and a generator.
SURFACES: dict[str, Callable[[str, np.random.Generator], HardProblem]] = {
    "H = 0.1": _rough_of(0.1),
    "H = 0.3": _rough_of(0.3),
    "H = 0.5": _rough_of(0.5),
    "H = 0.8": _rough_of(0.8),
    "H = 0.99": _rough_of(0.99),
    "white noise": _shaped(_noise),
    "paraboloid": _shaped(_paraboloid),
    "cone": _shaped(_cone),
    "cylinder": _shaped(_cylinder),
    "tilted plane": _shaped(_tilted),
    "egg box": _shaped(_egg_box),
    "checkerboard": _shaped(_checkerboard),
    "comb": _shaped(_comb),
    "step": _shaped(_step),
    "slopes 10 to 1000": _sloped(1, 3),
    "slopes 1e-9 to 1e-4": _sloped(-9, -4),
    "one node, by closure": _first_touch(False),
    "one node, by force": _first_touch(True),
    "no load": _no_load,
    "load 1e-12": _load_of(-12, -9),
    "load to saturation": _load_of(0, 2),
    "load far beyond saturation": _load_of(3, 6),
    "spike": _peaks(_anywhere),
    "several spikes": _peaks(_several),
    "spike in a corner": _peaks(_corner),
    "spike on an edge": _peaks(_edge),
    "spike on a mirror, by force": _spike_on_a_mirror,
    "two equal peaks": _twins,
    "pits": _pits,
    "plateau": _plateau,
    "ties": _ties,
    "identically zero, by closure": _zero(False),
    "identically zero, by force": _zero(True),
    "heights one bit apart": _last_bit,
}
