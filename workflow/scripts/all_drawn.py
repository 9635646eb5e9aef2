"""End the study with the names of the figures that were not drawn, if there are any."""

from pathlib import Path

from engine.job import job

from fractalcontact.core.atomic import atomic_write
from fractalcontact.core.errors import InputError

with job(snakemake):
    listed = [Path(path).read_text(encoding="utf-8").split() for path in snakemake.input.undrawn]
    if undrawn := ", ".join(name for names in listed for name in names):
        raise InputError(
            f"not drawn, because of an error of the program: {undrawn}; their pictures say so, the "
            f"logs in {snakemake.params.logs} hold the whole error; everything else is done"
        )
    with atomic_write(snakemake.output[0]) as path:
        path.write_text("", encoding="utf-8")
