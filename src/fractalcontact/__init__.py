"""Contact, closure, dilatancy and size effect of rough cracks, from profilometer scans."""

from .contact import ContactState, NotConverged, solve_contact
from .errors import InputError
from .halfspace import HalfSpace

__all__ = ["ContactState", "HalfSpace", "InputError", "NotConverged", "solve_contact"]
