"""Exceptions of the package."""


class InputError(ValueError):
    """A scan, a sidecar or a study that cannot be used as it stands.

    The message is written for the person who owns the file: it names the file, key or cell, says
    what was expected and what to write instead. Programs show it without a traceback.
    """


class OutputError(OSError):
    """Error of a result that could not be written, with the file's name and a remedy."""
