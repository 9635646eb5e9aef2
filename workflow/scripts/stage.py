"""Make one or more stages of a study: a call of their function with what the job is given.

Inputs are read and passed on by name, as the rule's parameters are; the datasets that the function
gives are written to the outputs of their names.
"""

from importlib import import_module

from engine.job import job, require_unchanged

from fractalcontact.core import netcdf, settings

arguments = dict(snakemake.params.items())
# Not from the table of stages: then a new one would make all others again.
module, _, name = arguments.pop("function").partition(":")
function = getattr(import_module(module), name)
for key in ("code", "peers"):  # they only say when it is to be made again
    arguments.pop(key, None)
digests = arguments.pop("digests", {})
arguments |= settings.arguments(function, arguments.pop("settings", {}))
arguments |= arguments.pop("arguments", {})

with job(snakemake) as log:
    for key, paths in snakemake.input.items():
        one = isinstance(paths, str)
        arguments[key] = netcdf.read(paths) if one else [netcdf.read(path) for path in paths]
    result = function(**arguments)
    require_unchanged(digests)
    made = dict(snakemake.output.items()) or {"": snakemake.output[0]}
    for stage, path in made.items():
        dataset = result[stage] if isinstance(result, dict) else result
        netcdf.write(dataset, path)
        log.info("%s", dataset)
        if dataset.attrs.get("warning"):
            log.warning("warning: %s", dataset.attrs["warning"])
