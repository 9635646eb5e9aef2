"""Parts that scripts share: inputs by name, unchanged scans, figures that failed."""

import importlib
import logging
import os
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr
from places import ROOT

from fractalcontact.core import netcdf
from fractalcontact.core.checksums import sha256
from fractalcontact.core.errors import InputError


@pytest.fixture
def files(monkeypatch):
    for folder in ("workflow", "workflow/scripts"):
        monkeypatch.syspath_prepend(str(ROOT / folder))
    return importlib.import_module("_files")


def test_a_scan_that_changed_while_the_study_ran_is_refused(files, tmp_path):
    scan = tmp_path / "rock.npy"
    scan.write_bytes(b"heights")
    digests = {str(scan): sha256(scan)}
    files.require_unchanged(digests)
    scan.write_bytes(b"others")
    with pytest.raises(InputError, match=r"rock\.npy: changed while the study ran"):
        files.require_unchanged(digests)
    scan.unlink()
    with pytest.raises(InputError, match=r"rock\.npy: changed while the study ran"):
        files.require_unchanged(digests)
    files.require_unchanged({str(scan): ""})  # what the study makes itself has no digest


def test_inputs_are_read_by_name_and_empty_ones_are_left_out(files, tmp_path):
    paths = {stage: str(tmp_path / stage / "rock.nc") for stage in ("closure", "area")}
    for stage, path in paths.items():
        Path(path).parent.mkdir()
        netcdf.write(xr.Dataset({"x": ("i", [1.0])}, attrs={"title": stage}), path)
    inputs = {"closure": paths["closure"], "parts": list(paths.values()), "ensemble": []}
    read = files.read_inputs(inputs)
    assert read.keys() == {"closure", "parts"}
    assert read["closure"].title == "closure"
    assert [part.title for part in read["parts"]] == ["closure", "area"]
    stages, made_with = files.read_stages(paths.values())
    assert {stage: list(of) for stage, of in stages.items()} == {key: ["rock"] for key in paths}
    assert made_with["area"]["rock"]["numpy"]


def test_figures_that_failed_are_listed_with_their_folder(files, tmp_path, caplog):
    figures = importlib.import_module("_figures")
    trace = {"joint": "KeyError: 'x'"}
    drawn = SimpleNamespace(captions={"relief": "Heights."}, failures=trace, unchanged=[])
    kept = SimpleNamespace(captions={}, failures={}, unchanged=["errors", "quality"])
    for result, folder, listed in ((drawn, "rock/", "rock/joint\n"), (kept, "rock/", "")):
        figures.say_drawn(result, tmp_path / "undrawn.txt", folder, logging.getLogger())
        assert (tmp_path / "undrawn.txt").read_text() == listed
    assert "figure joint was not drawn\nKeyError: 'x'" in caplog.text


#: Runs a script until it imports numpy, and then prints the variable that BLAS reads.
UNTIL_NUMPY = """
import os, runpy, sys

class Noting:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == "numpy":
            print(os.environ["OPENBLAS_NUM_THREADS"], flush=True)
            os._exit(0)

sys.meta_path.insert(0, Noting)
sys.path.insert(0, os.path.dirname(sys.argv[1]))
runpy.run_path(sys.argv[1])
"""


def first_import(script):
    """The first line of a script that imports a module of the project."""
    text = script.read_text(encoding="utf-8")
    return re.search(r"(?m)^from (?:_|engine|fractalcontact|contactlab).*", text)[0]


#: A script for each way to begin; all others import the same modules first.
BEGINNINGS = {first_import(path): path for path in (ROOT / "workflow/scripts").glob("[a-z]*.py")}


@pytest.mark.parametrize("script", BEGINNINGS.values(), ids=lambda path: path.stem)
def test_blas_has_one_thread_in_every_job(script):
    """A job of two threads, too: Snakemake sets the variable to the threads of the job."""
    paths = os.pathsep.join(str(ROOT / name) for name in ("src", "workflow"))
    done = subprocess.run(
        [sys.executable, "-c", UNTIL_NUMPY, str(script)],
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": paths, "OPENBLAS_NUM_THREADS": "2"},
    )
    assert done.stdout == "1\n", done.stderr
