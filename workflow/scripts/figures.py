"""Draw figures: of one specimen, from an atlas of its own made just before, or of the whole study.

Captions and failures stand in the log. Failures are listed in a file too, which is empty without
any, and the job goes on: other figures stay, and the rule `all_drawn` ends the study with the list.
"""

import gc
from pathlib import Path

from _stages import read_stages, warn_of_versions
from engine.job import job

from fractalcontact.core import netcdf
from fractalcontact.core.atomic import atomic_write
from fractalcontact.stages.atlas import join_stages, row_of

# The job ends with its figures: to collect what they leave takes half a second of eleven.
gc.disable()

with job(snakemake) as log:
    output, params = snakemake.output, snakemake.params
    names, specimen = params.names, snakemake.wildcards.get("specimen", "")
    atlas = output.atlas if specimen else snakemake.input[0]
    if specimen:
        stages, made_with = read_stages(snakemake.input)
        warn_of_versions(join_stages(stages, atlas, params.configuration, made_with), log)
        if output.get("row"):
            netcdf.write(row_of(atlas, specimen), output.row)
    captions, failures = {}, {}
    if names:  # else nothing needs the figures and what they import
        from fractalcontact.figures.draw import draw_figures, draw_study_figures

        drawn = (
            draw_figures(atlas, specimen, params.folder, names)
            if specimen
            else draw_study_figures(atlas, params.specimens, Path(atlas).parent / "figures", names)
        )
        captions, failures = drawn.captions, drawn.failures
    for name, caption in captions.items():
        log.info("%s: %s", name, caption)
    for name, trace in failures.items():
        log.error("error in the program: figure %s was not drawn\n%s", name, trace)
    with atomic_write(output.undrawn) as path:
        Path(path).write_text("".join(f"{specimen}/{name}\n".lstrip("/") for name in failures))
