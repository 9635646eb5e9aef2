"""Embedded specimens: synthetic surfaces that a study makes itself, written as ordinary scan files.

They enter the program through the same door as a measured surface. Their heights are those of
:mod:`surface.embedded`.
"""

from pathlib import Path

import numpy as np
import yaml

from ..core.atomic import atomic_write
from .sidecar import sidecar_of_matrix


def write_scan(path: Path, heights: np.ndarray, spacing: float, *, sidecar: dict) -> None:
    """Write heights as a scan file NAME.npy with its sidecar NAME.yaml.

    Both files appear whole or not at all; the sidecar comes first, so that no scan is ever seen
    without its unit.

    Parameters
    ----------
    path : Path
        The scan, ending in ``.npy``; its folder is made where it is missing.
    heights : (ny, nx) array
        In mm, NaN where missing, rows ascending in y.
    spacing : float
        In mm.
    sidecar : dict
        Further keys, such as ``title`` or ``material``. `unit` and `spacing` are added.

    Raises
    ------
    ValueError
        If the path does not end in ``.npy`` or the sidecar contradicts the unit or spacing.
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
