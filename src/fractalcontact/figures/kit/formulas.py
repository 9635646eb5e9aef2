"""Formulas read once, and scaled to the sizes and resolutions they are drawn at."""

import contextlib
from collections.abc import Iterator
from functools import lru_cache
from math import ceil

from matplotlib import font_manager
from matplotlib.font_manager import FontProperties
from matplotlib.mathtext import MathTextParser, VectorParse

#: Size of the letters in which formulas are read, points, and pixels per inch. Rounding to pixels
#: is negligible at this size.
_SIZE, _DPI = 1000.0, 72.0
_READER, _read = MathTextParser("path"), MathTextParser.parse
_NAMES = "ttfFontProperty"
_font_names = lru_cache(100)(getattr(font_manager, _NAMES))


@contextlib.contextmanager
def formulas_read_once() -> Iterator[None]:
    """Every formula read once within the block, not once for each of its sizes.

    Matplotlib takes some milliseconds for each, and reads it for the PNG, for its size in the SVG
    and for the SVG itself.
    """
    # The SVG asks for the name of the font of every letter, so that names are cached too.
    places = ((MathTextParser, "parse", _read_or_remember), (font_manager, _NAMES, _font_names))
    before = [(place, name, getattr(place, name)) for place, name, _ in places]
    for place, name, function in places:
        setattr(place, name, function)
    try:
        yield
    finally:
        for place, name, function in before:
            setattr(place, name, function)


def _read_or_remember(parser, s, dpi=72, prop=None, *, antialiased=None):
    if parser._output_type != "vector":
        return _read(parser, s, dpi, prop, antialiased=antialiased)
    font = FontProperties() if prop is None else prop.copy()
    size = font.get_size_in_points()
    font.set_size(_SIZE)
    return _scaled(_large(s, font), size / _SIZE, dpi / _DPI)


@lru_cache(1024)
def _large(formula, font):
    return _read(_READER, formula, _DPI, font)


def _scaled(large: VectorParse, points: float, pixels: float) -> VectorParse:
    """A formula in letters of another size, on pixels of another size."""
    by = points * pixels
    glyphs = [
        (face, points * size, code, index, by * x, by * y)
        for face, size, code, index, x, y in large.glyphs
    ]
    rectangles = [(by * x, by * y, by * width, by * height) for x, y, width, height in large.rects]
    width, height, depth = (ceil(by * length) for length in large[:3])
    return VectorParse(width, height, depth, glyphs, rectangles)
