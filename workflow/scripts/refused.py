"""Fail and say why: a scan that the study leaves out, or figures that were not drawn."""

from pathlib import Path

from engine.job import job

from fractalcontact.core.atomic import atomic_write
from fractalcontact.core.errors import InputError

with job(snakemake):
    undrawn = snakemake.input.get("undrawn")
    names = [
        name for path in undrawn or [] for name in Path(path).read_text(encoding="utf-8").split()
    ]
    if names or undrawn is None:
        raise InputError(snakemake.params.reason.replace("NAMES", ", ".join(names)))
    with atomic_write(snakemake.output[0]) as path:
        path.write_text("", encoding="utf-8")
