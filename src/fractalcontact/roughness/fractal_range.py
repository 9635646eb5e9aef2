"""Ends of the self-affine range of a measured surface: noise floor, low-pass filter, roll-off.

An instrument changes the spectrum of profiles at short wavelengths. Independent errors
of the nodes make it flat, and with N the level of that floor their standard deviation is the root
of N / spacing. A finite spot, smoothing or interpolation makes it steeper than the surface. At the
long end a surface may roll off. A model with any of these is fitted to the spectrum, and one of
them counts as seen where the spectrum is not described as well without it; the model is that of
:mod:`roughness.spectrum_model`.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.intervals import t_quantile
from .curves import Curve, jackknife_standard_error, ratio
from .spectrum_model import FORMS, SAMPLINGS, Form, features_of, log_model, named

#: Least drop of the score (BIC) by a feature, beyond its parameters: "strong" in Kass & Raftery,
#: J. Am. Stat. Assoc. 90 (1995) 773.
EVIDENCE = 6.0
#: Least relative error of a bin of a spectrum, as tapering and binning bend it.
BIN_ERROR = 0.05
#: Neighbouring strips of one surface share its long waves (`estimator.Estimator.spread`).
SPREAD = 1.2
#: Slope 1 + 2H of a spectrum, between H = 0.2 and H = 1: no rock is known with a flatter one, which
#: could hardly be separated from noise.
SLOPES = (1.4, 3.0)
#: Shortest wavelength, spacings, at which a filter halves the spectrum; the grid's limit is below.
SHORTEST_FILTER = 2.2
#: Shortest wavelength, spacings, at which a floor meets the line; below it may be aliasing.
SHORTEST_NOISE = 2.5
#: Largest factor of w^-6 in the power that a taper leaks from the longest wave fitted, in units of
#: that wave's power, at w times its wave number (w from 2 on).
LEAKAGE = 3.0
#: Least ratio of the roll-off to the end of the range; below it there is no range.
SHORTEST_RANGE = 4.0
#: Largest factor, either way, of the interval of a determined wavelength.
VAGUE = 2.5
#: Least factor (rms) from every model of a spectrum without a power law, of which neither noise nor
#: filter is stated.
NO_POWER_LAW = 2.0
#: Features that lie at a wavelength.
LENGTHS = ("noise", "filter", "roll_off")
#: Power of a strip of profiles over the median strip's from which it is left out: it holds a spike
#: or a step, which is no noise of the instrument.
SPIKY = 3.0
#: Fewest bins of a spectrum that is fitted.
MIN_BINS = 7


class FractalRange(NamedTuple):
    """Fractal range of one spectrum: lengths and noise are NaN if not seen."""

    level: np.ndarray
    """The spectrum (k,) without strips that were left out, mm3."""
    fitted: np.ndarray
    """The model (k,), mm3; NaN without one."""
    left_out: float
    """Strips of profiles left out for spikes or steps, mean over the bins."""
    noise_limit: float
    """Upper bound of the noise: the lowest level of the spectrum, mm."""
    form: Form | None = None
    """Parts of the model; None where the spectrum has too few bins."""
    line: tuple[float, float] = (np.nan, np.nan)
    """Level (mm3) at a wavelength of 1 mm and exponent of the self-affine line."""
    noise_rms: Estimate = NO_ESTIMATE
    """Standard deviation of independent errors of the nodes, mm."""
    noise_wavelength: Estimate = NO_ESTIMATE
    """Wavelength at which the self-affine line meets the noise floor, mm."""
    filter_wavelength: Estimate = NO_ESTIMATE
    """Wavelength at which a filter halves the spectrum, mm."""
    roll_off_wavelength: Estimate = NO_ESTIMATE
    """Wavelength above which the spectrum is flat, mm."""
    end: Estimate = NO_ESTIMATE
    """Shortest wavelength of the fractal range: the longer of noise and filter, mm."""
    misfit: float = np.nan
    """Root mean square of the logarithm of measured over fitted spectrum."""


def find_fractal_range(curve: Curve, spacing: float) -> FractalRange:
    """Fractal range of a spectrum of :func:`roughness.spectra.profile_spectra`, mm and mm3.

    The noise, filter and roll-off that are seen in it; ``spacing`` is that of the nodes, mm.

    Strips of profiles that stand out from the others (`SPIKY`) are left out first. Least squares of
    the logarithms, each bin weighted by its jackknife error over the strips and `BIN_ERROR`. The
    form is the one with the lowest chi-square + (parameters) ln(bins) + `EVIDENCE` (features), the
    chi-square in units of the best form's own misfit, among those whose features lie within the
    spectrum and at a wavelength determined within `VAGUE`: a floor that meets the line at
    `SHORTEST_NOISE` spacings or more (or stands out at the shortest wave behind a filter), a filter
    at `SHORTEST_FILTER` spacings or more, a roll-off below the longest wave. Intervals are the
    wider of the fit's and the jackknife's, and hold those of another sampling with a score as good
    within `EVIDENCE`.
    """
    curve, left_out = _without_spiky_strips(curve)
    level = curve.measure()
    usable = _above_leakage(curve.length, level)
    limit = float(np.sqrt(level[usable].min() / spacing)) if usable.any() else np.nan
    fitted = np.full(len(level), np.nan)
    if usable.sum() < MIN_BINS:
        return FractalRange(level, fitted, left_out, limit)
    x = 2 * spacing / curve.length[usable]
    parts = np.log(curve.without_each_part()[:, usable])
    logs = np.log(level[usable])
    error = np.hypot(jackknife_standard_error(parts), BIN_ERROR)

    form, fit, values = _most_likely(x, logs, error, parts)
    fitted[usable] = np.exp(log_model(form, fit.x, x))
    misfit = float(np.sqrt(np.mean((logs - np.log(fitted[usable])) ** 2)))
    if misfit > np.log(NO_POWER_LAW):
        values = {}
    lengths = {  # logarithms of x become wavelengths, infinite if a bound
        name: Estimate(*(2 * spacing * np.exp(-np.array([value, high, low]))))
        for name, (value, low, high) in values.items()
        if name in LENGTHS
    }
    level_of_noise = np.array(values.get("level", NO_ESTIMATE.ends))
    rms = Estimate(*(np.exp(level_of_noise / 2) / np.sqrt(spacing)))
    slope = fit.x[1]
    return FractalRange(
        form=form,
        line=(float(np.exp(fit.x[0]) * (2 * spacing) ** -slope), float(slope)),
        noise_rms=rms,
        noise_limit=limit,
        noise_wavelength=lengths.get("noise", NO_ESTIMATE),
        filter_wavelength=lengths.get("filter", NO_ESTIMATE),
        roll_off_wavelength=lengths.get("roll_off", NO_ESTIMATE),
        end=max(
            (lengths[name] for name in ("noise", "filter") if name in lengths),
            key=lambda length: length.ends,
            default=NO_ESTIMATE,
        ),
        misfit=misfit,
        left_out=left_out,
        level=level,
        fitted=fitted,
    )


def _without_spiky_strips(curve: Curve) -> tuple[Curve, float]:
    """Curve without strips far above the median, and the number of strips left out in a bin."""
    strips = ratio(curve.total, curve.weight)
    if not np.isfinite(strips).any():
        return curve, np.nan
    spiky = strips > SPIKY * np.nanmedian(strips, axis=1, keepdims=True)
    kept = Curve(curve.length, np.where(spiky, 0, curve.total), np.where(spiky, 0, curve.weight))
    return kept, float(spiky.sum(axis=1).mean())


def _above_leakage(length, level) -> np.ndarray:
    """Mask of bins that hold more power than the taper leaks from the longest wave."""
    above = np.isfinite(level) & (level > 0)
    if above.any():
        longest = np.flatnonzero(above)[-1]
        part = length / length[longest]
        above &= (level > LEAKAGE * level[longest] * part**6) | (part > 0.5)
    return above


# -- fitting ---------------------------------------------------------------------------------------


def _most_likely(x, logs, error, parts):
    """Determined form with the lowest score, its fit and its features with intervals."""
    fits = {form: _fit(form, x, logs, error) for form in FORMS}
    freedom = {form: max(len(x) - len(fit.x), 1) for form, fit in fits.items()}
    left = max(1.0, min(2 * fit.cost / freedom[form] for form, fit in fits.items()))
    score = {
        form: 2 * fit.cost / left + len(fit.x) * np.log(len(x)) + EVIDENCE * form.features
        for form, fit in fits.items()
        if _is_sensible(form, fit.x, x)
    }
    for form in sorted(score, key=score.get):  # the line without features is always determined
        values = _with_intervals(form, fits[form], x, logs, parts, error)
        for other in _rivals(form, score):
            values = _joined(values, _with_intervals(other, fits[other], x, logs, parts, error))
        if _is_determined(values):
            return form, fits[form], values


def _rivals(form: Form, score) -> list[Form]:
    """Forms with the same features and another sampling, of nearly the same score."""
    same = [form._replace(sampling=sampling) for sampling in SAMPLINGS if sampling != form.sampling]
    return [other for other in same if score.get(other, np.inf) < score[form] + EVIDENCE]


def _joined(values, others):
    """Values with intervals that hold those of a rival form too."""
    return {
        name: (value, min(low, others[name][1]), max(high, others[name][2]))
        if name in others
        else (value, low, high)
        for name, (value, low, high) in values.items()
    }


def _is_determined(values) -> bool:
    """True if all wavelengths and the noise's standard deviation are determined within `VAGUE`."""
    widths = {name: high - low for name, (_, low, high) in values.items() if np.isfinite(low)}
    widths["level"] = widths.get("level", 0.0) / 2  # the level is a variance, not a deviation
    return all(widths.get(name, 0.0) < 2 * np.log(VAGUE) for name in (*LENGTHS, "level"))


