"""Scan files of any kind as heights (y, x) in mm, with missing cells and provenance."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "Motion": ".surface_motion",
        "Surface": ".surface_motion",
        "coordinate_files": ".options",
        "grid_nodes": ".surface_motion",
        "known_extensions": ".formats",
        "motion_variables": ".registration_scatter",
        "read_coordinates": ".coordinates",
        "read_faces": ".read",
        "read_matrix": ".read",
        "read_scan": ".read",
        "scattered_motions": ".registration_scatter",
        "stored_motions": ".registration_scatter",
    },
)
