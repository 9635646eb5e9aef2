"""Two suites: ``make test`` leaves out what is marked ``full``, ``make test-all`` does not.

What is marked ``browser`` is for ``make test-browser`` alone, which says where the browser is.
"""

import gc
import os

import pytest
from ensembles import EVERYTHING
from xdist.scheduler import LoadScopeScheduling

#: Folders whose files share costly fixtures, by what one process runs all of.
SHARING = {f"tests/{name}": name for name in ("browser", "figures", "pages", "workflow")}
SHARING["tests/cards"] = "pages"


class ByFile(LoadScopeScheduling):
    """A file, or a folder of :data:`SHARING`, is run by one process."""

    def _split_scope(self, nodeid):
        path = nodeid.partition("::")[0]
        return SHARING.get(path.rpartition("/")[0], path)


@pytest.fixture(scope="session")
def cards_folder(tmp_path_factory):
    """Folder of the results of a study of :mod:`page_study` with its cards, to be read alone."""
    from page_study import write_study

    from fractalcontact.cards.write import write_cards

    folder = tmp_path_factory.mktemp("cards") / "results/tiny"
    write_study(folder)
    assert write_cards(folder / "atlas.nc", folder) == ["flat.1", "pair"]
    return folder


@pytest.hookimpl(wrapper=True)
def pytest_collection():
    """To look for garbage among the modules of all tests would take a tenth of all seconds."""
    gc.disable()
    found = yield
    gc.freeze()
    gc.set_threshold(10_000, 10, 10)
    gc.enable()
    return found


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    return ByFile(config, log)


def pytest_collection_modifyitems(config, items):
    left_out = [] if EVERYTHING else ["full"]
    left_out += [] if os.environ.get("CHROMIUM") else ["browser"]
    for mark in left_out:
        config.hook.pytest_deselected(items=[i for i in items if i.get_closest_marker(mark)])
        items[:] = [item for item in items if not item.get_closest_marker(mark)]
