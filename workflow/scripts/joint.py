"""Slide the joint: offsets, composite topographies, rigid dilatancy."""

from _job import reported

from fractalcontact import store
from fractalcontact.joint import describe_joint

with reported(snakemake.log) as log:
    joint = describe_joint(store.read(snakemake.input[0]), snakemake.params.settings)
    store.write(joint, snakemake.output[0])
    log.info("%s", joint)
