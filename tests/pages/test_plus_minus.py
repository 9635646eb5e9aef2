"""An error that is not known is said so: no sign stands before a dash."""

import numpy as np
import pytest

from fractalcontact.pages.words import MISSING, plus_minus, with_unit


@pytest.mark.parametrize("error", [np.nan, np.inf])
def test_an_error_that_is_not_known_has_no_sign(error):
    assert with_unit(np.nan, "mm") == MISSING
    assert plus_minus(error, with_unit(error, "mm")) == "error not known"


def test_a_known_error_has_its_sign():
    assert plus_minus(0.5, "0.5 mm") == "± 0.5 mm"
