"""Contact states of a specimen as text: numbers, contact domains and fields for the explorer.

Numbers are float64, contact domains bits, pressures float32: what the page shows is what the atlas
holds. The gap alone is rounded, to a thousandth of the largest. All is little-endian, deflated,
and in base64.
"""

import base64
import math
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..core.determined import decided_by_scan
from ..core.estimate import DIMENSION, Estimate, names_of
from ..core.labels import cf_attrs
from ..core.subject import Subject
from ..core.window import cell_side
from ..report.published import shown_in, total_of

#: Order of the dimensions of packed arrays; one-dimensional coordinates stand apart.
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
#: Reason why a state has no flow.
NO_FLOW = "computed at the reported offset alone, or has no path"
#: Variables that the curves need besides the rows of the register.
CURVES = (
    ("closure", "solved"),
    ("closure", "resolved"),
    ("closure", "area_corrected"),
    ("closure", "area_corrected_resolved"),
    ("closure", "offset_on_grid"),
    ("dilatancy", "rigid_dilatancy"),
    ("domains", "box_side"),
    ("domains", "box_count"),
    ("domains", "ordinary_used"),
    ("domains", "mean_side"),
    ("domains", "mean_count"),
)
#: Ends of intervals and error bounds, where a quantity has them.
BOUNDS = ("_low", "_high", "_error")
#: Level of compression: level 9 takes ten times as long for a page smaller by a fortieth.
COMPRESSION = 5
#: Steps of the largest gap of a specimen; the code after the last is a missing gap.
GAP_STEPS = 1000
#: Most gaps of one specimen on a page; of a larger window only the reference load is kept.
MAX_GAPS = 2_000_000


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

    ``numbers`` is the text of all arrays; ``arrays`` has the stage, variable, units, meaning,
    dimensions, shape and start of each in it. Arrays called ``total/ROW`` are errors of all
    sources, of which ``most`` has the largest, as a fraction of the number, that determines a row;
    ``undetermined/ROW``, for the rows ``of_joint`` ``undetermined/by_scan`` and for those
    ``of_touch`` ``undetermined/at_touch`` say where the pages call a number undetermined.
    ``domains`` are texts by resolution, direction and offset.
    """
    subject = Subject.of(atlas, name)
    stages = dict(subject.stages)
    stages["dilatancy"] = stages["dilatancy"].rename(
        {"direction": "rigid_direction", "contact_direction": "direction"}
    )
    closure = stages["closure"]
    stages["flow"] = _of_all_states(subject)
    numbers = _Numbers([], {})
    rows = shown_in("explorer")
    for stage, variable in (*((row.stage, row.variable) for row in rows), *CURVES):
        _add_with_bounds(numbers, stages[stage], stage, variable)
    numbers.add("domains", "law_count", stages["domains"]["law_count"], key="law_count")
    _add_undetermined(numbers, stages)
    return {
        **{
            key: closure[key].values.tolist()
            for key in ("direction", "offset", "resolution", "normal_force", "nominal_pressure")
        },
        **{
            key: stages["dilatancy"][key].values.tolist()
            for key in ("rigid_direction", "rigid_offset")
        },
        "rows": [row.source for row in rows],
        "of_joint": [row.source for row in rows if row.by_scan],
        "of_touch": [row.source for row in rows if row.from_touch],
        "most": {row.source: row.most for row in rows if math.isfinite(row.most)},
        "reasons": _reasons(stages),
        "totals": _totals(subject, numbers),
        "arrays": numbers.entries,
        "numbers": numbers.text(),
        "window": _window(stages["contact"], stages["specimens"]),
        "domains": _domains(stages["contact"]),
        "marks": _marks(stages["contact"]),
        "fields": _fields(stages["contact"], subject["flow"]),
    }


def _of_all_states(subject: Subject) -> xr.Dataset:
    """Flow over all states, with reasons; it is missing but at the reported offset."""
    reported, closure, flow = subject.reported, subject["closure"], subject["flow"]
    rows = [row for row in shown_in("explorer") if row.stage == "flow"]
    reasons = {row.reason.partition("/")[2] for row in rows if row.reason}
    # With the ends of their intervals, as the page of the specimen has them.
    shown = [of for row in rows for of in names_of(row.variable) if of in flow]
    flow = flow[[*shown, *sorted(reasons)]].expand_dims(
        direction=[reported.direction],
        offset=[reported.offset],
        resolution=[reported.resolution],
    )
    states = {name: closure[name] for name in ("direction", "offset", "resolution")}
    return flow.reindex(states, fill_value=dict.fromkeys(reasons, NO_FLOW))


def _add_with_bounds(numbers, dataset, stage, variable):
    numbers.add(stage, variable, dataset[variable])
    for ending in BOUNDS:
        other = f"{variable}{ending}"
        if other in dataset:
            numbers.add(stage, other, dataset[other], key=f"{stage}/{variable}{ending}")


def _add_undetermined(numbers, stages):
    """Add masks of undetermined numbers: by the scan, or by the interval."""
    by_scan = decided_by_scan(stages["closure"]["suspect_load_share"])
    attrs = cf_attrs("1", "whether suspicious cells of the scans decide what follows from contact")
    numbers.add("closure", "", by_scan.assign_attrs(attrs), key="undetermined/by_scan")
    lightest = stages["closure"]["closure"].notnull().argmax("normal_force")
    at_touch = by_scan.isel(normal_force=lightest).broadcast_like(by_scan)
    attrs = cf_attrs("1", "whether first touch lies on suspicious cells of the scans")
    numbers.add("closure", "", at_touch.assign_attrs(attrs), key="undetermined/at_touch")
    for row in (row for row in shown_in("explorer") if row.dimension):
        says = xr.apply_ufunc(
            lambda *ends: Estimate(*ends, scale=DIMENSION).determined,
            *(stages[row.stage][name] for name in names_of(row.variable)),
            vectorize=True,
        )
        attrs = cf_attrs("1", "whether its interval is too wide to be of use")
        numbers.add(row.stage, "", (~says).assign_attrs(attrs), key=f"undetermined/{row.source}")


def _reasons(stages):
    """Reason why a number of a solved state is missing, as on the result page."""
    words = {}
    for row in shown_in("explorer"):
        stage, _, variable = row.reason.partition("/")
        if row.reason:
            words[row.source] = stages[stage][variable]
        elif row.why or row.stage == "flow":
            values = stages[row.stage][row.variable]
            words[row.source] = xr.where(
                np.isfinite(values), "", row.missing if row.why else NO_FLOW
            )
    return {key: _listed(of_states) for key, of_states in words.items()}


def _listed(words: xr.DataArray) -> dict[str, Any]:
    """Words of states as places in a list of the different ones, in ``ORDER``."""
    words = words.transpose(*(name for name in ORDER if name in words.dims))
    different, places = np.unique(words.values.astype(str).ravel(), return_inverse=True)
    return {"words": different.tolist(), "places": places.tolist()}


def _totals(subject, numbers):
    """Errors of all sources at the offset of the maps, by the quantity that has them."""
    budget = subject["error_budget"]
    slides = budget.attrs["direction"] != "none"
    for row in shown_in("explorer"):
        total = total_of(row, subject)
        if total is None or (row.stage == "dilatancy" and not slides):
            continue
        total = total.assign_attrs(cf_attrs(row.unit, "error of all sources"))
        numbers.add("error_budget", "total", total, key=f"total/{row.source}")
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
    """Contact domains under all loads as bits, by resolution, direction and offset, or ""."""
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


def _marks(contact):
    """Nodes on overlapping faces, and on otherwise suspicious cells, as bits by direction, offset.

    None where there is neither.
    """
    marks = contact["node_mark"].transpose("direction", "offset", ...).values
    if not marks.any():
        return None
    return {
        kind: [
            [packed_bits(cells == mark) if (cells == mark).any() else "" for cells in row]
            for row in marks
        ]
        for kind, mark in (("overlap", 2), ("suspect", 1))
    }


def _fields(contact, flow):
    """Pressure, gap and flow where they are stored: the place, the loads, the values as text."""
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
        if kind == "gap" and data[loads].size > MAX_GAPS:
            forces = data["normal_force"].values[loads]
            loads = loads[[np.abs(forces - fields["normal_force"]).argmin()]]
        of_kind = {"units": data.attrs["units"], "loads": loads.tolist()}
        fields[kind] = of_kind | (pack(data.values[loads]) if loads.size else {})
    forces = contact["normal_force"].values
    reference = int(np.abs(forces - fields["normal_force"]).argmin())
    flux = flow["flux_map_along"].values[np.newaxis]
    is_open = bool(np.nansum(flux) > 0)
    fields["flow"] = {"units": "times the mean", "loads": [reference] * is_open}
    # Rounded to 0.4 %: the digits below are noise that does not deflate.
    rounded = (flux.astype("<f4").view("<u4") + 0x8000 & 0xFFFF0000).view("<f4")
    fields["flow"] |= _pressures(rounded) if is_open else {}
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
