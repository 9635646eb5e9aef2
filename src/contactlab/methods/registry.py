"""Registry of the comparison solvers: those that the files of this folder declare.

A new file needs no edit elsewhere: accuracy study, figures, benchmarks and tests read `METHODS`
and `PEERS`.
"""

import sys
from importlib.util import find_spec

from fractalcontact.core.modules import modules_of

from .method import Method

_FOUND: list[Method] = sorted(
    (
        method
        for module in modules_of(sys.modules[__package__]).values()
        for method in getattr(module, "METHODS", ())
    ),
    key=lambda method: (method.order, method.name),
)
#: Methods of the package by name.
METHODS = {method.name: method for method in _FOUND if not method.packages}
#: Public codes by name, installed or not.
PEERS = {method.name: method for method in _FOUND if method.packages}


def installed_peers() -> dict[str, Method]:
    """Public codes by name whose packages are installed."""
    return {name: peer for name, peer in PEERS.items() if all(map(find_spec, peer.packages))}
