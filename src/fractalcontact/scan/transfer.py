"""A scan on its way from the reader process: one line of JSON, then the arrays as raw bytes.

Nothing is pickled: what a damaged reader sends can be wrong, it cannot be run.
"""

import json
from dataclasses import fields
from typing import Any, BinaryIO

import numpy as np

from .raw import RawScan

_DTYPES = "fiub"  # kinds of arrays: floats, integers, truth values


def to_text(message: dict) -> bytes:
    """One line of JSON; numpy's own numbers become plain ones."""
    return json.dumps(message, default=lambda number: number.item()).encode() + b"\n"


def from_text(line: bytes) -> dict:
    """Inverse of `to_text`, lists as tuples: no dataclass here holds a list."""
    return _with_tuples(json.loads(line))


def send_scan(raw: RawScan, stream: BinaryIO) -> None:
    """Write a scan to a binary stream."""
    content = {field.name: getattr(raw, field.name) for field in fields(raw)}
    arrays = {k: np.ascontiguousarray(v) for k, v in content.items() if isinstance(v, np.ndarray)}
    heads = {k: {"dtype": v.dtype.str, "shape": v.shape} for k, v in arrays.items()}
    plain = {key: value for key, value in content.items() if key not in arrays}
    stream.write(to_text({"outcome": "scan", "arrays": heads, **plain}))
    for array in arrays.values():
        stream.write(memoryview(array).cast("B"))  # type: ignore[arg-type]  # arrays are buffers


def receive_scan(message: dict, stream: Any, max_bytes: int) -> RawScan | None:
    """Scan that a line announces, None if it breaks off or exceeds ``max_bytes``."""
    content = {key: value for key, value in message.items() if key not in ("outcome", "arrays")}
    for name, head in message["arrays"].items():
        dtype = np.dtype(head["dtype"])
        shape = head["shape"]
        if dtype.kind not in _DTYPES or np.prod(shape, dtype=float) * dtype.itemsize > max_bytes:
            return None
        content[name] = np.empty(shape, dtype)
        rest = memoryview(content[name]).cast("B")
        while len(rest) and (count := stream.readinto(rest)):
            rest = rest[count:]
        if len(rest):
            return None
    return RawScan(**content)


def _with_tuples(value):
    if isinstance(value, dict):
        return {key: _with_tuples(item) for key, item in value.items()}
    return tuple(_with_tuples(item) for item in value) if isinstance(value, list) else value
