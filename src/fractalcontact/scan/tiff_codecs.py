"""Decoders of LZW and of predictor 3 for TIFF files, which GDAL and ArcGIS often write.

Source: TIFF 6.0, section 13, and Adobe's Photoshop TIFF Technical Note 3.
"""

from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError

_CLEAR, _END = 256, 257
_MIN_WIDTH, _MAX_WIDTH = 9, 12  # bits of a code


def use_codecs() -> None:
    """Give tifffile the two decoders that it only has with the package imagecodecs, of 26 MB."""
    from tifffile.tifffile import imagecodecs

    for decoder in (lzw_decode, floatpred_decode):
        if not hasattr(imagecodecs, decoder.__name__):
            setattr(imagecodecs, decoder.__name__, decoder)


def refuse_unknown_coding(page: Any, path: Path) -> None:
    """Refuse a compression or predictor without a decoder, and say how to convert the file."""
    from tifffile import TIFF

    coding = None
    if page.compression not in TIFF.DECOMPRESSORS:
        coding = f"compression {getattr(page.compression, 'name', page.compression)}"
    elif page.predictor not in TIFF.UNPREDICTORS:
        coding = f"predictor {getattr(page.predictor, 'name', page.predictor)}"
    if coding:
        raise InputError(
            f"{path}: {coding} of TIFF is not read; export it without compression, or with LZW or "
            "deflate and predictor 1, 2 or 3, for example 'gdal_translate -co COMPRESS=DEFLATE "
            f"{path.name} new.tif'"
        )


def lzw_decode(data: bytes, out: int) -> bytes:
    """First ``out`` bytes of a segment in TIFF's LZW code; ValueError if damaged."""
    single = [bytes([value]) for value in range(256)] + [b"", b""]  # clear and end stand for none
    table: list[bytes] = []
    width, before = _MIN_WIDTH, b""
    decoded = bytearray()
    buffer = bits = 0
    for byte in data:
        buffer, bits = buffer << 8 | byte, bits + 8
        if bits < width:
            continue
        bits -= width
        code, buffer = buffer >> bits, buffer & (1 << bits) - 1
        if code == _CLEAR:
            table, width, before = single.copy(), _MIN_WIDTH, b""
            continue
        if not table:
            raise ValueError("its LZW codes do not begin as TIFF 6.0 says")
        if code == _END or len(decoded) >= out:
            break
        if code < len(table):
            entry = table[code]
        elif code == len(table) and before:
            entry = before + before[:1]
        else:
            raise ValueError(f"LZW code {code} is not defined")
        decoded += entry
        if before and len(table) < 1 << _MAX_WIDTH:
            table.append(before + entry[:1])
        before = entry
        # The encoder takes another bit one code early.
        width = max(_MIN_WIDTH, min(_MAX_WIDTH, (len(table) + 1).bit_length()))
    return bytes(decoded[:out])


def floatpred_decode(data: np.ndarray, axis: int = -2, out: Any = None) -> np.ndarray:
    """Numbers (..., columns, 1) of rows stored as differences of bytes, highest bytes first.

    ``axis`` is that of the columns, only -2; tifffile states ``out``, which is not used.
    """
    columns, size = data.shape[-2], data.dtype.itemsize
    rows = np.ascontiguousarray(data).view(np.uint8).reshape(-1, columns * size)
    high_first = np.cumsum(rows, axis=1, dtype=np.uint8).reshape(-1, size, columns)
    numbers = np.ascontiguousarray(high_first.swapaxes(1, 2)).view(f">f{size}")
    return numbers.reshape(data.shape).astype(data.dtype)
