"""Plain twins of the convolution and the preconditioner: scipy.fft, dense matrices, loops.

They say in a few lines what the hand-written transforms and the vectorised code compute, and are
what the tests compare these with. Those of the preconditioner take a time and a memory that grow
with the square of the nodes, or faster.
"""

import numpy as np
from scipy import fft

from roughcontact.contact.inverse_cholesky import block_shifts
from roughcontact.elastic.halfspace import HalfSpace


def convolution(kernel: np.ndarray, field: np.ndarray) -> np.ndarray:
    """Zero-padded convolution of a field with an even kernel.

    Parameters
    ----------
    kernel : (ny, nx) ndarray
        At distances from zero on; it is the same at negative ones.
    field : (ny, nx) ndarray

    Returns
    -------
    (ny, nx) ndarray
        At (y, x) the sum over all (j, i) of kernel(abs(y - j), abs(x - i)) field(j, i).
    """
    ny, nx = field.shape
    # Long enough that what is periodic in the transform does not reach round into the window.
    padded = [fft.next_fast_len(2 * n - 1, real=True) for n in field.shape]
    circulant = np.zeros(padded)
    y, x = np.arange(1 - ny, ny)[:, None], np.arange(1 - nx, nx)
    circulant[y, x] = kernel[np.abs(y), np.abs(x)]
    product = fft.rfft2(circulant) * fft.rfft2(field, s=padded)
    return fft.irfft2(product, s=padded)[:ny, :nx]


def operator_on(space: HalfSpace, nodes: np.ndarray) -> np.ndarray:
    """K on a set of nodes, (n, n): influence of each on each.

    Parameters
    ----------
    space : HalfSpace
    nodes : (n,) int ndarray
        Nodes as numbers of cells.
    """
    y, x = np.divmod(nodes, space.shape[1])
    return space.influence()[np.abs(y[:, None] - y), np.abs(x[:, None] - x)]


def inverse_cholesky(space: HalfSpace, nodes: np.ndarray, neighbourhood: np.ndarray) -> np.ndarray:
    """The factor U of `inverse_cholesky.InverseCholesky` as a dense matrix: U U' is about K^-1.

    Parameters
    ----------
    space : HalfSpace
    nodes : (n,) int ndarray
        Nodes as numbers of cells, ascending.
    neighbourhood : (m,) int ndarray
        Reach along x, in blocks, of the rows of blocks 0 ... m - 1 away.

    Returns
    -------
    (n, n) ndarray
        In column i the weights of node i and of those that it is conditioned on.
    """
    place = {node: i for i, node in enumerate(nodes.tolist())}
    level, representative, candidates = {}, [], list(place)
    blocks = [
        {node: (node // space.shape[1] >> dy, node % space.shape[1] >> dx) for node in place}
        for dy, dx in block_shifts(space)
    ]
    for k, block_of in enumerate(blocks):
        first: dict[tuple[int, int], int] = {}
        for node in candidates:
            if first.setdefault(block_of[node], node) == node:
                level[node] = k  # the coarsest on which it stands for its block
        representative.append(first)
        candidates = list(first.values())
    factor = np.zeros((nodes.size, nodes.size))
    for node, i in place.items():
        y, x = blocks[level[node]][node]
        members = [
            other
            for (block_y, block_x), other in representative[level[node]].items()
            if abs(block_y - y) < len(neighbourhood)
            and abs(block_x - x) <= neighbourhood[abs(block_y - y)]
            and (level[other], -other) > (level[node], -node)  # precedes it
        ]
        members.append(node)
        unit = np.eye(len(members))[-1]
        column = np.linalg.solve(operator_on(space, np.array(members)), unit)
        factor[[place[other] for other in members], i] = column / np.sqrt(column[-1])
    return factor


def balanced(
    inverse: np.ndarray, operator: np.ndarray, basis: np.ndarray, coarse: np.ndarray
) -> np.ndarray:
    """An approximate inverse M after the coarse correction, C + (1 - C A) M (1 - A C).

    Parameters
    ----------
    inverse : (n, n) ndarray
        M.
    operator : (n, n) ndarray
        A, the operator as the coarse grid has it: P K_c P' + D.
    basis : (n, m) ndarray
        Z, coarse basis functions on the nodes.
    coarse : (m, m) ndarray
        Inverse of Z' A Z with its ridge.

    Returns
    -------
    (n, n) ndarray
    """
    correction = basis @ coarse @ basis.T
    remainder = np.eye(len(inverse)) - correction @ operator
    return correction + remainder @ inverse @ remainder.T
