"""Heights written to scan files of many formats: for round trips, and as seeds for fuzzing."""

from pathlib import Path

import numpy as np

MATLAB_7_3_HEADER = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, HDF5 schema 1.00 ."


def write(path, heights, dx, dy):
    """Write one scan; the end of the file name says how (see `WRITERS`).

    Parameters
    ----------
    path : path-like
        Such as ``rock.npy``, or ``rock.xml.x3p`` for heights inside the XML.
    heights : (ny, nx) ndarray
        In mm, first row at the smallest y, NaN where missing.
    dx, dy : float
        Spacing in mm.

    Returns
    -------
    dict
        The sidecar `fractalcontact.scan.read.read_scan` needs to read the file back.
    """
    return WRITERS[_ending(Path(path))](Path(path), np.asarray(heights, dtype=float), dx, dy)


def _ending(path: Path) -> str:
    return max((end for end in WRITERS if path.name.endswith(end)), key=len)


#: How the texts that are written here have their numbers.
_TEXT = {"delimiter": "blank", "decimal": ".", "header": 0}
_FACE = {"kind": "face", "unit": "mm", "heights": "up", "missing": "none"}


def _image_sidecar(dx, dy, **more):
    return {**_FACE, "spacing": [dx, dy], "first_row": "bottom", **more}


def _matrix_sidecar(dx, dy, **more):
    return _image_sidecar(dx, dy, layout="matrix", axes="none", **more)


def nodes(heights, dx, dy):
    """Points (n, 3) of the cells that are present."""
    y, x = np.indices(heights.shape)
    points = np.column_stack([dx * x.ravel(), dy * y.ravel(), heights.ravel()])
    return points[np.isfinite(points[:, 2])]


def _write_npy(path, heights, dx, dy):
    np.save(path, heights)
    return _matrix_sidecar(dx, dy)


def _write_npz(path, heights, dx, dy):
    np.savez_compressed(path, height=heights, x=dx * np.arange(heights.shape[1]))
    return _matrix_sidecar(dx, dy)


def _write_csv(path, heights, dx, dy):
    np.savetxt(path, heights, delimiter=",", fmt="%.9g")
    return _matrix_sidecar(dx, dy, **_TEXT | {"delimiter": "comma"})


def _write_xyz(path, heights, dx, dy):
    np.savetxt(path, nodes(heights, dx, dy), fmt="%.9g")
    return {**_FACE, **_TEXT, "layout": "points", "columns": [0, 1, 2]}


def _write_gwyddion_text(path, heights, dx, dy):
    """Gwyddion's text export, which runs from the top and is in m."""
    ny, nx = heights.shape
    header = f"Channel: heights\nWidth: {nx * dx:.9g} mm\nHeight: {ny * dy:.9g} mm\nValue units: m"
    np.savetxt(path, heights[::-1] * 1e-3, delimiter="\t", fmt="%.9g", header=header)
    stated = _matrix_sidecar(f"{dx} mm", f"{dy} mm", delimiter="tab", decimal=".", header=4)
    return stated | {"unit": "m", "first_row": "top"}


def _write_x3p(path, heights, dx, dy, storage="BINARY"):
    import x3pio

    storage = x3pio.DataStorage[storage]
    x3pio.write(path, heights * 1e-3, x_scale=dx * 1e-3, y_scale=dy * 1e-3, storage=storage)
    return {}


def _write_xml_x3p(path, heights, dx, dy):
    return _write_x3p(path, heights, dx, dy, "XML")


def _write_cloud_x3p(path, heights, dx, dy):
    import x3pio

    x3pio.write_points(path, nodes(heights, dx, dy) * 1e-3)
    return {}


def _write_surfer(path, heights, dx, dy):
    """Surfer's text grid: its ranges go from the first node to the last."""
    ny, nx = heights.shape
    ranges = f"0 {dx * (nx - 1):.17g}\n0 {dy * (ny - 1):.17g}\n0 1"
    values = np.where(np.isfinite(heights), heights, 1.70141e38)
    np.savetxt(path, values, fmt="%.17g", header=f"DSAA\n{nx} {ny}\n{ranges}", comments="")
    return {"kind": "face", "unit": "mm", "heights": "up"}


