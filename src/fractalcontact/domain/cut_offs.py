"""Cut-offs of box counts, beyond which they are saturated.

Small boxes hold one node each, large ones are all occupied: their counts carry no information.
"""

import numpy as np

from .box_counts import boxes_along

#: Largest fraction of the nodes not alone in a box, or of the boxes not occupied, at saturated box
#: sizes.
SATURATED = 0.02


def between_cut_offs(
    count: np.ndarray, sizes: np.ndarray, nodes: int, shape: tuple[int, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Box sizes used (k,), and sizes with nearly every node alone or nearly every box occupied.

    ``count`` (k,) is the minimal cover N(r) at box sides ``sizes`` in cells, ``nodes`` the number
    of nodes in contact, ``shape`` the window's cells. Of a single node and of a window that nearly
    all touches, every size is used.
    """
    used = np.ones(sizes.size, dtype=bool)
    alone, full = np.zeros((2, sizes.size), dtype=bool)
    if 1 < nodes < (1 - SATURATED) * np.prod(shape):
        boxes = np.prod([boxes_along(n, sizes) for n in shape], axis=0)
        alone, full = _saturated(count, sizes, nodes, boxes)
        used = ~alone & ~full & (count > 1)
    return used, alone, full


def _saturated(count, sizes, nodes, boxes):
    """Sizes at which nearly every node is alone in its box, and nearly every box occupied."""
    alone = (count >= (1 - SATURATED) * nodes) & (sizes > 1)
    alone |= (sizes == 1) & alone.any()
    return alone, count >= (1 - SATURATED) * boxes
