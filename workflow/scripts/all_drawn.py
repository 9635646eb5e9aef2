"""End the study if an error of the program kept a figure from being drawn."""

from pathlib import Path

from _job import job

from fractalcontact.core.atomic import atomic_write
from fractalcontact.core.errors import OutputError

with job(snakemake) as log:
    names = [name for path in snakemake.input.undrawn for name in Path(path).read_text().split()]
    if names:
        raise OutputError(
            f"not drawn, because of an error of the program: {', '.join(names)}; their pictures "
            f"say so, {snakemake.params.logs} hold the whole error; everything else is done"
        )
    with atomic_write(snakemake.output[0]) as path:
        path.write_text("")
