"""Figures of the solve plan, and of the errors stated for the states."""

import numpy as np
import pytest
from cases import representative

from fractalcontact.figures.joint import choices, stated_errors

NAMES = ("sliding", "flat", "pair")


@pytest.mark.parametrize("name", representative(NAMES))
def test_choices_of_every_specimen(atlas, name):
    drawing = choices.draw(atlas, name)
    stated = list(atlas[f"choices/{name}"]["choice"].values)
    assert list(drawing.data["choice"]) == ["states", *stated]
    solved = f"{int(atlas[f'closure/{name}']['solved'].sum())} of "
    assert solved in drawing.caption
    assert drawing.data["value"][0].startswith(solved)


@pytest.mark.parametrize("name", representative(NAMES))
def test_stated_errors_are_the_largest_of_the_atlas(atlas, name):
    drawing = stated_errors.draw(atlas, name)
    curves = atlas[f"closure/{name}"].to_dataset().isel(direction=0).sel(resolution=1)
    worst = (curves["area_error"] / curves["area"]).max("offset")
    area = drawing.data[drawing.data["quantity"] == "real contact area"]
    np.testing.assert_allclose(area["largest_error"], worst.values)
    # A dimension may be 0: its error is no fraction of it.
    domains = atlas[f"domains/{name}"].to_dataset().isel(direction=0).sel(resolution=1)
    dimension = drawing.data[drawing.data["error_kind"] == "absolute"]
    known = domains["delta_sigma_error"].max("offset").dropna("normal_force")
    np.testing.assert_allclose(dimension["largest_error"], known.values)
    assert (
        not drawing.data.loc[drawing.data["error_kind"] == "relative", "quantity"]
        .str.contains("Delta")
        .any()
    )
    halved = bool(np.isfinite(curves["closure_spacing_error"]).any())
    assert ("At twice the spacing the closure changes by" in drawing.caption) == halved
