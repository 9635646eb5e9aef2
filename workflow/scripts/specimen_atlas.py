"""Judge the paper's statements for one joint, and put all that was made of it into one file."""

from _job import reported
from _stages import read_stages, write_atlas

from fractalcontact import store
from fractalcontact.statements import judge

with reported(snakemake.log) as log:
    name = snakemake.wildcards.specimen
    configuration = snakemake.params.configuration
    stages = read_stages(snakemake.input)
    # Contact maps, the study's, stand under names of their own.
    of_joint = {stage: parts[name] for stage, parts in stages.items() if name in parts}
    statements = judge(of_joint, configuration["settings"][name])
    store.write(statements, snakemake.output.statements)
    stages["statements"] = {name: statements}
    write_atlas(stages, snakemake.output.atlas, configuration)
    columns = (statements[key].values for key in ("claim", "verdict", "numbers"))
    for row in zip(*columns, strict=True):
        log.info("%s: %s (%s)", *row)
