"""Laboratory tests that differ from the computed curves of a specimen by a part of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from made_stages import given

from fractalcontact.core.keys import validate
from fractalcontact.measured.stage import measured_stage
from fractalcontact.study.laboratory_keys import Tests
from fractalcontact.study.laboratory_tests import resolve_tests

#: Measured over computed.
PART = 0.9


def computed_and_read(table):
    """Rows of a figure's table that are computed, and those of laboratory tests."""
    read = table.filter(regex="_test$").notna().any(axis=1)
    return table[~read], table[read]


def stated_tests(stated, where, folder):
    """Laboratory tests as a sidecar states them under ``measured``, checked by its classes."""
    return resolve_tests(validate(Tests, stated, where), where, Path(folder))


def with_tests(stages, settings, solver, folder):
    """Settings and stages of a specimen that slides, with a test of each kind in a folder."""
    direction = settings.contact_directions[0]
    at = {"direction": direction, "resolution": settings.resolutions[0]}
    closure = stages["closure"].sel(at).sel(offset=settings.map_offset, method="nearest")
    along = {"contact_direction": direction}
    strength = stages["strength"].sel(along)
    load = int(np.flatnonzero(stages["closure"]["reported_load"].values)[0])
    held = f"{float(closure['nominal_pressure'][load]):.12g} MPa"
    dilatancy = stages["dilatancy"].sel(along).isel(normal_force=load)
    shear = strength.isel(normal_force=load)
    pressure = closure["nominal_pressure"].values
    closing = closure["interface_closure"].where(closure["resolved"]).values
    flow = stages["flow"]["branch_transmissivity_along"].sel(branch="load").values
    curves = {
        "closure": (pressure, closing),
        "flow": (pressure, flow),
        "dilatancy": (dilatancy["offset_on_grid"].values, dilatancy["elastic_dilatancy"].values),
        "shear": (shear["midpoint"].values, shear["shear_strength"].values),
        "strength": (pressure, strength["peak_strength"].values),
    }
    heads = {
        "closure": "pressure [MPa], displacement [mm]",
        "flow": "pressure [MPa], transmissivity [mm3]",
        "dilatancy": "displacement [mm], dilation [mm]",
        "shear": "displacement [mm], shear_stress [MPa]",
        "strength": "pressure [MPa], shear_strength [MPa]",
    }
    slid = {"pressure": held, "direction": direction}
    stated = {
        "closure": {"gauge": "joint", "seat": "0.25 MPa", "branch": "load", "cycle": 1},
        "flow": {"way": "along", "branch": "load", "cycle": 1},
        "dilatancy": slid,
        "shear": slid,
        "strength": {"direction": direction},
    }
    for kind, (x, y) in curves.items():
        known = np.isfinite(x) & np.isfinite(y)
        places = np.linspace(x[known][0], x[known][-1], 30)
        rows = zip(places, PART * np.interp(places, x[known], y[known]), strict=True)
        text = "\n".join([heads[kind], *(f"{a!s}, {b!s}" for a, b in rows)])
        Path(folder, f"{kind}.csv").write_text(text, encoding="utf-8")
        stated[kind] = stated[kind] | {"file": f"{kind}.csv"}
    settings = replace(settings, measured=stated_tests(stated, "made: measured", folder))
    needed = ("specimens", "joints", "closure", "dilatancy", "error_budget", "flow", "strength")
    sections = given(measured_stage, settings, solver)
    found = measured_stage(**{name: stages[name] for name in needed}, **sections)
    return settings, stages | found
