"""Rigid dilatancy of made joints with and without a roll-off."""

from _job import reported

from fractalcontact import store
from fractalcontact.roll_off import roll_off_effect

with reported(snakemake.log) as log:
    effect = roll_off_effect(**snakemake.params.joints)
    store.write(effect, snakemake.output[0])
    log.info("%s", effect)
