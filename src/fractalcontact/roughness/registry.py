"""Registry of the estimators of the Hurst exponent: all files of their folder."""

from ..core.modules import modules_of
from . import estimators
from .estimator import Estimator


def _sorted_entries() -> dict[str, Estimator]:
    entries = {name: module.ESTIMATOR for name, module in modules_of(estimators).items()}
    return dict(sorted(entries.items(), key=lambda entry: entry[1].place))


#: The estimators by name, in the order of results and figures.
ESTIMATORS = _sorted_entries()
