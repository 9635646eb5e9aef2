"""Figure of the solve plan and of the errors stated for the states."""

import numpy as np
import pytest
from cases import representative

from fractalcontact.figures.joint import choices


@pytest.mark.parametrize("name", representative(["sliding", "flat", "pair"]))
def test_choices_and_errors_of_every_specimen(atlas, name):
    drawing = choices.draw(atlas, name)
    made, drawn = (drawing.data[drawing.data["kind"] == kind] for kind in ("choice", "error"))
    assert list(made["choice"]) == list(atlas[f"choices/{name}"]["choice"].values)
    curves = atlas[f"closure/{name}"].to_dataset().isel(direction=0).sel(resolution=1)
    worst = (curves["area_error"] / curves["area"]).max("offset")
    area = drawn[drawn["quantity"] == "real contact area"]
    np.testing.assert_allclose(area["largest"], worst.values)
    assert f"{int(atlas[f'closure/{name}']['solved'].sum())} of " in drawing.caption
    halved = bool(np.isfinite(curves["closure_spacing_error"]).any())
    assert ("twice the spacing changes the closure by" in drawing.caption) == halved
