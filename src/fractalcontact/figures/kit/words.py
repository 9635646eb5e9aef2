"""Symbols and places in the words of the figures."""

import textwrap

import xarray as xr

from ...core.text import compact, percent

PAPER = "Borri-Brunetto et al. (1999)"

#: Names and symbols of the two pressures wherever a figure has them (docs/conventions.md).
NOMINAL_PRESSURE = r"nominal pressure $\sigma_0$"
REAL_PRESSURE = r"real mean pressure $\sigma_n$"

TOWARDS = {"E": "East", "N": "North", "W": "West", "S": "South"}

#: Symbols of titles, as the captions write them and as formulas.
_FORMULAS = {
    "Delta_sigma": r"$\Delta_\sigma$",
    "Delta_g": r"$\Delta_g$",
    "sigma*": r"$\sigma^*$",
    "sigma_0": r"$\sigma_0$",
    "A_r": "$A_r$",
    "A_0": "$A_0$",
}


def opening(figures: str) -> str:
    """First words of a caption after "Fig. 2"; specimen and place stand in the figure's title."""
    return f"After {figures} of {PAPER}."


def formulas(text: str) -> str:
    """Text with its symbols as formulas: "Delta_g" as a Greek letter with an index."""
    for symbol, formula in _FORMULAS.items():
        text = text.replace(symbol, formula)
    return text


def place(direction: str, offset: float | None = None) -> str:
    """Place of the contact in words, at one ``offset`` in mm or at any."""
    if direction == "none":
        return "without sliding"
    if offset is None:
        return f"sliding towards {TOWARDS[direction]}"
    return f"slid {compact(offset)} mm towards {TOWARDS[direction]}"


def area_label(state: xr.Dataset) -> str:
    """A_r/A_0 of one state in per cent: corrected where enough nodes touch, else marked as raw."""
    if bool(state["area_corrected_resolved"]):
        return percent(float(state["area_corrected_share"]))
    return f"{percent(float(state['area_share']))} (raw)"


def wrapped(text: str) -> str:
    """Text broken into lines that fit under one panel of three."""
    return textwrap.fill(text, 34)
