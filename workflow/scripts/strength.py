"""Angles of dilatancy and friction, shear strength, and which of the paper's statements hold."""

from _job import reported

from fractalcontact import store
from fractalcontact.statements import judge
from fractalcontact.strength import joint_strength

with reported(snakemake.log) as log:
    stages = {name: store.read(path) for name, path in snakemake.input.items()}
    settings = snakemake.params.settings
    strength = joint_strength(stages["dilatancy"], stages["joint"], stages["specimen"], settings)
    statements = judge(stages, settings)
    store.write(strength, snakemake.output.strength)
    store.write(statements, snakemake.output.statements)
    log.info("%s\n%s", strength, statements)
