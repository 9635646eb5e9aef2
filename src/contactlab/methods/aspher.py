"""ASPHER, a public code: nested grids and conjugate gradients of Polonsky and Keer, by force only.

``active set``: its operator between candidates for contact, by a fast multipole method, verified on
the full grid; ``fft``: zero-padded convolution on every grid; ``float then double``: the multipole
operator on the whole grid, first in single precision. It takes square windows of a power of two
nodes along a side, and makes its operators anew in every call. The package has no wheels; it is
built with ``CMAKE_ARGS="-DASPHER_NATIVE=ON -DASPHER_USE_FFTW=ON" pip install aspher``, in some ten
minutes, where cmake, a C++ compiler, Eigen and FFTW are installed.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.elastic.halfspace import HalfSpace

from .method import Method
from .peers import Failed, Load, PublicCode

#: Arguments of ASPHER by mode.
_OPTIONS: dict[str, dict[str, Any]] = {
    "active set": {"active_set": True},
    "fft": {"backend": "fft"},
    "float then double": {"precision": "float_then_double"},
}
# Nodes along its coarsest grid; in small windows it has two coarser grids.
_COARSEST = 64


class Aspher(PublicCode):
    """ASPHER set up for one topography, in a mode of `_OPTIONS`."""

    def __init__(self, height: ArrayLike, space: HalfSpace, mode: str):
        import aspher

        super().__init__(height, space)
        self._solve, self._options = aspher.solve_nested, _OPTIONS[mode]
        self._gap = np.ascontiguousarray(-self.height).ravel()
        self._result: Any = None

    def solve(self, load: Load, rtol: float) -> np.ndarray:
        """Pressure under a force, as `PublicCode.solve`; the tolerance is its own."""
        if load.force is None:
            raise ValueError("ASPHER takes a force: give force=")
        n = self.space.shape[0]
        self._result = self._solve(
            grid_size=n,
            gap=self._gap,
            p_nominal=load.force / np.prod(self.sides),
            domain_size=self.sides[0],
            E_star=self.space.modulus,
            coarsest=min(_COARSEST, n // 4),
            tol=rtol,
            max_iter=self.max_iterations,
            **self._options,
        )
        pressure = np.array(self._result.pressure, float).reshape(self.space.shape)
        if not self._result.converged:
            reason = self._result.status_reason or self._result.status
            raise Failed(f"{reason} after {self._result.iterations} iterations", pressure)
        return pressure

    def closure(self, pressure: np.ndarray) -> float:
        """Closure of a pressure, from the mean gap over the contact, mm, with our operator."""
        return float((self.space.displacement(pressure) - self.height)[pressure > 0].mean())

    @property
    def applications(self) -> int | None:
        """Applications of the code's operator on the finest grid, whole or in part."""
        return None if self._result is None else self._result.matvec_count

    @property
    def path(self) -> str:
        """Path of the last call by the code's own counters."""
        result = self._result
        if result is None:
            return ""
        stages = " ".join(stage["name"] for stage in result.stage_stats)
        fallback = ", fell back to the whole grid" if result.active_fallback else ""
        return (
            f"{stages}: {result.precond_count} preconditioned, {result.active_rounds} rounds, "
            f"{result.verification_matvec_count} verifications{fallback}; set-up included"
        )


METHODS = [
    Method(
        name=f"ASPHER {mode}",
        order=300 + 10 * place,
        loads=("force",),
        kernels=("love",),
        windows="dyadic",
        counts="applications",
        likely=-6.0,
        packages=("aspher",),
        options={"mode": mode},
        solver=Aspher,
    )
    for place, mode in enumerate(_OPTIONS)
]
