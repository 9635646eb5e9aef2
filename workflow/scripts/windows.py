"""Press parts of the window: how its mechanics goes with their size, and whether eq. 6 tells it."""

import numpy as np
from _job import job

from fractalcontact import store
from fractalcontact.roughness import best_dimension
from fractalcontact.size_laws import joint_by_size
from fractalcontact.size_test import size_test

with job(snakemake) as log:
    settings = snakemake.params.settings
    pressing = (
        store.read(snakemake.input.specimen),
        settings["contact_directions"][0],
        np.sort(store.read(snakemake.input.joint)["offset_cells"][0].values),
        settings,
        snakemake.params.solver,
    )
    dimension = best_dimension(store.read(snakemake.input.surface_dimension))
    laws = joint_by_size(*pressing, dimension)
    tested = size_test(*pressing, laws)
    store.write(laws, snakemake.output.windows)
    store.write(tested, snakemake.output.size_test)
    log.info("%s\n%s", laws, tested)
