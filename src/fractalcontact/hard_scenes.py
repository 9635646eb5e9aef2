"""Contact problems of the kinds that methods fail on, each drawn at random from a seed.

The scenes of `scenes` mix sizes, shapes and units at random to find any fault of our own solver.
Here every kind isolates one difficulty and stays small enough for direct elimination, so that it
can be said of any method which difficulty it cannot take.
"""

from dataclasses import dataclass, field

import numpy as np

from .contact import ContactState, solve_contact
from .halfspace import HalfSpace
from .synthesis import self_affine

#: Cells along a side, smallest and largest: direct elimination stays below a second.
SIDES = (20, 33)
#: Capped scenes: hardness as a share of the largest elastic pressure.
YIELDING = {"cap, some yield": (0.5, 0.9), "cap, most yield": (0.05, 0.2)}


@dataclass(frozen=True)
class HardScene:
    """One contact problem.

    Attributes
    ----------
    kind : str
        A key of `KINDS`.
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


def hard_scene(kind, draw):
    """A scene that is the same for the same kind and number.

    Parameters
    ----------
    kind : str
        A key of `KINDS`.
    draw : int

    Returns
    -------
    HardScene
    """
    number = list(KINDS).index(kind)
    generator = np.random.default_rng([number, draw])
    return KINDS[kind](kind, generator)


def _shape(generator):
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


def _space(shape, *, cell=0.1, stretch=1.0, modulus=1e4):
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


def _pressed(kind, generator, height, *, share=(0.05, 0.6), space=None, by_force=None):
    """A scene pressed to a random share of its nodes, by closure or by force."""
    space = _space(height.shape) if space is None else space
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
        return _pressed(
            kind, generator, _scaled(rough_heights(generator, _shape(generator), hurst))
        )

    return scene


def _scaled(height, slope=0.1, cell=0.1):
    """Heights with a mean step of ``slope`` along x."""
    steps = np.abs(np.diff(height, axis=1)).mean() if height.shape[1] > 1 else 0.0
    return height * (slope * cell / steps) if steps > 0 else height


def _sloped(low, high):
    def scene(kind, generator):
        slope = 10 ** generator.uniform(low, high)
        return _pressed(
            kind, generator, _scaled(rough_heights(generator, _shape(generator)), slope)
        )

    return scene


def _first_touch(by_force):
    def scene(kind, generator):
        height = _scaled(rough_heights(generator, _shape(generator)))
        second = np.sort(height, axis=None)[-2]
        space = _space(height.shape)
        closure = (height.max() - second) * generator.uniform(1e-3, 0.9)
        load = {"closure": closure}
        if by_force:
            load = {"force": space.modulus * space.cell * closure}
        return HardScene(kind, height, space, load)

    return scene


def _load_of(low, high):
    def scene(kind, generator):
        height = _scaled(rough_heights(generator, _shape(generator)))
        space = _space(height.shape)
        closure = np.ptp(height) * 10 ** generator.uniform(low, high)
        return HardScene(kind, height, space, _load(generator, space, closure))

    return scene


def _peaks(places):
    """Single nodes above a rough surface; ``places`` chooses them from the shape."""

    def scene(kind, generator):
        height = _scaled(rough_heights(generator, _shape(generator)))
        for place in places(generator, height.shape):
            height[place] = height.max() + np.ptp(height) * generator.uniform(0.5, 20)
        return _pressed(kind, generator, height, share=(0.01, 0.3))

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
    height = _scaled(rough_heights(generator, _shape(generator)))
    top = height.max() + np.ptp(height)
    height[0, 0] = height[-1, -1] = top
    return _pressed(kind, generator, height, share=(0.01, 0.3))


def _spike_on_a_mirror(kind, generator):
    """A spike on a quantised surface far smoother, under a force with which it just sinks in.

    Under a given force all of its surroundings seem to touch, or none: seen on the scan of a
    polished surface with a grain of dust.
    """
    height = np.round(7 * generator.standard_t(4, size=_shape(generator))) * 1e-6
    height.flat[generator.integers(height.size)] = 1.3e-3 + height.std()
    space = _space(height.shape, cell=0.024)
    closure = generator.uniform(1, 1.05) * (height.max() - np.quantile(height, 0.98))
    force = solve_contact(height, space, closure=closure).force
    return HardScene(kind, height, space, {"force": force})


def _pits(kind, generator):
    height = _scaled(rough_heights(generator, _shape(generator)))
    height.flat[generator.integers(height.size, size=6)] -= 20 * np.ptp(height)
    return _pressed(kind, generator, height, share=(0.3, 0.9))


def _plateau(kind, generator):
    height = _scaled(rough_heights(generator, _shape(generator)))
    height = np.minimum(height, np.quantile(height, generator.uniform(0.2, 0.95)))
    return _pressed(kind, generator, height)


def _ties(kind, generator):
    height = np.round(3 * rough_heights(generator, _shape(generator))) / 300
    return _pressed(kind, generator, height)


def _zero(by_force):
    def scene(kind, generator):
        height = np.zeros(_shape(generator))
        space = _space(height.shape)
        load = {"force": 10 ** generator.uniform(-3, 3)}
        if not by_force:
            load = {"closure": 10 ** generator.uniform(-4, 0)}
        return HardScene(kind, height, space, load)

    return scene


def _last_bit(kind, generator):
    """Heights that differ by one unit in the last place."""
    height = 1.0 + np.spacing(1.0) * generator.integers(0, 2, size=_shape(generator))
    space = _space(height.shape)
    return HardScene(kind, height, space, {"closure": 10 ** generator.uniform(-3, 0)})


def _made(make):
    """A topography from coordinates (y, x) in [-1, 1] across the longer side."""

    def scene(kind, generator):
        shape = _shape(generator)
        longest = max(shape)
        y, x = ((np.arange(n) - (n - 1) / 2) * 2 / longest for n in shape)
        height = make(generator, y[:, None] + 0 * x, x[None, :] + 0 * y[:, None])
        return _pressed(kind, generator, np.ascontiguousarray(0.05 * height))

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


def _window(shape_of, stretch_of=lambda generator: 1.0):
    def scene(kind, generator):
        shape, stretch = shape_of(generator), stretch_of(generator)
        height = _scaled(rough_heights(generator, shape))
        return _pressed(kind, generator, height, space=_space(shape, stretch=stretch))

    return scene


def _strip(generator):
    long = int(generator.integers(48, 97))
    return (long // 8, long) if generator.random() < 0.5 else (long, long // 8)


def _row(generator):
    long = int(generator.integers(60, 200))
    return (1, long) if generator.random() < 0.5 else (long, 1)


def _primes(generator):
    return tuple(int(n) for n in generator.choice([11, 13, 17, 19, 23, 29, 31, 37, 41], size=2))


def _tiny(generator):
    return tuple(int(n) for n in generator.integers(1, 5, size=2))


def _length_unit(cell):
    """The same problem with lengths counted in another unit, and an odd unit of stress."""

    def scene(kind, generator):
        height = _scaled(rough_heights(generator, _shape(generator))) * (cell / 0.1)
        space = _space(height.shape, cell=cell, modulus=10 ** generator.uniform(-6, 12))
        return _pressed(kind, generator, height, space=space)

    return scene


def _offset(sign):
    def scene(kind, generator):
        height = _scaled(rough_heights(generator, _shape(generator)))
        return _pressed(kind, generator, height + sign * 1e6 * np.ptp(height))

    return scene


def _single_precision(kind, generator):
    height = _scaled(rough_heights(generator, _shape(generator))).astype(np.float32)
    return _pressed(kind, generator, height)


def _start(make):
    """A warm start from a state that is not near the one asked for."""

    def scene(kind, generator):
        shape = _shape(generator)
        height = _scaled(rough_heights(generator, shape))
        space = _space(shape)
        plain = _pressed(kind, generator, height, space=space, by_force=False)
        start = make(generator, height, space, plain.load["closure"])
        return HardScene(kind, height, space, {**plain.load, "start": start})

    return scene


def _of_other_surface(generator, height, space, closure):
    other = _scaled(rough_heights(generator, height.shape, hurst=0.4))
    return solve_contact(other, space, closure=pressed_closure(other, 0.4))


def _of_higher_load(generator, height, space, closure):
    return solve_contact(height, space, closure=closure * generator.uniform(3, 30))


def _of_lower_load(generator, height, space, closure):
    return solve_contact(height, space, closure=closure * generator.uniform(0.01, 0.2))


def _garbage(generator, height, space, closure):
    """Pressures drawn at random: no state of any surface."""
    pressure = 10 ** generator.uniform(-6, 6) * generator.random(height.shape)
    displacement = space.displacement(pressure)
    force = float(pressure.sum()) * space.cell_area
    return ContactState(
        pressure, displacement, displacement - closure, closure, force, 1.0, 0, space
    )


def _capped(kind, generator):
    height = _scaled(rough_heights(generator, _shape(generator)))
    space = _space(height.shape)
    closure = pressed_closure(height, generator.uniform(0.1, 0.6))
    elastic = solve_contact(height, space, closure=closure).pressure.max()
    return HardScene(
        kind,
        height,
        space,
        {"closure": closure, "hardness": elastic * generator.uniform(*YIELDING[kind])},
    )


def _all_but_capped(kind, generator):
    """A force just below what the whole window carries at the hardness."""
    height = _scaled(rough_heights(generator, _shape(generator)))
    space = _space(height.shape)
    hardness = 10 ** generator.uniform(0, 3)
    most = hardness * height.size * space.cell_area
    load = {"force": most * (1 - 10 ** generator.uniform(-6, -1)), "hardness": hardness}
    return HardScene(kind, height, space, load)


def _above_the_cap(kind, generator):
    """More than the window can carry: there is no such state."""
    height = _scaled(rough_heights(generator, _shape(generator)))
    space = _space(height.shape)
    hardness = 10 ** generator.uniform(0, 3)
    force = hardness * height.size * space.cell_area * generator.uniform(1, 10)
    load = {"force": force, "hardness": hardness}
    return HardScene(kind, height, space, load, solvable=False)


def _missing_cell(kind, generator):
    height = _scaled(rough_heights(generator, _shape(generator)))
    closure = pressed_closure(height, 0.3)
    height.flat[generator.integers(height.size)] = generator.choice([np.nan, np.inf, -np.inf])
    return HardScene(kind, height, _space(height.shape), {"closure": closure}, solvable=False)


def _no_load(kind, generator):
    height = _scaled(rough_heights(generator, _shape(generator)))
    control = str(generator.choice(["closure", "force"]))
    return HardScene(kind, height, _space(height.shape), {control: 0.0})


#: Every kind of scene, and what draws one.
KINDS = {
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
    "window 8:1": _window(_strip),
    "window one cell wide": _window(_row),
    "window of primes": _window(_primes),
    "window of 1 to 16 cells": _window(_tiny),
    "cells 8:1": _window(_shape, lambda generator: 8.0 ** generator.choice([-1, 1])),
    "cells 50:1": _window(_shape, lambda generator: 50.0 ** generator.choice([-1, 1])),
    "lengths in nm": _length_unit(1e5),
    "lengths in m": _length_unit(1e-4),
    "heights + 1e6": _offset(1),
    "heights - 1e6": _offset(-1),
    "float32 heights": _single_precision,
    "start from another surface": _start(_of_other_surface),
    "start from a higher load": _start(_of_higher_load),
    "start from a lower load": _start(_of_lower_load),
    "start from garbage": _start(_garbage),
    "cap, some yield": _capped,
    "cap, most yield": _capped,
    "cap, nearly all yields": _all_but_capped,
    "cap, load above it": _above_the_cap,
    "missing cell": _missing_cell,
}
