"""Comparison of a figure's data file with the arrays of the atlas, and with what is drawn."""

import re
from functools import cache

import numpy as np
import yaml
from places import ROOT

from fractalcontact.core.estimate import names_of
from fractalcontact.core.subject import Subject

#: Ends of the names of columns, by the unit that the atlas states.
UNITS = {
    "1": "",
    "mm": "_mm",
    "mm2": "_mm2",
    "mm3": "_mm3",
    "mm4": "_mm4",
    "mm-1": "_per_mm",
    "N": "_N",
    "N mm": "_N_mm",
    "N/mm": "_N_per_mm",
    "N mm^-delta_sigma": "_N_mm^-delta_sigma",
    "MPa": "_MPa",
    "MPa/mm": "_MPa_per_mm",
    "mm/MPa": "_mm_per_MPa",
    "degree": "_degree",
    "unit of the quantity": "",
}
#: Units of the axes of figures over those of the atlas: µm, m, kN and their like, per cent.
FACTORS = (1.0, 100.0, 1e-3, 1e3, 1e-6, 1e6)
#: Figures that draw points beside their places, up to this part of these, lest one hides another.
ASIDE = {
    *("fig01_strength", "fig11_slope_angle", "fig12_evolution", "fig13_size_effect"),
    *("size_prediction", "contact_geometry"),
}
_ASIDE = 0.25
#: Figures with the names of things, or ranks, along one axis: their numbers stand along the other.
RANKED = {"fig02_relief", "comparison"}
#: Figures of experiments that draw means of the rows, or sums of their columns: tests of their own.
MEANS = {"estimator_bias", "plateau", "resolution_law", "size_strength", "three_exponents"}
#: Panels with lines that no columns hold, and why.
UNKEPT = {
    ("fig01_strength", "b"): "power law of a self-affine surface",
    ("fig04_05_closure", "a"): "fitted laws",
    ("fig04_05_closure", "b"): "fitted laws",
    ("fig06_07_dilatancy", "a"): "lines fitted to the ends of the curves",
    ("fig09_box_counting", "c"): "dimensions over the sides that they are fitted to",
    ("fig11_slope_angle", ""): "power law quoted for shear tests",
    ("area_slope", "a"): "theories",
    ("area_slope", "b"): "theories",
    ("area_theories", "b"): "theories, the mean at the edge, and other offsets",
    ("conductance", ""): "fitted laws and theories",
    ("quality", "c"): "the Gaussian, and its histogram as a stair",
    ("quality", "f"): "self-affine lines",
    ("quality", "d"): "the Gaussian of two faces",
    ("quality", "g"): "self-affine lines of two faces",
    ("quality", "h"): "self-affine lines of two faces",
    ("size_test", "a"): "lines of eq. 6",
    ("strength", "c"): "lower ends of bars that leave the frame",
}


def column_of(data, name):
    """Name of a variable in the data file of a figure: its name in the atlas, and its unit."""
    unit = data[name].attrs.get("units", "1")
    return f"{name}{UNITS.get(unit, f'_{unit}')}"


def digits(column):
    """Numbers to eight digits, and words."""
    return [one if isinstance(one, str) else f"{float(one):.8g}" for one in column]


# Rows of the data file against the atlas


@cache
def _entries():
    path = ROOT / "tests/support/drawn_arrays.yaml"
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def lost(table, atlas, figure, subject):
    """Columns of arrays drawn that are incomplete in a figure's table, with the missing values."""
    of = Subject.of(atlas, subject) if isinstance(subject, str) else None
    for entry in _entries().get(figure, ()):
        if subject not in entry.get("of", [subject]):
            continue
        panels = entry.get("panel")
        panels = panels if isinstance(panels, list) or panels is None else [panels]
        rows = table if panels is None else table[table["panel"].isin(panels)]
        for stage in entry.keys() & atlas.children.keys():
            groups = atlas[stage].children
            for group in {subject} & {*groups} if isinstance(subject, str) else groups:
                data = groups[group].to_dataset()
                for name in entry[stage].split():
                    # Readings of a laboratory are drawn without bars, which would hide them.
                    ends = names_of(name) if stage != "measured" else (name,)
                    for end in (one for one in ends if one in data):
                        yield from _absent(rows, data, end, of, entry)


