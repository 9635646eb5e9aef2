"""Random contact problems of every size, shape and unit."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from rough_surfaces import self_affine

from roughcontact import HalfSpace

#: What a problem's topography is.
KINDS = (
    "rough",
    "spikes",
    "plateau",
    "ties",
    "single peak",
    "raised",
    "noise",
    "checkerboard",
    "comb",
    "step",
)
#: How far it is loaded: the fraction of nodes wanted within reach of the plane.
LOADINGS = ("first touch", "light", "half", "heavy", "full")


@dataclass(frozen=True)
class RandomProblem:
    """A contact problem drawn at random.

    Attributes
    ----------
    name : str
        What its topography is and how far it is loaded.
    height : (ny, nx) ndarray
        Composite topography, mm.
    space : HalfSpace
    load : mapping
        ``closure`` in mm or ``force`` in N.
    """

    name: str
    height: np.ndarray
    space: HalfSpace
    load: Mapping[str, float]


def random_problem(seed: int, *, largest: int = 400) -> RandomProblem:
    """A contact problem that is the same for the same seed.

    Parameters
    ----------
    seed : int
        Also runs through the kinds, loads and shapes, so that successive seeds cover them all.
    largest : int
        Cells along the longer side, at most; at least 33.

    Returns
    -------
    RandomProblem
    """
    generator = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    loading = LOADINGS[seed // len(KINDS) % len(LOADINGS)]
    shape = _shape(generator, seed, largest)
    height = _topography(generator, kind, shape, seed)
    cell = 10 ** generator.uniform(-6, 3)  # from nm to m, in mm
    stretch = 1.0 if generator.random() < 0.5 else 10 ** generator.uniform(-0.9, 0.9)
    space = HalfSpace(shape, (cell * stretch, cell), 10 ** generator.uniform(-3, 9))
    slope = 10 ** generator.uniform(-4, 1)
    height = height * (slope * cell / max(np.abs(np.diff(height, axis=1)).mean(), 1e-300))
    span = np.ptp(height)
    if kind == "raised":
        height = height + 1e6 * span
    closure = _closure(generator, height, loading)
    # A rough guess at the force for that closure: any force has its state.
    force = space.modulus * np.sqrt(height.size) * space.cell * closure
    load = {"closure": closure} if generator.random() < 0.5 else {"force": force}
    return RandomProblem(f"{kind}, {loading}", height, space, load)


def _shape(generator, seed, largest):
    """Squares, oblongs, primes among them, and strips eight times as long as wide."""
    long = int(generator.integers(33, largest + 1))
    if seed % 7 == 0:
        return (max(1, long // 8), long) if seed % 2 else (long, max(1, long // 8))
    if seed % 7 in (1, 2):
        primes = [n for n in range(33, largest + 1) if all(n % d for d in range(2, 21))]
        return tuple(int(n) for n in generator.choice(primes, 2))
    return (long, int(generator.integers(33, largest + 1)))


def _topography(generator, kind, shape, seed):
    """Heights of about unit size."""
    n = max(shape)
    height = self_affine((n, n), 1.0, generator.uniform(0.1, 0.99), rms=1.0, seed=seed)
    height = height[: shape[0], : shape[1]]
    if kind == "spikes":
        height.flat[generator.integers(height.size, size=8)] += generator.uniform(1, 20, size=8)
    elif kind == "plateau":
        height = np.minimum(height, np.quantile(height, generator.uniform(0.3, 0.99)))
    elif kind == "ties":
        height = np.round(4 * height) / 4
    elif kind == "single peak":
        height.flat[generator.integers(height.size)] = height.max() + 3
    elif kind == "noise":
        height = generator.standard_normal(shape)
    elif kind == "checkerboard":
        height = (np.indices(shape).sum(axis=0) % 2).astype(float)
    elif kind == "comb":
        teeth = int(generator.integers(2, 9))
        height = 0.1 * height + (np.indices(shape)[1] % teeth == 0)
    elif kind == "step":
        height = 0.1 * height + 3.0 * (np.indices(shape)[0] > shape[0] // 2)
    return height


def _closure(generator, height, loading):
    """A closure that reaches about the nodes that a loading asks for, mm."""
    depth = np.sort(height.max() - height, axis=None)
    if loading == "first touch":
        return max(depth[min(2, depth.size - 1)], 1e-6 * depth[-1]) * generator.uniform(0.2, 1)
    if loading == "full":
        return depth[-1] * 10 ** generator.uniform(0.5, 2.5)
    fraction = {"light": 0.05, "half": 0.5, "heavy": 0.9}[loading] * generator.uniform(0.5, 1)
    # Nodes are pushed down around those in contact, hence the factor.
    return depth[int(fraction * (depth.size - 1))] * generator.uniform(1, 3) + 1e-6 * depth[-1]
