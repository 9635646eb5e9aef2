"""Patterns of many names match these alone, as one after the other would, and soon."""

import re

from hypothesis import given
from hypothesis import strategies as st

from fractalcontact.core.patterns import alternation

NAMES = st.lists(st.text(alphabet="ab.[-", min_size=1, max_size=5), max_size=12)


@given(NAMES, NAMES)
def test_names_match_and_others_do_not(names, others):
    pattern = re.compile(alternation(names))
    for name in [*names, *others]:
        assert bool(pattern.fullmatch(name)) == (name in names)


def test_no_name_matches_nothing():
    assert re.match(alternation([]), "") is None


def test_names_that_begin_alike_are_written_once():
    names = [f"twin_{number:05d}" for number in range(10_000)]
    pattern = alternation(names)
    assert len(pattern) < 10 * len(names)
    assert all(re.compile(pattern).fullmatch(name) for name in names[::997])
