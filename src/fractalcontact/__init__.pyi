"""Signatures for type checkers and editors: the package imports its names when asked for."""

from roughcontact.contact.path import load_path as load_path
from roughcontact.contact.solve import solve_contact as solve_contact
from roughcontact.contact.state import ContactState as ContactState
from roughcontact.elastic.halfspace import HalfSpace as HalfSpace
from roughcontact.errors import NotConverged as NotConverged

from .core.errors import InputError as InputError
from .domain.box_dimension import BoxDimension as BoxDimension
from .domain.box_dimension import box_dimension as box_dimension
from .laws.closure_laws import Hyperbola as Hyperbola
from .laws.closure_laws import fit_hyperbola as fit_hyperbola
from .roughness.dimension import surface_dimension as surface_dimension
from .roughness.recommended import best_dimension as best_dimension
from .scan.read import read_faces as read_faces
from .scan.read import read_scan as read_scan
from .states.settlement import bulk_settlement as bulk_settlement
from .states.settlement import interface_closure as interface_closure
from .study.atlas import read_atlas as read_atlas
from .study.atlas_parts import open_atlas as open_atlas
from .surface.synthesis import self_affine as self_affine

__version__: str
__all__: list[str]
