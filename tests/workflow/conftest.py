"""A study that tests of the workflow copy: made once, since it takes as long as most of them."""

import pytest
import yaml
from projects import copy_project, made, small_study, write_scan


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """A study of one scan against a plane with one figure, made by run.py, and what it said."""
    folder = copy_project(tmp_path_factory.mktemp("finished"))
    study = folder / small_study(folder, figures=["fig02_relief"])
    document = yaml.safe_load(study.read_text(encoding="utf-8"))
    document["defaults"] |= {"opposite": "flat", "resolutions": [1, 2]}
    study.write_text(yaml.safe_dump(document), encoding="utf-8")
    write_scan(folder, "rock")
    done = made(folder, "config/test.yaml")
    assert done.returncode == 0, done.stderr[-3000:]
    (folder / "said").write_text(done.stdout, encoding="utf-8")
    return folder
