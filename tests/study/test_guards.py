"""Results that a run must not lose."""

import pytest

from fractalcontact.core import checksums
from fractalcontact.core.errors import InputError
from fractalcontact.study.guards import refuse_loss


@pytest.fixture
def results(tmp_path, monkeypatch):
    """Folder of a study with an atlas of two specimens and a contact map."""
    monkeypatch.chdir(tmp_path)
    for name in ("atlas", "specimens/rock", "specimens/joint", "contact_maps/film"):
        path = tmp_path / f"results/test/{name}.nc"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    (tmp_path / "results/test/specimens.txt").write_text("film\njoint\nrock\n")
    checksums.record(tmp_path / "results/test", (tmp_path / "results/test").rglob("*.nc"))
    return tmp_path / "results/test"


@pytest.mark.parametrize("listed", [True, False])
@pytest.mark.parametrize("aside", [True, False])
def test_an_atlas_loses_no_specimen_without_a_word(results, listed, aside):
    if not listed:  # of an earlier version
        (results / "specimens.txt").unlink()
    if aside:
        checksums.set_aside(results, results / "atlas.nc")
    refuse_loss(results, ["rock", "joint", "film", "new"])
    with pytest.raises(InputError, match=r"no longer has: film, rock; put their scans back"):
        refuse_loss(results, ["joint"])


def test_without_an_atlas_there_is_nothing_to_lose(results):
    (results / "atlas.nc").unlink()
    refuse_loss(results, [])
