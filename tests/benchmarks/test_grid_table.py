"""Table of elastic and capped contact on several grids: what it solves, keeps and writes."""

import numpy as np
import pandas as pd
import pytest
import yaml
from materials import ROCK
from places import BENCHMARKS

STUDY = {
    "study": "grids",
    "scans": None,
    "materials": {"rock": ROCK, "unknown": {"modulus": "20 GPa", "poisson": 0.2}},
    "embedded": {
        name: {
            **{"label": name, "size": "2.4 mm", "spacing": "0.1 mm", "dimension": 2.2},
            **{"rms": "0.1 mm", "roll_off": "1 mm", "seed": seed},
        }
        for name, seed in (("first", 1), ("second", 2), ("soft", 3))
    },
    "defaults": {
        **{"material": "rock", "opposite": "flat", "contact_directions": ["W"]},
        **{"loads": ["1 MPa", "25 MPa"], "resolutions": [1]},
    },
    "specimens": {"soft": {"material": "unknown"}},
}
PAGE = "# A page\n\n{begin}\nold\n{end}\n\nWhat follows.\n"


@pytest.fixture
def table(monkeypatch, tmp_path):
    """Rows and both files of the command for some specimens of the study."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    import grid_table

    study, page, rows = (tmp_path / name for name in ("study.yaml", "page.md", "rows.csv"))
    study.write_text(yaml.safe_dump(STUDY), encoding="utf-8")
    page.write_text(PAGE.format(begin=grid_table.BEGIN, end=grid_table.END), encoding="utf-8")

    def made(*names):
        files = ["--study", str(study), "--table", str(rows), "--page", str(page)]
        grid_table.main([*files, "--specimens", *names])
        return pd.read_csv(rows), page.read_text(encoding="utf-8")

    return made


def test_rows_are_kept_and_the_page_shows_them(table):
    first, _ = table("first")
    both, page = table("second")
    pd.testing.assert_frame_equal(both[both["specimen"] == "first"].reset_index(drop=True), first)
    assert set(both["grid"]) == {"s/2", "s", "2s", "4s"}
    assert page.startswith("# A page\n")
    assert page.endswith("What follows.\n")
    assert "old" not in page
    assert page.count("| second | JCS |") == 4
    capped = both[both["model"] != "elastic"]
    carried = capped["pressure_MPa"] / capped["model"].map({"JCS": 80.0, "3 JCS": 240.0})
    for area in ("area", "area_corrected"):
        assert (capped[area] >= (1 - 1e-3) * carried).all()
    seat = both[both["pressure_MPa"] == both["pressure_MPa"].min()]
    np.testing.assert_array_equal(seat["closure_mm"], 0)


@pytest.mark.parametrize(
    ("name", "words"), [("soft", "joint_wall_strength"), ("third", "no specimen third")]
)
def test_what_cannot_be_solved_is_said_in_one_sentence(table, name, words):
    with pytest.raises(SystemExit, match=words):
        table(name)
