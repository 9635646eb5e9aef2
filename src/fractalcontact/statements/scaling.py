"""What the paper says of the contact domain and of size (sects. 6 and 7, Figs. 1b and 8 to 13)."""

import numpy as np

from ..core.fitting import fit_line
from .findings import FAILS, HOLDS, LOOSELY, NEARLY, PARTLY, UNKNOWN, Finding, Joint, share

#: Delta_sigma up to here is near 0, and from here on near 2, the ends of the paper's Fig. 12.
NEAR_POINTS, NEAR_FULL = 0.25, 1.75

#: Verdicts of the size test that decide something; the first is in favour of eq. 6.
DECIDED = ("agrees", "measured steeper", "measured flatter")

#: An interval of the difference of the two estimates that is wider decides nothing.
WIDEST = 1.0

#: The two estimates of Delta_sigma, as their variables and in words.
ESTIMATES = {"area": "by A_r(s)", "box": "by boxes"}


def area_is_lacunar(joint: Joint) -> Finding:
    """Exponent of A_r over the resolutions, at the load of the maps."""
    state = joint.map_state("scaling")
    value, low, high = (float(state[f"delta_sigma{end}"]) for end in ("", "_low", "_high"))
    if not np.isfinite(value):
        return Finding(UNKNOWN, f"{int(state['n'])} resolutions with enough nodes, three needed")
    verdict = HOLDS if high < 2 else PARTLY if value < 2 else FAILS
    return Finding(
        verdict,
        f"A_r ~ s^(2 - Delta_sigma), Delta_sigma = {value:.2f} [{low:.2f}, {high:.2f}] over "
        f"{int(state['n'])} resolutions, r2 = {float(state['r2']):.3f}",
    )


def boxes_follow_one_law(joint: Joint) -> Finding:
    """Interval of the box-counting dimension at the load of the maps."""
    state = joint.map_state("domains")
    value, low, high = (float(state[f"delta_sigma{end}"]) for end in ("", "_low", "_high"))
    if not np.isfinite(value):
        return Finding(FAILS, f"no dimension: {state['reason'].item()}")
    half = (high - low) / 2
    verdict = HOLDS if half <= NEARLY else PARTLY if half <= LOOSELY else FAILS
    return Finding(
        verdict,
        f"Delta_sigma = {value:.2f} [{low:.2f}, {high:.2f}] for boxes of "
        f"{float(state['fit_min']):.3g} to {float(state['fit_max']):.3g} mm",
    )


def estimates_agree(joint: Joint) -> Finding:
    """Whether A_r(s) and box counting have one Delta_sigma, over all loads."""
    states = joint.map_states("scaling")
    width = (states["difference_high"] - states["difference_low"]).values
    known = width <= WIDEST
    if not known.any():
        both = int(np.isfinite(width).sum())
        return Finding(
            UNKNOWN,
            f"{both} loads with both estimates, none with an interval of their difference within "
            f"{WIDEST:g}",
        )
    agree = int((~states["disagree"].values[known].astype(bool)).sum())
    difference = states["difference"].values[known]
    return Finding(
        share(agree, known.sum()),
        f"they agree within their intervals at {agree} of {known.sum()} loads; A_r(s) less boxes "
        f"{difference.min():+.2f} to {difference.max():+.2f}",
    )


def dimension_rises_by_area(joint: Joint) -> Finding:
    """Delta_sigma from A_r(s) against the logarithm of F."""
    return _over_load(joint, "area")


def dimension_rises_by_boxes(joint: Joint) -> Finding:
    """Delta_sigma from box counts against the logarithm of F."""
    return _over_load(joint, "box")


def dimension_spans_all(joint: Joint) -> Finding:
    """Smallest and largest Delta_sigma by box counts over the loads."""
    values = joint.map_states("scaling")["delta_box"].values
    values = values[np.isfinite(values)]
    if not values.size:
        return Finding(UNKNOWN, "no load with a dimension by boxes")
    ends = int(values.min() <= NEAR_POINTS) + int(values.max() >= NEAR_FULL)
    return Finding(
        share(ends, 2),
        f"by boxes from {values.min():.2f} to {values.max():.2f} over the loads solved",
    )


