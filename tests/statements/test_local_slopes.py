"""Verdict on one local slope: sets of known dimension, and sets that have none."""

import numpy as np
import pytest
from ensembles import ensemble
from known_sets import (
    cantor_dust,
    fractal_percolation,
    percolation_cluster,
    sierpinski_carpet,
    thinned,
)

from fractalcontact.core.verdicts import FAILS, HOLDS, UNDETERMINED
from fractalcontact.domain.null_models import null_models
from fractalcontact.statements.local_slopes import one_slope


def verdict_on(domain):
    return one_slope(null_models(domain[np.newaxis], 0.1).isel(normal_force=0)).verdict


FULL = {
    "window": np.ones((200, 192), bool),
    "carpet": sierpinski_carpet(243),
    "cluster": percolation_cluster(256, 0),
}


@pytest.mark.parametrize("name", FULL)
def test_sets_of_large_dimension_have_one_slope(name):
    assert verdict_on(FULL[name]) == HOLDS


@pytest.mark.parametrize("seed", range(ensemble("fractals beside nulls")))
def test_fractals_are_not_refuted_by_their_own_scatter(seed):
    for domain in (cantor_dust((200, 243)[seed % 2]), fractal_percolation(8, 0.6, seed)):
        assert verdict_on(domain) != FAILS


@pytest.mark.parametrize("nodes", [100, 400])
def test_points_that_cross_over_to_full_boxes_have_no_one_slope(nodes):
    assert verdict_on(thinned(np.ones((160, 200), bool), nodes, 1)) == FAILS


def test_nothing_is_said_of_few_nodes_and_of_less_than_a_decade():
    few = null_models(thinned(FULL["carpet"], 20, 0)[np.newaxis], 0.1).isel(normal_force=0)
    found = one_slope(few)
    assert (found.verdict, found.numbers) == (UNDETERMINED, "fewer than 30 nodes in contact (20)")
    assert verdict_on(sierpinski_carpet(81)) == UNDETERMINED
