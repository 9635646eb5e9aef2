"""Entries of a card: numbers that the scans leave undetermined, and what an interval lacks."""

from types import SimpleNamespace

import pytest

from fractalcontact.cards.entries import number
from fractalcontact.core.estimate import Estimate
from fractalcontact.report.published import BY_SCAN, Number, row_of

SUBJECT = SimpleNamespace(stages={})


@pytest.mark.parametrize("name", ["mean_gap", "interface_stiffness", "hydraulic_aperture"])
def test_a_number_that_suspicious_cells_decide_is_undetermined(name):
    sound, decided = (
        number(row_of(name), SUBJECT, Number({}, Estimate(0.1, 0.09, 0.11), determined=sound))
        for sound in (True, False)
    )
    assert "determined" not in sound
    assert "note" not in sound
    assert decided["determined"] is False
    assert decided["note"] == BY_SCAN
    assert decided["value"] == sound["value"]


def test_an_interval_says_what_it_leaves_out():
    remark = "the interval leaves out the error of the mean gap"
    found = Number({}, Estimate(0.1, 0.09, 0.11, reason=remark))
    assert number(row_of("hydraulic_aperture"), SUBJECT, found)["note"] == remark
