"""Contact states of a specimen as text: numbers, contact domains and fields for the explorer.

Numbers are float64, contact domains bits, pressures float32: what the page shows is what the atlas
holds. The gap alone is rounded, to a thousandth of the largest. All is little-endian, deflated,
and in base64.
"""

import base64
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..domain.count_law import LawTerms, law_count
from ..mechanics.overlap import overlapping_nodes, suspect_nodes
from ..surface.specimen import cell_side

#: Order of the dimensions of all that is packed; one-dimensional coordinates stand apart.
ORDER = (
    "rigid_direction",
    "rigid_offset",
    "direction",
    "offset",
    "resolution",
    "normal_force",
    "scale",
    "mean_scale",
)
#: Quantities of a state, by stage: the rows of the page's table, in their order.
STATE = (
    ("closure", "closure"),
    ("closure", "interface_closure"),
    ("closure", "seated_closure"),
    ("closure", "separation"),
    ("dilatancy", "elastic_dilatancy"),
    ("closure", "area"),
    ("closure", "area_share"),
    ("closure", "area_corrected_share"),
    ("closure", "nodes"),
    ("closure", "stiffness"),
    ("closure", "interface_stiffness"),
    ("domains", "delta_sigma"),
    ("domains", "delta_sigma_ordinary"),
    ("scaling", "delta_sigma_area"),
    ("scaling", "sigma_star"),
    ("domains", "clusters"),
    ("domains", "largest_share"),
    ("closure", "suspect_load_share"),
    ("closure", "residual"),
)
#: What the curves need besides.
CURVES = (
    ("closure", "solved"),
    ("closure", "resolved"),
    ("closure", "area_corrected"),
    ("closure", "area_corrected_resolved"),
    ("closure", "offset_made"),
    ("dilatancy", "rigid_dilatancy"),
    ("domains", "box_side"),
    ("domains", "box_count"),
    ("domains", "ordinary_used"),
    ("domains", "mean_side"),
    ("domains", "mean_count"),
)
#: Ends of intervals and error bounds, where a quantity has them. Those of `delta_sigma_area` have
#: the names of the estimate by areas itself.
BOUNDS = ("_low", "_high", "_error")
BOUNDS_OF_AREA = {"_low": "delta_sigma_low", "_high": "delta_sigma_high"}
#: Why a number of a state is missing: row of the table, and stage and variable that say so.
REASONS = {
    "domains/delta_sigma": ("domains", "reason"),
    "closure/stiffness": ("closure", "interface_stiffness_reason"),
    "closure/interface_stiffness": ("closure", "interface_stiffness_reason"),
}
#: Of the texts: 9 takes ten times as long, for a page smaller by a fortieth.
COMPRESSION = 5
#: Steps that the largest gap of a specimen has; the code after the last stands for a missing gap.
GAP_STEPS = 1000
#: Gaps that a page may hold of one specimen; of a larger window only those under the map load.
MOST_GAPS = 2_000_000


def packed(values: np.ndarray) -> str:
    """Numbers as deflated bytes in base64, all first bytes before all second ones."""
    values = np.ascontiguousarray(values)
    planes = values.reshape(-1).view(np.uint8).reshape(values.size, values.itemsize).T
    return _text(planes.tobytes())


def packed_bits(cells: np.ndarray) -> str:
    """Truth values as deflated bits in base64, rows of the last axis filled up to whole bytes."""
    return _text(np.packbits(cells, axis=-1).tobytes())


def _text(data: bytes) -> str:
    return base64.b64encode(zlib.compress(data, COMPRESSION)).decode("ascii")


@dataclass
class _Numbers:
    """Arrays of one specimen, one after the other."""

    parts: list[np.ndarray]
    entries: dict[str, dict[str, Any]]

    def add(self, stage: str, variable: str, data: xr.DataArray, key: str = "") -> None:
        """Add an array under ``key``, by default stage/variable, its dimensions in ``ORDER``."""
        data = data.transpose(*(name for name in ORDER if name in data.dims))
        self.entries[key or f"{stage}/{variable}"] = {
            "stage": stage,
            "variable": variable,
            "units": data.attrs["units"],
            "meaning": data.attrs["long_name"],
            "dims": list(data.dims),
            "shape": list(data.shape),
            "start": sum(part.size for part in self.parts),
        }
        self.parts.append(np.ravel(data.values.astype("<f8")))

    def text(self) -> str:
        return packed(np.concatenate(self.parts))


