"""One surface elastic and capped: pairs, curves and captions of their figure."""

from dataclasses import asdict

import numpy as np
import pytest
from made_stages import scan, stages_of
from materials import ROCK

from fractalcontact.figures.draw import draw_figure
from fractalcontact.stages.atlas import join_stages
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.synthesis import self_affine

RECIPE = {
    **{"label": "twin", "size": "4 mm", "spacing": "0.1 mm", "dimension": 2.2},
    **{"rms": "0.1 mm", "roll_off": "1.5 mm", "seed": 1},
}
STUDY = {
    "study": "pairs",
    "materials": {"rock": ROCK, "weak": {**ROCK, "hardness": "80 MPa"}},
    "embedded": {"elastic": RECIPE, "weak": {**RECIPE, "label": "weak twin"}},
    "defaults": {
        **{"material": "rock", "contact_directions": ["W"], "offsets": ["0.3 mm"]},
        **{"loads": ["0.5 MPa", "4 MPa", "25 MPa", "60 MPa"], "resolutions": [1, 2]},
        **{"window": "3.2 mm"},
    },
    "specimens": {"weak": {"material": "weak"}},
}


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    heights = self_affine((40, 40), 0.1, 0.8, rms=0.1, seed=1, roll_off=1.5)
    stages, settings, solver = {}, {}, solver_settings({}, "pairs")
    for name in STUDY["embedded"]:
        stated = resolve_settings(STUDY, name, {}, "pairs")
        settings[name] = asdict(stated)
        found = stages_of(name, (scan(heights, 0.1), None), stated, solver, later=("closure",))
        for stage, data in found.items():
            stages.setdefault(stage, {})[name] = data
    path = tmp_path_factory.mktemp("pairs") / "atlas.nc"
    join_stages(stages, path, {"study": STUDY, "settings": settings})
    return read_atlas(path)


def test_both_models_of_a_surface_stand_side_by_side(atlas):
    drawing = draw_figure(atlas, "elastic_and_capped", ["elastic", "weak"])
    for panel, name in (("a", "elastic"), ("b", "weak")):
        rows = drawing.data[drawing.data["panel"] == panel]
        assert set(rows["resolution"]) == {1, 2}
        curve = atlas[f"closure/{name}"].to_dataset()["closure_from_stated_seat"].squeeze()
        for k, of_grid in rows.groupby("resolution"):
            np.testing.assert_array_equal(
                of_grid["closure_from_stated_seat_mm"], curve.sel(resolution=k).values
            )
    assert (drawing.data["panel"] == "c").sum() == 2 * len(STUDY["defaults"]["loads"])
    assert "capped" in drawing.caption


def test_a_study_without_a_pair_says_so(atlas):
    drawing = draw_figure(atlas, "elastic_and_capped", ["elastic"])
    assert drawing.data.empty
    words = [text.get_text() for axes in drawing.figure.axes for text in axes.texts]
    assert any("no surface" in one for one in words)


def test_yielded_nodes_and_set_are_drawn_where_contacts_crush(atlas):
    crushed = draw_figure(atlas, "seated_closure", "weak").data
    branches = atlas["branches/weak"].to_dataset().sel(branch="load")
    rows = crushed[crushed["panel"] == "c"]
    fraction = branches["yielded_fraction"].values
    np.testing.assert_array_equal(rows["yielded_fraction"].dropna(), fraction[fraction > 0])
    assert {"d", "e"} <= set(crushed["panel"])
    assert set(draw_figure(atlas, "seated_closure", "elastic").data["panel"]) == {"a", "b"}
