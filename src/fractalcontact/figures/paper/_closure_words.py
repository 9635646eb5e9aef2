"""Words on the laws that all closure curves and contact areas follow, drawn or not."""

import numpy as np
import xarray as xr
from matplotlib.lines import Line2D

from ...core.estimate import Estimate
from ...core.limits import GOOD_FIT, NEARLY
from ...core.verdicts import HYPERBOLA, NEITHER, SEMI_LOGARITHMIC, UNDECIDED
from ..kit.drawing import heading
from ..kit.words import percent

#: How captions name what curves follow.
_FOLLOWED = {
    SEMI_LOGARITHMIC: "the logarithmic law",
    HYPERBOLA: "the hyperbola",
    UNDECIDED: "both",
    NEITHER: f"neither (misfits above {percent(GOOD_FIT)})",
}


def no_law(curve: xr.Dataset) -> str:
    """Why no law could be fitted to a curve, without what would help."""
    return str(curve["closure_law_reason"].values).split(":")[0]


def all_offsets(curves: xr.Dataset, laws: xr.Dataset) -> tuple[list[Line2D], list[Line2D]]:
    """What all offsets have, drawn or not: legend entries for the laws, for the exponents m."""
    count = curves.sizes["offset"]
    named = _followed(curves)
    if not named:
        return [], []
    known = [f"{words.split(' (')[0].removeprefix('the ')} {n}" for words, n in named.items()]
    of_laws = [heading(f"(a), (b), {_some(sum(named.values()), count)}: {', '.join(known)}")]
    m = laws["corrected_exponent"].values
    m = m[np.isfinite(m)]
    if not m.size:
        return of_laws, []
    ends = " to ".join(dict.fromkeys(f"{end:.2f}" for end in (m.min(), m.max())))
    return of_laws, [heading(f"(c), {_some(m.size, count)}: $m$ = {ends}")]


def _some(known, count):
    return f"all {count} offsets" if known == count else f"{known} of {count} offsets"


def linear_words(laws: xr.Dataset) -> str:
    """How many exponents are near 1, and how many intervals lie beyond that: these decide."""
    value, low, high = Estimate.read(laws, "corrected_exponent").ends
    known = np.isfinite(value)
    if not known.any():
        return ""
    near = int((np.abs(value[known] - 1) <= NEARLY).sum())
    apart = int(((high < 1 - NEARLY) | (low > 1 + NEARLY))[known].sum())
    within = f"within {NEARLY:g} of 1"
    words = within if near == known.sum() == 1 else f"{near} of {known.sum()} {within}"
    if near == known.sum():
        return words
    return f"{words}, {apart or 'no'} interval{'' if apart == 1 else 's'} beyond"


def _followed(curves):
    """How many curves follow which law; empty where none could be fitted."""
    fitted = np.isfinite(curves["semi_logarithmic_misfit"].values)
    laws = curves["closure_law"].values.astype(str)[fitted]
    return (
        {words: int((laws == law).sum()) for law, words in _FOLLOWED.items()} if len(laws) else {}
    )


def laws_words(curves: xr.Dataset) -> str:
    """Which law the curves follow, beside the paper's hyperbola."""
    named = _followed(curves)
    if not named:
        return f"No law fitted ({no_law(curves.isel(offset=-1))})."
    if sum(named.values()) == 1:
        followed = next(words for words, n in named.items() if n)
        return f"The curve follows {followed.replace('neither', 'neither law')}."
    counts = ", ".join(f"{n} {words}" for words, n in named.items() if n)
    return f"Of {sum(named.values())} curves {counts.replace(' ', ' follow ', 1)}."
