"""The joint in one picture: window on the scan, gap, place of the load, faces along a line."""

import json

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.datasets import labelled_dataset
from ...core.subject import Subject
from ...core.text import length_unit, percent, pressure_label
from ...core.window import spacing_of, window_fraction, window_sides, window_slices
from .. import kit

TITLE = "The joint: window on the scan, gap, place of the load, and faces along a line"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "contact")
ORDER = 5
JOINT_STUDY = True
SECTION = "scan"

#: Beginning of the name of the reading of two scans that leaves the faces as they were given.
_AS_GIVEN = "registration none"


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Relief with the window, gap and contact under the reference load, and a profile."""
    subject = Subject.of(atlas, name)
    specimen, reference = subject["specimens"], subject.reported.reference
    gap = subject.states("contact")["map_gap"].isel(normal_force=reference).values
    domain = kit.contact_domain(subject, subject.reported.resolution, reference)
    rows, columns = window_slices(specimen)
    # The finest resolution of a study may be coarser than the scan.
    step, busiest = subject.reported.resolution, int(np.argmax(domain.sum(axis=1)))
    line = rows.start + step * busiest
    profile = _profile(specimen, line, columns.start + step * np.flatnonzero(domain[busiest]))

    figure = Figure(figsize=(kit.WIDTH, 5.2))
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.5, 1])  # type: ignore[misc]  # an array
    relief, of_gap, of_load = top.subplots(1, 3, width_ratios=[1.15, 1, 1])
    height = float(specimen["y"][line] - specimen["y"][0])
    share = window_fraction(specimen)
    _draw_relief(top, relief, specimen, height)
    sides = window_sides(specimen)
    upper_end = float(np.nanquantile(gap, 0.99)) or 1.0
    drawn = kit.draw_map(of_gap, gap, sides, ticks=3, cmap="viridis", vmin=0, vmax=upper_end)
    top.colorbar(drawn, ax=of_gap, location="bottom", extend="max", label="gap (mm)")
    kit.draw_domain(of_load, domain, sides, ticks=3)
    axes = bottom.subplots()
    _draw_profile(axes, profile, columns)
    bottom.legend(handles=kit.entries(axes), loc="outside lower center", ncols=5)
    titles = (f"window: {percent(share)} of the scan", "gap in the window", "where the load acts")
    for panel, which, title in zip((relief, of_gap, of_load), "abc", titles, strict=True):
        kit.letter(panel, which, title)
    kit.letter(axes, "d", "heights along the dashed line of a")
    pressure = pressure_label(float(subject["closure"]["nominal_pressure"][reference]))
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset), pressure)
    words = {
        "share": share,
        "pressure": pressure,
        "suspect": float(subject.state("closure")["suspect_load_share"]),
        "moved": _motion(specimen),
    }
    table = kit.rows(profile, *profile.data_vars)
    return kit.Drawing(figure, table, kit.caption(__name__, **words))


def _profile(specimen: xr.Dataset, line: int, touching: np.ndarray) -> xr.Dataset:
    """Heights of the faces over x along a line of the grid, mm, and at the nodes in contact."""
    heights = {face: specimen[face].values[line] for face in ("lower", "upper") if face in specimen}
    given = [
        str(words)
        for words in specimen.get("reading", xr.DataArray([])).values
        if str(words).startswith(_AS_GIVEN)
    ]
    if given:
        other = specimen["other_faces"].sel(reading=given[0], face="upper")
        heights["upper_as_given"] = other.transpose("y", "x").values[line]
    face = "upper" if "upper" in heights else "lower"
    loaded = np.full(specimen.sizes["x"], np.nan)
    loaded[touching] = heights[face][touching]
    heights[f"{face}_in_contact"] = loaded
    table = {key: ("x", "mm", f"height, {key.replace('_', ' ')}") for key in heights}
    # Distances from the corner of the scan, as on the map.
    x = specimen["x"] - float(specimen["x"][0]) + spacing_of(specimen)[1] / 2
    return labelled_dataset(table, heights, coords={"x": x.assign_attrs(specimen["x"].attrs)})


def _draw_relief(figure, axes, specimen, height):
    """Lower face with the outline of the window and the line of the profile."""
    sides = kit.scan_extent(specimen)
    outline = kit.draw_faces(figure, [axes], specimen, ["lower"], sides)
    outline.set_label("")
    _, size = length_unit(max(sides))
    middle = height + spacing_of(specimen)[0] / 2
    axes.axhline(middle / size, color="black", ls="--", lw=1, path_effects=kit.HALO)


def _draw_profile(axes, profile, columns):
    """Both faces along the line, the upper one also as given, and the nodes in contact."""
    x = profile["x"].values
    unit, size = length_unit(float(x[-1]))
    dots = {"color": kit.COLOURS[3], "marker": "o", "ms": 2.5, "ls": "none"}
    loaded = "load acts here", dots
    upper = "upper face, registered" if "upper_as_given" in profile else "upper face"
    styles = {
        "lower": ("lower face", {"color": kit.COLOURS[0], "lw": 0.9}),
        "upper": (upper, {"color": kit.COLOURS[4], "lw": 0.9}),
        "upper_as_given": ("upper face as scanned", {"color": kit.COLOURS[1], "ls": ":", "lw": 1}),
        "lower_in_contact": loaded,
        "upper_in_contact": loaded,
    }
    for key, (label, style) in styles.items():
        if key in profile and np.isfinite(profile[key]).any():
            axes.plot(x / size, profile[key], label=label, **style)
    ends = x[[columns.start, columns.stop - 1]] / size
    axes.axvspan(*ends, color="0.92", lw=0, zorder=0, label="window")
    axes.set_xlabel(f"$x$ ({unit})")
    axes.set_ylabel("height (mm)")
    axes.margins(x=0)


def _motion(specimen):
    """Registration of the faces: its shift and the deviation of the gap, mm; empty without one."""
    record = json.loads(specimen.attrs.get("registration") or "{}")
    if not record.get("applied"):
        return {}
    keys = ("shift_x_mm", "shift_y_mm", "gap_sd_before_mm", "gap_sd_after_mm")
    return {key.removesuffix("_mm"): record[key] for key in keys}
