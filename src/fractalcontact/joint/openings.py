"""Rigid openings of the pre-fractals of a joint."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from .joint import composite_topography, prefractal


def prefractal_openings(
    specimen: xr.Dataset, joint: xr.Dataset, resolutions: Sequence[int]
) -> xr.DataArray:
    """Rigid dilatancy of the pre-fractals: the opening at which each touches first, mm.

    max h_k(v) less a datum, over (direction, offset, resolution). The datum is max h(0) at the
    scan's own resolution, the joint before it slides; against a plane, which mates with nothing, it
    is the mean of h.
    """
    cells = joint["offset_cells"].transpose("contact_direction", ...)
    directions = cells["contact_direction"].values
    opened = np.empty((*cells.shape, len(resolutions)))
    for i, direction in enumerate(directions):
        mated = composite_topography(specimen, direction, 0)
        datum = mated.mean() if direction == "none" else mated.max()
        for j, n in enumerate(cells.values[i]):
            composite = composite_topography(specimen, direction, n)
            opened[i, j] = [prefractal(composite, k).max() - datum for k in resolutions]
    return xr.DataArray(
        opened,
        dims=("direction", "offset", "resolution"),
        coords={"direction": directions, "resolution": list(resolutions)},
    )
