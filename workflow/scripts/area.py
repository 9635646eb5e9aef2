"""Laws of the real contact area, and the classical theories for the same surface."""

from _job import reported

from fractalcontact import store
from fractalcontact.area import area_laws, joint_statistics
from fractalcontact.roughness import best_dimension

with reported(snakemake.log) as log:
    specimen = store.read(snakemake.input.specimen)
    laws = area_laws(
        store.read(snakemake.input.closure),
        joint_statistics(specimen, store.read(snakemake.input.joint)),
        snakemake.params.settings["material"]["e_star"],
        best_dimension(store.read(snakemake.input.surface_dimension))[0],
    )
    store.write(laws, snakemake.output[0])
    log.info("%s", laws)
