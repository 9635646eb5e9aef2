"""Displacement of windows that go on beyond their edges, by numpy alone: it shares no code."""

import numpy as np


def reflected(values):
    """A field with its reflections: twice as long and wide."""
    return np.block([[values, values[:, ::-1]], [values[::-1], values[::-1, ::-1]]])


def displacement(pressure, space):
    """2 p / (E* q) of each wave number q but 0, mm, in double precision."""
    (dy, dx), (ny, nx) = space.spacing, space.shape
    whole = reflected(pressure) if space.boundary == "mirrored" else pressure
    q = (
        2
        * np.pi
        * np.hypot(*np.meshgrid(*map(np.fft.fftfreq, whole.shape, (dy, dx)), indexing="ij"))
    )
    q[0, 0] = np.inf
    unit = np.abs(whole).max() or 1.0
    image = np.fft.ifft2(np.fft.fft2(whole / unit) * (2 / q)).real
    return image[:ny, :nx] * (unit / space.modulus)


def dense_operator(space):
    """Displacement of every node per pressure on every node, mm/MPa."""
    loads = np.eye(space.shape[0] * space.shape[1]).reshape(-1, *space.shape)
    return np.stack([displacement(load, space).ravel() for load in loads], axis=1)


def violation(state, height):
    """Largest violation of the contact conditions, in the unit that `rtol` counts."""
    p, space = state.pressure, state.space
    gap = displacement(p, space) + height.max() - height - state.closure
    at_cap = p >= np.asarray(state.hardness) * (1 - 1e-13)
    between = (p > 0) & ~at_cap
    worst = max(
        np.abs(gap[between]).max(initial=0),
        (-gap[p == 0]).max(initial=0),
        gap[at_cap].max(initial=0),
        -p.min() * space.cell / space.modulus,
    )
    return worst / (abs(state.closure) + p.mean() * space.cell / space.modulus)
