"""Numbers with their 95 % intervals: the one type of every estimate, in memory, on disk, in words.

In memory it is an :class:`Estimate`. On disk it is the variables, or columns, ``NAME``,
``NAME_low`` and ``NAME_high``: no other module puts these names together.
"""

from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np

from .determined import determined
from .labels import cf_attrs
from .text import compact, number, undetermined, with_error
from .verdicts import UNDETERMINED

#: Ends of an interval: ending of the name, and ending of the long name.
_ENDS = {
    "": "",
    "_low": ", lower end of the {} interval",
    "_high": ", upper end of the {} interval",
}
#: Probability of intervals, in words.
_LEVEL = "95 %"


class Scale(NamedTuple):
    """Kind of a quantity: the intervals that determine it, and the form of its numbers.

    ``span`` and ``exact`` are those of :func:`core.determined.determined`; without
    ``decimals`` numbers have three digits.
    """

    span: float = 0.0
    exact: tuple[float, ...] = ()
    decimals: int | None = None


#: Quantities of any size, which are determined to a factor.
SIZE = Scale()
#: Exponents and slopes.
EXPONENT = Scale(span=1.0)
#: Least and largest dimension of a set in the plane.
IN_PLANE = (0.0, 2.0)
#: Fractal dimensions and their slopes, which lie within 2: any interval determines them, and
#: verdicts rest on the values outside it; 0 and 2 of a contact domain need no interval.
DIMENSION = Scale(span=2.0, exact=IN_PLANE, decimals=2)


