"""The band of an ensemble beside its specimen, drawn where every realisation has a value."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from fractalcontact.core.subject import Subject
from fractalcontact.ensemble.statistics import add_statistics
from fractalcontact.figures.kit.ensembles import draw_band, members_of
from fractalcontact.figures.kit.panel import Panel, table_of


def subject_of(values):
    attrs = {"units": "1", "long_name": "Delta_sigma"}
    stage = xr.Dataset(
        {"delta_sigma": (("realisation", "normal_force"), values, attrs)},
        {"normal_force": [1.0, 10.0, 100.0]},
    )
    add_statistics(stage, ["delta_sigma"])
    return Subject({"ensemble": stage}, {})


@pytest.fixture
def panel():
    return Panel(Figure().subplots(), "a", "")


def test_the_band_spans_the_loads_that_every_realisation_has(panel):
    values = np.array([[np.nan, 0.8, 1.2], [0.2, 0.9, 1.3], [0.3, 1.0, 1.1]])
    subject = subject_of(values)
    draw_band(panel, subject, "delta_sigma", "k", "boxes")
    (band,) = panel.axes.collections
    assert band.get_label() == "band of 3 realisations, boxes"
    drawn = band.get_paths()[0].vertices
    assert {1.0} & set(drawn[:, 0]) == set()
    # t of two degrees of freedom 4.3027, standard deviation 0.1, root of 1 + 1/3.
    assert drawn[drawn[:, 0] == 10, 1].max() == pytest.approx(0.9 + 0.49683, abs=1e-4)
    kept = table_of(panel)
    np.testing.assert_allclose(kept["delta_sigma_mean"], [0.9, 1.2])
    assert (kept["delta_sigma_n"] == 3).all()


def test_nothing_is_drawn_without_an_ensemble_or_a_load_that_all_have(panel):
    without = Subject({}, {})
    assert members_of(without) == ""
    draw_band(panel, without, "delta_sigma", "k", "boxes")
    draw_band(panel, subject_of(np.full((3, 3), np.nan)), "delta_sigma", "k", "boxes")
    assert not panel.axes.collections
    assert not panel.records
