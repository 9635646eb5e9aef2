"""Surfaces: measured specimens, their cleaning and window, and synthetic ones."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "STEEP_TILT": ".specimen",
        "band_limited": ".synthesis",
        "band_slope": ".synthesis",
        "cantor_punch": ".known_dimension",
        "cell_side": ".specimen",
        "disc_outline": ".synthesis",
        "extruded": ".known_dimension",
        "faces": ".specimen",
        "find_outliers": ".cleaning",
        "grid_side": ".synthesis",
        "hole_free_square": ".window",
        "largest_offset": ".specimen",
        "levelled": ".synthesis",
        "make_specimen": ".specimen",
        "nominal_area": ".specimen",
        "overlap_statistics": ".suspect",
        "random_midpoint": ".known_dimension",
        "self_affine": ".synthesis",
        "spacing_of": ".grid",
        "weierstrass_mandelbrot": ".known_dimension",
        "window_sides": ".specimen",
        "window_slices": ".specimen",
    },
)
