"""Contact problems of the kinds that methods fail on, each drawn at random from a seed.

Those of `tests/support/random_problems.py` mix sizes, shapes and units to reveal any fault of our
own solver. Here every kind isolates one difficulty and stays small enough for direct elimination,
so that each failure of a method has its cause.

Problems that are hard for their surface, or for the depth of loading, are in `hard_surfaces`; those
here are hard for their window, units, start or hardness, or for missing properties.
"""

from collections.abc import Callable

import numpy as np

from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState

from .hard_surfaces import (
    SURFACES,
    HardProblem,
    closure_reaching,
    draw_shape,
    half_space,
    loaded,
    rough_heights,
    rough_surface,
    scaled,
)

#: Capped problems: hardness relative to the largest elastic pressure.
YIELDING = {"cap, some yield": (0.5, 0.9), "cap, most yield": (0.05, 0.2)}


def hard_problem(kind: str, draw: int) -> HardProblem:
    """Contact problem of a kind of `KINDS`, the same for the same kind and number ``draw``."""
    number = list(KINDS).index(kind)
    generator = np.random.default_rng([number, draw])
    return KINDS[kind](kind, generator)


def _window(shape_of, stretch_of=lambda generator: 1.0):
    def problem(kind, generator):
        shape, stretch = shape_of(generator), stretch_of(generator)
        height = scaled(rough_heights(generator, shape))
        return loaded(kind, generator, height, space=half_space(shape, stretch=stretch))

    return problem


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
    """Problem with lengths in another unit, and an odd unit of stress."""

    def problem(kind, generator):
        height = rough_surface(generator) * (cell / 0.1)
        space = half_space(height.shape, cell=cell, modulus=10 ** generator.uniform(-6, 12))
        return loaded(kind, generator, height, space=space)

    return problem


def _offset(sign):
    def problem(kind, generator):
        height = rough_surface(generator)
        return loaded(kind, generator, height + sign * 1e6 * np.ptp(height))

    return problem


def _single_precision(kind, generator):
    height = rough_surface(generator).astype(np.float32)
    return loaded(kind, generator, height)


def _start(make):
    """Warm start from a state far from the requested one."""

    def problem(kind, generator):
        shape = draw_shape(generator)
        height = scaled(rough_heights(generator, shape))
        space = half_space(shape)
        plain = loaded(kind, generator, height, space=space, by_force=False)
        start = make(generator, height, space, plain.load["closure"])
        return HardProblem(kind, height, space, {**plain.load, "start": start})

    return problem


def _of_other_surface(generator, height, space, closure):
    other = scaled(rough_heights(generator, height.shape, hurst=0.4))
    return solve_contact(other, space, closure=closure_reaching(other, 0.4))


def _of_higher_load(generator, height, space, closure):
    return solve_contact(height, space, closure=closure * generator.uniform(3, 30))


def _of_lower_load(generator, height, space, closure):
    return solve_contact(height, space, closure=closure * generator.uniform(0.01, 0.2))


def _garbage(generator, height, space, closure):
    """Random pressures: no state of any surface."""
    pressure = 10 ** generator.uniform(-6, 6) * generator.random(height.shape)
    displacement = space.displacement(pressure)
    force = float(pressure.sum()) * space.cell_area
    return ContactState(
        pressure, displacement, displacement - closure, closure, force, 1.0, 0, space
    )


def _capped(kind, generator):
    height = rough_surface(generator)
    space = half_space(height.shape)
    closure = closure_reaching(height, generator.uniform(0.1, 0.6))
    elastic = solve_contact(height, space, closure=closure).pressure.max()
    return HardProblem(
        kind,
        height,
        space,
        {"closure": closure, "hardness": elastic * generator.uniform(*YIELDING[kind])},
    )


def _all_but_capped(kind, generator):
    """A force just below what the whole window carries at the hardness."""
    height = rough_surface(generator)
    space = half_space(height.shape)
    hardness = 10 ** generator.uniform(0, 3)
    most = hardness * height.size * space.cell_area
    load = {"force": most * (1 - 10 ** generator.uniform(-6, -1)), "hardness": hardness}
    return HardProblem(kind, height, space, load)


def _above_the_cap(kind, generator):
    """Force above the largest that the window can carry: no such state exists."""
    height = rough_surface(generator)
    space = half_space(height.shape)
    hardness = 10 ** generator.uniform(0, 3)
    force = hardness * height.size * space.cell_area * generator.uniform(1, 10)
    load = {"force": force, "hardness": hardness}
    return HardProblem(kind, height, space, load, solvable=False)


def _missing_cell(kind, generator):
    height = rough_surface(generator)
    closure = closure_reaching(height, 0.3)
    height.flat[generator.integers(height.size)] = generator.choice([np.nan, np.inf, -np.inf])
    return HardProblem(kind, height, half_space(height.shape), {"closure": closure}, solvable=False)


#: Kinds of problem, and functions that draw one. The seeds depend on their order.
KINDS: dict[str, Callable[[str, np.random.Generator], HardProblem]] = {
    **SURFACES,
    "window 8:1": _window(_strip),
    "window one cell wide": _window(_row),
    "window of primes": _window(_primes),
    "window of 1 to 16 cells": _window(_tiny),
    "cells 8:1": _window(draw_shape, lambda generator: 8.0 ** generator.choice([-1, 1])),
    "cells 50:1": _window(draw_shape, lambda generator: 50.0 ** generator.choice([-1, 1])),
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
