"""Scans read as the draft of their sidecar says, its empty lines filled: for tests of other things.

The draft that a refusal prints is completed by what a test states, and taken as it is.
"""

import yaml

from fractalcontact.core.errors import InputError
from fractalcontact.scan import read
from fractalcontact.scan.raw import IncompleteSidecar

#: What the writers of the tests mean, where a file does not say it.
FILLED = {"kind": "face", "decimal": ".", "columns": [0, 1, 2], "axes": "none",
          "first_row": "bottom", "heights": "up", "missing": "none"}  # fmt: skip


def drafted(path, options=None):
    """Options completed by the draft for this file."""
    options = dict(options or {})
    try:
        read.read_matrix(path, options)
    except IncompleteSidecar as error:
        draft = yaml.safe_load(error.draft)
        filled = {key: FILLED.get(key) if value is None else value for key, value in draft.items()}
        if filled.get("layout") == "points" and not (
            options.get("spacing") or draft.get("spacing")
        ):
            filled.pop("first_row", None)
        return {key: value for key, value in filled.items() if value is not None} | options
    except InputError:
        pass
    return options


def read_scan(path, options=None):
    """A scan by its drafted sidecar."""
    return read.read_scan(path, drafted(path, options))


def read_faces(lower, upper=None, options=None):
    """Two faces by the sidecar drafted for the lower one."""
    return read.read_faces(lower, upper, drafted(lower, options))


#: What the sidecar of an array of heights states, but for its unit and spacing.
ARRAY = {
    "kind": "face",
    "layout": "matrix",
    "axes": "none",
    "first_row": "bottom",
    "heights": "up",
    "missing": "none",
}
#: The same of an array of contact.
MAP = {"kind": "contact-map", "axes": "none", "first_row": "bottom", "missing": "none"}
#: How numbers between commas are written, without a header.
COMMAS = {"delimiter": "comma", "decimal": ".", "header": 0}
#: Three columns x, y and z in mm.
POINTS = {
    **COMMAS,
    "kind": "face",
    "layout": "points",
    "columns": [0, 1, 2],
    "unit": "mm",
    "heights": "up",
    "missing": "none",
}
#: Sidecars of real scans, by folder and file.
GRANITE = {**POINTS, "header": 2, "upper": {"header": 0}}
CORONA = {**ARRAY, "variable": "Z_grid", "unit": "m", "spacing": 0.005685771715431078}
NANOVEA = {**POINTS, "unit": None, "unit_xy": "mm", "unit_z": "um"}
NANOVEA.pop("unit")
SURFDIFF = {**POINTS, "header": 1, "columns": ["x", "y", "z"]}


def sidecar(stated, **keys):
    """Text of a sidecar."""
    return yaml.safe_dump({**stated, **keys}, sort_keys=False)


def array_sidecar(spacing, **keys):
    """Text of the sidecar of an array of heights in mm."""
    return sidecar(ARRAY, unit="mm", spacing=spacing, **keys)
