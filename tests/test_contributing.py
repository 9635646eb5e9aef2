"""CONTRIBUTING.md names every part around Snakemake, and ``make lint`` prints net lines."""

import re
import subprocess

import net_lines
import pytest
from places import ROOT

TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
ENGINE = ROOT / "workflow" / "engine"


def parts_of_engine():
    """Paths named in the table of what is around Snakemake, by its rows, with the lines stated."""
    rows = TEXT.partition("\n| part of `workflow/engine/` |")[2].partition("\n\n")[0]
    for row in rows.splitlines()[2:]:
        part, lines, *_ = row.strip("|").split("|")
        names = re.findall(r"`([\w/.]+)`", part)
        yield (
            [ROOT / "src/fractalcontact" / n if "/" in n[:-1] else ENGINE / n for n in names],
            lines,
        )


def test_table_of_the_engine_names_every_part_and_its_lines():
    parts = list(parts_of_engine())
    named = {path for paths, _ in parts for path in paths if path.is_relative_to(ENGINE)}
    assert {
        path for path in ENGINE.iterdir() if path.name not in ("__init__.py", "__pycache__")
    } == {path for path in named if path.exists()}
    for paths, stated in parts:
        files = [f for path in paths for f in ([path] if path.is_file() else path.rglob("*.py"))]
        lines = sum(len(file.read_text(encoding="utf-8").splitlines()) for file in files)
        assert lines == pytest.approx(int(stated), rel=0.25, abs=20), paths


def git(folder, *args):
    settings = ("-c", "user.name=n", "-c", "user.email=e", "-c", "commit.gpgsign=false")
    subprocess.run(["git", *settings, "-C", folder, *args], check=True, capture_output=True)


@pytest.fixture
def repository(tmp_path):
    """A history of one merge, which adds three lines to src and removes one from tests."""
    folder = tmp_path / "repository"
    for name in ("src", "tests", "docs"):
        (folder / name).mkdir(parents=True)
    (folder / "tests/test_a.py").write_text("a\nb\n", encoding="utf-8")
    git(folder, "init", "-b", "main")
    git(folder, "add", ".")
    git(folder, "commit", "-m", "First")
    git(folder, "switch", "-c", "side")
    (folder / "src/a.py").write_text("a\nb\nc\n", encoding="utf-8")
    (folder / "tests/test_a.py").write_text("a\n", encoding="utf-8")
    (folder / "docs/a.md").write_text("of no folder that is counted\n", encoding="utf-8")
    git(folder, "add", ".")
    git(folder, "commit", "-m", "Second")
    git(folder, "switch", "main")
    git(folder, "merge", "--no-ff", "-m", "Merge branch 'side'", "side")
    return folder


def test_net_lines_of_a_merge_by_folder(repository):
    head, merge, total = net_lines.report(repository)
    assert head == "net lines over the last 1 merges"
    assert merge.split()[:6] == ["src", "+3", "workflow", "+0", "tests", "-1"]
    assert merge.endswith("Merge branch 'side'")
    assert total.split()[:6] == merge.split()[:6]


def test_no_net_lines_without_history_or_in_a_shallow_one(repository, tmp_path):
    shallow = tmp_path / "shallow"
    subprocess.run(
        ["git", "clone", "--depth=1", repository.as_uri(), shallow], check=True, capture_output=True
    )
    assert net_lines.report(shallow) == ["net lines: the history is shallow, so no merges to count"]
    (tmp_path / "archive").mkdir()
    assert "no history" in net_lines.report(tmp_path / "archive")[0]
