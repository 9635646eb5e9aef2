"""Solve surfaces of one or more classes of the experiment on the size effect."""

from _job import job
from xarray import concat

from contactlab.experiments.size_states import solve_task
from contactlab.experiments.size_tasks import SizeTask
from fractalcontact.core import netcdf

with job(snakemake) as log:
    params = snakemake.params
    tasks = [SizeTask(*task) for task in params.tasks]
    states = concat([solve_task(task, params.loads, params.rtol) for task in tasks], "surface")
    netcdf.write(states, snakemake.output[0])
    log.info("%s, largest residual %s", params.tasks, states.residual.max().item())
