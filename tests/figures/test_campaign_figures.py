"""Figures over specimens and groups: they draw what the atlas states, whatever there is of it."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from spreadsheets import FORMULA, formulas_in

from fractalcontact.core.subject import Subject
from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style, save
from fractalcontact.statements.comparison import COMPARED_QUANTITIES, UNDER_LOAD, compare_specimens

NAMES = ["flat", "pair", "sliding"]


def drawing_of(figure, atlas):
    with print_style():
        return drawer_of(figure)(atlas, NAMES)


def tree_of(rows):
    return xr.DataTree.from_dict({"study_comparison/study": compare_specimens(rows)})


def made_row(generator, group, pressures=(0.1, 1.0, 10.0), missing=()):
    variables = {"nominal_pressure": ("load", np.array(pressures))}
    for name in COMPARED_QUANTITIES:
        dims = ("load",) if name in UNDER_LOAD else ()
        value = 1 + 0.1 * generator.random(len(pressures) if dims else None)
        for end, sign in (("", 0), ("_low", -1), ("_high", 1)):
            found = np.nan if name in missing else 1.0
            variables[name + end] = (dims, found * (value + sign * 0.05))
    return xr.Dataset(variables, attrs={"group": group, "label": "a twin"})


def test_every_specimen_stands_in_the_table_with_its_surface_dimension(atlas):
    table = drawing_of("comparison", atlas).data
    loads = atlas["study_comparison/study"].sizes["load"]
    assert table["specimen"].tolist() == [name for name in NAMES for _ in range(loads)]
    table = table[table["load"] == 0]
    for name, row in zip(NAMES, table.to_dict("records"), strict=True):
        surface = atlas[f"surface_dimension/{name}"]
        assert row["delta_g"] == pytest.approx(float(surface["recommended_dimension"]), nan_ok=True)
    assert np.isnan(table["dilatancy_mm"].iloc[0])  # against a plane


def test_the_row_of_a_specimen_is_what_its_stages_state(atlas):
    row = atlas["comparison/sliding"].to_dataset()
    budget = atlas["error_budget/sliding"].to_dataset().sel(quantity="stiffness")
    here = Subject.of(atlas, "sliding").states("closure")
    assert np.allclose(row["stiffness"], here["interface_stiffness"], equal_nan=True)
    half = (row["stiffness_high"] - row["stiffness_low"]) / 2
    assert np.allclose(half, budget["total"], equal_nan=True)
    domains = atlas["domains/sliding"].to_dataset().sel(direction="W", resolution=1)
    at_maps = domains.sel(offset=0.4, method="nearest")
    assert np.allclose(row["delta_sigma"], at_maps["delta_sigma"], equal_nan=True)
    dilatancy = atlas["dilatancy/sliding"].to_dataset().sel(contact_direction="W")
    assert np.allclose(row["dilatancy"], dilatancy["elastic_dilatancy"][-1], equal_nan=True)
    tested = atlas["size_test/sliding"].to_dataset()
    pressure = row["nominal_pressure"].values
    for state, found in zip(pressure, row["size_exponent"].values, strict=True):
        same = np.isclose(tested["nominal_pressure"], state)
        stated = tested["area_exponent"].values[same]
        expected = float(stated[0]) if stated.size else np.nan
        assert found == pytest.approx(expected, nan_ok=True)


def test_groups_have_their_means_in_the_table():
    generator = np.random.default_rng(1)
    tree = tree_of({f"twin_{i}": made_row(generator, "ab"[i % 2]) for i in range(6)})
    compared = tree["study_comparison/study"].to_dataset()
    table = drawing_of("comparison", tree).data.dropna(subset="group_name")
    assert len(table) == compared.sizes["group_name"] * compared.sizes["pressure"]
    found = table["stiffness_mean_MPa_per_mm"].to_numpy()
    assert np.allclose(found, compared["stiffness_mean"].values.ravel(), equal_nan=True)


def test_many_specimens_strange_names_and_empty_quantities_are_drawn(tmp_path):
    generator = np.random.default_rng(1)
    rows = {
        f"twin_{i:03d}": made_row(
            generator,
            f"group ${i % 9}_^ of {'many ' * (i % 9)}specimens",
            missing=("dilatancy", "size_exponent"),
        )
        for i in range(400)
    }
    rows["other"] = made_row(generator, "alone", pressures=(3.0, 5.0))
    drawing = drawing_of("comparison", tree_of(rows))
    with print_style():
        save(drawing, tmp_path, "comparison")
    assert len(pd.read_csv(tmp_path / "comparison.csv")) == len(drawing.data)
    assert (tmp_path / "comparison.svg").stat().st_size < 2_000_000


def test_a_group_that_is_a_formula_is_text_in_its_table(tmp_path):
    generator = np.random.default_rng(1)
    rows = {f"twin_{i}": made_row(generator, FORMULA) for i in range(2)}
    drawing = drawing_of("comparison", tree_of(rows))
    with print_style():
        save(drawing, tmp_path, "comparison")
    text = (tmp_path / "comparison.csv").read_text(encoding="utf-8")
    assert formulas_in(text) == []
    assert f"'{FORMULA}" in text
