"""The result page of a study: plain HTML from templates, with the numbers of the atlas inside."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "Place": ".result_page",
        "write_explorer": ".explorer",
        "write_result_page": ".result_page",
    },
)
