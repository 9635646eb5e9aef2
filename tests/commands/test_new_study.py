"""Study of one's own scans: written once, valid, with drafts of the sidecars that scans lack."""

import re

import numpy as np
import pytest
import yaml

from fractalcontact.commands.new_study import main
from fractalcontact.study.campaign import MAX_WHOLE
from fractalcontact.study.checks import resolve_study
from fractalcontact.study.sidecar import sidecar_of_matrix


@pytest.fixture
def home(tmp_path, monkeypatch):
    (tmp_path / "scans").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def new(*arguments):
    return main([*map(str, arguments)])


def self_describing(folder, name, cells=12):
    z = np.random.default_rng(1).normal(size=(cells, cells))
    lines = [f"{x},{y},{z[y, x]:.4f}" for y in range(cells) for x in range(cells)]
    (folder / f"{name}.csv").write_text("x [mm],y [mm],z [um]\n" + "\n".join(lines) + "\n")


def resolved(path):
    config = yaml.safe_load(path.read_text())
    return config, resolve_study(config, str(path))


@pytest.mark.parametrize("make", [True, False])
def test_without_a_scan_one_sentence_says_where_to_put_one(home, capsys, make):
    (home / "scans/README.md").write_text("no scan")
    if not make:
        (home / "scans/README.md").unlink()
        (home / "scans").rmdir()
    assert new() == 1
    told = capsys.readouterr().err
    assert told.startswith("error: scans: no ")
    assert told.count("\n") == 1
    assert not (home / "config").exists()


def test_the_study_of_a_scan_that_describes_itself_resolves(home, capsys):
    self_describing(home / "scans", "granite")
    assert new() == 0
    config, study = resolved(home / "config/mine.yaml")
    assert (config["study"], config["scans"]) == ("mine", "scans")
    assert set(study.settings) == {"granite"}
    # No experiment, no twin.
    assert config.keys() <= {"study", "scans", "figures", "materials", "defaults"}
    assert config["figures"] == "joint"
    assert "granite" in (home / "config/mine.yaml").read_text().split("materials:")[0]
    *_, written, first, second, third = capsys.readouterr().out.splitlines()
    assert written == "config/mine.yaml: written"
    assert "draft" not in first
    assert "make check-scans STUDY=config/mine.yaml" in second
    assert third.startswith("3. make STUDY=config/mine.yaml ")


def test_a_scan_without_sidecar_gets_a_draft_that_no_study_reads(home, capsys):
    np.save(home / "scans/slate.npy", np.random.default_rng(1).normal(size=(12, 12)))
    assert new() == 0
    assert {path.name for path in (home / "scans").iterdir()} == {
        "slate.npy",
        "slate.draft.yaml",
        "slate.draft.png",
    }
    assert "rename NAME.draft.yaml to NAME.yaml" in capsys.readouterr().out
    assert resolved(home / "config/mine.yaml")[1].options == {"slate": {}}
    sidecar = yaml.safe_dump(sidecar_of_matrix(0.1))
    (home / "scans/slate.yaml").write_text(sidecar)
    assert resolved(home / "config/mine.yaml")[1].options["slate"]["spacing"] == "0.1 mm"


def test_nothing_is_overwritten_and_another_name_is_another_study(home, capsys):
    self_describing(home / "scans", "granite")
    assert new() == 0
    (home / "config/mine.yaml").write_text("my own\n")
    assert new() == 1
    assert re.search("config/mine.yaml exists.* make new NAME=", capsys.readouterr().err)
    assert (home / "config/mine.yaml").read_text() == "my own\n"
    assert new("--name", "other") == 0
    assert resolved(home / "config/other.yaml")[0]["study"] == "other"


@pytest.mark.parametrize("name", ["../mine", "a b", "$(id)", "", "mine\n", "-x.y"])
def test_a_name_that_cannot_name_a_study_is_refused(home, capsys, name):
    self_describing(home / "scans", "granite")
    assert new(f"--name={name}") == 1
    assert "expected the study's name" in capsys.readouterr().err
    assert [path.name for path in home.iterdir()] == ["scans"]


def test_hostile_names_of_files_and_folder_stay_words(home, capsys):
    folder = home / "my: scans #1 'of' \"rock\" ${name} {x}"
    folder.mkdir()
    for name in ("null", "1e3", "a b; rm -rf #", "ünïcode"):
        self_describing(folder, name)
    self_describing(folder, "bell\a")
    assert new("--scans", folder.name) == 0
    config = yaml.safe_load((home / "config/mine.yaml").read_text())
    assert config["scans"] == folder.name
    study = resolve_study(config, "mine", leave_out=True)
    assert set(study.settings) >= {"null", "1e3"}
    assert len(study.settings) == 4
    told = capsys.readouterr().out
    assert "\a" not in told
    assert "invisible characters" in told
    assert "mend or remove the refused files" in told


def test_many_scans_get_a_study_without_figures(home):
    for number in range(MAX_WHOLE + 1):
        self_describing(home / "scans", f"granite_{number}")
    assert new() == 0
    assert yaml.safe_load((home / "config/mine.yaml").read_text())["figures"] == "none"