def _is_sensible(form: Form, parameters: np.ndarray, x: np.ndarray) -> bool:
    """True if all features of a form lie where the spectrum shows them."""
    own = named(form, parameters)
    short_end = 0.0
    if form.filtering:
        if own["filter"] > np.log(2 / SHORTEST_FILTER):
            return False
        short_end = own["filter"]
    if form.noisy:
        meeting = (own["a"] - own["level"]) / own["slope"]
        silent = log_model(form._replace(noisy=False), parameters[:-1], x[:1])
        if silent[0] > own["level"] or not (form.filtering or meeting < np.log(2 / SHORTEST_NOISE)):
            return False
        short_end = min(short_end, meeting)
    if form.rolls_off:
        return np.log(x.min()) < own["roll_off"] < short_end - np.log(SHORTEST_RANGE)
    return True


def _fit(form: Form, x, logs, error):
    """Best of several weighted least-squares fits of the logarithms, from different starts."""
    low, high = _bounds(form, x, logs)

    def residuals(parameters):
        return (log_model(form, parameters, x) - logs) / error

    fits = [
        least_squares(
            residuals, np.clip(p, low + 1e-6, high - 1e-6), bounds=(low, high), ftol=1e-6, xtol=1e-6
        )
        for p in _starts(form, x, logs)
    ]
    return min(fits, key=lambda fit: fit.cost)


