"""States of surfaces of one class of the experiment on the size effect."""

from _files import write
from engine.job import job

from contactlab.experiments.size_states import solve_tasks

with job(snakemake) as log:
    given = snakemake.params
    write(solve_tasks(given.tasks, given.loads, given.rtol), snakemake.output[0], log)
