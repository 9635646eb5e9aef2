"""Scan files of any kind as heights (y, x) in mm, with missing cells and provenance."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "known_extensions": ".formats",
        "read_faces": ".read",
        "read_matrix": ".read",
        "read_scan": ".read",
    },
)
