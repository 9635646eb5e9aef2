"""Flow along and across the sliding, as the figures of the flow draw it."""

from typing import Any

import xarray as xr

from ..kit.drawing import colour_of

#: Ways of the flow with their style.
WAYS: dict[str, dict[str, Any]] = {
    "along": {"color": colour_of(0), "marker": "o"},
    "across": {"color": colour_of(1), "marker": "s", "mfc": "none"},
}


def open_states(data: xr.Dataset, name: str) -> xr.Dataset:
    """Data without the zeros of a variable: a logarithmic axis has none."""
    return data.assign({name: data[name].where(data[name] > 0).assign_attrs(data[name].attrs)})
