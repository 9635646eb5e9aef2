"""All modules and kernels that jobs use, loaded when this module is."""

import gc
import importlib
import pkgutil

from roughcontact.kernel_cache import load_cached

#: Rooms whose modules are loaded, with all that they import; the others are so too, or rarely used.
ROOMS = (
    *("fractalcontact.cards", "fractalcontact.ensemble", "fractalcontact.figures"),
    *("fractalcontact.mechanics", "fractalcontact.pages", "fractalcontact.stages"),
    "fractalcontact.study",
    *("contactlab.experiments", "contactlab.figures"),
)

for room in ROOMS:
    package = importlib.import_module(room)
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        importlib.import_module(module.name)
for name in ("engine.job", "netCDF4", "scipy.optimize", "scipy.stats"):
    importlib.import_module(name)
load_cached()
gc.collect()
gc.freeze()  # what is loaded stays, and forks share it: none is to go through it
