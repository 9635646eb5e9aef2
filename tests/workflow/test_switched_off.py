"""A study is the same to the last bit without each part of workflow/engine."""

import pytest
from projects import copy_project, made, run, small_study, write_scan

pytestmark = [pytest.mark.workflow, pytest.mark.full]
STUDY, ATLAS = "config/test.yaml", "results/test/atlas.nc"
#: Place of the job's log, checksums and signals: what is left sets threads, as libraries read them.
BARE_JOB = '''
import contextlib
import logging
import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"


@contextlib.contextmanager
def job(snakemake):
    """Nothing around the work."""
    yield logging.getLogger()
'''
#: Parts by name, and what is written in place of which text of a file; None is all of it.
PARTS = {
    "executor, logger and run.py": {},
    "code_digest.py": {
        "workflow/rules/common.smk": {
            'functools.cache(Code(ROOT / "src", ROOT, ROOT / "workflow").digest)': (
                'lambda *names: ""'
            )
        }
    },
    "provenance.py": {"Snakefile": {"\nremake_without_record()": ""}},
    "ending.py": {"workflow/rules/records.smk": {"        answer_in_thread()": "        pass"}},
    "plan.py and running.py": {"Snakefile": {"    begin()": "    pass", "    end()": "    pass"}},
    "job.py": {"workflow/engine/job.py": {None: BARE_JOB}},
}


def study_in(folder):
    folder.mkdir()
    copy_project(folder)
    small_study(folder)
    write_scan(folder, "rock")
    return folder


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """Atlas of a study that was made with all parts."""
    folder = study_in(tmp_path_factory.mktemp("with") / "all")
    done = made(folder, STUDY, targets=[ATLAS])
    assert done.returncode == 0, done.stderr[-3000:]
    return (folder / ATLAS).read_bytes()


@pytest.mark.parametrize("part", PARTS)
def test_a_study_has_the_same_bytes_without(expected, tmp_path, part):
    folder = study_in(tmp_path / "without")
    for name, texts in PARTS[part].items():
        text = (folder / name).read_text(encoding="utf-8")
        for old, new in texts.items():
            assert old is None or old in text
            text = new if old is None else text.replace(old, new)
        (folder / name).write_text(text, encoding="utf-8")
    done = made(folder, STUDY, targets=[ATLAS]) if PARTS[part] else run(folder, STUDY, ATLAS)
    assert done.returncode == 0, done.stderr[-3000:]
    assert (folder / ATLAS).read_bytes() == expected
