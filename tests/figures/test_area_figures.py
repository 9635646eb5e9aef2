"""Figures of the real contact area beside the theories."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from cases import representative
from drawings import changed

from contactlab.experiments.area_slope import area_slope
from contactlab.figures.experiments import area_slope as slope_figure
from fractalcontact.core.subject import Subject
from fractalcontact.figures.joint import area_theories
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.laws.area import (
    FULL_CONTACT,
    add_area_offset,
    area_laws,
    joint_statistics,
)
from fractalcontact.laws.area_theories import add_comparison

SPECIMENS = ("sliding", "flat", "pair")
RECIPE = {
    "dimension": 2.2,
    "nodes": 48,
    "seeds": [1, 2, 3],
    "roll_off_share": 0.125,
    "loads": [0.005, 0.01, 0.02],
}


@pytest.fixture(scope="module")
def with_area(atlas):
    """The small atlas with what these figures read, made by the package's own functions."""
    whole = atlas.copy()
    for name in SPECIMENS:
        specimen, joint, curves = (
            atlas[f"{stage}/{name}"].to_dataset() for stage in ("specimens", "joints", "closure")
        )
        e_star = Subject.of(atlas, name).settings["material"]["e_star"]
        offset = Subject.of(atlas, name).settings["map_offset"]
        laws = area_laws(curves, joint_statistics(specimen, joint), e_star, 2.2, offset)
        whole[f"area/{name}"] = xr.DataTree(laws)
    whole["area_slope/surfaces"] = xr.DataTree(area_slope(RECIPE))
    return whole


def drawn(atlas, name):
    with print_style():
        return area_theories.draw(atlas, name)


def slopes_drawn(atlas):
    with print_style():
        return slope_figure.draw(atlas, list(SPECIMENS))


# -- area beside the theories ----------------------------------------------------------------------


def test_only_loads_with_enough_nodes_have_a_kappa(with_area):
    drawing = drawn(with_area, "sliding")
    kappa = [line for line in drawing.figure.axes[1].lines if line.get_marker() == "o"]
    assert len(kappa) == 2  # corrected and raw
    columns = (("corrected_kappa", "corrected_fitted"), ("kappa", "fitted"))
    for line, (column, kept) in zip(kappa, columns, strict=True):
        fitted = drawing.data[drawing.data[kept]]
        np.testing.assert_array_equal(line.get_xdata(), fitted["reduced_pressure"])
        np.testing.assert_array_equal(line.get_ydata(), fitted[column])


def test_shares_beyond_the_window_are_not_drawn(with_area):
    heavy = changed(
        with_area,
        "area/flat",
        lambda laws: laws.assign(majumdar_bhushan_share=laws["majumdar_bhushan_share"] * 0 + 2),
    )
    lines = drawn(heavy, "flat").figure.axes[0].lines
    (line,) = (line for line in lines if "Majumdar" in line.get_label())
    assert not len(line.get_xdata())
    assert "not defined" in line.get_label()


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (1.2, "below both"),
        (1.58, "agrees with Persson's 1.596 and lies below Bush's 2.507"),
        (2.0, "lies between"),
        (2.55, "lies above Persson's 1.596 and agrees with Bush's 2.507"),
        (3.0, "above both"),
    ],
)
def test_kappa_is_judged_by_the_theories(with_area, value, words):
    def set_mean(laws):
        for key, ending in ((value, ""), (value - 0.1, "_low"), (value + 0.1, "_high")):
            laws[f"corrected_mean_kappa{ending}"] = laws["mean_kappa"] * 0 + key
        add_comparison(laws)
        return laws

    assert words in drawn(changed(with_area, "area/sliding", set_mean), "sliding").caption


