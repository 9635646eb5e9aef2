"""Extreme specimens in one study: each has its figures, and none stops another."""

import pytest
import yaml
from extremes import EXTREMES, write_extreme
from projects import made, project, run, small_study, write_scan

from fractalcontact.study.figure_list import figures_of

__all__ = ["project"]  # a fixture
pytestmark = [pytest.mark.workflow, pytest.mark.full]

#: In the copy of the project, a figure of one specimen fails.
BROKEN = """

_whole = draw


def draw(atlas, name):
    if name == "polished":
        raise ZeroDivisionError("made to fail")
    return _whole(atlas, name)
"""


def drawn(project, name):
    return {path.stem for path in (project / "results/test/figures" / name).glob("*.png")}


def test_extremes_are_drawn_together_and_a_figure_that_fails_stops_no_other(project):
    study = small_study(project)
    for name in ("polished", "plane_against_plane", "mated_faces"):
        _, _, options, settings = write_extreme(project / "scans", EXTREMES[name](), name)
        sidecar = yaml.safe_dump({**options, **settings})
        (project / f"scans/{name}.yaml").write_text(sidecar)
    write_scan(project, "rough")
    module = project / "src/fractalcontact/figures/joint/conductance.py"
    whole = module.read_text()
    module.write_text(whole + BROKEN)
    done = made(project, study)
    # All is there, but the study has not succeeded, and says what failed.
    assert done.returncode != 0
    errors = {line for line in done.stderr.splitlines() if line.startswith("error: ")}
    assert len(errors) == 1
    assert "polished/conductance" in errors.pop()
    expected = {name: set(figures_of("match")) for name in ("polished", "mated_faces", "rough")}
    expected["plane_against_plane"] = set(figures_of("flat"))
    assert {name: drawn(project, name) for name in expected} == expected
    figures = project / "results/test/figures"
    assert "made to fail" in (figures / "polished/conductance.txt").read_text()
    assert "made to fail" in (project / "results/test/logs/figures/polished.log").read_text()
    assert (project / "results/test/atlas.nc").exists()
    # Nothing is drawn again, and it is said again.
    again = made(project, study)
    assert again.returncode != 0
    assert "polished/conductance" in again.stderr

    module.write_text(whole)
    mended = made(project, study)
    assert mended.returncode == 0, mended.stderr
    assert (figures / "polished/conductance.txt").read_text().startswith("Supplementary")
    assert "Nothing to be done" in (p := run(project, study, "--dry-run")).stdout + p.stderr
