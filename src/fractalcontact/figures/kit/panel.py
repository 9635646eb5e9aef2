"""Panel that draws curves from a dataset and records them as rows of the figure's table."""

from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from ...core.estimate import Estimate, names_of
from .drawing import MARKERS, colour_of
from .points import draw_points, reach
from .titles import letter

#: A bar without an upper end is this many times as high as its value.
_FAR = 1e4


def column_of(data: xr.Dataset, name: Hashable) -> str:
    """A variable as a column of a table, named with its unit: "closure_mm"."""
    unit = data[name].attrs.get("units", "1")
    unit = unit.replace("mm-1", "per_mm").replace("/", "_per_").replace(" ", "_")
    return f"{name}" if unit == "1" else f"{name}_{unit}"


def rows(data: xr.Dataset, *names: str, **constants: Any) -> pd.DataFrame:
    """Variables of a dataset as the rows of a table, one for each place of their dimensions.

    Parameters
    ----------
    data : xr.Dataset
    *names : str
        Of variables; the ends of its interval go with each that has one.
    **constants
        Columns that are the same in all rows, such as ``panel="a"``.

    Returns
    -------
    pd.DataFrame
        The constants, the coordinates, the variables; units end the names of the columns.
    """
    wanted = [end for name in names for end in names_of(name) if end in data or end == name]
    chosen = data[wanted]
    if not chosen.dims:
        chosen = chosen.expand_dims("row")
    table = chosen.to_dataframe().reset_index().drop(columns="row", errors="ignore")
    places = [name for name in table.columns if name not in wanted]
    table = table[places + wanted].rename(columns=lambda name: column_of(data, name))
    for place, (name, value) in enumerate(constants.items()):
        table.insert(place, name, value)
    return table


class Panel:
    """Axes of one panel, and the rows of its table.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    which : str
        Letter of the panel; empty where a figure has one alone.
    title : str
    """

    def __init__(self, axes: Axes, which: str = "", title: str = ""):
        self.axes = axes
        self.which = which
        self.records: list[pd.DataFrame] = []
        self.title(title)

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
            Of its variables or coordinates.
        filled : str, optional
            Variable that says which points are trusted; all, without it.
        unit : (float, float), optional
            Values are drawn divided by these; rows keep the dataset's units.
        keep : sequence of str, optional
            Other variables that the rows have.
        caps : float, optional
            Half-width of the ends of bars, points: of its own where curves share their abscissae.
        hollow, **style
            As of :func:`kit.points.draw_points`.
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
        """A curve for each place along a dimension, each with its colour and marker.

        Parameters
        ----------
        data : xr.Dataset
            Over ``hue`` and one other dimension.
        x, y : str
        hue : str
        labels : sequence of str, optional
            Of the curves, for a legend.
        first : int, optional
            Number of the first colour.
        **of_curve
            As of :meth:`curve`.
        """
        for n in range(data.sizes[hue]):
            style = {"color": colour_of(n + first), "marker": MARKERS[n % len(MARKERS)]}
            if len(labels):
                style["label"] = labels[n]
            self.curve(data.isel({hue: n}), x, y, **{**style, **of_curve})

    def keep(self, data: xr.Dataset, *names: str, **constants: Any) -> None:
        """Add rows from :func:`rows` of what is drawn by other means."""
        which = {"panel": self.which} if self.which else {}
        self.records.append(rows(data, *names, **which, **constants))


def table_of(*panels: Panel) -> pd.DataFrame:
    """The rows of all panels: the figure's table."""
    kept = [record for panel in panels for record in panel.records if len(record)]
    return pd.concat(kept, ignore_index=True) if kept else pd.DataFrame()
