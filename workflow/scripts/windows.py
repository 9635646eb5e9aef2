"""Press parts of the window: how its mechanics goes with their size, and whether eq. 6 tells it."""

import numpy as np
from _job import job

from fractalcontact.core import netcdf
from fractalcontact.roughness.dimension import best_dimension
from fractalcontact.size_effect.eq6 import size_test
from fractalcontact.size_effect.laws import joint_by_size

with job(snakemake) as log:
    settings = snakemake.params.settings
    pressing = (
        netcdf.read(snakemake.input.specimen),
        settings["contact_directions"][0],
        np.sort(netcdf.read(snakemake.input.joint)["offset_cells"][0].values),
        settings,
        snakemake.params.solver,
    )
    dimension = best_dimension(netcdf.read(snakemake.input.surface_dimension))
    laws = joint_by_size(*pressing, dimension)
    tested = size_test(*pressing, laws)
    netcdf.write(laws, snakemake.output.windows)
    netcdf.write(tested, snakemake.output.size_test)
    log.info("%s\n%s", laws, tested)
