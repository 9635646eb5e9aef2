"""Packages with stages and figures: the chain and the laboratory."""

from pathlib import Path

#: Folder of the packages.
SOURCES = Path(__file__).absolute().parents[2]
CHAIN, LABORATORY = "fractalcontact", "contactlab"


def installed() -> list[str]:
    """Names of the installed packages; the chain also runs without the laboratory."""
    return [name for name in (CHAIN, LABORATORY) if (SOURCES / name).is_dir()]
