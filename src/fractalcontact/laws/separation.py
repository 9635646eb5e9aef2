"""Separation of the faces and closure from a seat, which depend on no single asperity.

Closure from first touch is an extreme: the highest node of the composite topography alone decides
where it begins, and that node changes with the spacing and the window. The separation of the mean
planes, delta_r - w, and the closure between two loads that many nodes carry do not depend on it.
"""

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.determined import decided_by_scan
from ..core.labels import cf_attrs
from ..core.limits import RESOLVED_NODES
from ..states.seat import seat_of
from ..states.states import error_attrs
from .scan_errors import on_sound_cells

#: Separation and seated closures: unit and long name.
_WORDS = {
    "separation": ("mm", "separation of the mean planes delta_r - w; 0 where faces are mated"),
    "seated_closure": ("mm", "interface closure from the seating pressure on"),
    "closure_from_common_seat": (
        "mm",
        "interface closure from the common seating pressure on, one for all offsets",
    ),
    "closure_from_stated_seat": (
        "mm",
        "interface closure from the stated seating pressure on, however few nodes touch there",
    ),
}

#: Seating pressures: dimensions, unit and long name.
_SEATS = {
    "seating_pressure": (
        ("direction", "offset", "resolution"),
        "MPa",
        "nominal pressure from which closure is seated",
    ),
    "common_seating_pressure": (
        ("direction", "resolution"),
        "MPa",
        "largest seating pressure of all offsets of a direction: closures compare from there on",
    ),
    "no_common_seat": (
        ("direction", "resolution"),
        "1",
        "why there is no common seating pressure",
    ),
}


def add_separation(curves: xr.Dataset, openings: xr.DataArray | None) -> None:
    """Add the separation of the mean planes to a closure stage.

    Without the openings of :func:`joint.openings.prefractal_openings` only the scan's own
    resolution has one.
    """
    if openings is None:
        openings = curves["rigid_opening"].where(curves["resolution"] == 1)
    else:
        # Openings are matched by position, not by label: where cells are not square, offsets of the
        # directions differ by part of a cell.
        openings = openings.sel(
            direction=curves["direction"].values, resolution=curves["resolution"].values
        ).drop_vars(["direction", "resolution"])
    dims = ("direction", "offset", "resolution")
    words = cf_attrs("mm", "opening at first touch of the pre-fractal; of a plane, from its mean")
    curves["prefractal_opening"] = (dims, openings.transpose(*dims).values, words)
    separation = curves["prefractal_opening"] - curves["closure"]
    curves["separation"] = separation.transpose(*curves["closure"].dims)
    curves["separation"].attrs = cf_attrs(*_WORDS["separation"])
    # The opening of rigid faces is read off the heights: it has no solver error.
    curves["separation_error"] = curves["closure_error"].assign_attrs(
        error_attrs(curves["separation"].attrs)
    )


def add_seated_closure(curves: xr.Dataset, seating_pressure: float) -> None:
    """Add the closures from a seating pressure, of each offset and of all, to a closure stage.

    At each offset and resolution the first load from the study's seating pressure on, MPa, whose
    state is resolved and rests on sound cells of the scans seats the joint. ``seated_closure``
    counts from the seating load of its own offset, so that each curve begins as early as it can.
    Closures of several offsets compare only from one pressure on: ``closure_from_common_seat``
    counts from the largest of these loads, at which enough nodes touch at all offsets that have
    one. Those of several resolutions do from the stated pressure: ``closure_from_stated_seat``
    counts from the first load from there on. Below
    its load a closure has no value, nor where the state under that load was not solved.
    """
    force = curves["normal_force"]
    area = float((force / curves["nominal_pressure"])[0])
    lightest = seating_pressure * area
    decided = on_sound_cells(curves) & np.isfinite(curves["interface_closure"])
    dims = [["normal_force"], [], ["normal_force"]]
    seats = xr.apply_ufunc(seat_of, force, lightest, decided, input_core_dims=dims)
    common = seats.max("offset")
    _add_closure_from(curves, seats, "seated_closure")
    _add_closure_from(curves, common, "closure_from_common_seat")
    stated = xr.full_like(seats, float(seat_of(force, lightest)))
    _add_closure_from(curves, stated, "closure_from_stated_seat")
    none = f"no state of any offset has {RESOLVED_NODES} nodes in contact"
    if seating_pressure > 0:
        none += f" at {seating_pressure:g} MPa or more"
    if decided_by_scan(curves["suspect_load_share"]).any():
        none += " with most of the force on sound cells of the scans"
    seating = {
        "seating_pressure": seats / area,
        "common_seating_pressure": common / area,
        "no_common_seat": xr.where(common.isnull(), none, ""),
    }
    values = {name: seating[name].transpose(*dims).values for name, (dims, *_) in _SEATS.items()}
    curves.update(labelled(_SEATS, values))


def _add_closure_from(curves: xr.Dataset, seats: xr.DataArray, name: str) -> None:
    """Add the closure counted from the states under the forces ``seats``, N, and its error."""
    closing, error = curves["interface_closure"], curves["closure_error"]
    force = curves["normal_force"]
    at_seat = force == seats
    at_its_seat = closing.where(at_seat).sum("normal_force", min_count=1)
    seated = closing - at_its_seat
    both = error + error.where(at_seat).sum("normal_force")
    # At the seat a closure is 0 by definition, without an error.
    both = both.where(~at_seat, 0.0)
    beyond = (force >= seats) & np.isfinite(seated)
    attrs = cf_attrs(*_WORDS[name])
    order = closing.dims
    curves[name] = seated.where(beyond).transpose(*order).assign_attrs(attrs)
    curves[f"{name}_error"] = both.where(beyond).transpose(*order).assign_attrs(error_attrs(attrs))
