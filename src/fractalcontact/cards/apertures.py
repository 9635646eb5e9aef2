"""Aperture maps of a joint under load for other programs: CSV, netCDF and VTK, all in mm."""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from ..core.atomic import atomic_write
from ..core.errors import InputError
from ..core.labels import cf_attrs
from ..core.netcdf import write
from ..core.tables import write_table
from ..core.text import exact

#: Relative difference of two pressures that are one.
SAME = 1e-6

#: Frames of the coordinates of a map, in words.
FRAMES = {
    "scan": "in the coordinates of the scan",
    "window": "from the corner of the window with the smallest x and y",
}

#: Endings of files of an aperture map.
MAP_ENDINGS = (".csv", ".nc", ".vtk")


def aperture_at(
    contact: xr.Dataset, pressure: float | None, name: str, results: Path | str | None = None
) -> xr.DataArray:
    """Aperture map (y, x) of a specimen at a pressure, mm, 0 in contact.

    Between two computed loads it is interpolated linearly in ln(pressure); the attribute ``source``
    says so.

    Parameters
    ----------
    contact : xr.Dataset
        Stage of this name, whose ``map_gap`` an atlas rounds and keeps under some of the loads.
    pressure : float or None
        MPa; None for the reference load.
    name : str
        The specimen.
    results : path-like, optional
        Folder of the results; its folder ``contact``, if it is there, has all gaps as solved.

    Raises
    ------
    InputError
        If the pressure lies outside those whose maps are kept.
    """
    maps = _gaps(contact, results, name).dropna("normal_force", how="all")
    kept = maps["nominal_pressure"].values
    if pressure is None:
        force = contact.attrs["map_load"]
        pressure = float(kept[np.argmin(np.abs(maps["normal_force"].values - force))])
    if not kept[0] * (1 - SAME) <= pressure <= kept[-1] * (1 + SAME):
        raise InputError(
            f"{name}: no aperture at {exact(pressure)} MPa; its maps are kept at "
            f"{', '.join(f'{exact(one, 4)}' for one in kept)} MPa, so write a pressure "
            "between the "
            "first and the last, or add it to 'loads' of the study (without the folder 'contact' "
            "of its results, to 'dilatancy_loads')"
        )
    place = np.interp(np.log(pressure), np.log(kept), np.arange(kept.size))
    low, nearest = int(place), round(place)
    if abs(kept[nearest] - pressure) <= SAME * pressure:
        values, source = maps.values[nearest], f"computed at {exact(pressure, 4)} MPa"
    else:
        values = (low + 1 - place) * maps.values[low] + (place - low) * maps.values[low + 1]
        ends = f"{exact(kept[low], 4)} and {exact(kept[low + 1], 4)} MPa"
        source = f"interpolated in ln(pressure) between {ends}"
    attrs = cf_attrs("mm", "aperture, 0 in contact") | {
        "specimen": name,
        "nominal_pressure_MPa": pressure,
        "offset_mm": contact.attrs["map_offset"],
        "direction": contact.attrs["map_direction"],
        "source": source,
    }
    coords = {
        axis: (axis, maps[dim].values, cf_attrs("mm", f"{axis} of the node") | {"axis": letter})
        for axis, letter, dim in zip("yx", "YX", maps.dims[1:], strict=True)
    }
    return xr.DataArray(values.astype(np.float32), coords, ("y", "x"), "aperture", attrs)


def _gaps(contact, results, name):
    """Gaps as solved where their states are kept, else those of the atlas."""
    for path in sorted(Path(results).glob(f"contact/{name}/*.nc")) if results else ():
        with xr.open_dataset(path) as part:
            if "map_gap" in part:
                return contact["map_gap"].copy(data=part["map_gap"].values)
    return contact["map_gap"]


