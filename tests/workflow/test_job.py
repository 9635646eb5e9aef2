"""Frame of a job: inputs as they were made, checksums of outputs, an end when it is told to end."""

import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT

from fractalcontact.core import checksums

FRAME = """
import os, signal, sys
from pathlib import Path
from types import SimpleNamespace
sys.path[:0] = [{workflow!r}, {package!r}]
from engine.job import job
snakemake = SimpleNamespace(
    log=["job.log"], input=[{input!r}], output=[{output!r}], resources={{}},
    config={{"study": "test"}},
)
with job(snakemake):
    {work}
"""
INPUT, OUTPUT = "results/test/a/rock.nc", "results/test/b/rock.nc"
WRITES = "Path(snakemake.output[0]).write_text('numbers')"
#: Work that takes the interrupt for an error of its own.
GOES_ON = f"""try:
        os.kill(os.getpid(), signal.SIGTERM)
        signal.pause()
    except KeyboardInterrupt:
        {WRITES}
"""


@pytest.fixture
def results(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path in map(Path, (INPUT, OUTPUT)):
        path.parent.mkdir(parents=True)
    Path(INPUT).write_text("heights")
    checksums.record(Path("results/test"), [Path(INPUT)])
    return Path("results/test")


def end_of(work):
    """Exit code of a job, and the last line of its log."""
    paths = {"workflow": str(ROOT / "workflow"), "package": str(ROOT / "src")}
    script = FRAME.format(work=work, input=INPUT, output=OUTPUT, **paths)
    done = subprocess.run([sys.executable, "-c", script], timeout=300)
    return done.returncode, Path("job.log").read_text().splitlines()[-1]


def test_an_output_leaves_its_checksum_and_the_log_ends_with_the_effort(results):
    code, last = end_of(WRITES)
    assert code == 0
    assert last.startswith("worked ")
    assert checksums.check(results).unrecorded == []


def test_a_damaged_input_is_refused_before_the_work(results):
    Path(INPUT).write_text("others")
    code, last = end_of(WRITES)
    assert (code, last) == (1, "no further attempt can do better")
    assert "error: results/test/a/rock.nc: damaged or replaced" in Path("job.log").read_text()
    assert not Path(OUTPUT).exists()


def test_a_job_that_is_told_to_end_leaves_no_result_though_its_work_goes_on(results):
    assert end_of(GOES_ON) == (143, "stopped before it was done")
    assert checksums.check(results).unrecorded == [Path(OUTPUT)]
