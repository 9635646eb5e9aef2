"""Rigid dilatancy of synthetic joints with and without a roll-off."""

from _job import job

from fractalcontact.core import netcdf
from fractalcontact.experiments.roll_off import roll_off_effect

with job(snakemake) as log:
    effect = roll_off_effect(**snakemake.params.joints)
    netcdf.write(effect, snakemake.output[0])
    log.info("%s", effect)
