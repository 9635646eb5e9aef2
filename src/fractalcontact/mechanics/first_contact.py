"""First contact as an extreme of the sample: how far the highest node of a composite scatters."""

import numpy as np

#: Blocks along a side of the window: of each the highest node counts, not its neighbours too.
BLOCKS = 8
#: Number of the highest blocks, whose heights show how the tail falls off.
HIGHEST = 10
#: Half of the 95 % interval of a Gumbel distribution, from -ln ln 40 to -ln -ln 0.975, in its
#: scale.
_HALF_WIDTH = 2.49


def highest_node_scatter(composite: np.ndarray) -> float:
    """Scatter of the highest node of a composite topography: half-width of about 95 %, mm.

    Parameters
    ----------
    composite : (ny, nx) ndarray
        h, mm.

    Returns
    -------
    float
        By which closure from first contact, and rigid dilatancy, are uncertain if another piece of
        the same joint, or another scan of it, had been taken. NaN of fewer than 4 x 4 nodes.

    Notes
    -----
    Where the tail of the heights falls off like an exponential or faster, the highest of many is
    Gumbel distributed; its scale is the mean excess of the k highest over the next one (Weissman,
    J. Am. Stat. Assoc. 73 (1978) 812), here of the maxima of blocks.
    """
    blocks = min(BLOCKS, *composite.shape)
    if blocks * blocks <= HIGHEST:
        return np.nan
    rows = np.array_split(np.arange(composite.shape[0]), blocks)
    columns = np.array_split(np.arange(composite.shape[1]), blocks)
    maxima = np.sort([composite[np.ix_(y, x)].max() for y in rows for x in columns])
    scale = float(np.mean(maxima[-HIGHEST:]) - maxima[-HIGHEST - 1])
    return _HALF_WIDTH * scale