def _write_mesh(path, heights, dx, dy):
    """Triangles between neighbours that are all present; STL repeats the vertices."""
    import trimesh

    number = np.full(heights.shape, -1)
    number[np.isfinite(heights)] = np.arange(np.isfinite(heights).sum())
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    triangles = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    triangles = triangles[(triangles >= 0).all(axis=1)]
    trimesh.Trimesh(nodes(heights, dx, dy), triangles, process=False).export(path)
    return {"unit": "mm"}


def _write_netcdf(path, heights, dx, dy, format="NETCDF4"):
    """Packed as instruments do: 32-bit steps of 1 nm, a fill value, coordinates with units."""
    import netCDF4

    with netCDF4.Dataset(path, "w", format=format) as file:
        for name, length, spacing in (("y", heights.shape[0], dy), ("x", heights.shape[1], dx)):
            file.createDimension(name, length)
            axis = file.createVariable(name, "f8", (name,))
            axis.units = "mm"
            axis[:] = spacing * np.arange(length)
        z = file.createVariable("height", "i4", ("y", "x"), fill_value=-(2**31))
        z.units, z.scale_factor = "um", 1e-3
        z[:] = np.ma.masked_array(np.nan_to_num(heights) * 1e3, np.isnan(heights))
    return {}


def _write_classic_netcdf(path, heights, dx, dy):
    return _write_netcdf(path, heights, dx, dy, "NETCDF3_CLASSIC")


def _write_hdf5(path, heights, dx, dy):
    import h5py

    with h5py.File(path, "w") as file:
        file.create_dataset("scan/height", data=heights, compression="gzip", chunks=True)
        file["scan/time"] = np.arange(5.0)
    return _matrix_sidecar(dx, dy)


def _write_mat(path, heights, dx, dy):
    from scipy.io import savemat

    savemat(path, {"height": heights, "dx": dx, "label": "rock"}, do_compression=True)
    return _matrix_sidecar(dx, dy)


def _write_mat4(path, heights, dx, dy):
    from scipy.io import savemat

    savemat(path, {"height": heights, "dx": dx}, format="4")
    return _matrix_sidecar(dx, dy)


def _write_mat73(path, heights, dx, dy):
    """MATLAB 7.3 is HDF5 behind 512 bytes of text, its matrices transposed."""
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("height", heights.T), ("dx", [[dx]])):
            file[name] = values
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
    with open(path, "r+b") as stream:
        stream.write(MATLAB_7_3_HEADER.ljust(124) + b"\x00\x02IM")
    return _matrix_sidecar(dx, dy)


def _write_tiff(path, heights, dx, dy):
    """An image: its first row is the top."""
    import tifffile

    tifffile.imwrite(path, heights[::-1].astype(np.float32), compression="zlib")
    return _image_sidecar(dx, dy, first_row="top")


def _topography(heights, dx, dy):
    from SurfaceTopography import Topography

    ny, nx = heights.shape
    masked = np.ma.masked_invalid(heights.T)  # SurfaceTopography's arrays are [x, y]
    return Topography(masked, (nx * dx, ny * dy), unit="mm")


def _write_instrument_netcdf(path, heights, dx, dy):
    _topography(heights, dx, dy).to_netcdf(path)
    return {}


def _write_gwyddion(path, heights, dx, dy):
    """Gwyddion's own file: from the top, the holes under its mask."""
    _topography(heights[::-1], dx, dy).to_gwy(str(path))
    return {}


#: How a file of each ending is written; each gives the sidecar that reads it back.
WRITERS = {
    ".npy": _write_npy,
    ".npz": _write_npz,
    ".csv": _write_csv,
    ".xyz": _write_xyz,
    ".grd": _write_surfer,
    ".gwyddion.txt": _write_gwyddion_text,
    ".gwy": _write_gwyddion,
    ".x3p": _write_x3p,
    ".xml.x3p": _write_xml_x3p,
    ".cloud.x3p": _write_cloud_x3p,
    ".stl": _write_mesh,
    ".ply": _write_mesh,
    ".obj": _write_mesh,
    ".nc": _write_netcdf,
    ".classic.nc": _write_classic_netcdf,
    ".instrument.nc": _write_instrument_netcdf,
    ".h5": _write_hdf5,
    ".mat": _write_mat,
    ".v4.mat": _write_mat4,
    ".v73.mat": _write_mat73,
    ".tif": _write_tiff,
}
