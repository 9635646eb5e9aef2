"""Cases of a test that only repeat a property: they run in the full suite alone."""

import pytest


def representative(cases, quick=1):
    """The first cases of a parametrised test for both suites, the others marked full.

    Parameters
    ----------
    cases : iterable
        Of values, or of tuples of values.
    quick : int
        How many stand for all.
    """
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=() if i < quick else pytest.mark.full,
        )
        for i, case in enumerate(cases)
    ]
