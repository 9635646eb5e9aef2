"""A stray file or half a pair stops the study, with --keep-going only itself."""

import numpy as np
import pytest
from projects import made, project, rough_heights, small_study
from stated import array_sidecar

__all__ = ["project"]  # a fixture
pytestmark = [pytest.mark.workflow, pytest.mark.full]


def test_what_is_wrong_with_one_scan_stops_only_that_where_the_user_asks_so(project):
    folder = project / "my scans/of rock"
    study = small_study(project, scans=str(folder.relative_to(project)))
    folder.mkdir(parents=True)
    np.save(folder / "good slab.npy", rough_heights())
    (folder / "good slab.yaml").write_text(array_sidecar(0.1))
    (folder / "half.lower.xyz").write_text("1 2 3\n")
    (folder / "Thumbs.db").write_text("")
    stopped = made(project, study)
    assert stopped.returncode != 0
    assert "half.lower.xyz: the upper face is missing" in stopped.stderr
    planned = made(project, study, "--dry-run", targets=("--keep-going",)).stdout
    assert planned.count("a scan that is left out: what is wrong with it") == 1
    assert planned.count(": levelled faces, Delta_g, composite topographies at all offsets") == 1
    specimen = "results/test/specimens/good_slab.nc"
    refused = "results/test/refused/0.txt"
    done = made(project, study, targets=("--keep-going", specimen, refused))
    said = done.stdout + done.stderr
    assert done.returncode != 0
    assert "half.lower.xyz: the upper face is missing; add half.upper.xyz" in said
    assert "passed over, as systems and editors leave such files: Thumbs.db" in said
    assert (project / specimen).is_file()
    assert not (project / refused).exists()
