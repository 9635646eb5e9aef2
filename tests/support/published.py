"""Published numbers of a study as tables that can be compared: of files, and of the atlas.

A name means one quantity, and at one state of a specimen it has one value. Whatever table has a
column is compared: a new figure, or a new column of one, needs no edit here.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np
import pandas as pd

#: What says which contact state a row is about. A table without one of these columns speaks of the
#: state of the contact maps.
STATE = ("direction", "offset_mm", "resolution", "force_N")
#: The same by other names, in the tables that have them.
SAME = {
    "load_N": "force_N",
    "normal_force_N": "force_N",
    "real_pressure_MPa": "sigma_n_MPa",
    "contact_nodes": "nodes",
    "k_ni_MPa_per_mm": "hyperbola_k_ni_MPa_per_mm",
    "k_ni_change_at_twice_the_spacing": "hyperbola_k_ni_change",
}
#: Names of summary.csv for what the atlas has by names of its own.
SUMMARY = {
    "stiffness_MPa_per_mm": "interface_stiffness_MPa_per_mm",
    "delta_sigma_boxes": "delta_sigma_box",
    "delta_sigma_areas": "delta_sigma_area",
}
#: Quantities of curves.csv.
CURVES = {
    "closure from the seat": "seated_closure_mm",
    "closure from first touch": "interface_closure_mm",
    "tangent stiffness": "interface_stiffness_MPa_per_mm",
    "real contact area A_r/A_0": "area_corrected_share",
    "Delta_sigma by box counting": "delta_sigma_box",
    "Delta_sigma by areas": "delta_sigma_area",
}
#: Further columns that say what a row is about, no values themselves.
COORDINATES = (
    *("side_mm", "scale_side_mm", "share", "b_mm", "box_side_mm", "mean_side_mm", "null_side_mm"),
    *("null_mean_side_mm", "spacing_mm", "gliding_side_mm", "order"),
    *("eq6_side_mm", "cluster_area_mm2", "octave", "scale", "mean_scale", "null_scale"),
    *("null_mean_scale", "null_octave", "x_mm", "wavelength_mm"),
)
#: Columns that say what the numbers of a row are: those of a side are means over sub-windows.
WHAT = ("quantity", "estimator", "side_mm")
#: Tables have eight digits.
DIGITS = 1e-6


class Table:
    """Rows of numbers: columns of :data:`STATE`, words and coordinates that tell them apart."""

    def __init__(self, source, rows):
        self.source, self.rows = source, rows
        numbers = {name for name in rows if rows[name].dtype.kind in "fib"}
        self.keys_of = {}
        for column in numbers - {*STATE, *COORDINATES}:
            known = rows[rows[column].notna()]
            telling = rows.columns.difference(numbers - {*STATE, *COORDINATES})
            self.keys_of[column] = {name for name in telling if known[name].notna().all()}

    def values(self, column, keys):
        """Known values of a column by the columns ``keys``; an empty set where all are missing."""
        parts = [map(_key, self.rows[name].tolist()) for name in keys]
        values = self.rows[column].astype(float).tolist()
        found = {}
        for *place, value in zip(*parts, values, strict=True):
            found.setdefault(tuple(place), set()).update([] if math.isnan(value) else [value])
        return found


def _key(value):
    """Numbers to six digits: of a table, and of the atlas."""
    return f"{value:.6g}" if isinstance(value, int | float) else value


class Specimen(NamedTuple):
    """A specimen with the state of its contact maps, and what a cell and its window measure."""

    name: str
    maps: dict
    spacing: float
    area: float


def specimen_of(atlas, name):
    """A specimen of an atlas."""
    budget, attrs = atlas[f"error_budget/{name}"], atlas[f"specimens/{name}"].attrs
    curves = atlas[f"closure/{name}"].to_dataset()
    maps = {
        "direction": budget.attrs["direction"],
        "offset_mm": budget.attrs["offset_mm"],
        "resolution": budget.attrs["resolution"],
        "force_N": atlas[f"contact/{name}"].attrs["map_load"],
    }
    spacing = max(attrs["spacing_x"], attrs["spacing_y"])
    area = float((curves["normal_force"] / curves["nominal_pressure"])[0])
    return Specimen(name, maps, spacing, area)


def tables_of(published, one):
    """Tables of a specimen: of its figures, its rows of the summary and of the curves."""
    figures = sorted((published / "figures" / one.name).glob("*.csv"))
    found = {path.name: pd.read_csv(path) for path in figures}
    found["summary.csv"] = _rows_of(published / "summary.csv", one.name).rename(columns=SUMMARY)
    curves = _rows_of(published / "curves.csv", one.name)
    for quantity, rows in curves.groupby("quantity"):
        rows = rows.rename(columns={"value": CURVES[quantity]})
        rows = rows.drop(columns=["quantity", "low", "high", "resolved"])
        found[f"curves.csv, {quantity}"] = rows
    return [Table(name, _with_state(rows, one)) for name, rows in found.items()]


def _rows_of(path, name):
    table = pd.read_csv(path)
    return table[table["specimen"] == name].drop(columns=["study", "specimen", "label"])


def _with_state(rows, one):
    rows = rows.rename(columns=SAME)
    if "force_N" not in rows and "nominal_pressure_MPa" in rows:
        rows = rows.assign(force_N=rows["nominal_pressure_MPa"] * one.area)
    if "resolution" not in rows and "spacing_mm" in rows:
        rows = rows.assign(resolution=np.round(rows["spacing_mm"] / one.spacing).fillna(1))
    return rows.assign(**{key: one.maps[key] for key in STATE if key not in rows})


def stages_of(atlas, name, columns):
    """Numbers of the atlas by the names that tables give them, their unit behind the name."""
    found = {}
    for stage, groups in atlas.children.items():
        if name in groups.children:
            data = groups[name].to_dataset()
            if "contact_direction" in data.dims:
                data = data.drop_dims("direction", errors="ignore")
                data = data.rename(contact_direction="direction")
            for variable, values in data.data_vars.items():
                _add(found, f"atlas, {stage}", variable, values, columns)
    budget = atlas[f"error_budget/{name}"].to_dataset()
    for quantity in budget["quantity"].values:
        here = budget.sel(quantity=quantity)
        prefix = {"closure": "interface_closure"}.get(quantity, quantity)
        for error, which in (("total", "surface"), ("total_of_population", "population")):
            values = here[error].assign_attrs(units=str(here["unit"].values))
            _add(found, "atlas, error_budget", f"{prefix}_error_{which}", values, columns)
    return found


def _add(found, source, variable, values, columns):
    """Add a variable as a table, if any table has its column."""
    unit = values.attrs.get("units", "1")
    unit = unit.replace("/", "_per_").replace("mm-1", "per_mm")
    column = variable if unit == "1" else f"{variable}_{unit}"
    if column not in columns or values.dtype.kind not in "fib":
        return
    values = values.drop_vars([name for name in values.coords if name not in values.dims])
    rows = pd.DataFrame({"value": np.ravel(values)})
    if values.dims:
        rows = values.rename("value").to_dataframe().reset_index()
    names = {"offset": "offset_mm", "normal_force": "force_N", "value": column}
    names |= {name: f"{name}_mm" for name in ("gliding_side", "eq6_side")}
    found.setdefault(column, []).append(Table(source, rows.rename(columns=names)))


# -- what is compared ------------------------------------------------------------------------------


def differing(one, other, column, *, missing=False):
    """Places where two tables have different values of a column, and in how many both have one.

    Where one has more rows, as of more spacings, its values hold those of the other. ``missing``
    says whether a value differs from one that the other table has, and says is missing.
    """
    ours, theirs = one.keys_of[column], other.keys_of[column]
    if any((name in ours) != (name in theirs) for name in WHAT):
        return [], 0
    keys = sorted(ours & theirs)
    ours, theirs = one.values(column, keys), other.values(column, keys)
    wrong, common = [], 0
    for place in ours.keys() & theirs.keys():
        few, many = sorted((ours[place], theirs[place]), key=len)
        if not few and (few is ours[place] or not missing):
            continue
        common += 1
        if not few or any(not _among(value, many) for value in few):
            at = ", ".join(f"{name} {word}" for name, word in zip(keys, place, strict=True))
            wrong.append(f"{sorted(ours[place])[:3]} and {sorted(theirs[place])[:3]} at {at}")
    return wrong, common


def _among(value, values):
    return any(math.isclose(value, other, rel_tol=DIGITS) for other in values)


def between_tables(tables):
    """Columns that two tables have, how often they are compared, and their different values."""
    for one, other in itertools.combinations(tables, 2):
        for column in one.keys_of.keys() & other.keys_of.keys():
            wrong, common = differing(one, other, column)
            yield column, common, [f"{column}: {one.source}, {other.source}: {w}" for w in wrong]


def against_the_atlas(tables, stages):
    """The same of columns and the stage of the atlas that agrees best of those with their name."""
    for table in tables:
        for column in table.keys_of:
            found = [
                (*differing(table, stage, column, missing=True), stage.source)
                for stage in stages.get(column, ())
                if {*stage.rows.columns} <= {*table.rows.columns}
            ]
            found = [one for one in found if one[1]]
            if found:
                wrong, common, source = min(found, key=lambda one: len(one[0]))
                yield column, common, [f"{column}: {table.source}, {source}: {w}" for w in wrong]
