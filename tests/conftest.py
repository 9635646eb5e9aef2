"""Two suites: ``make test`` leaves out what is marked ``full``, ``make test-all`` nothing."""

import pytest
from ensembles import EVERYTHING
from xdist.scheduler import LoadScopeScheduling

#: Folders whose files share costly fixtures: one process runs all of such a folder.
SHARING = ("tests/figures", "tests/workflow")


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
    if not EVERYTHING:
        full = [item for item in items if item.get_closest_marker("full")]
        config.hook.pytest_deselected(items=full)
        items[:] = [item for item in items if not item.get_closest_marker("full")]
