"""Test eq. 6 on parts of the window, and predict the whole from its parts."""

import numpy as np
from _job import reported

from fractalcontact import store
from fractalcontact.size_test import size_test

with reported(snakemake.log) as log:
    settings = snakemake.params.settings
    result = size_test(
        store.read(snakemake.input.specimen),
        settings["contact_directions"][0],
        np.sort(store.read(snakemake.input.joint)["offset_cells"][0].values),
        settings,
        snakemake.params.solver,
        store.read(snakemake.input.windows),
    )
    store.write(result, snakemake.output[0])
    log.info("%s", result)
