"""The figure of the contact domain's measures, from states of the small atlas."""

import numpy as np
import pytest
import xarray as xr
from cases import representative
from PIL import Image

from fractalcontact.core.subject import Subject
from fractalcontact.domain.measures import measures_of_states
from fractalcontact.figures.joint.domain_measures import draw
from fractalcontact.figures.kit.drawing import print_style, save


def with_measures(atlas, name, factor=1.0):
    """The atlas with a stage domain_measures, its pressure the distance from the rim of contact."""
    from scipy.ndimage import distance_transform_edt

    contact = atlas[f"contact/{name}"].to_dataset().isel(direction=0, offset=-1)
    domains = contact["in_contact_1"].values
    if factor == 0:
        domains = np.zeros_like(domains)
    pressures = np.array([distance_transform_edt(domain) for domain in domains])
    found = measures_of_states(pressures, 0.1, contact["normal_force"].values)
    found = found.assign_coords(
        direction=str(contact["direction"].values), offset=float(contact["offset"])
    )
    nodes = {group.path: group.to_dataset() for group in atlas.subtree}
    nodes[f"/domain_measures/{name}"] = found
    if factor == 0:
        domains = nodes[f"/domains/{name}"]
        missing = {of: domains[of] * np.nan for of in ("delta_sigma", "local_slope")}
        nodes[f"/domains/{name}"] = domains.assign(missing)
    return xr.DataTree.from_dict(nodes), found


@pytest.mark.parametrize("name", representative(["sliding", "flat", "pair"]))
def test_drawing_shows_what_was_measured(atlas, name, tmp_path):
    tree, found = with_measures(atlas, name)
    with print_style():
        drawing = draw(tree, name)
        save(drawing, tmp_path, "domain_measures")
    with Image.open(tmp_path / "domain_measures.png") as picture:
        assert np.ptp(np.asarray(picture.convert("L"))) > 100  # something is drawn
    counts = Subject.of(tree, name).states("domains")
    drawn_of = ((counts, "local_slope"), (found, "lacunarity"), (found, "generalised_dimension"))
    for panel, (source, of) in zip("abc", drawn_of, strict=True):
        drawn = drawing.data[drawing.data["panel"] == panel]
        assert len(drawn)
        for force, points in drawn.groupby("normal_force_N"):
            np.testing.assert_array_equal(points[of], source[of].sel(normal_force=force))
    assert "section 6" in drawing.caption
    assert "nan" not in drawing.caption


def test_no_contact_is_said(atlas):
    tree, _ = with_measures(atlas, "flat", factor=0)
    with print_style():
        drawing = draw(tree, "flat")
    assert "too small for a dimension" in drawing.caption
    assert drawing.data.empty
