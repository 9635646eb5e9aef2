"""Checks of arguments: plain arrays and numbers, or a `ValueError` of one sentence.

Every array and number of a user passes here first. numpy alone turns text into numbers, drops masks
and imaginary parts and truncates 2.5 to 2, all silently, and compiled code reads past the end of an
array that is too short. In all functions ``name`` and ``unit`` are words of the error message.
"""

import math
import operator
import reprlib
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

T = TypeVar("T")

#: Kinds of numpy dtypes that are real numbers; booleans are not among them.
_REAL = "iuf"
_LONGEST_INTEGER = 1000  # bits; longer integers are not quoted in full


class _Short(reprlib.Repr):
    """Short text of a value; Python refuses to print integers of thousands of digits."""

    def repr_int(self, x: int, level: int) -> str:
        if x.bit_length() > _LONGEST_INTEGER:
            return f"an integer of {x.bit_length()} bits"
        return super().repr_int(x, level)


#: Text of any value, short enough for a message.
quoted = _Short().repr


def number(value: Any, name: str, unit: str) -> float:
    """Real number: a float, an integer, or an array without dimensions.

    Integers beyond all floats become infinite. Text, complex and masked values and booleans are
    refused.
    """
    if isinstance(value, float):
        return float(value)
    if isinstance(value, int) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            return math.inf if value > 0 else -math.inf
    # Scalars of numpy, and labelled arrays without dimensions.
    array = np.asanyarray(value)
    if array.ndim or array.dtype.kind not in _REAL or np.ma.is_masked(array):
        raise ValueError(f"{name} {quoted(value)}: expected a plain number, in {unit}")
    return float(array)


def whole_number(value: Any, name: str, *, least: int, most: int) -> int:
    """Integer between bounds; 2.0 is refused."""
    integer = None
    # numpy.bool_ has an __index__ in some versions.
    if hasattr(value, "__index__") and not isinstance(value, bool | np.bool_ | np.ndarray):
        integer = operator.index(value)
    if integer is None or not least <= integer <= most:
        raise ValueError(f"{name} {quoted(value)}: expected a whole number from {least} to {most}")
    return integer


def whole_numbers(values: ArrayLike, name: str, *, least: int, most: int) -> np.ndarray:
    """Whole numbers between bounds, (k,) int64; 2.0 is accepted."""
    array = real_array(values, name)
    bounds = f"whole numbers from {least} to {most}"
    if array.ndim != 1 or not ((array >= least) & (array <= most) & (array % 1 == 0)).all():
        raise ValueError(f"{name} {quoted(array.tolist())}: expected a list of {bounds}")
    return array.astype(np.int64)


def pair(values: Sequence, name: str, convert: Callable[[Any], T]) -> tuple[T, T]:
    """Pair of values along y and x; ``convert`` converts one of them, or refuses it."""
    ordered = np.iterable(values) and not isinstance(values, str | bytes | dict | set)
    both = tuple(values) if ordered else ()
    if len(both) != 2:
        raise ValueError(f"{name} {quoted(values)}: expected two numbers, along y and along x")
    return convert(both[0]), convert(both[1])


def domain(values: ArrayLike, name: str) -> np.ndarray:
    """Set of nodes on a grid, (ny, nx) bool, from booleans or numbers; 0 is False.

    Masked and missing nodes are refused.
    """
    refuse_masked(values, name)
    array = real_array(values, name, _REAL + "b")
    if array.ndim != 2:
        raise ValueError(f"{name} is a (y, x) grid, not of shape {array.shape}")
    if np.isnan(array).any():
        raise ValueError(f"{name} has missing nodes; give each node True or False")
    return array.astype(bool, copy=False)


def field(values: ArrayLike, name: str, shape: Sequence[int] | None = None) -> np.ndarray:
    """Real numbers on a grid: (ny, nx) float64, contiguous, NaN and infinities included.

    The array is returned without a copy where it is so already. Without a ``shape`` any (y, x) grid
    is accepted. Masked cells, complex numbers, text and booleans are refused.
    """
    if type(values) is np.ndarray and values.dtype == np.float64:
        array = values  # the usual case; a solve of a small grid takes less than a millisecond
    else:
        refuse_masked(values, name)
        array = real_array(values, name)
    if shape is None and array.ndim != 2:
        raise ValueError(f"{name} {array.shape}: expected a (y, x) grid")
    if shape is not None and array.shape != tuple(shape):
        raise ValueError(f"{name} {array.shape}: expected the grid's {tuple(shape)}")
    return np.ascontiguousarray(array, float)


def real_array(values: ArrayLike, name: str, kinds: str = _REAL) -> np.ndarray:
    """Array of real numbers in their own precision; ``kinds`` are the allowed kinds of dtypes."""
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name}: expected an array of numbers ({error})") from error
    if array.dtype.kind not in kinds:
        raise ValueError(f"{name} of type {array.dtype}: expected real numbers, such as float64")
    return array


def refuse_masked(values: Any, name: str) -> None:
    """`ValueError` if cells are masked: numpy would take their values as numbers."""
    rows = values if isinstance(values, list | tuple) else [values]
    masked = sum(np.count_nonzero(np.ma.getmask(row)) for row in rows)
    if masked:
        raise ValueError(
            f"{name} has {masked} masked cells; fill them, or cut them off, and pass a plain array"
        )
