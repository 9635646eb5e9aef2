"""Laboratory tests beside computed curves: rows of a specimen's page."""

from typing import NamedTuple

from ..core.subject import Subject
from ..report.published import Number, read, row_of

#: Quantity that each kind of test measures, in the order of the page.
_WORDS = {
    "closure": "closure",
    "flow": "transmissivity",
    "dilatancy": "dilation",
    "shear": "shear strength",
    "strength": "peak shear strength",
}


class Test(NamedTuple):
    """Laboratory test: computed over measured value at the last computed state within it.

    ``note`` is what to know of its readings. ``status`` is "computed", or "fitted" or "predicted"
    where a constant is fitted to a test; ``calibrated`` is the same ratio with that constant.
    """

    words: str
    note: str
    ratio: Number
    status: str = "computed"
    calibrated: Number | None = None


def tests_of(subject: Subject) -> list[Test]:
    """Laboratory tests of a specimen."""
    tests = []
    for kind, words in _WORDS.items():
        ratios = [ratio for ratio in read(row_of(f"{kind}_over_measured"), subject) if ratio.at]
        for i, ratio in enumerate(ratios):
            fitted: tuple = ()
            if kind == "closure":
                status = str(subject["measured"]["closure_status"].values[i])
                fitted = (status, read(row_of("calibrated_over_measured"), subject)[i])
            note = str(subject["measured"][f"{kind}_note"].values[i])
            tests.append(Test(f"{words}: {ratio.at['test']}", note, ratio, *fitted))
    return tests


def calibration_of(subject: Subject) -> tuple[str, Number, str]:
    """Constant that is fitted to a test, its value, MPa, and what to know of it; "" without."""
    stage = subject.stages.get("measured")
    (value,) = read(row_of("calibrated"), subject)
    if stage is None or "calibrated_constant" not in stage:
        return "", value, ""
    constant, reason = (
        str(stage[name].item()) for name in ("calibrated_constant", "calibration_reason")
    )
    return constant, value, reason
