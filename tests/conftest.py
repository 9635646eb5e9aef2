"""Two suites: ``make test`` leaves out what is marked ``full``, ``make test-all`` does not.

What is marked ``browser`` is for ``make test-browser`` alone, which says where the browser is.
"""

import os

import pytest
from ensembles import EVERYTHING
from xdist.scheduler import LoadScopeScheduling

#: Folders whose files share costly fixtures: one process runs all of such a folder.
SHARING = ("tests/browser", "tests/cards", "tests/figures", "tests/pages", "tests/workflow")


class ByFile(LoadScopeScheduling):
    """A file, or a folder of :data:`SHARING`, is run by one process."""

    def _split_scope(self, nodeid):
        path = nodeid.partition("::")[0]
        folder = path.rpartition("/")[0]
        return folder if folder in SHARING else path


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    return ByFile(config, log)


def pytest_collection_modifyitems(config, items):
    left_out = [] if EVERYTHING else ["full"]
    left_out += [] if os.environ.get("CHROMIUM") else ["browser"]
    for mark in left_out:
        config.hook.pytest_deselected(items=[i for i in items if i.get_closest_marker(mark)])
        items[:] = [item for item in items if not item.get_closest_marker(mark)]
