"""Settings of a specimen, a class for each reader: the function of a stage names the one it takes.

An annotated field is a key that a study or a sidecar may state, with its text below; the others
follow from them. Lengths are in mm, forces in N, pressures in MPa, angles in degrees, and None
stands for "auto".
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
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
#: Boundaries of a window: it stands alone on the half-space, or is mirrored at its edges.
FREE, MIRRORED = "free", "mirrored"
_Loads = Annotated[list[Load], Field(min_length=1)]
_Directions = Annotated[
    list[str], StatedAs(Annotated[list[Direction], Field(min_length=1), *different])
]
_Multiple = Annotated[int, key("a whole number from 1 to 16384", ge=1, le=MAX_NODES_PER_SIDE)]
_Resolutions = Annotated[
    list[_Multiple],
    key(
        "whole multiples k of the scan's spacing, such as [1, 2, 4, 8]",
        unsaid="required in `defaults`",
        min_length=1,
    ),
    *different,
]
_ContactDirections = Annotated[
    _Directions,
    key(
        "sliding directions whose contact is solved, some of E, N, W, S",
        unsaid="`directions`",
        only="sliding",
    ),
]
#: Columns of each kind of laboratory test: the axis of the curve, then the measured quantity.
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
    """Friction angle and wall strength of a material; NaN if not stated.

    ``basic_friction_angle_is`` is "measured" or "assumed".
    """

    basic_friction_angle: float
    joint_wall_strength: float
    basic_friction_angle_is: str = field(default="assumed", kw_only=True)


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
        key("match (the other face fits perfectly) or flat (a rigid plane)", default="match"),
    ]
    """the face that was not scanned: `match` fits perfectly, `flat` is a rigid plane (the
    surface then does not slide). Refused where both were scanned"""
    outliers: Annotated[
        str,
        StatedAs(Literal["keep", "mask", "fill"]),
        key(
            "keep (outlying cells stay), mask (they become missing) or fill (they, lone spikes "
            "and deep overlaps are filled)",
            unsaid="`keep`; `fill` of one face against its own match",
            default="keep",
        ),
    ]
    """`keep`: outlying cells are counted and shown, not altered. `mask`: they become missing.
    `fill`: outlying cells, lone spikes and deep overlaps of two faces are filled from the cells
    around"""
    fill_holes: Annotated[
        int,
        key(
            "rows and columns of the largest hole to be filled, a whole number of cells from 0",
            default=0,
            ge=0,
            le=MAX_NODES_PER_SIDE,
        ),
    ]
    """side of the largest hole that is filled, rows or columns of cells; 0 fills none"""
    window: Annotated[
        float | None, auto(Length), key("auto, or the side of the square window such as 20 mm")
    ]
    """side of the square window, or `auto`: half of the largest square without holes, so that
    it can slide"""
    window_centre: Annotated[
        list[float] | None,
        StatedAs(Annotated[list[Length], Field(min_length=2, max_length=2)]),
        key("two lengths [x, y] in the scan's own coordinates", unsaid="the middle"),
    ]
    """`[x, y]` in the scan's own coordinates, within the scan"""
    directions: Annotated[
        _Directions,
        key(
            "sliding directions of the rigid dilatancy, some of E, N, W, S",
            unsaid="all four",
            default=["E", "N", "W", "S"],
            only="sliding",
        ),
    ]
    """sliding directions of the rigid dilatancy, some of `E, N, W, S`"""
    contact_directions: _ContactDirections
    """those of them whose contact is solved; most figures show the first"""
    offsets: Annotated[
        list[float] | None,
        auto(Annotated[list[Offset], Field(min_length=1)]),
        key("auto, or a list of shear offsets v such as [0.1 mm, 0.3 mm]", only="sliding"),
    ]
    """shear offsets v, rounded to whole cells of the scan; or `auto`: eight between one cell
    and the largest possible. Two scanned faces are solved at zero, too"""
    resolutions: _Resolutions
    """multiples k of the scan's spacing; every k-th node is kept"""
    surface_range: Range
    """`[smallest, largest]` lag of the Delta_g fits, or `auto`: 4 cells to an eighth of the
    side, or to a quarter of a roll-off that is seen"""


@dataclass(frozen=True)
class JointSettings:
    """Settings of every contact solve of a joint."""

    material: Elastic
    loads: Annotated[
        _Loads,
        key(
            "a list of forces (10 kN) or nominal pressures (25 MPa)",
            unsaid="required in `defaults`",
        ),
    ]
    """forces, or nominal pressures F / A_0. A specimen leaves out pressures in `defaults` of
    0.95 H and more, which its hardness cannot carry"""
    dilatancy_loads: Annotated[
        _Loads,
        key(
            "loads, all of them in loads, whose elastic dilatancy is drawn",
            unsaid="the three largest",
        ),
    ]
    """loads of the elastic dilatancy curves, of strength and of sub-windows, among `loads`"""
    resolutions: _Resolutions
    contact_directions: _ContactDirections
    map_offset: Annotated[
        float | None,
        StatedAs(Length),
        key(
            "a length with its unit, such as 0.3 mm",
            unsaid="0 of two scanned faces, else the third",
            only="sliding",
        ),
    ]
    """offset of the contact maps over resolutions and loads"""
    boundary: Annotated[
        str,
        StatedAs(Literal["free", "periodic", "mirrored"]),
        key(
            "free, periodic or mirrored: what lies beyond the edges of the window",
            unsaid="`mirrored` of a scan, `free` of an embedded specimen",
        ),
    ] = field(default=FREE, kw_only=True)
    """what lies beyond the edges of the window: `free`, an unloaded half-space, as in the paper;
    `mirrored`, its reflection, as of a column between frictionless walls; `periodic`, its
    repetition, which has a seam"""


