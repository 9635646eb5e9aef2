"""Panel that draws curves from a dataset and records them as rows of the figure's table."""

from collections.abc import Hashable, Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ...core.estimate import Estimate, names_of
from .drawing import MARKERS, colour_of
from .legends import entries
from .points import draw_points, reach
from .titles import letter

#: Length of a bar without an upper end, as a multiple of its value.
_FAR = 1e4


def column_of(data: xr.Dataset, name: Hashable) -> str:
    """Name of a variable as a column of a table, with its unit: "closure_mm"."""
    attrs = data.variables[name].attrs if name in data.variables else {}
    unit = attrs.get("units", "1")
    unit = unit.replace("mm-1", "per_mm").replace("/", "_per_").replace(" ", "_")
    return f"{name}" if unit == "1" else f"{name}_{unit}"


def rows(data: xr.Dataset, *names: str, **constants: Any) -> pd.DataFrame:
    """Variables of a dataset as the rows of a table, one for each place of their dimensions.

    Columns are the constants (such as ``panel="a"``), the coordinates, and the variables with the
    ends of their intervals; units end the names.
    """
    wanted = [end for name in names for end in names_of(name) if end in data or end == name]
    chosen = data[wanted]
    dims = chosen.sizes
    # Columns are made one by one: `to_dataframe` makes an index first and takes six times as long.
    columns: dict[Hashable, Any] = {}
    for axis, dim in enumerate(dims):
        index = chosen.indexes.get(dim, pd.RangeIndex(dims[dim])).to_numpy()
        along = index.reshape([-1 if n == axis else 1 for n in range(len(dims))])
        columns[dim] = np.broadcast_to(along, tuple(dims.values())).ravel()
    others = [name for name in chosen.variables if name not in dims and name not in wanted]
    for name in (*others, *(name for name in wanted if name not in dims)):
        columns[name] = chosen.variables[name].set_dims(dims).values.reshape(-1)
    named = {column_of(data, name): values for name, values in columns.items()}
    return pd.DataFrame({**constants, **named})


class Panel:
    """Axes of one panel with its letter, if any, and title, and the rows of its table."""

    def __init__(self, axes: Axes, which: str = "", title: str = ""):
        self.axes = axes
        self.which = which
        self.records: list[pd.DataFrame] = []
        self.title(title)

    @property
    def entries(self) -> list[Artist]:
        """Entries of a legend of the panel."""
        return entries(self.axes)

    def title(self, words: str) -> None:
        """Letter and title of the panel."""
        if self.which:
            letter(self.axes, self.which, words)
        else:
            self.axes.set_title(words, loc="left")

    def curve(
        self,
        data: xr.Dataset,
        x: str,
        y: str,
        *,
        filled: str = "",
        unit: tuple[float, float] = (1.0, 1.0),
        keep: Sequence[str] = (),
        hollow: dict[str, Any] | None = None,
        caps: float = 0.0,
        **style: Any,
    ) -> None:
        """One curve, its points hollow where they are not trusted, bars where they have intervals.

        Parameters
        ----------
        data : xr.Dataset
            Over one dimension.
        x, y : str
            Variables or coordinates.
        filled : str, optional
            Variable that states which points are trusted; all, without it.
        unit : (float, float), optional
            Units drawn, in units of the dataset; rows keep the dataset's units.
        keep : sequence of str, optional
            Other variables for the rows.
        caps : float, optional
            Half-width of the ends of bars, points; different where curves share their abscissae.
        hollow, **style
            As in :func:`kit.points.draw_points`.
        """
        across, along = data[x].values / unit[0], Estimate(data[y].values / unit[1])
        trusted = data[filled].values if filled else np.ones(np.shape(along.value), bool)
        if names_of(y)[1] in data:
            along = Estimate.read(data, y).mapped(lambda value: value / unit[1])
            colour = style.get("color")
            value, low, high = along.ends
            # A bar without an upper end leaves the frame.
            bars = reach(value, low, np.where(np.isposinf(high), _FAR * value, high))
            style_of_bars: dict[str, Any] = {
                "fmt": "none",
                "ecolor": colour,
                "elinewidth": 0.8,
                "capsize": caps,
            }
            self.axes.errorbar(across, value, bars, **style_of_bars)
        draw_points(self.axes, across, along.value, trusted, hollow, **style)
        named = [name for name in (x, y, filled, *keep) if name and name not in data.dims]
        self.keep(data, *dict.fromkeys(named))

    def curves(
        self,
        data: xr.Dataset,
        x: str,
        y: str,
        *,
        hue: str,
        labels: Sequence[str] = (),
        first: int = 0,
        **of_curve: Any,
    ) -> None:
        """A curve for each place along the dimension `hue`, with its colour, marker and label.

        `first` is the number of the first colour; `of_curve` goes to :meth:`curve`.
        """
        # A stage has hundreds of variables, each of which a selection goes through.
        names = (x, y, of_curve.get("filled", ""), *of_curve.get("keep", ()))
        ends = (end for name in names for end in names_of(name) if end in data.variables)
        data = data[[*dict.fromkeys(ends)]]
        for n in range(data.sizes[hue]):
            style = {"color": colour_of(n + first), "marker": MARKERS[n % len(MARKERS)]}
            if len(labels):
                style["label"] = labels[n]
            self.curve(data.isel({hue: n}), x, y, **{**style, **of_curve})

    def keep(self, data: xr.Dataset, *names: str, **constants: Any) -> None:
        """Add rows, as of :func:`rows`, of what is drawn by other means."""
        which = {"panel": self.which} if self.which else {}
        self.records.append(rows(data, *names, **which, **constants))


def panels_of(
    axes: Iterable[Axes], titles: Iterable[str], letters: str = "abcdefghijkl"
) -> list[Panel]:
    """Panels with letters in the order of their titles, as many as there are axes and titles."""
    return [Panel(*one) for one in zip(axes, letters, titles, strict=False)]


def table_of(*panels: Panel) -> pd.DataFrame:
    """The rows of all panels: the figure's table."""
    kept = [record for panel in panels for record in panel.records if len(record)]
    return pd.concat(kept, ignore_index=True) if kept else pd.DataFrame()
