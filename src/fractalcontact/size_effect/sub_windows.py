"""Sub-windows of one size at one offset, loaded step by step: for size laws and for eq. 6."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence

import numpy as np

from roughcontact.contact.state import ContactState

from ..core.settings import JointSettings
from ..joint.joint import prefractal
from ..states.loading import JointLoading
from ..states.settlement import window_settlement
from ..states.sweep import load_steps


class SubWindows(ABC):
    """Sub-windows of one size at some resolutions, loaded step by step.

    Parameters
    ----------
    loading : JointLoading
    windows : (window, ny, nx) ndarray
        Composite topographies, mm.
    pressures : (step,) ndarray
        Nominal, MPa, ascending.
    where : str
        Name of the loaded specimen or window, for errors.
    factors : sequence of int, optional
        Resolutions k, the finest first.
    places : (window,) int array_like, optional
        Numbers of the sub-windows, for errors.

    Attributes
    ----------
    sides : (2,) ndarray
        Sides (y, x) of a sub-window, mm.
    forces, settlement : (step,) ndarray
        On a sub-window, N, and the bulk settlement under them, mm.
    flush : list of bool
        Whether the faces of each sub-window match everywhere.
    solved : int
        Steps solved so far.
    """

    def __init__(
        self,
        loading: JointLoading[JointSettings],
        windows: np.ndarray,
        pressures: np.ndarray,
        where: str,
        factors: Sequence[int] = (1,),
        places: Sequence[int] | np.ndarray | None = None,
    ) -> None:
        cells = np.array(windows.shape[1:])
        self.sides, self.pressures, self.factors = cells * loading.spacing, pressures, factors
        self.forces = pressures * self.sides.prod()
        self.settlement = window_settlement(loading.half_space(cells), self.forces)
        self.flush = [np.ptp(window) == 0 for window in windows]
        self.solved = 0
        self._states: dict[tuple[int, int], Iterator[ContactState]] = {}
        numbers = range(len(windows)) if places is None else places
        for k, factor in enumerate(factors):
            space = loading.half_space(cells // factor, factor)
            for j, (number, window) in enumerate(zip(numbers, windows, strict=True)):
                of_window = f"{where}, sub-window {number}, resolution {factor}"
                h = prefractal(window, factor)
                self._states[j, k] = load_steps(h, space, self.forces, loading.solving, of_window)

    def extend(self, steps: int) -> None:
        """Load every sub-window by this many steps more, as far as there are any."""
        following = range(self.solved, min(self.solved + steps, len(self.forces)))
        for (window, resolution), rising in self._states.items():
            for step, state in zip(following, rising, strict=False):
                self.keep(state, window, resolution, step)
        self.solved = following.stop

    @abstractmethod
    def keep(self, state: ContactState, window: int, resolution: int, step: int) -> None:
        """Store the numbers of a state that the caller needs."""