def in_frame(aperture: xr.DataArray, frame: str) -> xr.DataArray:
    """Aperture map with x and y in one of :data:`FRAMES`, which the attribute ``frame`` names."""
    if frame == "window":
        half = {axis: (aperture[axis][1] - aperture[axis][0]) / 2 for axis in "xy"}
        moved = {
            axis: (axis, (aperture[axis] - aperture[axis][0] + half[axis]).values) for axis in "xy"
        }
        attrs = {axis: aperture[axis].attrs for axis in "xy"}
        aperture = aperture.assign_coords(moved)
        for axis in "xy":
            aperture[axis].attrs = attrs[axis]
    return aperture.assign_attrs(frame=FRAMES[frame])


def aperture_at_points(aperture: xr.DataArray, path: Path | str) -> pd.DataFrame:
    """Aperture at the points of a CSV file with columns x and y in mm, bilinear between nodes.

    Columns may be x_mm and y_mm too. The aperture is missing outside the window.

    Raises
    ------
    InputError
        If the file cannot be read or has no such columns of numbers.
    """
    try:
        table = pd.read_csv(path, skipinitialspace=True)
        points = table.rename(columns={"x_mm": "x", "y_mm": "y"})[["x", "y"]].astype(float)
    except (OSError, ValueError, KeyError) as error:
        raise InputError(
            f"{path}: cannot be read as points ({error}); expected a CSV file whose first line "
            "is 'x,y', numbers in mm below it"
        ) from None
    places = {axis: ("point", points[axis].values) for axis in "xy"}
    return points.assign(aperture=aperture.interp(places).values)


def outside_words(aperture: xr.DataArray, points: pd.DataFrame) -> str:
    """Number of points outside a map, whose aperture is missing; "" without any."""
    limits = {axis: (float(aperture[axis].min()), float(aperture[axis].max())) for axis in "xy"}
    inside = np.logical_and(*(points[axis].between(*limits[axis]).values for axis in "xy"))
    if inside.all():
        return ""
    ranges = " and ".join(
        f"{axis} = {exact(low)} to {exact(high)}" for axis, (low, high) in limits.items()
    )
    return (
        f"{np.count_nonzero(~inside)} of {len(points)} points lie outside the map, which covers "
        f"{ranges} mm: their aperture is missing"
    )


def write_aperture(aperture: xr.DataArray | pd.DataFrame, path: Path | str) -> None:
    """Write an aperture map, or apertures at points, whole or not at all.

    The ending of the path says the form: .csv (columns x_mm, y_mm, aperture_mm; the only
    one for points), .nc (netCDF by the CF conventions) or .vtk (legacy VTK, structured points).

    Raises
    ------
    InputError
        For any other ending.
    """
    path = Path(path)
    of_points = isinstance(aperture, pd.DataFrame)
    endings = (".csv",) if of_points else MAP_ENDINGS
    if path.suffix not in endings:
        what = "apertures at points" if of_points else "an aperture map"
        raise InputError(f"{path}: {what}: write a file that ends in {' or '.join(endings)}")
    if path.suffix == ".nc":
        write(aperture.to_dataset().assign_attrs(Conventions="CF-1.8"), path)
    elif path.suffix == ".vtk":
        with atomic_write(path) as file:
            file.write_bytes(_vtk(aperture))
    else:
        table = aperture if of_points else aperture.to_dataframe().reset_index()
        write_table(path, table[["x", "y", "aperture"]].add_suffix("_mm"))


def _vtk(aperture: xr.DataArray) -> bytes:
    """A map in VTK's legacy format: nodes as structured points, big-endian."""
    x, y = aperture["x"].values, aperture["y"].values
    header = f"""# vtk DataFile Version 3.0
aperture in mm, {aperture.attrs["source"]}
BINARY
DATASET STRUCTURED_POINTS
DIMENSIONS {x.size} {y.size} 1
ORIGIN {exact(x[0], 9)} {exact(y[0], 9)} 0
SPACING {exact(x[1] - x[0], 9)} {exact(y[1] - y[0], 9)} 1
POINT_DATA {aperture.size}
SCALARS aperture float 1
LOOKUP_TABLE default
"""
    return header.encode() + aperture.values.astype(">f4").tobytes() + b"\n"
