"""Exceptions of the package, and their form in commands."""

import functools
import sys
from collections.abc import Callable
from typing import ParamSpec

from roughcontact.errors import interruptible

P = ParamSpec("P")


class InputError(ValueError):
    """A scan, a sidecar or a study that cannot be used as it stands.

    The message is written for the person who owns the file: it names the file, key or cell, says
    what was expected and what to write instead. Programs show it without a traceback.
    """


class OutputError(OSError):
    """Error of a result that could not be written, with the file's name and a remedy."""


def said_in_one_line(main: Callable[P, int]) -> Callable[P, int]:
    """A command whose errors of input and output are one line each, with exit code 1."""

    @functools.wraps(main)
    def command(*arguments: P.args, **options: P.kwargs) -> int:
        try:
            with interruptible():
                return main(*arguments, **options)
        except (InputError, OutputError) as error:
            sys.stderr.write(f"error: {error}\n")
            return 1

    return command