@dataclass(frozen=True)
class Estimate:
    """A number, or an array of numbers, with the ends of the 95 % interval.

    Attributes
    ----------
    value, low, high : float or ndarray
        NaN where missing.
    n : int or ndarray of int
        Points, or samples, that it rests on; 0 where that is not counted.
    over : (float, float) or (ndarray, ndarray)
        Range of the fit; NaN without a fit.
    reason : str or ndarray of str
        Reason of a missing value, or a remark on it.
    scale : Scale
        Kind of the quantity.
    level : str
        Probability of the interval, in words; of its class.
    """

    level: ClassVar[str] = _LEVEL
    value: Any = np.nan
    low: Any = np.nan
    high: Any = np.nan
    n: Any = 0
    over: tuple[Any, Any] = (np.nan, np.nan)
    reason: Any = ""
    scale: Scale = SIZE

    @classmethod
    def read(cls, table: Any, name: str, *, reason: Any = "", scale: Scale = SIZE) -> Self:
        """Estimate of this name in a dataset, a table or one row of a table.

        KeyError if the value or an end is missing.
        """
        value, low, high = (np.asarray(table[of])[()] for of in names_of(name))
        return cls(value, low, high, reason=reason, scale=scale)

    @classmethod
    def about(
        cls, value: Any, half: Any, least: float = -np.inf, most: float = np.inf, **of: Any
    ) -> Self:
        """Estimate from a half-width, its ends kept within bounds of the quantity, as 0 of a gap.

        A half-width that is NaN gives no interval; ``of`` are further fields.
        """
        value, half = np.asarray(value, float)[()], np.asarray(half, float)[()]
        low, high = np.maximum(value - half, least), np.minimum(value + half, most)
        # The interval holds its value even if rounding puts that beyond a bound.
        return cls(value, np.minimum(low, value), np.maximum(high, value), **of)

    @classmethod
    def stack(cls, estimates: Iterable["Estimate"], shape: Sequence[int] = (-1,)) -> "Estimate":
        """Estimates as one of arrays, in C order over ``shape``."""
        members = list(estimates)

        def joined(field: Callable[["Estimate"], Any]) -> np.ndarray:
            # A scalar field of a member belongs to all of its numbers.
            columns = [np.broadcast_to(field(member), np.shape(member.value)) for member in members]
            return np.reshape(columns, shape)

        value, low, high, n, reason = (
            joined(attrgetter(name)) for name in ("value", "low", "high", "n", "reason")
        )
        over = joined(lambda member: member.over[0]), joined(lambda member: member.over[1])
        return cls(value, low, high, n, over, reason, members[0].scale if members else SIZE)

    def __getitem__(self, index: Any) -> "Estimate":
        """Estimates at an index of the arrays; scalars shared by all are kept."""
        value, low, high, n, first, last, reason = (
            part[index] if np.ndim(part) else part
            for part in (*self.ends, self.n, *self.over, self.reason)
        )
        return Estimate(value, low, high, n, (first, last), reason, self.scale)

    @property
    def ends(self) -> tuple[Any, Any, Any]:
        """Value, lower and upper end."""
        return self.value, self.low, self.high

    @property
    def width(self) -> Any:
        """Distance of the ends."""
        return self.high - self.low

    @property
    def known(self) -> Any:
        """True if there is a value."""
        return np.isfinite(self.value)

    @property
    def determined(self) -> Any:
        """True if the interval determines a quantity of this kind; for a single number."""
        span, exact, _ = self.scale
        return determined(*self.ends, span=span, exact=exact)

    def text(self, unit: str = "") -> str:
        """Value with its interval: "0.954 [0.912, 1.02] MPa"; for a single number.

        "no fit" where there is none, :attr:`undetermined` where the interval is too wide
        to be of use.
        """
        if not self.known:
            return "no fit" if self.scale.decimals is None else UNDETERMINED
        if not self.determined:
            return self.undetermined(unit)
        decimals = self.scale.decimals
        words = compact(self) if decimals is None else number(self, decimals)
        return f"{words} {unit}".rstrip()

    def undetermined(self, unit: str = "") -> str:
        """ "undetermined" with the value and its error in brackets.

        The error is half of an even interval; an uneven one has both ends.
        """
        if not self.known:
            return UNDETERMINED
        return undetermined(with_error(*self.ends, self.scale.decimals, unit))

    def mapped(self, function: Callable[[Any], Any], *, falling: bool = False) -> Self:
        """Estimate of a monotone function of the quantity; a falling one exchanges the ends."""
        value, low, high = (function(end) for end in self.ends)
        return (
            replace(self, value=value, low=high, high=low)
            if falling
            else replace(self, value=value, low=low, high=high)
        )

    def in_plane(self) -> Self:
        """Estimate of the dimension of a set in the plane, which lies between 0 and 2.

        A value, or an end of an interval, beyond these bounds is stated as the bound.
        """
        return self.within(*IN_PLANE)

    def within(self, least: float, most: float) -> Self:
        """Estimate of a bounded quantity; a value or an end beyond a bound becomes the bound."""
        return self.mapped(lambda end: np.clip(end, least, most))

    def columns(self, name: str, unit: str = "") -> dict[str, Any]:
        """Columns of a table: ``NAME``, ``NAME_low``, ``NAME_high``, each ending in the unit."""
        return dict(zip(names_of(name, unit), self.ends, strict=True))

    def variables(
        self, name: str, dims: Hashable | Sequence[Hashable], units: str, long_name: str
    ) -> dict[str, tuple[Any, Any, dict[str, str]]]:
        """Variables ``NAME``, ``NAME_low`` and ``NAME_high``, as ``xr.Dataset`` takes them.

        ``dims`` are those of the arrays, () for a number.
        """
        rows = rows_of(name, units, long_name, self.level)
        return {
            of: (dims, value, cf_attrs(*row))
            for (of, row), value in zip(rows.items(), self.ends, strict=True)
        }


#: Estimate of an unknown quantity.
NO_ESTIMATE = Estimate()


def names_of(name: str, unit: str = "") -> list[str]:
    """Names of an estimate's variables, or columns: the value's and both ends'."""
    return [column_of(name, unit, end.lstrip("_")) for end in _ENDS]


def column_of(name: str, unit: str = "", of: str = "") -> str:
    """Name of a column: ``NAME``, ``NAME_OF`` such as ``NAME_low``, and the unit at its end."""
    of = f"_{of}" if of else ""
    return f"{name}{of}_{unit.replace('/', '_per_')}" if unit not in ("", "1") else f"{name}{of}"


def rows_of(
    name: str, units: str, long_name: str, level: str = _LEVEL
) -> dict[str, tuple[str, str]]:
    """Unit and long name of an estimate's variables, by their names, for a table of variables."""
    return {
        f"{name}{end}": (units, f"{long_name}{words.format(level)}") for end, words in _ENDS.items()
    }
