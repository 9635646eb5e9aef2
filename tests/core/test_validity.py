"""Verdict on the elastic model as the atlas states it, read back and put into words."""

import pytest
import xarray as xr

from fractalcontact.core.validity import SLOPE, Limits, Validity, pressure_words
from fractalcontact.core.verdicts import HARDNESS, IN_PART, STRENGTH, USUAL

STATED = Limits(STRENGTH, 80.0, 80.0, 80.0, 240.0)
CAPPED = Limits(HARDNESS, 1234.5, 1234.5, 1234.5, 1234.5)
ASSUMED = Limits(USUAL, 20.0, 100.0, 20.0, 300.0)


def test_a_criterion_is_named_with_its_strength_or_the_range_assumed():
    assert STATED.words == f"{STRENGTH} (80 MPa)"
    assert CAPPED.words == f"{HARDNESS} (1230 MPa)"
    assert ASSUMED.words == f"{USUAL}, none being stated (E/1000 to E/200: 20 to 100 MPa)"


@pytest.mark.parametrize(
    ("limits", "capped", "stated"),
    [(STATED, False, True), (CAPPED, True, True), (ASSUMED, False, False)],
)
def test_a_verdict_of_the_atlas_is_read_as_it_was_made(limits, capped, stated):
    made = Validity(IN_PART, 12.5, "rms slope 0.5, too steep", SLOPE, limits)
    state = xr.Dataset({**dict(zip(made._fields[:-1], made[:-1], strict=True)), **limits._asdict()})
    assert Validity.of(state) == made
    assert (made.capped, made.stated) == (capped, stated)


@pytest.mark.parametrize(("pressure", "words"), [(80, "80 MPa"), (0.01234, "0.0123 MPa")])
def test_a_pressure_has_three_digits_at_most(pressure, words):
    assert pressure_words(pressure) == words
