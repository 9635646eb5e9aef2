"""Figures of aperture and flow: what they draw is what the atlas holds."""

import numpy as np
import pytest

from fractalcontact.core.subject import Subject
from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style

SPECIMENS = ("sliding", "pair", "flat")


def drawn(atlas, specimen, figure):
    with print_style():
        return drawer_of(figure)(atlas, specimen)


@pytest.mark.parametrize("name", SPECIMENS)
def test_hydraulic_apertures_and_branches_are_those_of_the_atlas(atlas, name):
    table = drawn(atlas, name, "hydraulic_aperture").data
    subject = Subject.of(atlas, name)
    flow, closure = subject.states("flow"), subject.states("closure")
    along = table[(table.panel == "a") & table.hydraulic_aperture_along_mm.notna()]
    expected = flow["hydraulic_aperture_along"].values
    np.testing.assert_allclose(along.hydraulic_aperture_along_mm, expected[expected > 0])
    np.testing.assert_allclose(along.mean_gap_mm, closure["mean_gap"].values[expected > 0])
    loading = table[(table.branch == "load") & table.branch_transmissivity_along_mm3.notna()]
    np.testing.assert_allclose(
        loading.branch_transmissivity_along_mm3, expected[expected > 0] ** 3 / 12
    )


@pytest.mark.parametrize("name", ["sliding", "pair"])
def test_offsets_are_drawn_in_both_directions(atlas, name):
    table = drawn(atlas, name, "hydraulic_aperture").data
    flow = Subject.of(atlas, name)["flow"]
    mean = table["offset_mean_gap_mm"].dropna()
    np.testing.assert_allclose(mean, flow["offset_mean_gap"].values)
    for way in ("along", "across"):
        values = table[f"offset_transmissivity_{way}_mm3"].dropna()
        np.testing.assert_allclose(values, flow[f"offset_transmissivity_{way}"].values)


def test_the_reported_offset_has_the_flow_of_the_reference_load(atlas):
    subject = Subject.of(atlas, "sliding")
    flow, reference = subject["flow"], subject.reported.reference
    at = flow.sel(offset=subject.offset, method="nearest")
    found = float(at["offset_transmissivity_along"])
    assert found == float(flow["transmissivity_along"][reference])
    assert found > 0


def test_maps_say_what_carries_the_flow(atlas):
    table = drawn(atlas, "sliding", "flux_map").data
    at = Subject.of(atlas, "sliding").state("flow")
    assert float(table.channel_fraction_along.iloc[0]) == float(at["channel_fraction_along"])
    flux = at["flux_map_along"].values
    # What goes to and fro is no less than what goes through every section.
    assert (flux.mean(axis=0) > 1 - 1e-3).all()


def test_branches_of_what_does_not_yield_are_one(atlas):
    branches = Subject.of(atlas, "sliding")["flow"]["branch_transmissivity_along"]
    load, reload = branches.sel(branch="load"), branches.sel(branch="reload")
    known = np.isfinite(reload)
    np.testing.assert_array_equal(load.where(known), reload)


def test_the_mean_gap_falls_from_that_at_first_touch(atlas):
    for name in SPECIMENS:
        subject = Subject.of(atlas, name)
        flow, mean = subject.states("flow"), subject.states("closure")["mean_gap"].values
        assert (np.diff(mean) < 0).all()
        assert mean[0] < float(flow["unloaded_mean_gap"])


def test_quantiles_of_the_gap_count_contact_as_zero(atlas):
    subject = Subject.of(atlas, "pair")
    flow, gaps = subject.states("flow"), subject.states("contact")["map_gap"]
    for load in subject.reported.quoted:
        gap, probability = gaps[load].values, flow["gap_probability"].values
        found, expected = flow["gap_quantile"][:, load], np.quantile(gap, probability)
        # The atlas keeps three digits of the map.
        np.testing.assert_allclose(found, expected, rtol=2e-3)
        assert ((gap == 0).mean() < probability[found == 0]).sum() == 0
