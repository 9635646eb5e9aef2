"""Figures of the experiment on the size effect, and the page that is written from it."""

import numpy as np
import pytest
import xarray as xr

from contactlab.commands import size_effect_page
from contactlab.figures.experiments import (
    resolution_law,
    size_effect,
    size_strength,
    three_exponents,
)
from fractalcontact.figures.kit.drawing import print_style


@pytest.fixture(scope="module")
def test_of(atlas):
    return atlas["size_effect/surfaces"].to_dataset()


def drawn(module, atlas):
    with print_style():
        drawing = module.draw(atlas, [])
    drawing.figure.draw_without_rendering()
    return drawing


def test_decision_counts_the_classes(atlas, test_of):
    caption = drawn(size_effect, atlas).caption
    refuted = int((test_of["overall"] == "eq. 6 refuted").sum())
    assert f"refuted for {refuted or 'none'} of {test_of['overall'].size} classes" in caption


def test_resolution_law_drawn_is_that_of_the_atlas(atlas, test_of):
    table = drawn(resolution_law, atlas).data
    fine = test_of.isel(surface=(test_of["of_arm"] == "R").values)
    assert len(table) == fine["corrected_share"].size
    found = table["resolved_kappa"] * table["resolved_pressure"]
    np.testing.assert_allclose(found, table["corrected_share"])
    # In the finest class the loads are those of the recipe; longer cut-offs have more of them.
    finest = table[table["of_cut_off"] == table["of_cut_off"].min()]
    np.testing.assert_allclose(finest["resolved_pressure"], finest["reduced_pressure"])
    coarse = table[table["of_cut_off"] == table["of_cut_off"].max()]
    assert (coarse["resolved_pressure"] > coarse["reduced_pressure"]).all()


def test_exponents_drawn_are_those_of_the_atlas(atlas, test_of):
    table = drawn(three_exponents, atlas).data
    found = table.set_index(["exponent", "hurst", "reduced_pressure"])["value"]
    for (name, hurst, load), value in found.items():
        one = test_of.sel(hurst=hurst, reduced_pressure=load)
        of_arm = one[name].sel(arm="S1") if "arm" in one[name].dims else one[name]
        np.testing.assert_allclose(value, of_arm)
    assert set(table["exponent"]) >= {"area_delta", "box_delta", "alpha", "random_delta"}
    # The bars are those of 95 %, inside the 99 % of the decision.
    alpha = table[table["exponent"] == "alpha"].set_index(["hurst", "reduced_pressure"])
    for (hurst, load), row in alpha.iterrows():
        one = test_of.sel(arm="S1", hurst=hurst, reduced_pressure=load)
        assert row["value_half_width"] == one["alpha_half_width"]
        assert 0 < row["value_half_width"] < one["alpha_high"] - one["alpha"]
    assert "95 % intervals" in drawn(three_exponents, atlas).caption


def test_strength_drawn_is_that_of_the_atlas(atlas):
    strength = atlas["size_strength/surfaces"].to_dataset()
    drawing = drawn(size_strength, atlas)
    table = drawing.data
    assert (table["drawn"] == "strength").sum() == strength["strength"].size
    assert (table["drawn"] == "equal v").sum() == strength["strength_exponent"].size
    scaled = table[table["drawn"] == "equal v/b"]
    assert len(scaled) == strength["scaled_strength_exponent"].size > 0
    for _, row in scaled.iterrows():
        one = strength.sel(hurst=row["hurst"], law=row["law"], reduced_pressure=0.05)
        one = one.sel(fraction=row["fraction"])
        for name in ("scaled_strength_exponent", "predicted_exponent"):
            np.testing.assert_allclose(row[name], one[name])
    for text in strength["overall"].values.ravel():
        assert text in drawing.caption


def test_page_states_the_strength(atlas, test_of):
    strength = atlas["size_strength/surfaces"].to_dataset()
    page = size_effect_page.page(test_of, "tiny", strength)
    section = page.split("## Strength")[1].split("## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("| 0.")]
    assert len(rows) == strength["pooled_exponent"].size
    assert f"{float(strength['pooled_exponent'][0, 0, 0]):+.3f}" in rows[0]
    assert {row.count("|") for row in rows} == {5 + strength.sizes["fraction"]}
    assert f"{float(strength['scaled_strength_exponent'][0, 0, 0, -1]):+.3f}" in rows[0]
    largest = float(strength["area_exponent"].sel(law="capped").max())
    assert f"to {largest:+.3f} (median" in section.split("capped, A_r/A_0")[1]
    assert "nan" not in section
    assert "## Strength" not in size_effect_page.page(test_of, "tiny")


def test_page_states_every_class(test_of):
    page = size_effect_page.page(test_of, "tiny")
    size = page.partition("## Size")[2].partition("## Compliance")[0]
    rows = [line for line in size.splitlines() if line.startswith("| S1")]
    assert len(rows) == test_of.sizes["hurst"]
    first = test_of.isel(arm=0, hurst=0, reduced_pressure=0)
    assert f"{float(first['alpha']):+.3f}" in rows[0]
    assert first["overall"].item() in rows[0]
    assert "nan" not in page
    assert "make STUDY=config/tiny.yaml" in page


def test_page_is_written_from_an_atlas(atlas_file, tmp_path):
    size_effect_page.main([str(atlas_file), str(tmp_path / "page.md")])
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert text.startswith("# What carries the size effect")


def test_page_of_another_study_is_refused(tmp_path, capsys):
    empty = tmp_path / "atlas.nc"
    xr.DataTree.from_dict({"/speed/one": xr.Dataset()}).to_netcdf(empty)
    assert size_effect_page.main([str(empty), str(tmp_path / "page.md")]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "no stage size_effect" in line
