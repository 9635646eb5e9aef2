"""Signatures for type checkers and editors: the package imports its names when asked for."""

from . import kernel_cache as kernel_cache
from .contact.path import BranchState as BranchState
from .contact.path import load_path as load_path
from .contact.solve import solve_contact as solve_contact
from .contact.state import ContactState as ContactState
from .elastic.halfspace import HalfSpace as HalfSpace
from .errors import NotConverged as NotConverged

__all__: list[str]
__version__: str
