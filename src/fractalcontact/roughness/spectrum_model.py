"""Model spectrum of a measured profile: self-affine surface, grid and instrument.

The model, with x the wave number over that of the shortest wave (two spacings):

    C(x) = P(x) G(x / x_f) + N,    P(x) = A x^-(1 + 2H) above the roll-off

Several forms are tried for the grid's effect on P: none; aliasing, where points of a finer
surface were taken; a band limit, where a surface was made on the grid itself. Each of them bends
the last octave a little, and none is the instrument's. Several forms are tried, too, for the filter
G, which halves the spectrum at x_f.
"""

from itertools import product
from typing import Any, NamedTuple

import numpy as np
from scipy import special

#: Forms of the filter: Gaussian, and powers of the wave number (2 f of straight facets).
FILTERS = ("Gaussian", "second order", "fourth order")
#: Effects of the grid on a surface, which the docstring of this module explains.
IDEAL, ALIASED, BAND_LIMITED = SAMPLINGS = ("ideal", "aliased", "band-limited")


class Form(NamedTuple):
    """Parts of a model of the spectrum."""

    sampling: str
    filtering: str
    rolls_off: bool
    noisy: bool

    @property
    def features(self) -> int:
        """Number of parts beyond the self-affine one."""
        return bool(self.filtering) + self.rolls_off + self.noisy


FORMS = tuple(
    Form(sampling, filtering, rolls_off, noisy)
    for (sampling, filtering), rolls_off, noisy in product(
        [*((sampling, "") for sampling in SAMPLINGS), *((IDEAL, f) for f in FILTERS)],
        (False, True),
        (False, True),
    )
)


def log_model(form: Form, parameters: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Logarithm of the spectrum (k,) at wave numbers x.

    Parameters in order: ln A, slope, then the logarithms of roll-off, filter and noise level of
    those the form has.
    """
    own = named(form, parameters)
    log_x = np.log(x)
    surface = own["a"] - own["slope"] * log_x
    surface += np.log(sampled(form.sampling, own["slope"], x))
    if form.rolls_off:
        surface += np.log(rolled_off(own["slope"], np.exp(own["roll_off"]), x))
    if form.filtering:
        surface += _filtered(form.filtering, log_x - own["filter"])
    return np.logaddexp(surface, own["level"]) if form.noisy else surface


def named(form: Form, parameters: np.ndarray) -> dict[str, float]:
    """Parameters of :func:`log_model` by name: a, slope and those of roll_off, filter, level."""
    names = ["a", "slope"]
    names += ["roll_off"] * form.rolls_off + ["filter"] * bool(form.filtering)
    return dict(zip(names + ["level"] * form.noisy, parameters, strict=True))


def sampled(sampling: str, slope: float | np.ndarray, x: np.ndarray) -> Any:
    """Factor of the grid on a profile's spectrum x^-slope, by one of :data:`SAMPLINGS`.

    Slopes are one number or (n, 1), wave numbers x (k,) over that of the shortest wave, two
    spacings.
    """
    if sampling == ALIASED:
        # The sum of |x + 2k|^-slope over all whole k, by Hurwitz zeta functions.
        waves = special.zeta(slope, x / 2) + special.zeta(slope, 1 - x / 2)
        return waves * (x / 2) ** slope
    if sampling == BAND_LIMITED:
        # A profile's spectrum is the surface's, integrated over the other axis only up to x = 1.
        return special.betainc(0.5, slope / 2, 1 / (1 + x**2))
    return 1.0


def rolled_off(slope: float | np.ndarray, start: float, x: np.ndarray) -> np.ndarray:
    """Factor on the profiles' spectrum of an isotropic surface: flat spectrum below `start`."""
    whole = special.beta(0.5, slope / 2) / 2
    inside = np.clip(1 - (x / start) ** 2, 0, None)
    flat = np.sqrt(inside) * (x / start) ** slope
    return flat / whole + 1 - special.betainc(0.5, slope / 2, inside)


def _filtered(filtering: str, log_ratio: np.ndarray) -> np.ndarray:
    """Logarithm of a filter's effect on the spectrum; the filter halves it where log_ratio is 0."""
    if filtering == "Gaussian":
        return -np.log(2) * np.exp(2 * log_ratio)
    order = 2 if filtering == "second order" else 4
    return -np.logaddexp(0, order * log_ratio)


def features_of(form: Form, parameters: np.ndarray, x: np.ndarray) -> dict[str, float]:
    """Parameters: H, and logarithms of the others; the noise as the x where it meets the line."""
    own = named(form, parameters)
    features = {"hurst": (own["slope"] - 1) / 2}
    features |= {name: own[name] for name in ("roll_off", "filter", "level") if name in own}
    if form.noisy:
        # A line that lies below the floor everywhere gets the longest wave, x's minimum.
        features["noise"] = max((own["a"] - own["level"]) / own["slope"], np.log(x.min()))
        if features["noise"] > 0:  # a filter ends the range before the line meets the floor
            del features["noise"]
    return features
