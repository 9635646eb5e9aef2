"""Two rough faces pressed together: closure curve, k_ni and the dimension of the contact.

python docs/gallery/rough_faces.py
"""

import numpy as np

from fractalcontact import (
    BoxDimension,
    HalfSpace,
    Hyperbola,
    box_dimension,
    bulk_settlement,
    fit_hyperbola,
    interface_closure,
    self_affine,
    solve_contact,
)

NODES, SPACING = 128, 0.1  # mm
E_STAR = 20e3  # MPa
PRESSURES = np.geomspace(0.5, 50, 8)  # nominal, MPa


def main() -> tuple[Hyperbola, BoxDimension]:
    """The hyperbola of the closure curve, and the box dimension under the last load."""
    # Two faces that have nothing to do with each other; the highest point of the composite
    # topography, lower less upper, touches first.
    lower, upper = (
        self_affine((NODES, NODES), SPACING, hurst=0.8, rms=0.02, seed=seed, roll_off=3.0)
        for seed in (1, 2)
    )
    space = HalfSpace((NODES, NODES), SPACING, E_STAR)
    side = NODES * SPACING
    closures, state = [], None
    for pressure in PRESSURES:
        state = solve_contact(lower - upper, space, force=pressure * side**2, start=state)
        settled = bulk_settlement(state.force, E_STAR, side, side)
        closures.append(float(interface_closure(state.closure, settled)))
        print(f"{pressure:6.2f} MPa: {closures[-1]:.4f} mm, {state.area / side**2:.1%} in contact")
    hyperbola = fit_hyperbola(PRESSURES, closures)
    k_ni = hyperbola.k_ni
    print(f"k_ni = {k_ni.value:.3g} [{k_ni.low:.3g}, {k_ni.high:.3g}] MPa/mm")
    print(f"misfit {hyperbola.misfit:.1%} {hyperbola.reason}")
    dimension = box_dimension(state.in_contact, SPACING)
    print(dimension)
    return hyperbola, dimension


if __name__ == "__main__":
    main()
