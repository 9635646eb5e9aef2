"""Hertz's sphere on ever finer grids: the force of a given closure, and its error.

python docs/gallery/hertz.py
"""

import numpy as np

from fractalcontact import HalfSpace, solve_contact

RADIUS, E_STAR = 10.0, 20e3  # mm, MPa
CLOSURE = 0.01  # mm


def force_on(nodes: int) -> float:
    """Force, N, on a window of three contact radii with this many nodes per side."""
    side = 3 * np.sqrt(RADIUS * CLOSURE)
    spacing = side / nodes
    x = (np.arange(nodes) - (nodes - 1) / 2) * spacing
    # An odd number of nodes: one stands at the top of the sphere.
    sphere = -(x[:, None] ** 2 + x**2) / (2 * RADIUS)
    space = HalfSpace(sphere.shape, spacing, E_STAR)
    return solve_contact(sphere, space, closure=CLOSURE).force


def main() -> dict[int, float]:
    """Relative errors by the nodes per side."""
    hertz = 4 / 3 * E_STAR * np.sqrt(RADIUS) * CLOSURE**1.5
    errors = {nodes: force_on(nodes) / hertz - 1 for nodes in (15, 31, 63, 127)}
    print(f"Hertz: {hertz:.5g} N")
    for nodes, error in errors.items():
        print(f"{nodes:4d} nodes per side: {error:+.3%}")
    return errors


if __name__ == "__main__":
    main()
