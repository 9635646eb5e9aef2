"""Two suites: ``make test`` leaves out what is marked ``full``, ``make test-all`` nothing."""

from ensembles import EVERYTHING


def pytest_collection_modifyitems(config, items):
    if not EVERYTHING:
        full = [item for item in items if item.get_closest_marker("full")]
        config.hook.pytest_deselected(items=full)
        items[:] = [item for item in items if not item.get_closest_marker("full")]
