"""Embedded specimens by their constructions: each has the dimension it is asked for."""

import numpy as np
import pytest
import yaml
from ensembles import ensemble
from known_sets import punch_dimensions
from places import ROOT, SCANS
from scipy import stats
from stated import GRANITE

from fractalcontact.core.errors import InputError
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.roughness.dimension import surface_dimension
from fractalcontact.scan.read import read_scan
from fractalcontact.study.configuration import resolve_embedded
from fractalcontact.surface.cleaning import clean_faces
from fractalcontact.surface.embedded import embedded_surface

RECIPE = {
    "label": "synthetic",
    "size": "24.3 mm",
    "spacing": "0.1 mm",
    "dimension": 2.3,
    "rms": "0.2 mm",
    "seed": 3,
}
CONSTRUCTIONS = ["spectrum", "weierstrass-mandelbrot", "random-midpoint", "cantor-punch"]


def _surface(construction, **changes):
    recipe = RECIPE | {"construction": construction} | changes
    return embedded_surface(resolve_embedded(recipe, "embedded.it"))


@pytest.mark.parametrize("construction", CONSTRUCTIONS)
def test_size_and_roughness_are_those_asked_for(construction):
    heights = _surface(construction)
    assert heights.shape == (243, 243)
    assert np.isfinite(heights).all()
    np.testing.assert_array_equal(heights, _surface(construction))
    # About its mean plane, or about its mean: of the punch the plane is part of the shape.
    assert heights.std() == pytest.approx(0.2, rel=1e-6)
    assert np.isnan(_surface(construction, outline="disc")[0, 0])


@pytest.mark.parametrize("construction", CONSTRUCTIONS[:-1])
def test_random_surfaces_have_their_dimension(construction):
    found = surface_dimension(_surface(construction), 0.1).sel(estimator="variogram")
    assert float(found["dimension"]) == pytest.approx(2.3, abs=0.12)


@pytest.mark.parametrize("dimension", [2.1, 2.3, 2.6])
def test_the_punch_has_its_dimension(dimension):
    heights = _surface("cantor-punch", dimension=dimension)
    lowering = np.unique(np.round(np.diff(np.unique(heights)), 12))
    profile, contact = punch_dimensions(lowering=2 / 3 ** (dimension - 2))
    assert profile + 1 == pytest.approx(dimension)
    assert contact == pytest.approx(np.log(2) / np.log(3))
    assert len(lowering) > 1
    # The highest nodes are the Cantor set of the last generation.
    assert np.count_nonzero(heights[0] == heights[0].max()) == 2**5


def test_the_default_is_the_spectrum():
    plain = embedded_surface(resolve_embedded(RECIPE, "embedded.it"))
    np.testing.assert_array_equal(plain, _surface("spectrum"))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"construction": "random-midpoint", "roll_off": "1 mm"}, "write null"),
        ({"construction": "cantor-punch", "size": "20 mm"}, "write a size of 24.3 mm"),
        ({"construction": "random-midpoint", "anisotropy": 2}, "anisotropy: .* leave it out"),
        ({"construction": "cantor-punch", "intermittency": 0.1}, "intermittency: .* leave it out"),
    ],
)
def test_what_a_construction_cannot_make_is_refused(changes, words):
    with pytest.raises(InputError, match=words):
        resolve_embedded(RECIPE | changes, "embedded.it")


# -- faces like fractured rock ---------------------------------------------------------------------

FRACTURED = yaml.safe_load((ROOT / "config/examples/fractured_twins.yaml").read_text())["embedded"]


def _step(heights, lag):
    """Height differences over a number of nodes along x and y."""
    return heights[:, lag:] - heights[:, :-lag], heights[lag:] - heights[:-lag]


@pytest.mark.parametrize("name", FRACTURED)
def test_no_realisation_is_steeper_than_fractured_rock(name):
    recipe = resolve_embedded(FRACTURED[name], "embedded.it")
    spacing = recipe["spacing"]
    lag = round(0.3 / spacing)
    for seed in range(recipe["seed"], recipe["seed"] + ensemble("faces like fractured rock")):
        heights = embedded_surface({**recipe, "seed": seed})
        for step in _step(heights, lag):
            assert np.sqrt(np.nanmean(step**2)) / (lag * spacing) <= 0.36
        steepest = sum(np.nanmean(step**2) for step in _step(heights, 1)) / spacing**2
        assert np.sqrt(steepest) <= 0.8


def test_the_two_faces_share_no_seed():
    seeds = [range(r["seed"], r["seed"] + r["realisations"]) for r in FRACTURED.values()]
    assert set(seeds[0]).isdisjoint(seeds[1])


@pytest.mark.scans
@pytest.mark.skipif(not SCANS.is_dir(), reason="the folder of real scans is absent")
@pytest.mark.parametrize(
    ("file", "header"),
    [
        ("Extracted_M_CNL_SideA_bottom.txt", 2),
        pytest.param("Extracted_M_CNL_SideB_top.txt", 0, marks=pytest.mark.full),
    ],
)
def test_the_recipe_is_that_of_a_granite_face(file, header):
    stated = {key: value for key, value in GRANITE.items() if key != "upper"}
    scan = read_scan(SCANS / "cnl_granite_pair" / file, stated | {"header": header})
    (face,), _, _ = clean_faces([scan], outliers="fill", largest_hole=6)
    granite = without_mean_plane(face.values[3:211, 3:211])
    spacing = f"{face.attrs['spacing_x']} mm"
    recipe = FRACTURED["sandstone_face"] | {"spacing": spacing, "outline": "square"}
    recipe |= {"size": f"{208 * face.attrs['spacing_x']} mm", "rms": f"{granite.std()} mm"}
    recipe = resolve_embedded(recipe, "embedded.it")
    made = [embedded_surface({**recipe, "seed": seed}) for seed in range(12)]
    for lag in (1, 2, 4, 8, 16, 32):
        of_granite = [np.sqrt(np.mean(step**2)) for step in _step(granite, lag)]
        of_recipe = [
            np.sqrt(np.mean([np.mean(step**2) for step in steps]))
            for steps in zip(*(_step(heights, lag) for heights in made), strict=True)
        ]
        np.testing.assert_allclose(of_recipe, of_granite, rtol=0.3)
        assert of_granite[0] > of_granite[1]
    # At the spacing the slopes have tails far heavier than Gaussian ones, as those of the recipe.
    for steps in (_step(granite, 1), _step(made[0], 1)):
        for step in steps:
            assert stats.kurtosis(step, axis=None) + 3 > 6
