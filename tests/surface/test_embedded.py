"""Embedded specimens by their constructions: each has the dimension it is asked for."""

import numpy as np
import pytest
from known_sets import punch_dimensions

from fractalcontact.core.errors import InputError
from fractalcontact.roughness.dimension import surface_dimension
from fractalcontact.study.configuration import resolve_embedded
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
    ],
)
def test_what_a_construction_cannot_make_is_refused(changes, words):
    with pytest.raises(InputError, match=words):
        resolve_embedded(RECIPE | changes, "embedded.it")
