"""Contact problems that are hard for their surface or for how deeply it is pressed.

What all scenes of `hard_scenes` are drawn with stands here too: shapes, rough heights, loads.
"""

from dataclasses import dataclass, field

import numpy as np

from ..contact.solve import solve_contact
from ..elastic.halfspace import HalfSpace
from ..surface.synthesis import self_affine

#: Cells along a side, smallest and largest: direct elimination stays below a second.
SIDES = (20, 33)


@dataclass(frozen=True)
class HardScene:
    """One contact problem.

    Attributes
    ----------
    kind : str
        A key of `hard_scenes.KINDS`.
    height : (ny, nx) ndarray
        Composite topography, mm.
    space : HalfSpace
    load : dict
        Keywords for a solver: ``closure`` (mm) or ``force`` (N), and where it matters ``hardness``
        (MPa) and ``start``.
    solvable : bool
        False where no state exists and a method must say so.
    """

    kind: str
    height: np.ndarray
    space: HalfSpace
    load: dict = field(default_factory=dict)
    solvable: bool = True


def draw_shape(generator):
    """Cells (ny, nx) of a window."""
    return tuple(int(n) for n in generator.integers(*SIDES, size=2))


def rough_heights(generator, shape, hurst=0.8):
    """Self-affine heights of about unit standard deviation.

    Parameters
    ----------
    generator : numpy.random.Generator
    shape : (int, int)
    hurst : float

    Returns
    -------
    (ny, nx) ndarray
    """
    n = max(*shape, 8)
    seed = int(generator.integers(2**31))
    return self_affine((n, n), 1.0, hurst, rms=1.0, seed=seed)[: shape[0], : shape[1]]


def cells(shape, *, cell=0.1, stretch=1.0, modulus=1e4):
    """The half-space under so many cells, ``stretch`` times as long along y as along x."""
    return HalfSpace(tuple(shape), (cell * stretch, cell), modulus)


def pressed_closure(height, share):
    """Closure at which a share of the nodes lies above the rigid plane, before they give way.

    Parameters
    ----------
    height : (ny, nx) ndarray
        mm.
    share : float
        From 0 to 1.

    Returns
    -------
    float
        mm, above zero unless all heights are equal.
    """
    depth = np.sort(height.max() - height, axis=None)
    reached = depth[min(int(share * depth.size), depth.size - 1)]
    return float(max(reached, depth[min(1, depth.size - 1)], 1e-3 * depth[-1]))


def pressed(kind, generator, height, *, share=(0.05, 0.6), space=None, by_force=None):
    """A scene pressed to a random share of its nodes, by closure or by force."""
    space = cells(height.shape) if space is None else space
    closure = pressed_closure(height, generator.uniform(*share))
    return HardScene(kind, height, space, _load(generator, space, closure, by_force))


def _load(generator, space, closure, by_force=None):
    """A closure or, in half the cases, about its force: that of a punch as large as the window.

    Any force has its state.
    """
    by_force = generator.random() < 0.5 if by_force is None else by_force
    if not by_force:
        return {"closure": closure}
    return {"force": space.modulus * np.sqrt(np.prod(space.shape)) * space.cell * closure}


# One difficulty a function, or one family of them -----------------------------------------------


def _rough_of(hurst):
    def scene(kind, generator):
        return pressed(
            kind, generator, scaled(rough_heights(generator, draw_shape(generator), hurst))
        )

    return scene


def scaled(height, slope=0.1, cell=0.1):
    """Heights with a mean step of ``slope`` along x."""
    steps = np.abs(np.diff(height, axis=1)).mean() if height.shape[1] > 1 else 0.0
    return height * (slope * cell / steps) if steps > 0 else height


def _sloped(low, high):
    def scene(kind, generator):
        slope = 10 ** generator.uniform(low, high)
        return pressed(
            kind, generator, scaled(rough_heights(generator, draw_shape(generator)), slope)
        )

    return scene


def _first_touch(by_force):
    def scene(kind, generator):
        height = scaled(rough_heights(generator, draw_shape(generator)))
        second = np.sort(height, axis=None)[-2]
        space = cells(height.shape)
        closure = (height.max() - second) * generator.uniform(1e-3, 0.9)
        load = {"closure": closure}
        if by_force:
            load = {"force": space.modulus * space.cell * closure}
        return HardScene(kind, height, space, load)

    return scene


