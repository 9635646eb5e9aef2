"""Laboratory tests beside computed curves: rows of a specimen's page and columns of the summary."""

import re
from dataclasses import dataclass

from ..core.estimate import Estimate
from ..core.subject import Subject

#: What each kind of test measures, in the order of the page.
_WORDS = {
    "closure": "closure",
    "flow": "transmissivity",
    "dilatancy": "dilation",
    "shear": "shear strength",
    "strength": "peak shear strength",
}


@dataclass(frozen=True)
class Test:
    """A test: computed over measured at the last computed state within it.

    Attributes
    ----------
    kind, label, words : str
    ratio : Estimate
    calibrated : Estimate
        The same with the constant that is fitted to a test; NaN without.
    status : str
        "computed", or "fitted" and "predicted" with that constant.
    note : str
        What to know of its readings; "" if nothing is.
    """

    kind: str
    label: str
    words: str
    ratio: Estimate
    calibrated: Estimate
    status: str
    note: str

    @property
    def columns(self) -> dict[str, float]:
        """Columns of the summary, with the ends of the interval."""
        name = re.sub(r"\W+", "_", f"computed_over_measured_{self.kind}_{self.label}")
        return self.ratio.columns(name)


def tests_of(subject: Subject) -> list[Test]:
    """Laboratory tests of a specimen; none of one without."""
    found = []
    stage = subject.stages.get("measured")
    for kind, words in _WORDS.items():
        if stage is None or f"{kind}_test" not in stage:
            continue
        for label in map(str, stage[f"{kind}_test"].values):
            test = stage.sel({f"{kind}_test": label})
            of_closure = kind == "closure"
            found.append(
                Test(
                    kind,
                    label,
                    words,
                    Estimate.read(test, f"{kind}_ratio_at_last"),
                    Estimate.read(test, "closure_ratio_calibrated") if of_closure else Estimate(),
                    str(test["closure_status"].item()) if of_closure else "computed",
                    str(test[f"{kind}_note"].item()),
                )
            )
    return found


def calibration_of(subject: Subject) -> tuple[str, Estimate, str]:
    """Constant that is fitted to a test, its value, MPa, and what to know of it; "" without."""
    stage = subject.stages.get("measured")
    if stage is None or "calibrated_constant" not in stage:
        return "", Estimate(), ""
    value = Estimate.read(stage, "calibrated_value")
    constant = str(stage["calibrated_constant"].item())
    return constant, value, str(stage["calibration_reason"].item())
