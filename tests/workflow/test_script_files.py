"""What scripts share: scans that must not change while a study runs."""

import importlib

import pytest
from places import ROOT

from fractalcontact.core.checksums import sha256
from fractalcontact.core.errors import InputError


@pytest.fixture
def files(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "workflow/scripts"))
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
