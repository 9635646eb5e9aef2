"""Loading and reloading of one crushing joint by what lies beyond its window: `boundaries.py`.

The joint is a window of a larger mated joint that slid; it is solved free, periodic, mirrored, and
as the middle of a mirrored window of twice the side, on two grids (the second is the spline of the
first). The closure of the middle is the fall of its mean gap, its pressure the mean of its own
nodes, and its largest pressure that of the others.
"""

import argparse

import numpy as np

from fractalcontact.states.settlement import window_settlement
from fractalcontact.states.subgrid import subgrid
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.path import load_path
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

MODULUS, HARDNESS, RTOL = 20e3 / (2 * (1 - 0.2**2)), 80.0, 1e-5  # MPa
SEAT, PRESSURES, LARGEST = 0.25, (1.0, 5.0, 10.0), 25.0  # MPa
#: Steps of the pressure between which a stiffness is taken.
STEP = 0.03


class Window:
    """A joint under rising and falling loads: pressure and closure of a window or of its middle."""

    def __init__(self, composite, spacing, boundary, middle=False):
        self.composite, self.boundary = composite, boundary
        self.space = HalfSpace(composite.shape, spacing, MODULUS, boundary=boundary)
        n = composite.shape[0] // 4 if middle else 0
        self.part = slice(n, composite.shape[0] - n)

    def of(self, state):
        """Mean pressure, MPa, and closure, mm, of the window or of its middle."""
        contact = getattr(state, "contact", state)
        pressure = contact.pressure[self.part, self.part].mean()
        settled = contact.displacement[self.part, self.part].mean()
        if self.boundary == "free":
            settled = float(window_settlement(self.space, contact.force))
        return float(pressure), float(state.closure - settled)

    def force_of(self, solve, pressure):
        """Force under which the window or its middle carries a pressure, by secants."""
        force = pressure * self.space.area
        for _ in range(3):
            force *= pressure / self.of(solve(force))[0]
        return force

    def loaded(self, pressure):
        """State on loading."""
        solving = {"hardness": HARDNESS, "rtol": RTOL}

        def solve(force):
            return solve_contact(self.composite, self.space, force=force, **solving)

        if self.part.start == 0:
            return solve(pressure * self.space.area)
        return solve(self.force_of(solve, pressure))

    def reloaded(self, top, forces):
        """States on unloading from a loaded state, under falling forces."""
        return load_path(
            self.composite, self.space, forces=forces, hardness=HARDNESS, rtol=RTOL, loaded=top
        )

    def numbers(self):
        """Closure from the seat to the largest pressure, the stiffness on loading and reloading."""
        seat, top = self.loaded(SEAT), self.loaded(LARGEST)
        rows = {"closure": self.of(top)[1] - self.of(seat)[1]}
        falling = np.array(sorted(PRESSURES, reverse=True))
        share = self.of(top)[0] * self.space.area / top.force
        forces = [
            pressure * self.space.area / share * (1 + sign * STEP)
            for pressure in falling
            for sign in (1, -1)
        ]
        found = [self.of(state) for state in self.reloaded(top, forces)]
        x, w = np.log([p for p, _ in found]), np.array([c for _, c in found])
        k = {}
        for i, pressure in enumerate(falling):
            high, low = 2 * i, 2 * i + 1
            at = np.exp((x[high] + x[low]) / 2)
            k[pressure] = (at * (x[high] - x[low]) / (w[high] - w[low]), at)
        for pressure in PRESSURES:
            stiffness, at = k[pressure]
            # The middle carries a little less or more than was meant: stiffness is near sigma^1.
            rows[f"reload {pressure:g}"] = stiffness * pressure / at
            up, down = (self.loaded(pressure * (1 + sign * 3 * STEP)) for sign in (1, -1))
            (p1, w1), (p0, w0) = self.of(up), self.of(down)
            rows[f"load {pressure:g}"] = (p1 - p0) / (w1 - w0)
        empty = self.of(self.reloaded(top, [SEAT / LARGEST * top.force])[0])
        ten = self.of(self.reloaded(top, [10 / LARGEST * top.force])[0])
        rows["reload closure"] = ten[1] - empty[1]
        return rows


def main(arguments=None):
    """Print a row for each boundary, grid and seed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=96, help="nodes along a side of the window")
    parser.add_argument("--spacing", type=float, default=0.2, help="mm")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    given = parser.parse_args(arguments)
    n, s = given.cells, given.spacing
    for seed in given.seeds:
        slid = max(1, round(0.4 / s))
        face = self_affine((2 * n, 2 * n + slid), s, 0.8, rms=0.3, seed=seed, roll_off=n * s / 4)
        whole = face[:, slid:] - face[:, : 2 * n]
        inner = whole[n // 2 : n // 2 + n, n // 2 : n // 2 + n]
        for factor in (1, 2):
            small, large = subgrid(inner, factor), subgrid(whole, factor)
            windows = {
                boundary: Window(small, s / factor, boundary)
                for boundary in ("free", "periodic", "mirrored")
            } | {"middle": Window(large, s / factor, "mirrored", middle=True)}
            for name, window in windows.items():
                numbers = window.numbers()
                words = ", ".join(f"{key} {value:.5g}" for key, value in numbers.items())
                print(f"seed {seed}, spacing {s / factor:g}, {name}: {words}", flush=True)


if __name__ == "__main__":
    main()
