"""A stage added as in docs/extending_stages.md is made by the workflow, and by it alone."""

import pytest
import xarray as xr
from code_blocks import blocks
from projects import jobs_of, project, run, small_study, write_scan

__all__ = ["project"]  # a fixture
pytestmark = [pytest.mark.workflow, pytest.mark.full]


def test_the_stage_of_the_recipe_is_made(project):
    module, script, rule = (
        block.text for block in blocks("docs/extending_stages.md") if block.heading == "A stage"
    )
    (project / "src/fractalcontact/joint/summits.py").write_text(module, encoding="utf-8")
    (project / "workflow/scripts/summits.py").write_text(script, encoding="utf-8")
    with open(project / "workflow/rules/contact.smk", "a", encoding="utf-8") as rules:
        rules.write(f"\n\n{rule}")
    atlas = project / "workflow/rules/atlas.smk"
    text, before = atlas.read_text(encoding="utf-8"), "    *rules.flow.output,\n"
    assert text.count(before) == 1
    atlas.write_text(text.replace(before, f"{before}    *rules.summits.output,\n"))
    study = small_study(project)
    write_scan(project, "rock")
    target = "results/test/summits/rock.nc"
    assert jobs_of(run(project, study, "--dry-run"))["summits"] == 1
    done = run(project, study, target)
    assert done.returncode == 0, done.stderr[-3000:]
    found = xr.load_dataset(project / target)["summits"]
    assert (found > 0).all()
    assert "summits of the composite topographies" in done.stderr + done.stdout
