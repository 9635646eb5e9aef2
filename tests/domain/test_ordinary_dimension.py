"""The ordinary box-counting dimension, and the one result that every stage states."""

import numpy as np
import pytest
import xarray as xr
from known_sets import embedded

from fractalcontact.domain.analysis import analyse_domains
from fractalcontact.domain.box_counts import box_count, mean_count, window_sizes
from fractalcontact.domain.box_dimension import box_dimension, dimension_of_domain
from fractalcontact.domain.count_law import law_count
from fractalcontact.domain.null_models import null_models
from fractalcontact.domain.ordinary_dimension import dyadic_sizes
from fractalcontact.surface.synthesis import self_affine

HEIGHTS = self_affine((128, 128), 0.1, 0.8, rms=1.0, seed=2)


EXACT = {
    "window": (np.ones((128, 128), bool), 2),
    "square": (embedded((256, 256), slice(64, 192), slice(64, 192)), 2),
    "row": (embedded((256, 256), 100, slice(None)), 1),
    "diagonal": (np.eye(256, dtype=bool), 1),
}


@pytest.mark.parametrize("name", EXACT)
def test_squares_and_lines(name):
    domain, exact = EXACT[name]
    found = dimension_of_domain(domain, 0.1).ordinary
    assert found.value == pytest.approx(exact, abs=1e-9)
    assert found.low <= exact <= found.high


def test_slope_is_that_of_the_minimal_cover():
    domain = HEIGHTS > 1.2
    found = dimension_of_domain(domain, 0.1).ordinary
    sizes = found.sizes[found.used]
    slope = np.polyfit(np.log(sizes), np.log(box_count(domain, sizes)), 1)[0]
    assert found.value == pytest.approx(-slope)
    assert found.n == sizes.size
    assert dyadic_sizes((200, 128)).tolist() == [1, 2, 4, 8, 16, 32, 64]


def test_few_counts_on_a_line_do_not_claim_to_be_exact():
    domain = embedded((64, 64), [10, 10, 10, 10, 11, 50], [10, 11, 12, 14, 20, 50])
    found = dimension_of_domain(domain, 0.1).ordinary
    assert not found.high - found.low < 0.1


@pytest.mark.parametrize("level", [0.3, 1.0, 1.8])
def test_stored_terms_draw_the_curve_of_the_law(level):
    domain = level < HEIGHTS
    found = dimension_of_domain(domain, 0.1)
    sizes = np.array([4, 8, 16])
    drawn = law_count(sizes * 0.1, found.dimension, found.terms)
    counts = mean_count(domain, sizes).sum(axis=(1, 2))
    assert found.misfit < 0.1
    np.testing.assert_allclose(drawn, counts, rtol=4 * found.misfit)


@pytest.mark.parametrize("level", [0.5, 1.5, 2.2])
def test_every_stage_states_one_dimension(level):
    domain, fit_range = level < HEIGHTS, (0.2, 4.0)
    fields = xr.Dataset(
        {
            "in_contact_1": (
                ("direction", "offset", "normal_force", "y_1", "x_1"),
                domain[None, None, None],
            )
        },
        coords={"direction": ["E"], "offset": [0.0], "normal_force": [1.0]},
    )
    alone = dimension_of_domain(domain, 0.1, fit_range=fit_range)
    row = analyse_domains(fields, 0.1, fit_range=fit_range).squeeze()
    nulls = null_models(domain[np.newaxis], 0.1, HEIGHTS, fit_range=fit_range)
    assert row["delta_sigma"].item() == alone.dimension
    assert row["delta_sigma_low"].item() == alone.low
    assert row["delta_sigma_ordinary"].item() == alone.ordinary.value
    # The cut of a surface at one level is the domain itself.
    assert nulls["delta_sigma_cut"].item() == alone.dimension


def test_the_place_of_a_domain_in_its_window_changes_nothing():
    domain = np.zeros((160, 160), bool)
    domain[:60, :60] = HEIGHTS[:60, :60] > 1.0
    first = dimension_of_domain(domain, 0.1)
    moved = dimension_of_domain(np.roll(domain, (37, 91), (0, 1)), 0.1)
    assert (first.dimension, first.low) == (moved.dimension, moved.low)
    assert first.ordinary.value == moved.ordinary.value


def test_sizes_are_those_of_the_window():
    domain = HEIGHTS > 1.0
    np.testing.assert_allclose(dimension_of_domain(domain, 0.1).r, window_sizes((128, 128)) * 0.1)
    assert (
        dimension_of_domain(domain, 0.1).dimension
        == box_dimension(domain, 0.1, sizes=window_sizes((128, 128)), whole_cells=False).dimension
    )
