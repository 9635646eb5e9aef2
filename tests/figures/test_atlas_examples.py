"""What the documentation reads of an atlas is there, and the script of the gallery draws it."""

import importlib
import json
import runpy
import shutil

import matplotlib.pyplot as plt
import netCDF4
import numpy as np
import pytest
import yaml
from code_blocks import blocks, code, run_code
from markup import MARKUP
from places import ROOT
from print_size import faults

from fractalcontact import open_atlas
from fractalcontact.core import checksums
from fractalcontact.core.subject import Subject
from fractalcontact.core.text import compact
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.joint.joint import composite_topography
from fractalcontact.study.crate import Workflow, write_crate
from fractalcontact.study.figure_list import read_figure

DOCS = ROOT / "docs"
WORKFLOW = Workflow(
    folder=ROOT,
    main="Snakefile",
    parts=("LICENSE",),
    language="Snakemake",
    url="https://snakemake.github.io",
    version="9.0",
)


#: Names of the documents, and what the small atlas has in their place.
JOINT = ("concrete_twin", "sliding")


@pytest.fixture(scope="module")
def project(atlas_file, tmp_path_factory):
    """A project with the results of a study, and of a campaign of one group."""
    folder = tmp_path_factory.mktemp("project")
    for study in ("paper", "campaign"):
        results = folder / "results" / study
        results.mkdir(parents=True)
        shutil.copy(atlas_file, results / "atlas.nc")
        checksums.record(results, [results / "atlas.nc"])
        write_crate(results, WORKFLOW, study, {})
    with netCDF4.Dataset(folder / "results/campaign/atlas.nc", "a") as file:
        configuration = json.loads(file.configuration)
        configuration["settings"]["sliding"]["group"] = "basalt"
        file.configuration = json.dumps(configuration)
    return folder


@pytest.fixture(autouse=True)
def within(project, monkeypatch):
    monkeypatch.chdir(project)


@pytest.fixture(scope="module")
def names(project):
    """What the examples leave behind, of the sliding joint of the small atlas."""
    with pytest.MonkeyPatch.context() as patched:
        patched.chdir(project)
        left = run_code("docs/atlas_examples.md", replaced=[JOINT])
        yield left
    left["atlas"].close()


def test_the_page_on_flow_finds_what_it_names():
    left = run_code("docs/flow.md", replaced=[JOINT])
    assert np.isfinite(left["flow"]["transmissivity_along"]).all()
    assert 0.08 < left["core"].hydraulic_aperture < left["along"].hydraulic_aperture * 1.05 < 0.11


def test_examples_find_what_they_name(names):
    assert np.isfinite(float(names["roughness"]["recommended_dimension"]))
    assert names["touching"].sum() > 0
    assert len(names["table"].dropna()) > 1
    assert set(names["plateau"]["plateau_trend"]) <= {"level", "rising", "falling"}
    assert {"delta_sigma_box", "delta_sigma_area"} <= set(names["both"])


def test_the_atlas_opens_in_every_way_that_is_documented(capsys):
    replaced = [JOINT, ("offset=0.24", "offset=0.4"), ("basalt_s01", "sliding")]
    left = run_code("docs/atlas.md", replaced=replaced)
    assert left["touching"].sum() > 0
    assert capsys.readouterr().out.startswith("sliding ")  # the one specimen of the group
    assert "ro-crate-metadata.json" in {entity["@id"] for entity in left["crate"]["@graph"]}


def test_the_first_lines_read_an_atlas():
    left = run_code("README.md", "What a study gives", replaced=[JOINT])
    assert "closure" in left["atlas"].children
    left["atlas"].close()
    left = run_code("docs/first_hour.md", replaced=[JOINT])
    assert np.isfinite(left["curves"]["interface_closure"]).any()
    left["atlas"].close()


def test_the_notebook_solves_a_state_on_the_curve_of_its_joint(project, monkeypatch):
    folder = project / "docs/notebooks"
    folder.mkdir(parents=True)
    monkeypatch.chdir(folder)
    notebook = json.loads((DOCS / "notebooks/own_joint.ipynb").read_text(encoding="utf-8"))
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert [cell["outputs"] for cell in cells] == [[]] * len(cells)
    program = "\n".join("".join(cell["source"]) for cell in cells)
    for words, others in (('"own_joint", "granite"', '"paper", "sliding"'), ("7.0", "LOAD")):
        assert words in program
        program = program.replace(words, others)
    atlas = open_atlas(project / "results/paper")
    budget, closure = atlas["error_budget/sliding"], atlas["closure/sliding"]
    place = {name: budget[name].values for name in ("direction", "offset")}
    curve = closure.sel(resolution=1, **place)
    load = int(np.argmax(curve["interface_closure"].values))
    names = {"LOAD": float(curve["nominal_pressure"][load])}
    exec(program, names)
    assert names["one_more"] == pytest.approx(float(curve["interface_closure"][load]), rel=1e-4)
    assert names["axes"].get_xlabel() == "closure from first touch (mm)"
    plt.close("all")


def test_the_figure_of_the_recipe_is_drawn(atlas, tmp_path, monkeypatch):
    """Its constants are read from its text, its words stand apart, its data are the atlas's."""
    (tmp_path / "joint").mkdir()
    path = tmp_path / "joint/stiffness.py"
    path.write_text(code("docs/extending.md", "A figure"), encoding="utf-8")
    stated = read_figure(path)
    for stage in stated.needs:
        assert stage in atlas.children
    (entry,) = (
        one.text for one in blocks("docs/extending.md") if one.text.startswith("stiffness:")
    )
    added = yaml.safe_load(entry)["stiffness"]
    # The package has the function of this name.
    caption = importlib.import_module("fractalcontact.figures.kit.caption")
    monkeypatch.setattr(caption, "_templates", lambda group: {"added": added})
    module = run_code("docs/extending.md", "A figure", package="fractalcontact.figures.joint")
    for name in ("sliding", "flat"):
        with print_style():
            drawing = module["draw"](atlas, name)
            assert faults(drawing.figure) == []
        states = Subject.of(atlas, name).states("closure")
        np.testing.assert_array_equal(drawing.data["stiffness_N_per_mm"], states["stiffness"])
        assert drawing.caption.startswith("Supplementary figure.")
        stiffest = float(states["stiffness"].max())
        assert f"at most {compact(stiffest)} N/mm." in drawing.caption


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
