"""A stage added as in docs/extending_stages.md is made by the workflow, and by it alone."""

import pytest
import xarray as xr
from code_blocks import blocks
from projects import jobs_of, project, run, small_study, write_scan

__all__ = ["project"]  # a fixture
pytestmark = [pytest.mark.workflow, pytest.mark.full]


def test_the_stage_of_the_recipe_is_made(project):
    entry, module, row = (
        block.text for block in blocks("docs/extending_stages.md") if block.heading == "A stage"
    )
    package = project / "src/fractalcontact"
    table = package / "study/stages.py"
    before = '    Stage("joints", '
    text = table.read_text(encoding="utf-8")
    assert text.count(before) == 1
    table.write_text(text.replace(before, f"    {entry.strip()}\n{before}"), encoding="utf-8")
    (package / "mechanics/summits.py").write_text(module, encoding="utf-8")
    rules = project / "workflow/rules/contact.smk"
    jobs = rules.read_text(encoding="utf-8")
    assert jobs.count("STAGE_JOBS = {") == 1
    rules.write_text(jobs.replace("STAGE_JOBS = {", f"STAGE_JOBS = {{\n{row}"), encoding="utf-8")
    study = small_study(project)
    write_scan(project, "rock")
    target = "results/test/summits/rock.nc"
    assert jobs_of(run(project, study, "--dry-run"))["summits"] == 1
    done = run(project, study, target)
    assert done.returncode == 0, done.stderr[-3000:]
    found = xr.load_dataset(project / target)["summits"]
    assert (found > 0).all()
    assert "summits of the composite topographies" in done.stderr + done.stdout