def _absent(rows, data, name, of, entry):
    """The column of a variable, if its rows lack a value at its place."""
    column, values = column_of(data, name), data[name]
    places = {
        dim: _places(dim, data, of, entry.get(dim)) for dim in values.dims if of or dim in entry
    }
    if "where" in entry:
        values = values.where(data[entry["where"]].notnull())
    whole = values.reset_coords(drop=True).isel(places).expand_dims("whole")
    whole = whole.to_series().rename("its value").reset_index()
    whole = whole[whole["its value"].notna()]
    if entry.get("positive"):
        whole = whole[whole["its value"] > 0]
    keys = {dim: column_of(data, dim) if dim in data.coords else dim for dim in values.dims}
    keys = {dim: key for dim, key in keys.items() if key in rows}
    wanted = [*zip(*(digits(whole[dim]) for dim in (*keys, "its value")), strict=True)]
    held = rows.dropna(subset=[*keys.values(), column]) if column in rows else rows[:0]
    held = zip(*(digits(held[key]) for key in (*keys.values(), column) if key in held), strict=True)
    if absent := sorted({*wanted} - {*held}):
        yield f"{column}: {len(absent)} of {len(wanted)} lost, such as {absent[0]}"


def _places(dim, data, of, wanted):
    """Indices along a dimension that an entry asks for."""
    n = data.sizes[dim]
    if isinstance(wanted, int):
        return np.unique(np.round(np.linspace(0, n - 1, min(wanted, n))).astype(int))
    if isinstance(wanted, list):
        return np.flatnonzero(data[dim].isin(wanted))
    if dim in ("direction", "contact_direction") and wanted is None:
        return np.flatnonzero(data[dim] == of.direction)
    if dim == "resolution" and wanted is None:
        return [int(np.argmin(data[dim].values))]
    if dim == "offset" and wanted is not None:
        offset = of.offset if wanted == "reported" else float(np.squeeze(of["area"]["area_offset"]))
        return [int(np.argmin(abs(data[dim].values - offset)))]
    if dim == "normal_force" and wanted is not None:
        loads = {"reported": "loads", "quoted": "quoted", "reference": "reference"}[wanted]
        forces = of.forces[np.atleast_1d(getattr(of.reported, loads))]
        return [int(np.argmin(abs(data[dim].values - force))) for force in forces]
    return np.arange(n)


# What is drawn against the data file


def points_of(figure):
    """Points drawn in a figure: letter of the panel, line style, marker or kind, x and y of each.

    Lines across a panel, marks on a map, and entries of a legend that draw nothing, are none.
    """
    for axes in (axes for axes in figure.axes if not axes.images):
        letter = re.match(r"\((\w)\)", axes.get_title(loc="left"))
        letter = letter[1] if letter else ""
        for line in axes.lines:
            x, y = (np.asarray(one, float) for one in line.get_data(orig=False))
            known = np.isfinite(x) & np.isfinite(y)
            if line.get_transform() == axes.transData and known.any():
                marker = line.get_marker() if line.get_marker() != "None" else ""
                yield letter, line.get_linestyle(), marker, x[known], y[known]
        for bars in (one for one in axes.collections if hasattr(one, "get_segments")):
            ends = np.array([part for part in bars.get_segments() if len(part) == 2])
            if len(ends):
                for side in (0, 1):
                    yield letter, "bars", "", ends[:, side, 0], ends[:, side, 1]


def unkept(points, table, figure):
    """Points drawn that no two columns of the data file hold in one row, in words."""
    if figure in MEANS:
        return
    every = table.select_dtypes("number")
    for letter, style, marker, x, y in points:
        if not marker and (figure, letter) in UNKEPT:
            continue
        rows = every
        # Curves of another panel are drawn again, without points, for comparison.
        if letter and marker and "panel" in table:
            rows = every[[letter in panel.split(", ") for panel in table["panel"]]]
        if not _in_rows(rows, x, y, figure):
            yield f"({letter}) {style!r}, {marker!r}: no two columns hold {x[:3]}, {y[:3]} ..."


def _in_rows(rows, x, y, figure):
    """True if two columns, or one where the other axis has names, hold all points in one row."""
    if figure in RANKED:
        return any(True for values in (x, y) for _ in _holding(rows, values))
    at_y = [*_holding(rows, y)]
    at_x = _holding(rows, x, _ASIDE if figure in ASIDE else 1e-6)
    return any((a & b).any(axis=0).all() for a in at_x for b in at_y)


def _holding(rows, values, rtol=1e-6):
    """Columns that hold all values in one unit: their rows, (row, value) bool."""
    # Most columns lack a value, which their sorted numbers show without comparing every pair.
    reach = (1 + 1e-6) * rtol * np.abs(values)
    for _, column in rows.items():
        numbers = column.to_numpy()
        ordered = np.sort(numbers[np.isfinite(numbers)])
        for factor in FACTORS:
            first = np.searchsorted(ordered * factor, values - reach, "left")
            if not (np.searchsorted(ordered * factor, values + reach, "right") > first).all():
                continue
            same = np.isclose(numbers[:, None] * factor, values, rtol=rtol, atol=0)
            if same.any(axis=0).all():
                yield same
