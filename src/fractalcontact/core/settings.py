"""Settings of a specimen, a class for each reader: the function of a stage names the one it takes.

A field with :func:`core.keys.key` is a key that a study or a sidecar may state; the others follow
from them. Lengths are in mm, forces in N, pressures in MPa, angles in degrees, and None stands for
"auto".
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin, get_type_hints

from pydantic import Field

from .keys import (
    LINE,
    MAX_NODES_PER_SIDE,
    Direction,
    Length,
    Load,
    Offset,
    Pressure,
    Range,
    StatedAs,
    auto,
    different,
    key,
)

S = TypeVar("S")
_Pair = Annotated[list[Length], Field(min_length=2, max_length=2)]
_Loads = Annotated[list[Load], Field(min_length=1)]
_Directions = Annotated[
    list[str], StatedAs(Annotated[list[Direction], Field(min_length=1), *different])
]
_Multiple = Annotated[
    int, Field(ge=1, le=MAX_NODES_PER_SIDE, description="a whole number from 1 to 16384")
]
_Resolutions = Annotated[
    list[_Multiple],
    Field(min_length=1),
    *different,
    key(
        "whole multiples k of the scan's spacing, such as [1, 2, 4, 8]",
        doc="multiples k of the scan's spacing; every k-th node is kept",
        unsaid="required in `defaults`",
    ),
]
_ContactDirections = Annotated[
    _Directions,
    key(
        only="sliding",
        words="sliding directions whose contact is solved, some of E, N, W, S",
        doc="those of them whose contact is solved; most figures show the first",
        unsaid="`directions`",
    ),
]
#: Columns of each kind of laboratory test: the curve's axis, then the quantity measured over it.
TEST_COLUMNS = {
    "closure": ("pressure", "displacement"),
    "flow": ("pressure", "transmissivity"),
    "dilatancy": ("displacement", "dilation"),
    "shear": ("displacement", "shear_stress"),
    "strength": ("pressure", "shear_strength"),
}


@dataclass(frozen=True)
class Elastic:
    """Elastic constants and hardness of a material; the hardness is infinite if nothing yields."""

    e_star: float
    hardness: float


@dataclass(frozen=True)
class Friction:
    """Friction angle and wall strength of a material; NaN if not stated."""

    basic_friction_angle: float
    joint_wall_strength: float


@dataclass(frozen=True)
class Material(Elastic, Friction):
    """A material of a study."""

    name: str
    modulus: float
    poisson: float


@dataclass(frozen=True)
class SpecimenSettings:
    """Settings of the scan, the window and the offsets."""

    known_dimension: float
    opposite: Annotated[
        str,
        StatedAs(Literal["match", "flat"]),
        key(
            "match (the other face fits perfectly) or flat (a rigid plane)",
            doc=(
                "the face that was not scanned: `match` fits perfectly, `flat` is a rigid plane"
                " (the surface then does not slide). Refused where both were scanned"
            ),
            unsaid="`match`",
            default="match",
        ),
    ]
    outliers: Annotated[
        str,
        StatedAs(Literal["keep", "mask", "fill"]),
        key(
            (
                "keep (outlying cells stay), mask (they become missing) or fill (they, lone "
                "spikes and deep overlaps are filled)"
            ),
            doc=(
                "`keep`: outlying cells are counted and shown, not altered. `mask`: they become"
                " missing. `fill`: outlying cells, lone spikes and deep overlaps of two faces "
                "(`scans/README.md`) are filled from the cells around"
            ),
            unsaid="`keep`",
            default="keep",
        ),
    ]
    fill_holes: Annotated[
        int,
        Field(ge=0, le=MAX_NODES_PER_SIDE),
        key(
            "rows and columns of the largest hole to be filled, a whole number of cells from 0",
            doc="side of the largest hole that is filled, rows or columns of cells; 0 fills none",
            default=0,
            unsaid="0",
        ),
    ]
    window: Annotated[
        float | None,
        auto(Length),
        key(
            "auto, or the side of the square window such as 20 mm",
            doc=(
                "side of the square window, or `auto`: half of the largest square without "
                "holes, so that it can slide"
            ),
            unsaid="`auto`",
        ),
    ]
    window_centre: Annotated[
        list[float] | None,
        StatedAs(_Pair),
        key(
            "two lengths [x, y] in the scan's own coordinates",
            doc="`[x, y]` in the scan's own coordinates, within the scan",
            unsaid="the middle",
        ),
    ]
    directions: Annotated[
        _Directions,
        key(
            "sliding directions of the rigid dilatancy, some of E, N, W, S",
            doc="sliding directions of the rigid dilatancy, some of `E, N, W, S`",
            unsaid="all four",
            default=["E", "N", "W", "S"],
            only="sliding",
        ),
    ]
    contact_directions: _ContactDirections
    offsets: Annotated[
        list[float] | None,
        auto(Annotated[list[Offset], Field(min_length=1)]),
        key(
            "auto, or a list of shear offsets v such as [0.1 mm, 0.3 mm]",
            doc=(
                "shear offsets v, rounded to whole cells of the scan; or `auto`: eight between "
                "one cell and the largest possible, and zero where two faces were scanned"
            ),
            unsaid="`auto`",
            only="sliding",
        ),
    ]
    resolutions: _Resolutions
    surface_range: Annotated[
        Range,
        key(
            "auto, or two lengths [smallest, largest] such as [0.2 mm, 2 mm]",
            doc=(
                "`[smallest, largest]` lag of the Delta_g fits, or `auto`: 4 cells to an eighth"
                " of the side, or to a quarter of a roll-off that is seen (then from 2 cells if"
                " need be). A stated range is used as it is, with a warning if it reaches "
                "beyond that quarter"
            ),
            unsaid="`auto`",
        ),
    ]


@dataclass(frozen=True)
class JointSettings:
    """Settings of every contact solve of a joint."""

    material: Elastic
    loads: Annotated[
        _Loads,
        key(
            "a list of forces (10 kN) or nominal pressures (25 MPa)",
            doc=(
                "forces, or nominal pressures F / A_0. A specimen leaves out pressures in "
                "`defaults` of 0.95 H and more, which its hardness cannot carry"
            ),
            unsaid="required in `defaults`",
        ),
    ]
    dilatancy_loads: Annotated[
        _Loads,
        key(
            "loads, all of them in loads, whose elastic dilatancy is drawn",
            doc=(
                "loads of the elastic dilatancy curves, of strength and of sub-windows, among "
                "`loads`"
            ),
            unsaid="the three largest",
        ),
    ]
    resolutions: _Resolutions
    contact_directions: _ContactDirections
    map_offset: Annotated[
        float | None,
        StatedAs(Length),
        key(
            "a length with its unit, such as 0.3 mm",
            doc="offset of the contact maps over resolutions and loads",
            unsaid="0 of two scanned faces, else the third",
            only="sliding",
        ),
    ]


@dataclass(frozen=True)
class ContactSettings(JointSettings):
    """Settings that choose the contact states."""

    map_load: Annotated[
        Load,
        key(
            "a force or a pressure among the loads, such as 25 MPa",
            doc="load of the contact maps, among `loads`",
            unsaid="the largest",
        ),
    ]

    @property
    def drawn_loads(self) -> list[Load]:
        """Loads that figures show: those of the dilatancy and of the contact maps."""
        return [*self.dilatancy_loads, self.map_load]


@dataclass(frozen=True)
class WindowSettings(JointSettings):
    """Settings of the sub-windows."""

    box_range: Range
    scaling_range: Range


@dataclass(frozen=True)
class StateSettings(ContactSettings):
    """Settings of the analysis of contact states: curves, laws, domains."""

    box_range: Annotated[
        Range,
        key(
            "auto, or two lengths [smallest, largest] such as [0.2 mm, 2 mm]",
            doc=(
                "`[smallest, largest]` box of the box counts, or `auto`: all box sizes between "
                "the cut-offs"
            ),
            unsaid="`auto`",
        ),
    ]
    scaling_range: Annotated[
        Range,
        key(
            "auto, or two lengths [smallest, largest] such as [0.2 mm, 2 mm]",
            doc="`[smallest, largest]` spacing s of the fits of A_r(s), or `auto` for all",
            unsaid="`auto`",
        ),
    ]
    hyperbola_range: Annotated[
        list[Load] | None,
        auto(Annotated[list[Load], Field(min_length=2, max_length=2)]),
        key(
            "auto, or two loads [smallest, largest] between which closure laws are fitted",
            doc=(
                "`[smallest, largest]` load of the closure fits, or `auto` for all with 10 "
                "nodes or more"
            ),
            unsaid="`auto`",
        ),
    ]
    seating_pressure: Annotated[
        Pressure,
        key(
            "a pressure with its unit, such as 0.25 MPa",
            doc=(
                "nominal pressure from which closure and its laws are counted, as a laboratory "
                "seats its specimen. The seat is, at each offset, the first of `loads` from "
                "this pressure on with 10 nodes or more"
            ),
            unsaid="`0.25 MPa`",
            default="0.25 MPa",
        ),
    ]


@dataclass(frozen=True)
class EnsembleSettings(SpecimenSettings, StateSettings):
    """Settings of an ensemble: for making its members and their states."""


@dataclass(frozen=True)
class StrengthSettings:
    """Settings of strength and size laws."""

    material: Material
    surface_range: Range


@dataclass(frozen=True)
class MeasuredTest:
    """A laboratory test; fields without a meaning for its kind are NaN or empty.

    Attributes
    ----------
    kind : str
        Key of `TEST_COLUMNS`.
    file : str
    columns : dict of str to str
        Heading in the file by column; that of the curve's axis comes first.
    branch : {"load", "unload", "reload", ""}
    cycle : int
    way : {"along", "across", ""}
        Direction of the flow.
    direction : str
        Direction of sliding.
    seat, pressure, largest_pressure : float
        Pressures of the zero of displacement, during the test, and largest in the joint's history,
        MPa.
    compliance : float
        Compliance of the rock between the gauge points, mm/MPa.
    error : float
        Half-width of the interval of a reading, 95 %, mm or MPa.
    calibrate : {"modulus", "hardness", ""}
    """

    kind: str
    file: str
    columns: dict[str, str]
    branch: str
    cycle: int
    way: str
    direction: str
    seat: float
    pressure: float
    largest_pressure: float
    compliance: float
    error: float
    calibrate: str

    @property
    def label(self) -> str:
        """Name of the test among those of its kind: "load, cycle 1"."""
        held = f"{self.pressure:g} MPa" if self.pressure > 0 else ""
        of_cycle = f"{self.branch}, cycle {self.cycle}" if self.branch else ""
        return ", ".join(filter(None, (self.way, of_cycle, self.direction, held)))


@dataclass(frozen=True)
class MeasuredSettings(JointSettings):
    """Settings of the comparison with laboratory tests."""

    measured: list[MeasuredTest]


@dataclass(frozen=True)
class ReportSettings(StrengthSettings):
    """Settings of the report: strength, size laws and verdicts."""

    material: Material
    opposite: str
    label: Annotated[
        str,
        Field(pattern=LINE % 200),
        key(
            "what it is, in up to 200 characters on one line, without $",
            doc="what it is, in words: one line of up to 200 characters, without `$`",
            unsaid="its name",
        ),
    ]
    group: Annotated[
        str,
        Field(pattern=LINE % 100),
        key(
            "the group of specimens it belongs to, up to 100 characters on one line, without $",
            doc=(
                "the group of specimens it belongs to, up to 100 characters: groups are "
                "compared in figures and in `study_comparison` of the atlas"
            ),
            unsaid="its folder's name with `groups: folders`, else none",
        ),
    ]
    chosen_for: dict[str, str]
    capped_variant: bool


@dataclass(frozen=True)
class Settings(SpecimenSettings, StateSettings, WindowSettings, MeasuredSettings, ReportSettings):
    """All settings of a specimen, as the atlas keeps them; ``twins`` of a scan, 0 for none."""

    material: Material
    twins: Annotated[
        int,
        StatedAs(Literal[0] | Annotated[int, Field(ge=3, le=1000)]),
        key(
            "0 for none, or a number of twins of the scan from 3 to 1000",
            doc=(
                "of a scan: number of twins (0, or 3 or more), random surfaces with the "
                "measured spectrum, solved in the reported direction and offset alone. Their "
                "spread says how far the scan's numbers may differ from those of the whole "
                "joint ([Twins of a scan](../docs/conventions.md#twins-of-a-scan)). In "
                "`defaults` it concerns scans alone; an embedded specimen has `realisations`"
            ),
            unsaid="0",
        ),
    ]


@dataclass(frozen=True)
class Solver:
    """Settings of the contact solver; accuracy None for a study of all states."""

    rtol: float
    kernel: str
    accuracy: dict[str, float] | None


def read(section: type[S], stated: Mapping[str, Any]) -> S:
    """Part of some settings, by key, that a class of this module names; other keys are ignored."""
    types = get_type_hints(section)
    return section(
        **{
            key: _read(types[key], stated[key])
            for key in (field.name for field in fields(section))  # type: ignore[arg-type]
        }
    )


def _read(kind: Any, value: Any) -> Any:
    """Value, or each value of a list, as its class where it has one."""
    if get_origin(kind) is list and is_dataclass(of := get_args(kind)[0]):
        return [read(of, item) for item in value]  # type: ignore[arg-type]
    return read(kind, value) if is_dataclass(kind) else value  # type: ignore[arg-type]
