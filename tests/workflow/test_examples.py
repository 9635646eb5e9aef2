"""Studies of `config/examples`: valid and short; `make examples` runs each of them once."""

import os

import pytest
import yaml
from places import ROOT
from projects import made, project, rough_heights, write_scan

from fractalcontact.study.checks import resolve_study

__all__ = ["project"]  # a fixture
EXAMPLES = sorted(ROOT.glob("config/examples/*.yaml"))


def write_pair(folder):
    """Two faces 0.05 mm apart in one frame, and what is said of them."""
    heights = rough_heights(seed=2, n=96)
    write_scan(folder, "granite", heights)
    (folder / "scans/granite.npy").rename(folder / "scans/granite.lower.npy")
    write_scan(folder, "upper", rough_heights(seed=3, n=96) * 0.05 + heights + 0.05)
    (folder / "scans/upper.npy").rename(folder / "scans/granite.upper.npy")
    (folder / "scans/upper.yaml").unlink()


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_short_valid_and_says_what_it_answers(path, tmp_path, monkeypatch):
    (tmp_path / "scans").mkdir()
    write_pair(tmp_path)
    monkeypatch.chdir(tmp_path)
    first, *lines = path.read_text().splitlines()
    assert first.startswith("# ")
    assert first.endswith("?")
    assert len(lines) < 40
    config = yaml.safe_load(path.read_text())
    assert resolve_study(config, path.name).settings
    assert config["study"] == path.stem


@pytest.mark.skipif("EXAMPLES" not in os.environ, reason="`make examples` runs them, minutes each")
@pytest.mark.workflow
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs_to_its_page(path, project):
    write_pair(project)
    done = made(project, f"config/examples/{path.name}")
    assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]
    assert (project / f"results/{path.stem}/index.html").is_file()
