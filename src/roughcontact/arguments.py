"""Arguments of public functions: plain arrays and numbers, or one sentence that refuses them.

numpy turns text into numbers, drops masks and imaginary parts and rounds 2.5 down without a word,
and compiled code reads past the end of an array that is too short. So all that users hand over
passes here first.
"""

import math
import operator
import reprlib
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

T = TypeVar("T")

#: Kinds of numpy's types that are real numbers; True and False are none.
_REAL = "iuf"
_LONGEST_INTEGER = 1000  # bits of an integer that is still quoted in full


class _Short(reprlib.Repr):
    """Any value in few characters: Python refuses to write out integers of thousands of digits."""

    def repr_int(self, x: int, level: int) -> str:
        if x.bit_length() > _LONGEST_INTEGER:
            return f"an integer of {x.bit_length()} bits"
        return super().repr_int(x, level)


#: A value of any kind and size, short enough for a message.
quoted = _Short().repr


def number(value: Any, name: str, unit: str) -> float:
    """A real number.

    Parameters
    ----------
    value : float, int, or an array of no dimension
    name : str
        What it is, for the message.
    unit : str
        What it counts, for the message.

    Returns
    -------
    float
        Infinite for integers beyond all floats.

    Raises
    ------
    ValueError
        If it is text, complex, masked, True or False, or more than one number.
    """
    if isinstance(value, float):
        return float(value)
    if isinstance(value, int) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            return math.inf if value > 0 else -math.inf
    # Anything that numpy can read: its own scalars, and arrays with labels, of no dimension.
    array = np.asanyarray(value)
    if array.ndim or array.dtype.kind not in _REAL or np.ma.is_masked(array):
        raise ValueError(f"{name} {quoted(value)}: expected a plain number, in {unit}")
    return float(array)


def whole_number(value: Any, name: str, *, least: int, most: int) -> int:
    """A whole number.

    Parameters
    ----------
    value : int
    name : str
        What it is, for the message.
    least, most : int
        The smallest and the largest allowed.

    Raises
    ------
    ValueError
        If it is no integer (2.0 is none) or out of these bounds.
    """
    found = None
    # numpy calls its own True an integer in some versions.
    if hasattr(value, "__index__") and not isinstance(value, bool | np.bool_ | np.ndarray):
        found = operator.index(value)
    if found is None or not least <= found <= most:
        raise ValueError(f"{name} {quoted(value)}: expected a whole number from {least} to {most}")
    return found


def whole_numbers(values: ArrayLike, name: str, *, least: int, most: int) -> np.ndarray:
    """Whole numbers, also such as 2.0.

    Parameters
    ----------
    values : (k,) array_like
    name : str
        What they are, for the message.
    least, most : int
        The smallest and the largest allowed.

    Returns
    -------
    (k,) int64 ndarray

    Raises
    ------
    ValueError
        If one is not whole or out of these bounds.
    """
    array = real_array(values, name)
    bounds = f"whole numbers from {least} to {most}"
    if array.ndim != 1 or not ((array >= least) & (array <= most) & (array % 1 == 0)).all():
        raise ValueError(f"{name} {quoted(array.tolist())}: expected a list of {bounds}")
    return array.astype(np.int64)


def pair(values: Sequence, name: str, each: Callable[[Any], T]) -> tuple[T, T]:
    """Two things, one along y and one along x.

    Parameters
    ----------
    values : sequence
    name : str
        What they are, for the message.
    each : callable
        Makes one of them, and refuses what it cannot be.

    Returns
    -------
    tuple

    Raises
    ------
    ValueError
        If there are not two, or as ``each``.
    """
    ordered = np.iterable(values) and not isinstance(values, str | bytes | dict | set)
    both = tuple(values) if ordered else ()
    if len(both) != 2:
        raise ValueError(f"{name} {quoted(values)}: expected two numbers, along y and along x")
    return each(both[0]), each(both[1])


def domain(values: ArrayLike, name: str) -> np.ndarray:
    """Nodes of a grid that are in contact, or in any other set.

    Parameters
    ----------
    values : (ny, nx) array_like
        True and False, or numbers of which 0 is False; not masked.
    name : str
        What they are, for the message.

    Returns
    -------
    (ny, nx) bool ndarray

    Raises
    ------
    ValueError
        If they are anything else, or missing.
    """
    refuse_masked(values, name)
    array = real_array(values, name, _REAL + "b")
    if array.ndim != 2:
        raise ValueError(f"{name} is a (y, x) grid, not of shape {array.shape}")
    if np.isnan(array).any():
        raise ValueError(f"{name} has missing nodes; give each node True or False")
    return array.astype(bool, copy=False)


def field(values: ArrayLike, name: str, shape: Sequence[int] | None = None) -> np.ndarray:
    """Real numbers on a grid.

    Parameters
    ----------
    values : (ny, nx) array_like
        A masked array only if nothing is masked.
    name : str
        What they are, for the message.
    shape : (int, int), optional
        Of the grid; by default any (y, x) grid.

    Returns
    -------
    (ny, nx) float64 ndarray
        Contiguous; the same memory where it was so already. May hold NaN and infinities.

    Raises
    ------
    ValueError
        If they are masked, complex, text, True and False, no array, or on another grid.
    """
    if type(values) is np.ndarray and values.dtype == np.float64:
        array = values  # as it mostly is: small grids are solved in less than a millisecond
    else:
        refuse_masked(values, name)
        array = real_array(values, name)
    if shape is None and array.ndim != 2:
        raise ValueError(f"{name} {array.shape}: expected a (y, x) grid")
    if shape is not None and array.shape != tuple(shape):
        raise ValueError(f"{name} {array.shape}: expected the grid's {tuple(shape)}")
    return np.ascontiguousarray(array, float)


def real_array(values: ArrayLike, name: str, kinds: str = _REAL) -> np.ndarray:
    """An array of real numbers, in their own precision.

    Parameters
    ----------
    values : array_like
    name : str
        What they are, for the message.
    kinds : str
        Letters of numpy's kinds of types that will do.

    Returns
    -------
    ndarray

    Raises
    ------
    ValueError
        If they are complex, text, True and False, or no array.
    """
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name}: expected an array of numbers ({error})") from error
    if array.dtype.kind not in kinds:
        raise ValueError(f"{name} of type {array.dtype}: expected real numbers, such as float64")
    return array


def refuse_masked(values: Any, name: str) -> None:
    """Refuse masked cells, whose values numpy would take as numbers.

    Raises
    ------
    ValueError
    """
    rows = values if isinstance(values, list | tuple) else [values]
    masked = sum(np.count_nonzero(np.ma.getmask(row)) for row in rows)
    if masked:
        raise ValueError(
            f"{name} has {masked} masked cells; fill them, or cut them off, and pass a plain array"
        )
