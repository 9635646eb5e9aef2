"""Compile the kernels once after the installation; otherwise each of the first jobs would.

python -m fractalcontact.commands.compile_kernels
"""

import numpy as np

from roughcontact.contact.full_approximation import MIN_FINE_SIDE
from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.elastic.split_convolution import MIN_SPLIT_SIDE

from ..domain.measures import measures_of_states
from ..flow.cubic_law import plane_flow
from ..joint.rigid_slide import slide
from ..roughness.dimension import surface_dimension
from ..states.state_scalars import aperture
from ..surface.synthesis import self_affine

#: Nodes per side of a window whose solves compile the kernels of small windows.
SIDE = 200
#: Fewest nodes per side of a window whose solves also use the code for light contact.
LARGE_SIDE = 512
#: Force, N, that one node carries: arrays of one node are contiguous in two orders at once, and
#: numba compiles kernels of their own for them.
ONE_NODE = 1e-6


def compile_kernels() -> list[float]:
    """Stiffnesses, N/mm, of small states that run all kernels of a study: compiled code is kept."""
    surface = self_affine((SIDE, SIDE), 1.0, 0.8, seed=1, rms=1.0)
    surface_dimension(surface, 1.0)
    surface[0, 0] = np.nan
    surface_dimension(surface, 1.0)
    surface[0, 0] = 0.0
    slide(surface, surface[:9, :9].copy(), np.array([[0, 0], [0, 9]]))
    space = HalfSpace(surface.shape, (1.0, 1.0), 1.0)
    states = []
    for hardness in (None, 1.0):
        state = None
        for force in (ONE_NODE, 2.0, 2000.0):
            state = solve_contact(surface, space, force=force, start=state, hardness=hardness)
            states.append(state)
    states += _light_states() + _large_states()
    stiffness = [state.stiffness for state in states]
    small = [state for state in states if state.pressure.shape == surface.shape]
    pressures = np.array([state.pressure for state in small])
    plane_flow(aperture(small[0]), (1.0, 1.0))
    measures_of_states(pressures, 1.0, np.arange(1.0, len(small) + 1))
    return stiffness


def _light_states() -> list[ContactState]:
    """States of a large window under light loads, whose candidates alone are solved.

    Under the lightest loads pairs of the few candidates are summed directly, or one stands alone.
    """
    surface = self_affine((LARGE_SIDE, LARGE_SIDE), 1.0, 0.8, seed=1, rms=1.0)
    space = HalfSpace(surface.shape, (1.0, 1.0), 1.0)
    state = solve_contact(surface, space, force=20.0)
    step = solve_contact(surface, space, force=22.0, start=state)
    return [
        *(state, step),
        *(solve_contact(surface, space, force=force) for force in (2.0, ONE_NODE)),
    ]


def _large_states() -> list[ContactState]:
    """States of a window whose convolutions are split and whose steps begin on coarse grids."""
    side = max(MIN_FINE_SIDE, MIN_SPLIT_SIDE)
    surface = self_affine((side, side), 1.0, 0.8, seed=1, rms=1.0)
    space = HalfSpace(surface.shape, (1.0, 1.0), 1.0)
    state = solve_contact(surface, space, closure=2.0)
    return [state, solve_contact(surface, space, closure=2.6, start=state)]


if __name__ == "__main__":
    compile_kernels()
