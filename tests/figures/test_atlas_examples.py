"""What the documentation reads of an atlas is there, and the script of the gallery draws it."""

import re
import runpy

import numpy as np
import pytest
from markup import MARKUP
from places import ROOT

from fractalcontact.mechanics.joint import composite_topography

DOCS = ROOT / "docs"


@pytest.fixture(scope="module")
def names(atlas_file):
    """What the examples leave behind, of the sliding joint of the small atlas."""
    text = (DOCS / "atlas_examples.md").read_text()
    blocks = re.findall(r"^```python\n(.+?)^```$", text, re.MULTILINE | re.DOTALL)
    program = "\n".join(blocks)
    program = program.replace("results/paper/atlas.nc", str(atlas_file))
    left = {}
    exec(compile(program.replace("/concrete_twin", "/sliding"), "atlas_examples.md", "exec"), left)
    yield left
    left["atlas"].close()


def test_examples_find_what_they_name(names):
    assert np.isfinite(float(names["roughness"]["recommended_dimension"]))
    assert names["touching"].sum() > 0
    assert len(names["table"].dropna()) > 1
    assert set(names["plateau"]["plateau_trend"]) <= {"level", "rising", "falling"}
    assert {"delta_sigma_box", "delta_sigma_area"} <= set(names["both"])


def test_no_word_of_the_atlas_is_markup_of_docstrings(atlas):
    for node in atlas.subtree:
        words = [node.attrs, *(values.attrs for values in node.to_dataset().variables.values())]
        words += [v.values for v in node.to_dataset().variables.values() if v.dtype.kind in "UO"]
        assert not [said for said in map(str, words) if MARKUP.search(said)], node.path


def test_the_gallery_draws_the_states_of_the_atlas(names, atlas_file, tmp_path):
    script = runpy.run_path(str(DOCS / "gallery/joint_at_a_glance.py"))
    figure = script["draw"](names["atlas"], "sliding")
    relief, domain, curves, *_ = figure.axes
    assert len(domain.lines[0].get_xdata()) == int(names["touching"].sum())
    contact = names["contact"].attrs
    offset, direction = contact["map_offset"], contact["map_direction"]
    shown = np.ma.filled(relief.images[0].get_array(), np.nan)
    np.testing.assert_array_equal(
        shown, names["joint"]["composite"].sel(offset=offset, method="nearest")
    )
    # What is pressed is what the faces give, to the steps that the atlas keeps heights in.
    specimen = names["atlas"]["specimens/sliding"].to_dataset()
    pressed = composite_topography(specimen, direction, round(offset / specimen.attrs["spacing_x"]))
    np.testing.assert_allclose(shown, pressed, atol=1e-4 * np.ptp(pressed))
    assert 2 <= len(curves.lines) <= 5
    picture = tmp_path / "joint.png"
    script["main"](str(atlas_file), "sliding", str(picture))
    assert picture.stat().st_size > 10_000
