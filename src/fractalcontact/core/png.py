"""Pictures as PNG whose rows are compressed as they are.

Other writers try five filters on every row for the one after which it compresses best (W3C, "PNG
Specification", section 9). Lines and words on white, as maps of few colours, do so without any:
trying them takes half of the time, for files no smaller.
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
        Of compression, 1 to 9.
    dpi : float, optional
        Pixels of an inch, where the file is to say so.
    """
    ny, nx, colours = np.atleast_3d(picture).shape
    kind = {1: 0, 3: 2}[colours]
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", nx, ny, 8, kind, 0, 0, 0))]
    if dpi:
        of_metre = round(dpi / 0.0254)
        chunks.append((b"pHYs", struct.pack(">IIB", of_metre, of_metre, 1)))
    # Before each row the number of its filter, which is none.
    rows = np.zeros((ny, 1 + nx * colours), np.uint8)
    for colour in range(colours):  # each at once: pixel by pixel numpy takes six times as long
        rows[:, 1 + colour :: colours] = np.atleast_3d(picture)[..., colour]
    chunks += [(b"IDAT", zlib.compress(rows.tobytes(), level)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks
    )