def _bounds(form: Form, x, logs):
    ends = {
        "a": (logs.min() - 60, logs.max() + 60),
        "slope": SLOPES,
        "roll_off": (np.log(x.min()) - 3, 0.0),
        "filter": (np.log(x.min()), 3.0),
        "level": (logs.min() - 20, logs.max() + 5),
    }
    names = named(form, np.zeros(2 + form.features))
    return np.array([ends[name] for name in names], float).T


def _starts(form: Form, x, logs):
    """Starting points: filters at two places, all other features at one."""
    middle = slice(len(x) // 4, -(len(x) // 4))
    slope = np.clip(-np.polyfit(np.log(x[middle]), logs[middle], 1)[0], 1.2, 2.8)
    a = np.mean(logs + slope * np.log(x))
    begin = {"a": a, "slope": slope, "roll_off": np.log(2 * x.min()), "level": logs.min()}
    places = (np.log(0.25), np.log(0.6)) if form.filtering else (0.0,)
    names = named(form, np.zeros(2 + form.features))
    return [np.array([(begin | {"filter": place})[name] for name in names]) for place in places]


def _with_intervals(form: Form, fit, x, logs, parts, error) -> dict[str, tuple]:
    """Features with their 95 % intervals: the wider of jackknife and fit.

    Parameters without one strip follow from those of all by one step of Gauss and Newton.
    """
    inverse = np.linalg.pinv(fit.jac)
    without = [features_of(form, fit.x + inverse @ ((part - logs) / error), x) for part in parts]
    quantile = t_quantile(len(parts) - 1)
    scatter = max(1.0, 2 * fit.cost / max(len(x) - len(fit.x), 1))
    covariance = scatter * inverse @ inverse.T
    intervals = {}
    for name, value in features_of(form, fit.x, x).items():
        values = np.array([[features.get(name, 0.0)] for features in without])
        gradient = _gradient(form, fit.x, x, name, value)
        of_fit = np.sqrt(gradient @ covariance @ gradient)
        if name == "noise" and value <= np.log(x.min()):
            # The floor lies above the surface at all wavelengths: its end is a bound, no estimate.
            intervals[name] = (value, -np.inf, value)
            continue
        half = quantile * max(SPREAD * float(jackknife_standard_error(values)[0]), of_fit)
        intervals[name] = (value, value - half, value + half)
    return intervals


def _gradient(form, parameters, x, name, value):
    """Derivative of a feature by the parameters."""
    step = 1e-6
    steps = parameters + step * np.eye(len(parameters))
    return np.array([features_of(form, p, x).get(name, value) - value for p in steps]) / step