def _load_of(low, high):
    def scene(kind, generator):
        height = scaled(rough_heights(generator, draw_shape(generator)))
        space = cells(height.shape)
        closure = np.ptp(height) * 10 ** generator.uniform(low, high)
        return HardScene(kind, height, space, _load(generator, space, closure))

    return scene


def _no_load(kind, generator):
    height = scaled(rough_heights(generator, draw_shape(generator)))
    control = str(generator.choice(["closure", "force"]))
    return HardScene(kind, height, cells(height.shape), {control: 0.0})


def _peaks(places):
    """Single nodes above a rough surface; ``places`` chooses them from the shape."""

    def scene(kind, generator):
        height = scaled(rough_heights(generator, draw_shape(generator)))
        for place in places(generator, height.shape):
            height[place] = height.max() + np.ptp(height) * generator.uniform(0.5, 20)
        return pressed(kind, generator, height, share=(0.01, 0.3))

    return scene


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
    height = scaled(rough_heights(generator, draw_shape(generator)))
    top = height.max() + np.ptp(height)
    height[0, 0] = height[-1, -1] = top
    return pressed(kind, generator, height, share=(0.01, 0.3))


def _spike_on_a_mirror(kind, generator):
    """A spike on a quantised surface far smoother, under a force with which it just sinks in.

    Under a given force all of its surroundings seem to touch, or none: seen on the scan of a
    polished surface with a grain of dust.
    """
    height = np.round(7 * generator.standard_t(4, size=draw_shape(generator))) * 1e-6
    height.flat[generator.integers(height.size)] = 1.3e-3 + height.std()
    space = cells(height.shape, cell=0.024)
    closure = generator.uniform(1, 1.05) * (height.max() - np.quantile(height, 0.98))
    force = solve_contact(height, space, closure=closure).force
    return HardScene(kind, height, space, {"force": force})


def _pits(kind, generator):
    height = scaled(rough_heights(generator, draw_shape(generator)))
    height.flat[generator.integers(height.size, size=6)] -= 20 * np.ptp(height)
    return pressed(kind, generator, height, share=(0.3, 0.9))


def _plateau(kind, generator):
    height = scaled(rough_heights(generator, draw_shape(generator)))
    height = np.minimum(height, np.quantile(height, generator.uniform(0.2, 0.95)))
    return pressed(kind, generator, height)


def _ties(kind, generator):
    height = np.round(3 * rough_heights(generator, draw_shape(generator))) / 300
    return pressed(kind, generator, height)


def _zero(by_force):
    def scene(kind, generator):
        height = np.zeros(draw_shape(generator))
        space = cells(height.shape)
        load = {"force": 10 ** generator.uniform(-3, 3)}
        if not by_force:
            load = {"closure": 10 ** generator.uniform(-4, 0)}
        return HardScene(kind, height, space, load)

    return scene


def _last_bit(kind, generator):
    """Heights that differ by one unit in the last place."""
    height = 1.0 + np.spacing(1.0) * generator.integers(0, 2, size=draw_shape(generator))
    space = cells(height.shape)
    return HardScene(kind, height, space, {"closure": 10 ** generator.uniform(-3, 0)})


def _made(make):
    """A topography from coordinates (y, x) in [-1, 1] across the longer side."""

    def scene(kind, generator):
        shape = draw_shape(generator)
        longest = max(shape)
        y, x = ((np.arange(n) - (n - 1) / 2) * 2 / longest for n in shape)
        height = make(generator, y[:, None] + 0 * x, x[None, :] + 0 * y[:, None])
        return pressed(kind, generator, np.ascontiguousarray(0.05 * height))

    return scene


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


#: Kinds of scene, and what draws one.
SURFACES = {
    "H = 0.1": _rough_of(0.1),
    "H = 0.3": _rough_of(0.3),
    "H = 0.5": _rough_of(0.5),
    "H = 0.8": _rough_of(0.8),
    "H = 0.99": _rough_of(0.99),
    "white noise": _made(_noise),
    "paraboloid": _made(_paraboloid),
    "cone": _made(_cone),
    "cylinder": _made(_cylinder),
    "tilted plane": _made(_tilted),
    "egg box": _made(_egg_box),
    "checkerboard": _made(_checkerboard),
    "comb": _made(_comb),
    "step": _made(_step),
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
