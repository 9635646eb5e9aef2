"""The result page of a study: plain HTML from templates, with the numbers of the atlas inside."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(__name__, {})
