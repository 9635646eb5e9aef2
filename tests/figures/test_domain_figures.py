"""The figure of the contact domain's measures, from states of the small atlas."""

import numpy as np
import xarray as xr

from fractalcontact.core.subject import Subject
from fractalcontact.domain.measures import measures_of_states
from fractalcontact.figures.joint.domain_measures import draw
from fractalcontact.figures.kit.drawing import print_style


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


def test_loads_drawn_are_three_with_the_reference_load_among_them(atlas):
    tree, measures = with_measures(atlas, "sliding")
    with print_style():
        drawing = draw(tree, "sliding")
    known = measures["normal_force"][measures["lacunarity"].notnull().any("gliding_side")]
    for _, rows in drawing.data.groupby("panel"):
        drawn = rows["normal_force_N"].unique()
        assert len(drawn) == min(3, known.size)
        assert Subject.of(tree, "sliding").reported.force in drawn


def test_no_contact_is_said(atlas):
    tree, _ = with_measures(atlas, "flat", factor=0)
    with print_style():
        drawing = draw(tree, "flat")
    assert "too small for a dimension" in drawing.caption
    assert drawing.data.empty
