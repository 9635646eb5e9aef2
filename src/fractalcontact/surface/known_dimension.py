"""Synthetic surfaces of known dimension by other constructions than a spectrum, for experiments.

A sum of waves, a random iterated function, and the stepped profile of Borodich and Mosolov's punch,
extruded. What holds on all of them, and on :func:`surface.synthesis.self_affine`, belongs to
the dimension and not to the way a surface was made.
"""

import numpy as np
from numpy.typing import ArrayLike

from .synthesis import check_surface, levelled

#: Ratio of neighbouring frequencies of the Weierstrass-Mandelbrot surface (Berry & Lewis).
FREQUENCY_RATIO = 1.5

#: Waves of each frequency, in as many directions.
DIRECTIONS = 12


def weierstrass_mandelbrot(
    shape: tuple[int, int], spacing: float, hurst: float, *, rms: float, seed: int
) -> np.ndarray:
    """Weierstrass-Mandelbrot surface: waves of frequencies in geometric series.

    Parameters, returns and errors are those of :func:`surface.synthesis.self_affine`, without roll-
    off.

    Ausloos & Berman, Proc. R. Soc. A 400 (1985) 331: amplitudes gamma^(-H n) at frequencies
    gamma^n, from waves of twice the longer side to waves of two nodes, in evenly spread directions
    with random phases. The whole fan of directions is turned at random from frequency to frequency.
    """
    check_surface(shape, hurst, spacing, rms)
    generator = np.random.Generator(np.random.PCG64(seed))
    y, x = (np.arange(n, dtype=float) for n in shape)
    octaves = np.log(max(shape)) / np.log(FREQUENCY_RATIO)
    heights = np.zeros(shape)
    for n in range(int(octaves) + 1):
        wave_number = np.pi / max(shape) * FREQUENCY_RATIO**n
        turn = generator.uniform(0, np.pi / DIRECTIONS)
        directions = turn + np.pi * np.arange(DIRECTIONS) / DIRECTIONS
        phases = generator.uniform(0, 2 * np.pi, DIRECTIONS)
        for direction, phase in zip(directions, phases, strict=True):
            along_y = wave_number * np.sin(direction) * y[:, np.newaxis]
            along_x = wave_number * np.cos(direction) * x + phase
            # cos(a + b) from one sine and cosine of each row and column.
            wave = np.cos(along_y) * np.cos(along_x) - np.sin(along_y) * np.sin(along_x)
            heights += FREQUENCY_RATIO ** (-hurst * n) * wave
    return levelled(heights, rms)


def random_midpoint(
    shape: tuple[int, int], spacing: float, hurst: float, *, rms: float, seed: int
) -> np.ndarray:
    """Surface by a random iterated function: midpoints, and random additions everywhere.

    Parameters, returns and errors are those of :func:`weierstrass_mandelbrot`.

    Voss' successive random additions (Saupe in Peitgen & Saupe (1988), The Science of Fractal
    Images, sect. 2.3.2): each step halves the spacing, sets the new nodes to the mean of their
    neighbours and adds to all nodes a number of standard deviation 2^(-H step). Displacing the new
    nodes alone leaves creases along the old ones.
    """
    check_surface(shape, hurst, spacing, rms)
    generator = np.random.Generator(np.random.PCG64(seed))
    heights = generator.standard_normal((3, 3))
    step = 0
    while len(heights) < max(shape):
        step += 1
        for axis in (0, 1):
            old = np.moveaxis(heights, axis, 0)
            finer = np.empty((2 * len(old) - 1, old.shape[1]))
            finer[::2], finer[1::2] = old, (old[1:] + old[:-1]) / 2
            heights = np.moveaxis(finer, 0, axis)
        heights = heights + 2.0 ** (-hurst * step) * generator.standard_normal(heights.shape)
    return levelled(heights[: shape[0], : shape[1]], rms)


def cantor_punch(
    generations: int, *, parts: int = 2, narrowing: float = 1.5, lowering: float = 1.3
) -> np.ndarray:
    """Profile (n,) of a Cantor punch: steps upon steps, each generation narrower and lower.

    Each step of a generation carries ``parts`` equal steps of the next, evenly spread from one of
    its ends to the other, ``narrowing`` times narrower together and ``lowering`` times lower. Its
    length is 1, as is the height of the first step; it has ``(parts narrowing)^generations`` nodes.

    ``parts`` is 2 or more, ``narrowing`` and ``lowering`` more than 1, and ``parts narrowing``
    whole, so that all steps end at nodes; ValueError otherwise.

    Borodich & Mosolov, J. Appl. Math. Mech. 56 (1992) 681; its parts and ratios as in Warren &
    Krajcinovic, Int. J. Solids Struct. 33 (1996) 1. The set at which it touches a plane has the
    dimension ln(parts) / ln(parts narrowing); the profile, counted with the flanks of its steps, 1
    + ln(parts / lowering) / ln(parts narrowing), or 1 if that is less.
    """
    ratio = round(parts * narrowing)
    gap = (ratio - parts) / (parts - 1)
    if generations < 1 or abs(ratio - parts * narrowing) > 1e-9 or gap <= 0 or gap != int(gap):
        raise ValueError(
            f"a Cantor punch of {parts} parts, {narrowing} times narrower, does not end at nodes: "
            "parts x narrowing and the gap between the parts must be whole numbers"
        )
    first = np.zeros(ratio, bool)
    first[:: 1 + int(gap)] = True
    standing, heights = np.ones(1, bool), np.zeros(1)
    for generation in range(generations):
        standing = np.kron(standing, first)
        heights = np.repeat(heights, ratio) + standing * float(lowering) ** -generation
    return heights


def extruded(profile: ArrayLike, rows: int) -> np.ndarray:
    """Surface (rows, nx) of one profile in every row: one dimension more than the profile."""
    return np.tile(np.asarray(profile), (rows, 1))
