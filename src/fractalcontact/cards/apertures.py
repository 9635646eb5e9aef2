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

#: Relative difference of two pressures that are one.
SAME = 1e-6


def with_solved_gaps(contact: xr.Dataset, results: Path | str, name: str) -> xr.Dataset:
    """Stage contact with the gaps of all loads as solved, where their states are in the results.

    Parameters
    ----------
    contact : xr.Dataset
        Of the stage of this name, whose ``map_gap`` an atlas rounds, under some of the loads.
    results : path-like
        Folder of the results of a study.
    name : str
        The specimen.
    """
    for path in sorted(Path(results).glob(f"contact/{name}/*.nc")):
        with xr.open_dataset(path) as part:
            if "map_gap" in part:
                gaps = part["map_gap"].values  # read while the file is open
                return contact.assign(map_gap=contact["map_gap"].copy(data=gaps))
    return contact


def aperture_at(contact: xr.Dataset, pressure: float | None, name: str) -> xr.DataArray:
    """Aperture map at a pressure, 0 in contact.

    Parameters
    ----------
    contact : xr.Dataset
        As :func:`with_solved_gaps` gives it.
    pressure : float or None
        MPa; None for the reference load.
    name : str
        The specimen.

    Returns
    -------
    xr.DataArray
        (y, x) in mm, in the coordinates of the scan. The attribute ``source`` says whether it is
        computed or interpolated, linearly in ln(pressure), between two computed loads.

    Raises
    ------
    InputError
        If the pressure lies outside those whose maps are kept.
    """
    maps = contact["map_gap"].dropna("normal_force", how="all")
    known = maps["nominal_pressure"].values
    if pressure is None:
        force = contact.attrs["map_load"]
        pressure = float(known[np.argmin(np.abs(maps["normal_force"].values - force))])
    if not known[0] * (1 - SAME) <= pressure <= known[-1] * (1 + SAME):
        raise InputError(
            f"{name}: no aperture at {pressure:g} MPa; its maps are kept at "
            f"{', '.join(f'{one:.4g}' for one in known)} MPa, so write a pressure between the "
            "first and the last, or add it to 'loads' of the study (without the folder 'contact' "
            "of its results, to 'dilatancy_loads')"
        )
    nearest = int(np.argmin(np.abs(np.log(known / pressure))))
    if abs(known[nearest] - pressure) <= SAME * pressure:
        values, source = maps.values[nearest], f"computed at {pressure:.4g} MPa"
    else:
        after = int(np.searchsorted(known, pressure))
        low, high = known[after - 1], known[after]
        share = np.log(pressure / low) / np.log(high / low)
        values = (1 - share) * maps.values[after - 1] + share * maps.values[after]
        source = f"interpolated in ln(pressure) between {low:.4g} and {high:.4g} MPa"
    y, x = (maps[dim].values for dim in maps.dims[1:])
    attrs = cf_attrs("mm", "aperture, 0 in contact") | {
        "specimen": name,
        "nominal_pressure_MPa": pressure,
        "offset_mm": contact.attrs["map_offset"],
        "direction": contact.attrs["map_direction"],
        "source": source,
    }
    coords = {
        "y": ("y", y, cf_attrs("mm", "y of the node") | {"axis": "Y"}),
        "x": ("x", x, cf_attrs("mm", "x of the node") | {"axis": "X"}),
    }
    return xr.DataArray(values.astype(np.float32), coords, ("y", "x"), "aperture", attrs)


def aperture_at_points(aperture: xr.DataArray, path: Path | str) -> pd.DataFrame:
    """Aperture at the points of a CSV file with columns x and y in mm; missing outside the window.

    Between nodes it is bilinear.

    Raises
    ------
    InputError
        If the file cannot be read or has no such columns of numbers.
    """
    try:
        read = pd.read_csv(path, skipinitialspace=True)
        points = read[["x", "y"]].astype(float)
    except (OSError, ValueError, KeyError) as error:
        raise InputError(
            f"{path}: cannot be read as points ({error}); expected a CSV file whose first line "
            "is 'x,y', numbers in mm below it"
        ) from None
    places = {axis: ("point", points[axis].values) for axis in "xy"}
    return points.assign(aperture=aperture.interp(places).values)


def write_aperture(aperture: xr.DataArray | pd.DataFrame, path: Path | str) -> None:
    """Write an aperture map, or apertures at points, whole or not at all.

    Parameters
    ----------
    aperture : xr.DataArray or pd.DataFrame
        Points have a CSV file alone.
    path : path-like
        Its ending is .csv (columns x, y, aperture), .nc (netCDF by the CF conventions) or .vtk
        (legacy VTK, structured points).

    Raises
    ------
    InputError
        For any other ending.
    """
    path = Path(path)
    of_points = isinstance(aperture, pd.DataFrame)
    endings = (".csv",) if of_points else (".csv", ".nc", ".vtk")
    if path.suffix not in endings:
        what = "apertures at points" if of_points else "an aperture map"
        raise InputError(f"{path}: {what}: write a file that ends in {' or '.join(endings)}")
    if path.suffix == ".nc":
        write(aperture.to_dataset().assign_attrs(Conventions="CF-1.8"), path)
        return
    if of_points:
        write_table(path, aperture[["x", "y", "aperture"]])
        return
    with atomic_write(path) as file:
        file.write_bytes(_vtk(aperture) if path.suffix == ".vtk" else _csv(aperture))


def _csv(aperture: xr.DataArray) -> bytes:
    """The table that :func:`core.tables.table_text` makes of a map, in a third of its time."""
    x, y = ([f"{one:.8g}," for one in aperture[axis].values] for axis in "xy")
    rows = zip(y, aperture.values.tolist(), strict=True)
    cells = ((f"{a}{b}", gap) for b, row in rows for a, gap in zip(x, row, strict=True))
    # A missing aperture, which equals nothing, is an empty cell.
    of_nodes = (f"{at}{gap:.8g}" if gap == gap else at for at, gap in cells)
    return "\n".join(("x,y,aperture", *of_nodes, "")).encode()


def _vtk(aperture: xr.DataArray) -> bytes:
    """A map in VTK's legacy format: nodes as structured points, big-endian."""
    x, y = aperture["x"].values, aperture["y"].values
    title = f"aperture in mm, {aperture.attrs['source']}"
    header = f"""# vtk DataFile Version 3.0
{title[:255]}
BINARY
DATASET STRUCTURED_POINTS
DIMENSIONS {x.size} {y.size} 1
ORIGIN {x[0]:.9g} {y[0]:.9g} 0
SPACING {x[1] - x[0]:.9g} {y[1] - y[0]:.9g} 1
POINT_DATA {aperture.size}
SCALARS aperture float 1
LOOKUP_TABLE default
"""
    return header.encode() + aperture.values.astype(">f4").tobytes() + b"\n"
