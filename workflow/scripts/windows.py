"""Press parts of the window, and fit how closure, roughness and strength go with their size."""

import numpy as np
from _job import reported

from fractalcontact import store
from fractalcontact.roughness import best_dimension
from fractalcontact.size_laws import size_laws
from fractalcontact.strength import profile_roughness
from fractalcontact.windows import window_states

with reported(snakemake.log) as log:
    settings = snakemake.params.settings
    specimen = store.read(snakemake.input.specimen)
    cells = np.sort(store.read(snakemake.input.joint)["offset_cells"][0].values)
    direction = settings["contact_directions"][0]
    slides = direction != "none"
    lags = settings["surface_range"]
    states = window_states(specimen, direction, cells, settings, snakemake.params.solver)
    laws = size_laws(
        states,
        settings["material"],
        float(profile_roughness(specimen, direction)["jrc_used"]) if slides else np.nan,
        best_dimension(store.read(snakemake.input.surface_dimension)),
        # A window of side b looks at waves of b, a lag at waves of twice its length.
        None if lags is None else [2 * lag for lag in lags],
    )
    store.write(laws, snakemake.output[0])
    log.info("%s", laws)
