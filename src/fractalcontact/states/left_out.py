"""Contact domains without one of their parts, the same ground at all resolutions (jackknife)."""

import functools

import numpy as np
import xarray as xr

from roughcontact.contact.corrected_area import cell_areas

from ..core.datasets import domains_by_resolution
from ..core.intervals import LEFT_OUT

#: Number of parts; each holds equally many nodes of the finest domain.
PARTS_LEFT_OUT = 32


def part_ends(domain: np.ndarray, factor: int) -> np.ndarray:
    """Ends (PARTS_LEFT_OUT - 1,) of parts of equally many nodes along Morton's curve.

    Of the domain at the finest resolution, a multiple k of the scan's spacing; empty without a
    node. Contact gathers on few hills, which squares of the window would cut unevenly, and leave
    empty elsewhere. Morton's curve keeps neighbours together, so that its parts are compact.
    """
    places = np.sort(_places(domain, factor))
    first = np.arange(1, PARTS_LEFT_OUT) * places.size // PARTS_LEFT_OUT
    return places[first] if places.size else places


def fractions_left(domain: np.ndarray, factor: int, ends: np.ndarray) -> np.ndarray:
    """Fraction (PARTS_LEFT_OUT,) of a domain's corrected area that is left without each part.

    ``ends`` are those of :func:`part_ends` of the finest domain. NaN without a node, or without
    ends.
    """
    places = _places(domain, factor)
    if not (places.size and ends.size):
        return np.full(PARTS_LEFT_OUT, np.nan)
    part = np.searchsorted(ends, places, side="right")
    area = np.bincount(part, cell_areas(domain), PARTS_LEFT_OUT)
    return 1 - area / area.sum()


def left_of_fields(fields: xr.Dataset) -> xr.DataArray:
    """:func:`fractions_left` of all contact domains ``in_contact_k`` of a specimen.

    Over (direction, offset, resolution, normal_force, left_out).
    """
    domains = {k: domain.values for k, domain in domains_by_resolution(fields).items()}
    factors = list(domains)
    n_direction, n_offset, n_load = domains[factors[0]].shape[:3]
    left = np.empty((n_direction, n_offset, len(factors), n_load, PARTS_LEFT_OUT))
    for direction, offset, load in np.ndindex(n_direction, n_offset, n_load):
        of_state = [domains[k][direction, offset, load] for k in factors]
        ends = part_ends(of_state[0], factors[0])
        for i, (factor, domain) in enumerate(zip(factors, of_state, strict=True)):
            left[direction, offset, i, load] = fractions_left(domain, factor, ends)
    dims = ("direction", "offset", "resolution", "normal_force", LEFT_OUT)
    coords = {name: fields[name] for name in ("direction", "offset", "normal_force")}
    return xr.DataArray(left, dims=dims, coords={**coords, "resolution": factors})


def _places(domain: np.ndarray, factor: int) -> np.ndarray:
    """Places of the nodes of a domain along Morton's curve, on the grid of the scan."""
    y, x = np.nonzero(domain)
    spread = _spread(factor * max(domain.shape))
    return 2 * spread[factor * y] + spread[factor * x]


@functools.cache
def _spread(n: int) -> np.ndarray:
    """Numbers below n with a 0 before each of their binary digits."""
    return np.array([int(f"{number:b}", 4) for number in range(n)])
