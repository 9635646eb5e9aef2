"""What users hand over is refused by measures of domains and surfaces where it cannot be meant."""

import numpy as np
import pytest
from refused import GRID, NAN, masked

from fractalcontact.domain.box_counts import box_count, mean_count
from fractalcontact.domain.count_law import Law, best_law, law_dimension
from fractalcontact.domain.multifractal import generalised_dimensions, gliding_moments, lacunarity
from fractalcontact.roughness.estimators.cube_counting import cube_counting_curves
from fractalcontact.roughness.estimators.roughness_length import roughness_length_curves
from fractalcontact.roughness.estimators.triangular_prism import triangular_prism_curves
from fractalcontact.roughness.estimators.variogram import variogram_curves

DOMAIN = np.eye(12, dtype=bool)
SIZES = np.arange(4.0, 20.0)


@pytest.mark.parametrize(
    "call",
    [
        lambda: box_count(DOMAIN, [0]),
        lambda: box_count(DOMAIN[0], [1]),
        lambda: box_count(DOMAIN, [np.nan]),
        lambda: box_count(DOMAIN, [np.inf]),
        lambda: box_count(DOMAIN, [[1.0, 2.0]]),
        lambda: box_count(DOMAIN, ["2"]),
        lambda: box_count(DOMAIN, [2.0], max_shifts=0),
        lambda: box_count(DOMAIN.astype(str), [2.0]),
        lambda: box_count(masked(), [2.0]),
        lambda: box_count(NAN, [2.0]),
        lambda: mean_count(DOMAIN, [0]),
        lambda: mean_count(DOMAIN, [2], blocks=0),
        lambda: mean_count(DOMAIN, [2], blocks=-3),
        lambda: mean_count(DOMAIN, [2.5]),
        lambda: mean_count(DOMAIN, [1e300]),
        lambda: mean_count(DOMAIN[0], [1]),
        lambda: gliding_moments(GRID, [0], [1.0]),
        lambda: gliding_moments(GRID, [-4], [1.0]),
        lambda: gliding_moments(GRID, [2.5], [1.0]),
        lambda: gliding_moments(masked(), [2], [1.0]),
        lambda: lacunarity(np.ones(5), 1.0),
        lambda: lacunarity(GRID * 1j, 1.0),
        lambda: generalised_dimensions(-GRID, 1.0),
        lambda: best_law(SIZES, SIZES[1:], 20.0),
        lambda: best_law(SIZES[:, None], SIZES[:, None], 20.0),
        lambda: law_dimension(Law(1.0, 0.0, 1, 0), SIZES, SIZES[1:], 20.0),
        *(
            lambda curves=curves, values=values: curves(values, 0.1)
            for curves in (
                variogram_curves,
                roughness_length_curves,
                triangular_prism_curves,
                cube_counting_curves,
            )
            for values in (np.ones((16, 16, 16)), masked(), GRID * 1j, GRID.astype(str))
        ),
    ],
)
def test_measures_refuse_what_is_no_domain_no_surface_or_no_size(call):
    with pytest.raises(ValueError, match=r"expected|masked|grid|must be|missing|at least one cell"):
        call()
