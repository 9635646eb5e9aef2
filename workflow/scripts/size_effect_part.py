"""Solve surfaces of one class of the experiment on the size effect."""

from _job import job

from fractalcontact.core import netcdf
from fractalcontact.experiments.size_states import solve_task
from fractalcontact.study.size_tasks import SizeTask

with job(snakemake) as log:
    params = snakemake.params
    states = solve_task(SizeTask(*params.task), params.loads, params.rtol)
    netcdf.write(states, snakemake.output[0])
    log.info("%s, largest residual %s", params.task, states.residual.max().item())
