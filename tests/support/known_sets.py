"""Sets of known dimension: Sierpinski's carpet, Cantor dust, percolation; and parts of them."""

import numpy as np
from scipy import ndimage


def ternary_digits(n, levels):
    """Base-3 digits of the places of n cell centres in the unit interval, (levels, n)."""
    place = ((2 * np.arange(n) + 1) * 3**levels) // (2 * n)
    return np.array([(place // 3**level) % 3 for level in range(levels)])


def levels_of(n):
    """Generations that n cells resolve: the last one is at least a cell wide."""
    return int(np.floor(np.log(n) / np.log(3) + 1e-9))


def sierpinski_carpet(n):
    middle = ternary_digits(n, levels_of(n)) == 1
    return ~(middle[:, :, np.newaxis] & middle[:, np.newaxis, :]).any(axis=0)


def cantor_dust(n):
    line = (ternary_digits(n, levels_of(n)) != 1).all(axis=0)
    return line[:, np.newaxis] & line[np.newaxis, :]


def percolation_cluster(n, seed):
    label, _ = ndimage.label(np.random.default_rng(seed).random((n, n)) < 0.592746)
    sizes = np.bincount(label.ravel())
    return label == 1 + np.argmax(sizes[1:])


def punch_dimensions(parts=2, narrowing=1.5, lowering=1.3):
    """Dimension of a Cantor punch's profile, and of the set at which it touches a plane.

    Of generation n there are parts^n steps, lowering^-n high and (parts narrowing)^-n wide.
    """
    ratio = np.log(parts * narrowing)
    return 1 + max(np.log(parts / lowering) / ratio, 0.0), np.log(parts) / ratio


def fractal_percolation(levels, kept, seed):
    """Mandelbrot's percolation on 2^levels cells a side, of dimension 2 + log2(kept)."""
    rng, cells = np.random.default_rng(seed), np.ones((1, 1), bool)
    for _ in range(levels):
        cells = np.kron(cells, np.ones((2, 2), bool))
        cells &= rng.random(cells.shape) < kept
    return cells


def embedded(shape, rows, columns):
    """Window of a shape whose cells at rows and columns are set."""
    domain = np.zeros(shape, bool)
    domain[rows, columns] = True
    return domain


def thinned(domain, nodes, seed):
    """Some nodes of a domain, drawn at random."""
    part = np.zeros(domain.size, bool)
    part[np.random.default_rng(seed).choice(np.flatnonzero(domain), nodes, replace=False)] = True
    return part.reshape(domain.shape)
