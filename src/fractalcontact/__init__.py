"""Contact, closure, dilatancy and size effect of rough cracks, from profilometer scans.

``docs/library.md`` has an example of each name. What it takes to compute anything is imported when
it is first asked for.
"""

from .core.lazy import exports

__version__ = "0.1.0"

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "BoxDimension": ".domain.box_dimension",
        "ContactState": ".contact.state",
        "HalfSpace": ".elastic.halfspace",
        "Hyperbola": ".mechanics.closure_laws",
        "InputError": ".core.errors",
        "NotConverged": ".core.errors",
        "bulk_settlement": ".mechanics.closure",
        "best_dimension": ".roughness.recommended",
        "box_dimension": ".domain.box_dimension",
        "fit_hyperbola": ".mechanics.closure_laws",
        "interface_closure": ".mechanics.closure",
        "open_atlas": ".study.atlas_parts",
        "read_atlas": ".study.atlas",
        "read_faces": ".scan.read",
        "read_scan": ".scan.read",
        "self_affine": ".surface.synthesis",
        "solve_contact": ".contact.solve",
        "surface_dimension": ".roughness.dimension",
    },
    rooms=(
        "accuracy",
        "commands",
        "contact",
        "core",
        "domain",
        "elastic",
        "experiments",
        "figures",
        "mechanics",
        "methods",
        "pages",
        "roughness",
        "scan",
        "size_effect",
        "stages",
        "statements",
        "study",
        "surface",
    ),
)
