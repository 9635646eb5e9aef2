"""Figures that would not change are kept: what is a change of a figure, and what is none."""

import json

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.subject import configuration_of
from fractalcontact.figures import draw
from fractalcontact.figures.draw import ENDINGS, draw_figures
from fractalcontact.figures.sources import read_sources, source_of
from fractalcontact.study.figure_list import all_figures

NAMES = ["conductance", "compliance", "strength"]
SPECIMEN = "sliding"


@pytest.fixture
def redrawn(atlas, tmp_path, monkeypatch):
    """Names of the figures that a second job draws, of an atlas drawn once and then changed."""

    def drawn(changed, code="as it was"):
        monkeypatch.setattr(draw, "read_atlas", lambda path: changed)
        record = tmp_path / "drawn_from.txt"
        result = draw_figures("", SPECIMEN, tmp_path / "figures", NAMES, record, code)
        assert result.failures == {}
        assert sorted([*result.captions, *result.unchanged]) == sorted(NAMES)
        assert read_sources(record).keys() == set(NAMES)
        return set(result.captions)

    assert drawn(atlas) == set(NAMES)
    return drawn


def with_stage(atlas, stage, **variables):
    """The atlas with other values of variables of a stage of the specimen."""
    changed, data = atlas.copy(), atlas[f"{stage}/{SPECIMEN}"].to_dataset()
    for name, values in variables.items():
        data[name] = data[name].copy(data=values)
    changed[f"{stage}/{SPECIMEN}"] = xr.DataTree(data)
    return changed


def with_settings(atlas, **changes):
    """The atlas with other settings of the specimen."""
    changed, configuration = atlas.copy(), configuration_of(atlas)
    configuration["settings"][SPECIMEN] |= changes
    changed.attrs = atlas.attrs | {"configuration": json.dumps(configuration)}
    return changed


def test_what_did_not_change_is_kept_and_other_code_draws_all(redrawn, atlas, tmp_path):
    files = [tmp_path / f"figures/{name}.{ending}" for name in NAMES for ending in ENDINGS]
    times = [path.stat().st_mtime_ns for path in files]
    assert redrawn(atlas) == set()
    assert [path.stat().st_mtime_ns for path in files] == times
    assert redrawn(atlas, code="another") == set(NAMES)
    assert [path.stat().st_mtime_ns for path in files] != times


def test_a_changed_stage_draws_the_figures_that_need_it(redrawn, atlas):
    angle = atlas[f"strength/{SPECIMEN}"]["dilatancy_angle"].values + 1e-9
    assert redrawn(with_stage(atlas, "strength", dilatancy_angle=angle)) == {"strength"}
    for name in NAMES:
        assert ("strength" in all_figures()[name].needs) == (name == "strength")


def test_a_changed_verdict_draws_the_figures_that_quote_it(redrawn, atlas, tmp_path):
    table = atlas[f"statements/{SPECIMEN}"].to_dataset()
    quoted = set(read_sources(tmp_path / "drawn_from.txt")["compliance"].statements)
    rows = table["statement"].values.tolist()
    assert quoted & set(rows)
    assert quoted < set(rows)
    for statements, expected in ((quoted, {"compliance"}), (set(rows) - quoted, set())):
        words = table["numbers"].values.copy()
        words[[one in statements for one in rows]] = "other numbers"
        changed = with_stage(atlas, "statements", numbers=words)
        assert redrawn(changed) == expected
        redrawn(atlas)


def test_friction_angle_and_wall_strength_draw_nothing_by_themselves(redrawn, atlas):
    material = configuration_of(atlas)["settings"][SPECIMEN]["material"]
    friction = {"basic_friction_angle": 44.0, "joint_wall_strength": 55.0}
    assert redrawn(with_settings(atlas, material=material | friction)) == set()
    assert redrawn(with_settings(atlas, label="another name")) == set(NAMES)
    stiffer = with_settings(atlas, label="another name", material=material | {"e_star": 1.0})
    assert redrawn(stiffer) == set(NAMES)


def test_a_lost_file_is_drawn_again_and_a_figure_that_failed_is_not_kept(
    redrawn, atlas, tmp_path, monkeypatch
):
    (tmp_path / "figures/strength.csv").unlink()
    assert redrawn(atlas) == {"strength"}
    whole = draw.draw_figure

    def failing(tree, name, subject):
        if name == "strength":
            raise ValueError("made to fail")
        return whole(tree, name, subject)

    monkeypatch.setattr(draw, "draw_figure", failing)
    record = tmp_path / "drawn_from.txt"
    failed = draw_figures("", SPECIMEN, tmp_path / "figures", NAMES, record, "another code")
    assert failed.failures.keys() == {"strength"}
    assert read_sources(record).keys() == set(NAMES) - {"strength"}
    monkeypatch.setattr(draw, "draw_figure", whole)
    assert redrawn(atlas, code="another code") == {"strength"}


def test_equal_content_has_one_digest_and_every_part_of_it_counts(atlas):
    def digest(tree):
        return source_of(tree, "conductance", SPECIMEN, (), "").digest

    stage = atlas[f"closure/{SPECIMEN}"].to_dataset()
    assert digest(atlas) == digest(atlas.copy(deep=True))
    other = stage["stiffness"].values.copy()
    other.flat[0] = np.nextafter(np.nan_to_num(other.flat[0]), np.inf)
    assert digest(with_stage(atlas, "closure", stiffness=other)) != digest(atlas)
    changed = atlas.copy()
    changed[f"closure/{SPECIMEN}"] = xr.DataTree(stage.assign_attrs(warning="another"))
    assert digest(changed) != digest(atlas)
