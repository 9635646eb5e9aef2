"""Surfaces: measured specimens, their cleaning and window, and synthetic ones."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "STEEP_TILT": ".specimen",
        "cell_side": ".specimen",
        "disc_outline": ".synthesis",
        "faces": ".specimen",
        "find_outliers": ".cleaning",
        "hole_free_square": ".window",
        "largest_offset": ".specimen",
        "make_specimen": ".specimen",
        "nominal_area": ".specimen",
        "self_affine": ".synthesis",
        "spacing_of": ".grid",
        "window_sides": ".specimen",
        "window_slices": ".specimen",
    },
)
