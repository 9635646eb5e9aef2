"""Press parts of the window, and fit how closure, roughness and strength go with their size."""

import numpy as np
from _job import reported

from fractalcontact import store
from fractalcontact.roughness import best_dimension
from fractalcontact.size_laws import joint_by_size

with reported(snakemake.log) as log:
    settings = snakemake.params.settings
    laws = joint_by_size(
        store.read(snakemake.input.specimen),
        settings["contact_directions"][0],
        np.sort(store.read(snakemake.input.joint)["offset_cells"][0].values),
        settings,
        snakemake.params.solver,
        best_dimension(store.read(snakemake.input.surface_dimension)),
    )
    store.write(laws, snakemake.output[0])
    log.info("%s", laws)
