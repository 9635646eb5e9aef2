"""Laws of clusters over the offsets: sizes beside their power law, Morisita's index against v."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.domain.cluster_laws import cluster_laws
from fractalcontact.domain.clusters import cluster_statistics

OFFSETS = np.array([0.0, 0.1, 0.2, 0.4, 0.8])
STATES = ("direction", "offset", "resolution", "normal_force")
SPACING = 0.5


def domains(index):
    """The table of one load in one direction, with the same random clusters at every offset."""
    rng = np.random.default_rng(1)
    # Percolation below its threshold: clusters of all sizes.
    row = cluster_statistics(rng.random((256, 256)) < 0.35, SPACING)
    shape = (1, len(OFFSETS), 1, 1)
    octaves = row.pop("cluster_octaves")
    table = {name: (STATES, np.full(shape, value)) for name, value in row.items()}
    table["cluster_octaves"] = (
        (*STATES, "octave"),
        np.broadcast_to(octaves, (*shape, len(octaves))),
    )
    table["morisita"] = (STATES, np.reshape(index, shape))
    coords = {"direction": ["E"], "offset": OFFSETS, "resolution": [1], "normal_force": [1.0]}
    return xr.Dataset(table, coords | {"octave": np.arange(len(octaves))})


def test_the_exponent_of_a_power_of_the_offset_is_found():
    index = np.where(OFFSETS > 0, 3 * np.maximum(OFFSETS, 0.1) ** 0.7, 50.0)
    laws = cluster_laws(domains(index), np.full((1, 5, 1, 1), 100), SPACING)
    assert laws["morisita_exponent"].item() == pytest.approx(0.7)
    np.testing.assert_array_equal(laws["morisita_used"].values.ravel(), OFFSETS > 0)


def test_domains_of_few_nodes_are_in_no_trend():
    index = np.where(OFFSETS > 0, np.maximum(OFFSETS, 0.1) ** 0.7, 1.0)
    index[2] = 1e3  # one node decides it
    nodes = np.full((1, 5, 1, 1), 100)
    nodes[0, 2] = 9
    laws = cluster_laws(domains(index), nodes, SPACING)
    assert not laws["morisita_used"].values[0, 2].any()
    assert laws["morisita_exponent"].item() == pytest.approx(0.7)
    none = cluster_laws(domains(index), np.full((1, 5, 1, 1), 9), SPACING)
    assert not none["morisita_used"].any()
    assert np.isnan(none["morisita_exponent"].item())


def test_counts_start_with_all_clusters_and_their_law_with_those_fitted():
    table = domains(np.ones(5))
    laws = cluster_laws(table, np.full((1, 5, 1, 1), 100), SPACING).isel(offset=0).squeeze()
    row = table.isel(offset=0).squeeze()
    assert laws["cluster_area"].values[0] == SPACING**2
    assert laws["clusters_at_least"].values[0] == row["clusters"]
    assert (laws["clusters_at_least"].diff("octave") <= 0).all()
    law, area = laws["cluster_law_count"], laws["cluster_area"]
    known = np.isfinite(law)
    first = area.where(known).min()
    assert float(first) <= float(row["cluster_fit_min"]) < 2 * float(first)
    assert float(law.max()) == pytest.approx(float(row["cluster_fit_n"]))
    slope = np.diff(np.log(law[known])) / np.diff(np.log(area[known]))
    np.testing.assert_allclose(slope, -float(row["cluster_exponent"]))
    assert float(area.where(known).max()) <= float(row["cluster_fit_max"])
