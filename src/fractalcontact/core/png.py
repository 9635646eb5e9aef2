"""Pictures as PNG whose rows are compressed without filters.

Other writers try five filters on every row for the best compression (W3C, "PNG
Specification", section 9). Lines and words on white, and maps of few colours, compress as well
without any: trying them takes half of the time, for files no smaller.
"""

import struct
import zlib

import numpy as np


def png(picture: np.ndarray, level: int, dpi: float | None = None) -> bytes:
    """PNG of a picture.

    Parameters
    ----------
    picture : (ny, nx) or (ny, nx, 3) ndarray of uint8
        Grey levels, or red, green and blue; row 0 at the top.
    level : int
        Compression, 1 to 9.
    dpi : float, optional
        Pixels per inch, if the file is to state it.
    """
    ny, nx, colours = np.atleast_3d(picture).shape
    kind = {1: 0, 3: 2}[colours]
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", nx, ny, 8, kind, 0, 0, 0))]
    if dpi:
        of_metre = round(dpi / 0.0254)
        chunks.append((b"pHYs", struct.pack(">IIB", of_metre, of_metre, 1)))
    # Each row begins with the number of its filter: 0, no filter.
    rows = np.zeros((ny, 1 + nx * colours), np.uint8)
    for colour in range(colours):  # colour by colour: pixel by pixel takes numpy six times as long
        rows[:, 1 + colour :: colours] = np.atleast_3d(picture)[..., colour]
    chunks += [(b"IDAT", zlib.compress(rows.tobytes(), level)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
