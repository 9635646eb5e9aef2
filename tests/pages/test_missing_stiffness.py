"""A stiffness that single cells would decide is missing in atlas and figures."""

import re

import numpy as np
import pytest
from chain import atlas_of_scan
from extremes import Extreme, rough, write_extreme
from materials import ROCK

from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.study.atlas import read_atlas
from roughcontact.contact.slope import FEW_CELLS

LOADS = ["0.2 MPa", "1 MPa", "5 MPa", "20 MPa", "60 MPa", "120 MPa"]
HARDNESS = 150.0


@pytest.fixture(scope="module")
def atlas_file(tmp_path_factory):
    """A joint that yields at all loads but the lightest."""
    folder = tmp_path_factory.mktemp("project") / "results/small"
    folder.mkdir(parents=True)
    material = {"material": ROCK | {"hardness": f"{HARDNESS:g} MPa"}}
    shown = {"map_load": "1 MPa", "dilatancy_loads": ["1 MPa", "5 MPa", "60 MPa"]}
    settings = material | {"loads": LOADS} | shown
    files = write_extreme(folder, Extreme(rough(), settings=settings), "specimen")
    path, _ = atlas_of_scan(*files[:3], folder, files[3])
    return path


@pytest.fixture(scope="module")
def atlas(atlas_file):
    return read_atlas(atlas_file)


@pytest.fixture(scope="module")
def curves(atlas):
    return atlas["closure/specimen"].to_dataset()


def test_whatever_is_missing_has_its_reason_and_nothing_else_has_one(curves):
    missing = curves["solved"] & curves["interface_stiffness"].isnull()
    reasons = curves["interface_stiffness_reason"]
    assert missing.any()
    np.testing.assert_array_equal(reasons != "", missing)
    assert not (curves["interface_stiffness"] <= 0).any()
    for name in (
        "stiffness_error",
        "interface_stiffness_error",
        "conductance",
        "conductance_error",
    ):
        assert curves[name].where(missing).isnull().all(), name


def test_a_stiffness_beside_yielded_nodes_is_that_of_its_closure_curve(curves):
    """It lies about the secants to the states beside it, and half of the states have one.

    The others have under 30 free nodes.
    """
    every = curves[["closure", "stiffness"]].sel(resolution=1)
    every = every.transpose("direction", "offset", "normal_force")
    secants = np.diff(every["normal_force"].values) / np.diff(every["closure"].values)
    low = np.minimum(secants[..., :-1], secants[..., 1:]) / 2
    high = np.maximum(secants[..., :-1], secants[..., 1:]) * 2
    stiffness = every["stiffness"].values[..., 1:-1]
    known = np.isfinite(stiffness)
    assert ((low < stiffness) & (stiffness < high))[known].all()
    assert 0.4 < known.mean() < 1


def test_the_scatter_of_a_secant_is_no_error_of_the_solver(atlas, curves):
    """In the error budget it has a source of its own; what the solver leaves is small beside it."""
    scatter, error = curves["interface_stiffness_scatter"], curves["interface_stiffness_error"]
    known = curves["interface_stiffness"].notnull()
    assert (scatter <= error).where(known, True).all()
    errors = atlas["error_budget/specimen"].to_dataset()["error"].sel(quantity="stiffness")
    yields = errors.sel(source="secant") > 0
    assert yields.any()
    assert (errors.sel(source="solver") < errors.sel(source="secant")).where(yields, True).all()


def test_errors_of_the_closure_stay_known_beside_a_missing_stiffness(atlas, curves):
    budget = atlas["error_budget/specimen"].to_dataset()
    assert np.isfinite(budget["total"].sel(quantity="closure")).all()
    left_out = atlas["dilatancy/specimen"].to_dataset()["left_out_error"]
    assert np.isfinite(left_out.isel(normal_force=slice(1, -1))).all()


@pytest.mark.parametrize("figure", ["compliance", "conductance", "fig04_05_closure"])
def test_figures_say_why_points_are_missing(atlas, figure):
    with print_style():
        drawing = drawer_of(figure)(atlas, "specimen")
    shown = [text.get_text() for legend in drawing.figure.legends for text in legend.get_texts()]
    shown += [text.get_text() for axes in drawing.figure.axes for text in axes.texts]
    assert FEW_CELLS in re.sub(r"\s+", " ", " ".join(shown))
    table = drawing.data
    ends = "stiffness_MPa_per_mm", "compliance_mm_per_MPa"
    known = [name for name in table if name.endswith(ends)]
    stated = ("stiffness_missing_because", "interface_stiffness_reason")
    reasons = table[next(name for name in stated if name in table)].fillna("")
    for name in known:
        assert table.loc[reasons != "", name].isna().all()
