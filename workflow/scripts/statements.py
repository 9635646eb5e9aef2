"""Which of the paper's statements hold for this joint."""

from _job import reported

from fractalcontact import store
from fractalcontact.statements import judge

with reported(snakemake.log) as log:
    stages = {name: store.read(path) for name, path in snakemake.input.items()}
    statements = judge(stages, snakemake.params.settings)
    store.write(statements, snakemake.output[0])
    columns = (statements[key].values for key in ("claim", "verdict", "numbers"))
    for row in zip(*columns, strict=True):
        log.info("%s: %s (%s)", *row)