def packed_states(atlas: xr.DataTree, name: str) -> dict[str, Any]:
    """All contact states of a specimen, as JSON can hold them.

    Parameters
    ----------
    atlas : xr.DataTree
        From :func:`study.atlas.read_atlas`, with the stages of one specimen.
    name : str
        The specimen; it has a group in the stage ``closure``.

    Returns
    -------
    dict
        Coordinates (`direction`, `offset`, `resolution`, `normal_force`, `nominal_pressure`,
        `rigid_direction`, `rigid_offset`), `arrays` (stage, variable, units, meaning, dims, shape,
        start of each in `numbers`), `numbers` (text), `reasons`, `window`, `domains` (text by
        resolution, direction and offset), `marks` and `fields`.
    """
    stages = {
        stage: atlas[f"{stage}/{name}"].to_dataset()
        for stage in ("closure", "dilatancy", "domains", "scaling", "contact", "specimens")
    }
    stages["dilatancy"] = stages["dilatancy"].rename(
        {"direction": "rigid_direction", "contact_direction": "direction"}
    )
    closure = stages["closure"]
    numbers = _Numbers([], {})
    for stage, variable in (*STATE, *CURVES):
        _add_with_bounds(numbers, stages[stage], stage, variable)
    numbers.add("domains", "delta_sigma", _law(stages["domains"]), key="law_count")
    return {
        **{
            key: closure[key].values.tolist()
            for key in ("direction", "offset", "resolution", "normal_force", "nominal_pressure")
        },
        **{
            key: stages["dilatancy"][key].values.tolist()
            for key in ("rigid_direction", "rigid_offset")
        },
        "rows": [f"{stage}/{variable}" for stage, variable in STATE],
        "reasons": {
            row: _reasons(stages[stage][variable]) for row, (stage, variable) in REASONS.items()
        },
        "totals": _totals(atlas, name, numbers),
        "arrays": numbers.entries,
        "numbers": numbers.text(),
        "window": _window(stages["contact"], stages["specimens"]),
        "domains": _domains(stages["contact"]),
        "marks": _marks(atlas[f"joints/{name}"].to_dataset(), stages["specimens"]),
        "fields": _fields(stages["contact"]),
    }


def _add_with_bounds(numbers, dataset, stage, variable):
    numbers.add(stage, variable, dataset[variable])
    for ending in BOUNDS:
        other = f"{variable}{ending}"
        if variable == "delta_sigma_area":
            other = BOUNDS_OF_AREA.get(ending, "")
        if other in dataset:
            numbers.add(stage, other, dataset[other], key=f"{stage}/{variable}{ending}")


def _law(domains):
    """Box counts by the count law over the sizes of the mean counts; NaN beyond its fit."""
    side, dimension = domains["mean_side"], domains["delta_sigma"]
    terms = LawTerms(*(domains[f"law_{field}"] for field in LawTerms._fields))
    kept = (side >= domains["fit_min"] * (1 - 1e-9)) & (side <= domains["fit_max"] * (1 + 1e-9))
    with np.errstate(invalid="ignore"):
        counts = xr.apply_ufunc(
            lambda r, d, *t: law_count(r, d, LawTerms(*t)), side, dimension, *terms
        )
    return counts.where(kept).assign_attrs(
        units="1", long_name="box counts by the law that Delta_sigma is fitted with"
    )


def _reasons(words: xr.DataArray) -> dict[str, Any]:
    """Words of states as places in a list of the different ones, in ``ORDER``."""
    words = words.transpose(*(name for name in ORDER if name in words.dims))
    different, places = np.unique(words.values.astype(str).ravel(), return_inverse=True)
    return {"words": different.tolist(), "places": places.tolist()}


