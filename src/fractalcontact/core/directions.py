"""Directions of the shear offset: where the upper block slides, seen from above."""

from .errors import InputError

#: Axis and sign of each.
DIRECTIONS = {"E": ("x", 1), "N": ("y", 1), "W": ("x", -1), "S": ("y", -1)}

#: Kind of a file, and of a specimen, that holds the opening between two faces in place of a face.
APERTURE = "aperture"

#: What does not slide, in words.
NO_SLIDING = "an aperture map, or a surface against a plane,"

#: Offsets that "auto" places between one cell and the largest possible, in geometric steps.
AUTOMATIC_OFFSETS = 8


def slides(opposite: str) -> bool:
    """True unless a specimen lies against a plane, or is an aperture map, both faces in one.

    Parameters
    ----------
    opposite : str
        Attribute or setting of a specimen.
    """
    return opposite not in ("flat", APERTURE)


def axis_and_sign(direction: str) -> tuple[str, int]:
    """Axis, "x" or "y", of a direction, and its sign.

    Raises
    ------
    InputError
        If there is no such direction.
    """
    if direction not in DIRECTIONS:
        raise InputError(f"direction {direction!r}; expected one of {', '.join(DIRECTIONS)}")
    return DIRECTIONS[direction]
