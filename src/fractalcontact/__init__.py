"""Contact, closure, dilatancy and size effect of rough cracks, from profilometer scans.

``docs/library.md`` has an example of each name. What it takes to compute anything is imported when
it is first asked for: to read the workflow, or one scan file, neither xarray, numba nor matplotlib
may be.
"""

import sys
from importlib import import_module
from typing import Any

__version__ = "1.0.0"

#: Module of each name.
_HOMES = {
    "BoxDimension": ".domain.box_dimension",
    "ContactState": "roughcontact.contact.state",
    "HalfSpace": "roughcontact.elastic.halfspace",
    "Hyperbola": ".laws.closure_laws",
    "InputError": ".core.errors",
    "NotConverged": "roughcontact.errors",
    "bulk_settlement": ".states.settlement",
    "best_dimension": ".roughness.recommended",
    "box_dimension": ".domain.box_dimension",
    "fit_hyperbola": ".laws.closure_laws",
    "interface_closure": ".states.settlement",
    "load_path": "roughcontact.contact.path",
    "open_atlas": ".study.atlas_parts",
    "read_atlas": ".study.atlas",
    "read_faces": ".scan.read",
    "read_scan": ".scan.read",
    "self_affine": ".surface.synthesis",
    "solve_contact": "roughcontact.contact.solve",
    "surface_dimension": ".roughness.dimension",
}
__all__ = sorted(_HOMES)


def __getattr__(name: str) -> Any:
    """Name of the package, imported at its first use."""
    if name not in _HOMES:
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message, name=name, obj=sys.modules[__name__])
    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
