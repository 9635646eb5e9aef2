"""Plan of a run: what its jobs on a cluster work with, whatever is edited meanwhile."""

import sys
from types import SimpleNamespace

import pytest
import yaml
from places import ROOT
from snakemake.exceptions import WorkflowError
from stated import array_sidecar

from fractalcontact.core.checksums import sha256

sys.path.append(str(ROOT / "workflow"))
from engine import plan

STUDY = """
study: test
materials: {rock: {modulus: 20 GPa, poisson: 0.2}}
defaults: {material: rock, loads: [5 MPa], resolutions: [1, 2]}
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scans").mkdir()
    (tmp_path / ".snakemake").mkdir()
    (tmp_path / "scans/rock.npy").write_bytes(b"heights")
    (tmp_path / "scans/rock.yaml").write_text(array_sidecar(0.1))
    (tmp_path / "study.yaml").write_text(STUDY)
    return tmp_path


def planned(config, *, is_job=False, told=None):
    """Plan of a run, or of one of its jobs on a cluster."""
    workflow = SimpleNamespace(
        is_main_process=not is_job,
        config=config,
        configfiles=["study.yaml"],
        config_settings=SimpleNamespace(config=told or {}),
    )
    return plan.Plan(workflow, config, "study.yaml")


def test_a_study_is_read_as_the_program_reads_it_and_the_command_line_comes_last(folder):
    config = {"study": "as Snakemake reads it"}
    planned(config, told={"study": "told"})
    assert config == yaml.safe_load(STUDY) | {"study": "told"}


def test_a_study_that_another_workflow_hands_over_stays(folder):
    config = yaml.safe_load(STUDY) | {"study": "of_another"}
    workflow = SimpleNamespace(config={"study": "of the other workflow"}, configfiles=[])
    plan.read_again(workflow, config)
    assert config["study"] == "of_another"


def test_jobs_of_a_run_take_its_study_and_digests_whatever_is_edited_meanwhile(folder):
    config = {}
    run = planned(config)
    scan = folder / "scans/rock.npy"
    digest = sha256(scan)
    run.save()
    scan.write_bytes(b"others")
    (folder / "scans/rock.yaml").write_text(array_sidecar(0.2))
    (folder / "study.yaml").write_text("study: another\nscans: nowhere\n")
    of_job = {"study": "another", "scans": "nowhere"}
    job = planned(of_job, is_job=True)
    assert of_job == config
    assert job.study.options == run.study.options
    assert job.all_digests() == run.all_digests() == {"scans/rock.npy": digest}


def test_a_scan_has_the_digest_that_it_had_first(folder):
    run = planned({})
    digests = run.digests("scans/rock.npy")
    (folder / "scans/rock.npy").write_bytes(b"others")
    assert run.digests("scans/rock.npy") == digests
    assert run.digests("scans/none.npy") == {"scans/none.npy": ""}


@pytest.mark.parametrize("words", [["-k"], ["--keep-going"], []])
def test_one_bad_scan_is_left_out_where_the_user_asks_so(folder, monkeypatch, words):
    monkeypatch.setattr(sys, "argv", ["snakemake", *words])
    (folder / "scans/half.lower.xyz").write_text("1 2 3\n")
    if words:
        assert list(planned({}).study.refused) == ["half"]
    else:
        with pytest.raises(WorkflowError, match="the upper face is missing"):
            planned({})
