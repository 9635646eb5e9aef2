"""Canvas that prints a line of words as one picture, and writes the figure without transparency.

Matplotlib renders the letters of a text one by one and lays the line out three times (for its size,
for the picture, for the vectors), which takes a fourth of the time of a figure.
"""

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg, get_hinting_flag
from matplotlib.backends.backend_mixed import MixedModeRenderer
from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.font_manager import FontProperties, fontManager, get_font
from matplotlib.ft2font import RenderMode

from ...core.png import png

#: Compression level of the PNG: lower levels save no time, higher ones take twice as long.
COMPRESSION = 3
#: Number of places within a pixel, along either side, at which a letter of a formula may begin.
_PHASES = 4
#: Points per inch, the unit of the vectors.
_POINTS = 72


class Canvas(FigureCanvasAgg):
    """Canvas of a figure, which keeps its renderer while the size stays the same."""

    _size: tuple[float, ...] = ()

    def get_renderer(self) -> RendererAgg:
        """Renderer that measures and draws the figure."""
        size = (*self.get_width_height(physical=True), self.figure.dpi)
        if size != self._size:
            self._size, self.renderer = size, _Renderer(*size)
        return self.renderer

    def write_png(self, path: Path | str) -> None:
        """Draw the figure, and write its picture."""
        self.draw()
        picture = np.asarray(self.buffer_rgba())[..., :3]
        Path(path).write_bytes(png(picture, COMPRESSION, self.figure.dpi))

    def write_svg(self, path: Path | str) -> None:
        """Draw the figure as vectors. The file has no date: the same figure is the same file."""
        resolution = self.figure.dpi
        width, height = self.figure.get_size_inches()
        size = (_POINTS * width, _POINTS * height)
        self.figure.dpi = _POINTS
        try:
            with open(path, "w", encoding="utf-8") as file:
                vectors = _Vectors(*size, file, image_dpi=resolution, metadata={"Date": None})
                # Maps and panels of many points are pixels in the SVG too.
                mixed: Any = MixedModeRenderer(self.figure, width, height, resolution, vectors)
                self.figure.draw(mixed)
                mixed.finalize()
        finally:
            self.figure.dpi = resolution


class _Vectors(RendererSVG):
    """Vectors whose words have the sizes that they have in the PNG, which is drawn before."""

    def get_text_width_height_descent(self, s, prop, ismath):
        if ismath:
            size = self._text2path.mathtext_parser.parse(s, self.image_dpi, prop)[:3]
        else:
            _, _, size = _printed(s, prop, self.image_dpi)
        return tuple(length * _POINTS / self.image_dpi for length in size)


class _Renderer(RendererAgg):
    def get_text_width_height_descent(self, s, prop, ismath):
        if ismath:
            return super().get_text_width_height_descent(s, prop, ismath)
        _, _, size = _printed(s, prop, self.dpi)
        return size

    def draw_text(self, gc, x, y, s, prop, angle, ismath=False, mtext=None):
        if ismath or angle:
            super().draw_text(gc, x, y, s, prop, angle, ismath, mtext)
            return
        picture, (right, down), (_, _, descent) = _printed(s, prop.copy(), self.dpi)
        # The picture lies on whole pixels, because the font's hints put the stems of letters there.
        place = round(x + right), round(y + down + descent) + 1
        self._renderer.draw_text_image(picture, *place, 0, gc)

    def _draw_text_glyphs_and_boxes(self, gc, x, y, angle, glyphs, boxes):
        """Letters one by one: of formulas, and of words that are turned."""
        x, y = round(x), round(y)
        cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        for face, size, index, _, _, along, up in glyphs:
            place = along * cos - up * sin, along * sin + up * cos
            (column, right), (row, above) = (
                divmod(round(_PHASES * coordinate), _PHASES) for coordinate in place
            )
            picture, left, top = _letter(face, size, self.dpi, index, angle, right, above)
            self._renderer.draw_text_image(
                picture, x + column + left, y - row - top + len(picture), 0, gc
            )
        super()._draw_text_glyphs_and_boxes(gc, x, y, angle, [], boxes)


@lru_cache(8192)
def _letter(face, size: float, dpi: float, index: int, angle: float, right: int, above: int):
    """Picture of a letter at a phase right of and above a pixel, with its left and top."""
    face.set_size(size, dpi)
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = (2**16 * np.array([[cos, -sin], [sin, cos]])).round().astype(int)
    face._set_transform(turn, [64 * right // _PHASES, 64 * above // _PHASES])
    letter = face._render_glyph(index, get_hinting_flag(), RenderMode.NORMAL)
    return np.array(letter.buffer), letter.left, letter.top


@lru_cache(2048)
def _printed(words: str, font: FontProperties, dpi: float):
    """Picture of a line of words, its place in pixels, and the line's width, height and descent."""
    face = get_font(fontManager._find_fonts_by_props(font))
    face.clear()
    face.set_size(font.get_size_in_points(), dpi)
    face.set_text(words, 0.0, flags=get_hinting_flag())
    face.draw_glyphs_to_bitmap()
    size = (*np.array(face.get_width_height()) / 64, face.get_descent() / 64)
    return np.array(face.get_image()), np.array(face.get_bitmap_offset()) / 64, size
