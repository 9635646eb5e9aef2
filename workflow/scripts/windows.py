"""Sub-windows of the joint: how its mechanics goes with their size, and the test of eq. 6."""

import numpy as np
from _job import job

from fractalcontact.core import netcdf
from fractalcontact.mechanics.loading import JointLoading
from fractalcontact.roughness.dimension import best_dimension
from fractalcontact.size_effect.eq6 import size_test
from fractalcontact.size_effect.laws import joint_by_size

with job(snakemake) as log:
    settings = snakemake.params.settings
    joint = JointLoading.of_joint(
        netcdf.read(snakemake.input.specimen),
        netcdf.read(snakemake.input.joint),
        settings["contact_directions"][0],
        settings,
        snakemake.params.solver,
    )
    loading = joint.at(np.sort(joint.cells))
    dimension = best_dimension(netcdf.read(snakemake.input.surface_dimension))
    laws = joint_by_size(loading, dimension)
    tested = size_test(loading, laws)
    netcdf.write(laws, snakemake.output.windows)
    netcdf.write(tested, snakemake.output.size_test)
    log.info("%s\n%s", laws, tested)
