"""Two suites: ``make test`` leaves out what is marked ``full``, ``make test-all`` nothing."""

import pytest
from ensembles import EVERYTHING

#: Folders whose files share costly fixtures: one process runs all of such a folder.
SHARING = ("figures", "workflow")


def pytest_itemcollected(item):
    folder = item.path.parent.name
    group = folder if folder in SHARING else f"{folder}/{item.path.stem}"
    item.add_marker(pytest.mark.xdist_group(group))


def pytest_collection_modifyitems(config, items):
    if not EVERYTHING:
        full = [item for item in items if item.get_closest_marker("full")]
        config.hook.pytest_deselected(items=full)
        items[:] = [item for item in items if not item.get_closest_marker("full")]
