"""A study of measured contact maps alone, from end to end."""

import numpy as np
import pandas as pd
import pytest
import yaml
from projects import copy_project, jobs_of, made, run
from stated import COMMAS, MAP

from fractalcontact.study.atlas import read_atlas

pytestmark = [pytest.mark.workflow, pytest.mark.full]
STUDY = "config/maps.yaml"


@pytest.fixture
def project(tmp_path):
    """Four films of one series, one of them in three files."""
    folder = copy_project(tmp_path)
    (folder / STUDY).write_text(yaml.safe_dump({"study": "maps", "scans": "scans"}))
    film = np.random.default_rng(0).random((24, 24))
    keys = {**MAP, **COMMAS, "unit": "mm", "series": "films", "threshold": [0.8, 0.9]}
    for n in range(4):
        np.savetxt(folder / f"scans/film_{n}.csv", film * (1 + 0.05 * n), delimiter=",")
        sidecar = keys | {"load": f"{10**n} N", "spacing": "0.5 mm"}
        if n == 3:
            del sidecar["spacing"], sidecar["first_row"]
            sidecar |= {"x": "film_x.csv", "y": "film_y.csv"}
        (folder / f"scans/film_{n}.yaml").write_text(yaml.safe_dump(sidecar))
    for axis in "xy":
        np.savetxt(folder / f"scans/film_{axis}.csv", [0.5 * np.arange(24)], delimiter=",")
    return folder


def test_maps_alone_are_a_study_and_get_their_figures(project):
    done = made(project, STUDY)
    assert done.returncode == 0, done.stderr[-3000:]
    atlas = read_atlas(project / "results/maps/atlas.nc")
    names = [f"film_{n}" for n in range(4)]
    assert [name for name, group in atlas.children.items() if group.children] == ["contact_maps"]
    assert sorted(atlas["contact_maps"].children) == names
    for name in ("contact_maps", "map_trend"):
        for ending in ("png", "svg", "csv", "txt"):
            assert (project / f"results/maps/figures/{name}.{ending}").is_file()
    summary = pd.read_csv(project / "results/maps/summary.csv")
    assert list(summary["map"]) == names
    assert jobs_of(run(project, STUDY, "--dry-run")) == {}
    # The files of the coordinates count as the map does.
    np.savetxt(project / "scans/film_x.csv", [0.4 * np.arange(24)], delimiter=",")
    jobs = jobs_of(run(project, STUDY, "--dry-run"))
    jobs_of_maps = ["contact_map", "atlas", "study_figures", "result_page", "all_drawn", "all"]
    assert jobs == dict.fromkeys(jobs_of_maps, 1)
