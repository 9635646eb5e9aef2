"""Scans read as the draft of their sidecar says, its empty lines filled: for tests of other things.

The draft that a refusal prints is completed by what a test states, and taken as it is.
"""

import yaml

from fractalcontact.core.errors import InputError
from fractalcontact.scan import read
from fractalcontact.scan.raw import IncompleteSidecar

#: What the writers of the tests mean, where a file does not say it.
FILLED = {"first_row": "bottom", "heights": "up", "missing": "none"}


def drafted(path, options=None):
    """Options completed by the draft for this file."""
    options = dict(options or {})
    try:
        read.read_matrix(path, options)
    except IncompleteSidecar as error:
        draft = yaml.safe_load(error.draft)
        filled = {key: FILLED.get(key) if value is None else value for key, value in draft.items()}
        return {key: value for key, value in filled.items() if value is not None} | options
    except InputError:
        pass
    return options


def read_scan(path, options=None):
    """A scan by its drafted sidecar."""
    return read.read_scan(path, drafted(path, options))


def read_faces(lower, upper=None, options=None):
    """Two faces by the sidecar drafted for the lower one."""
    return read.read_faces(lower, upper, drafted(lower, options))
