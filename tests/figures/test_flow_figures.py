"""Aperture and flow as their figures draw them: relations between the arrays of the atlas."""

import numpy as np

from fractalcontact.core.subject import Subject

SPECIMENS = ("sliding", "pair", "flat")


def test_the_reported_offset_has_the_flow_of_the_reference_load(atlas):
    subject = Subject.of(atlas, "sliding")
    flow, reference = subject["flow"], subject.reported.reference
    at = flow.sel(offset=subject.offset, method="nearest")
    found = float(at["offset_transmissivity_along"])
    assert found == float(flow["transmissivity_along"][reference])
    assert found > 0


def test_maps_hold_at_least_the_flow_of_every_section(atlas):
    flux = Subject.of(atlas, "sliding").state("flow")["flux_map_along"].values
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
