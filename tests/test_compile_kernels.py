"""The installation compiles every kernel that a study uses."""

import importlib
import pkgutil

from numba.core.dispatcher import Dispatcher

import fractalcontact
from fractalcontact.compile_kernels import compile_kernels


def test_no_module_with_kernels_is_left_to_the_jobs_of_a_study():
    """Module by module: those that other kernels call are loaded with them, and seen nowhere."""
    assert min(compile_kernels()) > 0
    used = {}
    # The methods kept for comparison and the readers of clouds compile their own when used.
    for module in pkgutil.iter_modules(fractalcontact.__path__):
        if not module.ispkg:
            found = importlib.import_module(f"fractalcontact.{module.name}")
            for value in vars(found).values():
                if isinstance(value, Dispatcher):
                    home = value.py_func.__module__
                    used[home] = used.get(home, False) or bool(value.signatures)
    assert len(used) >= 10
    assert [home for home, called in used.items() if not called] == []