@pytest.mark.parametrize(
    ("low", "high", "words"),
    representative(
        [
            (0.95, 1.02, "fits Archard's level 3"),
            (0.85, 0.98, "fits Archard's level 2, 3"),
            (0.75, 0.8, "fits none of Archard's"),
        ]
    ),
)
def test_exponent_is_judged_by_its_interval(with_area, low, high, words):
    def set_exponent(laws):
        for name, value in (("_low", low), ("", (low + high) / 2), ("_high", high)):
            laws[f"corrected_exponent{name}"] = laws["rms_slope"] * 0 + value
        laws["no_corrected_law"] = xr.full_like(laws["no_corrected_law"], "")
        add_comparison(laws)
        return laws

    assert words in drawn(changed(with_area, "area/sliding", set_exponent), "sliding").caption


def test_flush_faces_are_passed_over_and_if_there_are_no_others_said_to_be(with_area):
    def flush(laws):
        laws = laws.copy(deep=True)
        numbers = [name for name in laws.data_vars if laws[name].dtype.kind == "f"]
        for name in numbers:
            if "offset" in laws[name].dims:
                laws[name][{"offset": slice(0, count)}] = np.nan
        for fitted in ("fitted", "corrected_fitted"):
            laws[fitted][{"offset": slice(0, count)}] = False
        reasons = dict.fromkeys(("no_mean_kappa", "no_corrected_mean_kappa"), "the faces are flush")
        for name, reason in {"no_corrected_law": FULL_CONTACT, **reasons}.items():
            laws[name] = laws[name].astype(object)
            laws[name][{"offset": slice(0, count)}] = reason
        add_comparison(laws)
        add_area_offset(laws, 0.4)
        return laws

    count = 3  # all up to the offset of the maps
    drawing = drawn(changed(with_area, "area/sliding", flush), "sliding")
    assert drawing.data["offset_mm"].iloc[0] == pytest.approx(0.6)
    count = with_area["area/sliding"].sizes["offset"]
    drawing = drawn(changed(with_area, "area/sliding", flush), "sliding")
    drawing.figure.draw_without_rendering()
    assert FULL_CONTACT in drawing.caption
    assert "No kappa at light load: the faces are flush" in drawing.caption


def test_one_load_is_drawn(with_area):
    one = with_area
    for group in ("area/sliding", "closure/sliding"):
        one = changed(one, group, lambda dataset: dataset.isel(normal_force=[-1]))
    drawn(one, "sliding").figure.draw_without_rendering()


# -- synthetic surfaces ----------------------------------------------------------------------------


def test_every_surface_is_in_its_panel(with_area):
    drawing = slopes_drawn(with_area)
    drawing.figure.draw_without_rendering()
    slopes = with_area["area_slope/surfaces"].to_dataset()
    for axes, kind in zip(drawing.figure.axes, slopes["surface"].values, strict=True):
        lines = [line for line in axes.lines if line.get_marker() not in (None, "None", "")]
        values = [line.get_ydata() for line in lines]
        one = slopes.sel(surface=kind)
        stored = [
            one[name].sel(seed=seed).values
            for seed in RECIPE["seeds"]
            for name in ("corrected_kappa", "kappa")
        ]
        np.testing.assert_array_equal(values, stored)
    assert len(drawing.data) == slopes["kappa"].size
    assert isinstance(drawing.data, pd.DataFrame)
    assert "1/8 of the side" in drawing.figure.axes[0].get_title(loc="left")


def test_values_outside_the_theories_are_counted(with_area):
    def lower(slopes):
        slopes = slopes.copy(deep=True)
        slopes["corrected_kappa"][...] = 2.0
        slopes["corrected_kappa"][0, 0, 0] = 1.0
        return slopes

    caption = slopes_drawn(changed(with_area, "area_slope/surfaces", lower)).caption
    assert "1.00 to 2.00 (8 of 9 between theories) with a roll-off" in caption
    assert "2.00 to 2.00 (all between theories) without" in caption


def test_one_seed_is_enough(with_area):
    one = changed(
        with_area, "area_slope/surfaces", lambda _: area_slope(RECIPE | {"seeds": [1], "nodes": 32})
    )
    drawing = slopes_drawn(one)
    assert "nan" not in drawing.caption
