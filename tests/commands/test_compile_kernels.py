"""The installation compiles every kernel that a study uses."""

import importlib
import pkgutil
import subprocess
import sys

from numba.core.dispatcher import Dispatcher

import fractalcontact
import roughcontact
from fractalcontact.commands.compile_kernels import compile_kernels


def test_no_module_with_kernels_is_left_to_the_jobs_of_a_study():
    """Module by module: those that other kernels call are loaded with them, and seen nowhere."""
    assert min(compile_kernels()) > 0
    used = {}
    # Readers of clouds compile their own when used.
    packages = (roughcontact, fractalcontact)
    modules = (m for p in packages for m in pkgutil.walk_packages(p.__path__, f"{p.__name__}."))
    for module in modules:
        if not module.name.startswith("fractalcontact.gridding"):
            found = importlib.import_module(module.name)
            for value in vars(found).values():
                if isinstance(value, Dispatcher):
                    home = value.py_func.__module__
                    used[home] = used.get(home, False) or bool(value.signatures)
    assert len(used) >= 10
    assert [home for home, called in used.items() if not called] == []


def test_another_process_finds_every_kernel_compiled():
    """Even those whose types have no name that stays the same."""
    compile_kernels()
    code = (
        "import gc; from numba.core.dispatcher import Dispatcher\n"
        "from fractalcontact.commands.compile_kernels import compile_kernels; compile_kernels()\n"
        "kernels = [k for k in gc.get_objects() if isinstance(k, Dispatcher)]\n"
        "packages = ('roughcontact.', 'fractalcontact.')\n"
        "ours = [k for k in kernels if k.py_func.__module__.startswith(packages)]\n"
        "assert sum(sum(k.stats.cache_hits.values()) for k in ours) > 50\n"
        "print([k.py_func.__qualname__ for k in ours if k.stats.cache_misses])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
