"""Picture in place of a figure that an error of the program kept from being drawn."""

import textwrap

import pandas as pd
from matplotlib.figure import Figure

from ...core.labels import printable
from .drawing import WIDTH, Drawing

#: Letters of the error that are shown, and of a line.
_LONGEST, _LINE = 300, 90


def undrawn(title: str, subject: str | list[str], error: BaseException) -> Drawing:
    """Drawing that replaces a failed figure by the reason.

    Parameters
    ----------
    title : str
        Of the figure.
    subject : str or list of str
        The specimen, or the specimens of the study.
    error : BaseException
    """
    reason = printable(f"{type(error).__name__}: {error}", _LONGEST)
    of = "" if isinstance(subject, list) else f" of {subject}"
    words = f"Not drawn: {title}{of}, because of an error of the program ({reason})."
    figure = Figure(figsize=(WIDTH, 1.6))
    figure.set_layout_engine("none")  # there are no axes to lay out
    # Nothing in the words is a formula.
    figure.text(
        0.5,
        0.5,
        textwrap.fill(words, _LINE),
        ha="center",
        va="center",
        color="#D55E00",
        parse_math=False,
    )
    table = pd.DataFrame({"figure": [title], "not_drawn_because": [reason]})
    return Drawing(figure, table, words)
