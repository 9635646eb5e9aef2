"""All modules and kernels that jobs use, loaded when this module is."""

import gc
import importlib
import pkgutil

from roughcontact.kernel_cache import load_cached

#: Rooms whose modules are loaded. These import most other rooms; the rest is rarely used.
ROOMS = (
    *("fractalcontact.cards", "fractalcontact.ensemble", "fractalcontact.figures"),
    *("fractalcontact.joint", "fractalcontact.laws", "fractalcontact.pages"),
    *("fractalcontact.stages", "fractalcontact.states", "fractalcontact.study"),
    *("contactlab.experiments", "contactlab.figures"),
)

for room in ROOMS:
    package = importlib.import_module(room)
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        importlib.import_module(module.name)
# Libraries that the rooms, or xarray when it first reads or writes a file, import only inside
# functions. Without this every job would import them, pint alone for 0.1 s.
LATER = (
    *("engine.job", "netCDF4", "pandas.io.formats.csvs", "pint", "scipy.optimize", "scipy.stats"),
    *("snakemake.io", "xarray.backends.netCDF4_"),
)
for name in LATER:
    importlib.import_module(name)
load_cached()
gc.collect()
gc.freeze()  # loaded modules stay and forks share them: the collector is not to visit them