def _totals(atlas, name, numbers):
    """Errors of all sources at the offset of the maps, by the quantity that has them."""
    if "error_budget" not in atlas.children or name not in atlas["error_budget"].children:
        return None
    budget = atlas[f"error_budget/{name}"].to_dataset()
    keys = {
        "closure": "closure/interface_closure",
        "separation": "closure/separation",
        "area_corrected": "closure/area_corrected",
        "stiffness": "closure/interface_stiffness",
        "delta_sigma": "domains/delta_sigma",
    }
    for quantity in budget["quantity"].values.tolist():
        total = budget["total"].sel(quantity=quantity, drop=True)
        total.attrs["units"] = str(budget["unit"].sel(quantity=quantity).item())
        numbers.add("error_budget", "total", total, key=f"total/{keys[quantity]}")
    return {
        "direction": str(budget.attrs["direction"]),
        "offset": float(budget.attrs["offset_mm"]),
        "resolution": int(budget.attrs["resolution"]),
    }


def _window(contact, specimen):
    """Nodes of the window at the finest resolution: numbers, spacings and first places, mm."""
    finest = int(contact["resolution"].values.min())
    y, x = (contact[f"{axis}_{finest}"].values for axis in "yx")
    return {
        "shape": [int(specimen.attrs[f"window_n{axis}"]) for axis in "yx"],
        "spacing": [float(specimen.attrs[f"spacing_{axis}"]) for axis in "yx"],
        "first": [float(y[0]), float(x[0])],
        "cell_side": cell_side(specimen),
    }


def _domains(contact):
    """Contact domains under all loads as bits, by resolution, direction and offset; "" if none."""
    domains = {}
    for factor in contact["resolution"].values.tolist():
        field = contact[f"in_contact_{factor}"]
        field = field.transpose("direction", "offset", "normal_force", ...).values
        domains[factor] = {
            "shape": list(field.shape[-2:]),
            "bits": [
                [packed_bits(states == 1) if (states >= 0).any() else "" for states in offsets]
                for offsets in field
            ],
        }
    return domains


def _marks(joint, specimen):
    """Nodes on overlapping faces, and on otherwise suspicious cells, as bits by direction, offset.

    None where there is neither.
    """
    marks = {"overlap": [], "suspect": []}
    for direction in joint["contact_direction"].values.tolist():
        cells = joint["offset_cells"].sel(contact_direction=direction).values.tolist()
        overlap = [overlapping_nodes(specimen, direction, n) for n in cells]
        suspect = [suspect_nodes(specimen, direction, n) for n in cells]
        marks["overlap"].append(overlap)
        marks["suspect"].append([s & ~o for s, o in zip(suspect, overlap, strict=True)])
    if not any(_flat(cells) for cells in marks.values()):
        return None
    return {
        kind: [[packed_bits(cells) if cells.any() else "" for cells in row] for row in rows]
        for kind, rows in marks.items()
    }


def _flat(rows: Iterable) -> bool:
    return any(cells.any() for row in rows for cells in row)


def _fields(contact):
    """Pressure and gap where they are stored: the place, the loads, the values as text."""
    if "map_pressure" not in contact:
        return None
    fields: dict[str, Any] = {
        "direction": str(contact.attrs["map_direction"]),
        "offset": float(contact.attrs["map_offset"]),
        "resolution": int(contact.attrs["map_resolution"]),
        "normal_force": float(contact.attrs["map_load"]),
    }
    for kind, pack in (("pressure", _pressures), ("gap", _gaps)):
        data = contact[f"map_{kind}"].transpose("normal_force", ...)
        loads = np.flatnonzero(np.isfinite(data.values).any(axis=(1, 2)))
        if kind == "gap" and data[loads].size > MOST_GAPS:
            forces = data["normal_force"].values[loads]
            loads = loads[[np.abs(forces - fields["normal_force"]).argmin()]]
        of_kind = {"units": data.attrs["units"], "loads": loads.tolist()}
        fields[kind] = of_kind | (pack(data.values[loads]) if loads.size else {})
    return fields


def _pressures(values):
    return {
        "largest": float(np.nanmax(values)),
        "data": [packed(state.astype("<f4")) for state in values],
    }


def _gaps(values):
    """Steps of each gap less those of the node West of it: smooth fields deflate better."""
    step = float(np.nanmax(values)) / GAP_STEPS or 1.0
    missing = ~np.isfinite(values)
    steps = np.where(missing, GAP_STEPS + 1, np.rint(np.clip(values, 0, None) / step))
    changes = np.diff(steps.astype("<u2"), axis=-1, prepend=np.uint16(0))
    return {
        "largest": float(np.nanmax(values)),
        "step": step,
        "missing": GAP_STEPS + 1,
        "data": [packed(state.astype("<u2")) for state in changes],
    }
