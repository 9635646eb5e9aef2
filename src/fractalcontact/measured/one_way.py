"""Order of the readings of a test: the pressure goes one way, and so does the displacement."""

import numpy as np

from ..core.errors import InputError
from ..scan.columns import Column

#: Largest fall-back that is sorted, a fraction of the range: noise of a gauge or a pump.
MAX_FALL_BACK = 0.05


def require_one_way(branch: str, name: str, column: Column) -> str:
    """Sentence on readings that fall back a little and were sorted; "" without any.

    The branch is "load", "unload", "reload" or "", the name that of the column: "pressure" or
    "displacement". Readings are sorted by it. That is right while they fall back within the noise
    of the gauge, and mixes two branches, or two ways of sliding, where they do not: `InputError`,
    with its line, if a reading falls back by more than `MAX_FALL_BACK` of the range.
    """
    falls = branch == "unload"
    values = -column.values if falls else column.values
    travelled = np.maximum.accumulate(values)
    back = travelled - values
    far = np.flatnonzero(back > MAX_FALL_BACK * np.ptp(values))
    if far.size:
        raise InputError(_refusal(branch, name, column, values, int(far[0])))
    count = int(np.count_nonzero(np.diff(values) < 0))
    if not count:
        return ""
    return (
        f"{column.file.name}: the {name} {_goes(not falls)} from one reading to the next in "
        f"{count} of {values.size - 1} steps, by up to {back.max():.3g} {column.unit}: sorted, as "
        f"no reading lies back by more than {MAX_FALL_BACK:.0%} of the range"
    )


def _refusal(branch: str, name: str, column: Column, values: np.ndarray, far: int) -> str:
    """Sentence with the reading where the way turns, and the one that lies farthest back."""
    turn = int(np.argmax(values[: far + 1]))
    again = np.flatnonzero(values[far:] >= values[turn])
    until = far + int(again[0]) if again.size else values.size
    lowest = turn + int(np.argmin(values[turn:until]))
    if branch:
        stated = f"'branch: {branch}', but "
        write = (
            "keep the readings in their order, write each branch into a file of its own, and "
            "state its 'branch': load, unload or reload"
        )
    else:
        stated, write = "", "keep the readings of one way of sliding, given as positive"
    return (
        f"{column.file}: line {column.line(turn + 1)}: {stated}the {name} "
        f"{_goes(branch != 'unload')} from {column.said(turn)} (line {column.line(turn)}) to "
        f"{column.said(lowest)} (line {column.line(lowest)}); {write} (up to {MAX_FALL_BACK:.0%} "
        "of the range may be noise, and is sorted)"
    )


def _goes(falls: bool) -> str:
    """Verb of a reading against its way."""
    return "falls back" if falls else "rises again"
