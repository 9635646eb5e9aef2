"""Tools shared by figures, which import this package alone: ``from .. import kit``."""

# ruff: noqa: F401  # names for the figures

from .axes import force_axis, offset_axis, second_axis, spacing_axis
from .caption import caption
from .domains import (
    RISES,
    contact_domain,
    departures,
    estimates_of,
    prefractals,
    rise_words,
    size_axes,
    spread_loads,
)
from .drawing import COLOURS, LINES, MARKERS, WEAK, WIDTH, Drawing, colour_of, spread
from .empty import TOO_FULL, different_reasons, missing_lines, say_empty
from .ensembles import draw_band, members_of
from .kappa import kappa_lines
from .laboratory import draw_tests, test_words
from .legends import entries, heading, legends_below, mark
from .maps import (
    HALO,
    MISSING,
    draw_domain,
    draw_map,
    enlargement,
    missing_patch,
    node_position,
    scan_extent,
    window_outline,
)
from .measured_maps import (
    draw_over_force,
    draw_series,
    measured_range,
    measured_series,
    threshold_words,
)
from .measured_maps import table_of as table_of_maps
from .panel import Panel, panels_of, rows, table_of
from .points import draw_points, hollow_entry, reach
from .relief import draw_faces
from .sizes import (
    BARS,
    NO_STRENGTH,
    SHIFTED,
    TRUNCATED,
    draw_bars,
    draw_over_size,
    logarithmic,
    name_exponents,
    plain_decades,
    roughness_words,
    series,
    size_axis,
)
from .titles import headline, letter
from .verdicts import claim, row_of, verdict_words
from .words import NOMINAL_PRESSURE, REAL_PRESSURE, TOWARDS, area_label, place, wrapped
