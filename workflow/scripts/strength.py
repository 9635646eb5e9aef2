"""Angles of dilatancy and friction, and shear strength."""

from _job import reported

from fractalcontact import store
from fractalcontact.strength import joint_strength

with reported(snakemake.log) as log:
    stages = [store.read(snakemake.input[name]) for name in ("dilatancy", "joint", "specimen")]
    strength = joint_strength(*stages, snakemake.params.settings)
    store.write(strength, snakemake.output[0])
    log.info("%s", strength)
