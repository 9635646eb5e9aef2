"""Embedded specimens: synthetic surfaces of a study, written as ordinary scan files.

The files are read like measured surfaces. Heights come from :mod:`surface.embedded`.
"""

from pathlib import Path

import numpy as np
import yaml

from ..core.atomic import atomic_write
from .sidecar import sidecar_of_matrix


def write_scan(path: Path, heights: np.ndarray, spacing: float, *, sidecar: dict) -> None:
    """Write heights in mm, rows ascending in y, as a scan NAME.npy with its sidecar NAME.yaml.

    Both files appear whole or not at all; the sidecar comes first, so that no scan is ever seen
    without its unit. ``spacing`` is in mm; ``sidecar`` holds further keys, such as ``material``.

    Raises
    ------
    ValueError
        If the path does not end in ``.npy``, or the sidecar states a key of the scan itself.
    """
    path = Path(path)
    if path.suffix != ".npy":
        raise ValueError(f"{path}: a scan is written as .npy")
    described = sidecar_of_matrix(spacing)
    for key in described.keys() & sidecar.keys():
        raise ValueError(f"{path}: the key '{key}' of the sidecar is set by the scan itself")
    text = yaml.safe_dump(described | sidecar, sort_keys=False, allow_unicode=True)
    with atomic_write(path.with_suffix(".yaml")) as temporary:
        temporary.write_text(text, encoding="utf-8")
    with atomic_write(path) as temporary:
        np.save(temporary, heights, allow_pickle=False)
