"""A known surface in every dialect of text; `make fuzz-dialects FILES=5000` is the whole."""

import itertools
from dataclasses import replace

import dialect_fuzzing
import dialects
import numpy as np
import pytest
from ensembles import ensemble

from fractalcontact.core.errors import InputError
from fractalcontact.scan.read import read_scan


def test_files_depend_on_seed_and_number_alone_and_differ():
    assert len(dialects.DIALECTS) >= 200
    count = len(dialects.DIALECTS)
    first, again = dialects.make(3, 7), dialects.make(3, 7)
    assert (first.content, first.sidecar) == (again.content, again.sidecar)
    contents = {dialects.make(3, 7 + n * count).content for n in range(5)}
    assert len(contents) == 5


def test_the_judge_sees_what_must_not_happen(tmp_path):
    """A flip, a transposition, a wrong step, a wrong unit and a lost cell are each read wrong."""
    written = dialects.make(1, 0, "plain matrix")
    assert dialect_fuzzing.judge(written, tmp_path).outcome == "right"
    truth = written.surface
    holed = truth.heights.copy()
    holed[3, 3] = np.nan if np.isfinite(holed[3, 3]) else 0.0
    for wrong in (
        replace(truth, heights=truth.heights[::-1]),
        replace(truth, heights=truth.heights.T),
        replace(truth, dx=2 * truth.dx),
        replace(truth, heights=truth.heights * 1000),
        replace(truth, heights=holed),
    ):
        judgement = dialect_fuzzing.judge(replace(written, surface=wrong), tmp_path)
        assert (judgement.outcome, bool(judgement.fault)) == ("wrong", True)
    read = dialect_fuzzing.judge(replace(written, expected="refused"), tmp_path)
    assert read.outcome == "wrong"
    refused = dialect_fuzzing.judge(replace(written, sidecar={}), tmp_path)
    assert "refused, but its sidecar says all" in refused.fault
    named = dialects.make(1, 0, "units with the names")
    while not named.describes_itself or read_alone(named, tmp_path) != "read":
        named = dialects.make(1, next(NUMBERS), "units with the names")
    believed = dialect_fuzzing.judge(replace(named, describes_itself=False), tmp_path)
    assert "read without a sidecar, right" in believed.fault
    assert dialect_fuzzing.judge(named, tmp_path).fault == ""


NUMBERS = itertools.count(1)


def read_alone(written, folder):
    path = folder / f"alone{written.ending}"
    path.write_bytes(written.content)
    try:
        read_scan(path)
    except InputError:
        return "refused"
    return "read"


@pytest.mark.parametrize("name", dialects.DIALECTS)
def test_a_dialect_is_read_right_or_refused_with_advice(tmp_path, name):
    number = list(dialects.DIALECTS).index(name)
    for turn in range(ensemble("files of every dialect")):
        written = dialects.make(1, number + turn * len(dialects.DIALECTS))
        assert written.dialect == name
        judgement = dialect_fuzzing.judge(written, tmp_path)
        assert judgement.fault == ""
        if written.expected != "either":
            assert (judgement.outcome == "refused") == (written.expected == "refused")


def test_drafts_completed_by_their_owner_are_hardly_ever_read_wrong():
    """Empty lines are filled truly, all others accepted: one file in forty may be misread."""
    count = ensemble("drafted files")
    judgements = dialect_fuzzing.run(range(count), seed=2)
    wrong = [j.written.dialect for j in judgements if j.drafted == "wrong"]
    assert len(wrong) <= count / 40, wrong
    assert sum(j.drafted == "right" for j in judgements) > count / 2