def size_effect_follows(joint: Joint) -> Finding:
    """Verdicts of the direct test of eq. 6, over loads, with either estimate of Delta_sigma."""
    test = joint.stages["size_test"].sel(estimator=list(ESTIMATES))
    decided = test["verdict"].isin(DECIDED).values
    if not decided.any():
        return Finding(UNKNOWN, "no load at which the parts decide")
    agree = (test["verdict"] == DECIDED[0]).values
    words = ", ".join(
        f"{ESTIMATES[key]} at {agree[i].sum()} of {decided[i].sum()} loads"
        for i, key in enumerate(ESTIMATES)
    )
    slope = test["slope"].values[decided.any(axis=0)]
    return Finding(
        share(int(agree.sum()), int(decided.sum())),
        f"the measured slope of log sigma_0 over log b, {slope.min():.2f} to {slope.max():.2f}, "
        f"agrees with -(2 - Delta_sigma) {words}",
    )


def larger_domains_are_less_dense(joint: Joint) -> Finding:
    """Exponent of A_r/A_0 against window size at one nominal pressure."""
    windows = joint.map_windows()
    return _of_size(windows, "area_exponent", "A_r/A_0")


def strength_falls_with_size(joint: Joint) -> Finding:
    """Exponents of shear strength against window size, at equal v/b and all loads."""
    windows = joint.stages["windows"]
    if "similar_strength_exponent" not in windows:
        return Finding(UNKNOWN, "strength needs a joint that slides")
    value, low, high = (
        windows[f"similar_strength_exponent{end}"].values.ravel() for end in ("", "_low", "_high")
    )
    known = np.isfinite(value)
    if not known.any():
        return Finding(UNKNOWN, "no v/b at which three sizes of window could be compared")
    falls, rises = int((high[known] < 0).sum()), int((low[known] > 0).sum())
    verdict = HOLDS if falls == known.sum() else PARTLY if falls > rises else FAILS
    return Finding(
        verdict,
        f"tau ~ b^e at equal v/b, e = {value[known].min():.2f} to {value[known].max():.2f}; it "
        f"falls beyond its interval in {falls} of {known.sum()} cases and rises in {rises}",
    )


#: Figure, claim in our words, and what judges it.
STATEMENTS = (
    (
        "8, 10",
        "The contact area falls with finer resolution, as a power law",
        area_is_lacunar,
    ),
    (
        "9",
        "Contact domains are self-similar: one power law of box counts",
        boxes_follow_one_law,
    ),
    ("8-10", "One Delta_sigma governs box counts and the area over resolutions", estimates_agree),
    ("12, 13", "Delta_sigma rises with F, judged by A_r(s)", dimension_rises_by_area),
    ("12, 13", "Delta_sigma rises with F, judged by box counts", dimension_rises_by_boxes),
    ("12", "Delta_sigma goes from 0 to 2 as the load grows", dimension_spans_all),
    ("10, 13", "Eq. 6: at one sigma*, sigma_0 goes as b^-(2 - Delta_sigma)", size_effect_follows),
    ("7", "Domains of larger joints are less dense", larger_domains_are_less_dense),
    (
        "1b, 11",
        "Apparent shear strength falls with size",
        strength_falls_with_size,
    ),
)


def _over_load(joint, key):
    """Whether an estimate of Delta_sigma rises with log F, beyond the interval of the line."""
    states = joint.map_states("scaling")
    values = states[f"delta_{key}"].values
    line = fit_line(np.log10(states["normal_force"].values), values)
    if not np.isfinite(line.slope):
        return Finding(UNKNOWN, f"{line.n} loads with an estimate {ESTIMATES[key]}, three needed")
    verdict = HOLDS if line.slope_low > 0 else PARTLY if line.slope > 0 else FAILS
    return Finding(
        verdict,
        f"{line.slope:+.2f} [{line.slope_low:+.2f}, {line.slope_high:+.2f}] a decade of F over "
        f"{line.n} loads",
    )


def _of_size(windows, name, symbol):
    """Whether a quantity falls with the window's size beyond its interval."""
    value, low, high = (float(windows[f"{name}{end}"]) for end in ("", "_low", "_high"))
    if not np.isfinite(value):
        return Finding(UNKNOWN, "fewer than three sizes of window")
    verdict = HOLDS if high < 0 else PARTLY if value < 0 else FAILS
    pressure = float(windows["nominal_pressure"])
    return Finding(
        verdict, f"{symbol} ~ b^e, e = {value:.2f} [{low:.2f}, {high:.2f}] at {pressure:.3g} MPa"
    )
