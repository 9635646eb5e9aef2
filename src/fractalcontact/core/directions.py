"""Directions of the shear offset: sliding of the upper block, seen from above."""

from .errors import InputError

#: Axis and sign of each direction.
DIRECTIONS = {"E": ("x", 1), "N": ("y", 1), "W": ("x", -1), "S": ("y", -1)}

#: Kind of a file, and of a specimen, with the opening between two faces in place of a face.
APERTURE = "aperture"

#: Specimens that do not slide, in words.
NO_SLIDING = "an aperture map, or a surface against a plane,"

#: Number of offsets of "auto" from one cell to the largest possible, in geometric steps.
AUTOMATIC_OFFSETS = 8


def slides(opposite: str) -> bool:
    """True unless ``opposite`` of a specimen is a plane, or an aperture map, both faces in one."""
    return opposite not in ("flat", APERTURE)


def axis_and_sign(direction: str) -> tuple[str, int]:
    """Axis, "x" or "y", of a direction, and its sign; InputError if there is no such direction."""
    if direction not in DIRECTIONS:
        raise InputError(f"direction {direction!r}; expected one of {', '.join(DIRECTIONS)}")
    return DIRECTIONS[direction]
