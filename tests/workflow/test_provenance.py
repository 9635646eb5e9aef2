"""Results whose record is lost, damaged or another job's are those that are made again."""

import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from places import ROOT

from fractalcontact.core import checksums

sys.path.append(str(ROOT / "workflow"))
from engine import provenance

RESULTS = "results/test"
FILE = f"{RESULTS}/closure/rock.nc"
STATES = f"{RESULTS}/contact/rock.nc"
RECORD = {"params": ["settings"], "input": [STATES, "scans/rock.npy"], "starttime": 1000.0}


@pytest.fixture
def is_kept(tmp_path, monkeypatch):
    """True if a file with this record, log and times (of itself, of its checksums) is kept."""
    monkeypatch.chdir(tmp_path)
    for path in (FILE, STATES):
        Path(path).parent.mkdir(parents=True)
        Path(path).write_text("numbers")
    checksums.record(Path(RESULTS), [Path(FILE)])
    log = Path("rock.log")

    def kept(*, of_file=1005, of_sums=1010, said="worked 3 s\n", outdated=False, **changes):
        log.write_text(said)
        record = SimpleNamespace(**RECORD | {"log": [str(log)]} | changes)
        os.utime(FILE, (of_file, of_file))
        sums = checksums.record_of(RESULTS, FILE)
        os.utime(sums, (of_sums, of_sums))
        records = SimpleNamespace(
            metadata=lambda file: record if changes.get("params") != "lost" else None,
            has_outdated_metadata=lambda job: outdated,
        )
        is_there = os.path.exists
        return provenance._has_provenance(FILE, records, RESULTS, is_there)

    return kept


def test_a_result_with_its_record_is_kept_wherever_its_scan_is(is_kept):
    assert is_kept()


@pytest.mark.parametrize(
    "changes",
    [{"params": "lost"}, {"params": None}, {"input": None}, {"outdated": True}],
    ids=str,
)
def test_a_result_whose_record_is_lost_or_of_another_version_is_made_again(is_kept, changes):
    assert not is_kept(**changes)


def test_a_record_that_cannot_be_read_is_lost():
    def unreadable(file):
        raise ValueError("no JSON")

    records = SimpleNamespace(metadata=unreadable)
    assert not provenance._has_provenance(FILE, records, RESULTS, os.path.exists)


def test_a_result_of_a_result_that_is_gone_is_made_again(is_kept):
    Path(STATES).unlink()
    assert not is_kept()


@pytest.mark.parametrize(
    ("times", "said", "is_old"),
    [
        # The job of the record began, and the file was put back, after its last checksums.
        ({"starttime": 1020.0, "of_file": 1030}, "error: no numbers\n", True),
        ({"starttime": 1020.0, "of_file": 1030}, "worked 3 s\nkilled\n", True),
        ({"starttime": 1020.0, "of_file": 1030}, "worked 3 s\n", False),  # `--touch`
        ({"starttime": 1020.0}, "error: no numbers\n", False),
        ({"of_file": 1030}, "error: no numbers\n", False),
    ],
)
def test_a_file_that_its_failed_job_put_back_is_made_again(is_kept, times, said, is_old):
    assert is_kept(said=said, **times) is not is_old