@dataclass(frozen=True)
class ContactSettings(JointSettings):
    """Settings that choose the contact states."""

    map_load: Annotated[
        Load, key("a force or a pressure among the loads, such as 25 MPa", unsaid="the largest")
    ]
    """load of the contact maps, among `loads`"""

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

    box_range: Range
    """`[smallest, largest]` box of the box counts, or `auto`: all box sizes between the cut-offs"""
    scaling_range: Range
    """`[smallest, largest]` spacing s of the fits of A_r(s), or `auto` for all"""
    hyperbola_range: Annotated[
        list[Load] | None,
        auto(Annotated[list[Load], Field(min_length=2, max_length=2)]),
        key("auto, or two loads [smallest, largest] between which closure laws are fitted"),
    ]
    """`[smallest, largest]` load of the closure fits, or `auto` for all with 10 nodes or more"""
    seating_pressure: Annotated[
        Pressure, key("a pressure with its unit, such as 0.25 MPa", default="0.25 MPa")
    ]
    """nominal pressure from which closure and its laws are counted. The seat of an offset is the
    first of `loads` from this pressure on with 10 nodes or more and half of the force on sound
    cells"""


@dataclass(frozen=True)
class EnsembleSettings(SpecimenSettings, StateSettings):
    """Settings of an ensemble: for making its members and their states."""


@dataclass(frozen=True)
class StrengthSettings:
    """Settings of strength and size laws."""

    material: Material
    surface_range: Range
    block_lengths: Annotated[
        list[float],
        StatedAs(Annotated[list[Length], Field(min_length=1, max_length=20), *different]),
        key("lengths of blocks such as [200 mm, 1 m]", unsaid="none"),
    ]
    """lengths along the sliding of blocks whose strength is stated beside that of the window, by
    each law that holds for them"""


@dataclass(frozen=True)
class MeasuredTest:
    """A laboratory test; fields without a meaning for its kind are NaN or empty.

    ``columns`` are headings in the file by column, that of the curve's axis first; ``way`` is that
    of the flow, ``direction`` that of sliding. Displacement is counted from ``seat``; ``pressure``
    is held, ``largest_pressure`` was carried before (MPa). ``compliance`` is that of the rock
    between the gauge points (mm/MPa), ``error`` the half-width of the 95 % interval of a reading
    (mm or MPa), ``calibrate`` "modulus" or "hardness", ``datum_pressure`` that of the reading of a
    flow test which sets the rigid position of the faces.
    """

    kind: str
    file: str
    columns: dict[str, str]
    branch: str = ""
    cycle: int = 1
    way: str = ""
    direction: str = ""
    seat: float = math.nan
    pressure: float = math.nan
    largest_pressure: float = math.nan
    compliance: float = 0.0
    error: float = math.nan
    calibrate: str = ""
    datum_pressure: float = math.nan

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
        key(
            "what it is, in up to 200 characters on one line, without $",
            unsaid="its name",
            pattern=LINE % 200,
        ),
    ]
    """what it is, in words: one line of up to 200 characters, without `$`"""
    group: Annotated[
        str,
        key(
            "the group of specimens it belongs to, up to 100 characters on one line, without $",
            unsaid="its folder's name with `groups: folders`, else none",
            pattern=LINE % 100,
        ),
    ]
    """the group of specimens it belongs to, up to 100 characters: groups are compared in
    figures and in `study_comparison` of the atlas"""
    chosen_for: dict[str, str]
    capped_variant: bool
    known_contact: bool


@dataclass(frozen=True)
class Settings(SpecimenSettings, StateSettings, WindowSettings, MeasuredSettings, ReportSettings):
    """All settings of a specimen, as the atlas keeps them; ``twins`` of a scan, 0 for none."""

    material: Material
    twins: Annotated[
        int,
        StatedAs(Literal[0] | Annotated[int, Field(ge=3, le=1000)]),
        key("0 for none, or a number of twins of the scan from 3 to 1000", unsaid="0"),
    ]
    """of a scan: number of [twins](twins.md) (0, or 3 or more), random surfaces with its spectrum,
    whose spread says how far the whole joint may differ. An embedded specimen has
    `realisations`"""


@dataclass(frozen=True)
class Solver:
    """Settings of the contact solver; accuracy None for a study of all states."""

    rtol: float
    kernel: str
    accuracy: dict[str, float] | None


def read(section: type[S], stated: Mapping[str, Any]) -> S:
    """Settings of a class from a mapping, such as ``dataclasses.asdict`` of :class:`Settings`.

    Further keys are passed over.
    """
    types = get_type_hints(section)
    return section(
        **{
            key: _read(types[key], stated[key])
            for key in (field.name for field in fields(section))  # type: ignore[arg-type]
        }
    )


def _read(kind: Any, value: Any) -> Any:
    """Value, or each value of a list, as an instance of its class where it has one."""
    if get_origin(kind) is list and is_dataclass(of := get_args(kind)[0]):
        return [read(of, item) for item in value]  # type: ignore[arg-type]
    return read(kind, value) if is_dataclass(kind) else value  # type: ignore[arg-type]
