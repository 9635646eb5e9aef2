"""Settings of a study, a class for each reader: the function of a stage names the one it takes.

Fields have the names of the keys of config/schema/study.schema.yaml; lengths are in mm, forces in
N, pressures in MPa, angles in degrees, and None stands for "auto".
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

#: Value and kind, "force" (N) or "pressure" (MPa).
Load = tuple[float, str]
#: Smallest and largest length, mm.
Range = tuple[float, float] | None
S = TypeVar("S")
#: Columns of each kind of laboratory test: that of the curve's axis, then what is measured over it.
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
    opposite: str
    outliers: str
    fill_holes: int
    window: float | list[float] | None
    window_centre: list[float] | None
    directions: list[str]
    contact_directions: list[str]
    offsets: list[float] | None
    resolutions: list[int]
    surface_range: Range


@dataclass(frozen=True)
class JointSettings:
    """Settings of every contact solve of a joint."""

    material: Elastic
    loads: list[Load]
    dilatancy_loads: list[Load]
    resolutions: list[int]
    contact_directions: list[str]
    map_offset: float | None


@dataclass(frozen=True)
class ContactSettings(JointSettings):
    """Settings that choose the contact states."""

    map_load: Load

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
    scaling_range: Range
    hyperbola_range: list[Load] | None
    seating_pressure: float


@dataclass(frozen=True)
class EnsembleSettings(SpecimenSettings, StateSettings):
    """Settings of an ensemble: of the making of its members and their states."""


@dataclass(frozen=True)
class StrengthSettings:
    """Settings of strength and size laws."""

    material: Material
    surface_range: Range


@dataclass(frozen=True)
class MeasuredTest:
    """A laboratory test; what has no meaning for its kind is NaN or empty.

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
        Of the flow.
    direction : str
        Of sliding.
    seat, pressure, largest_pressure : float
        That the displacement counts from, that is held, and that the joint has carried, MPa.
    compliance : float
        Of the rock between the gauge points, mm/MPa.
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
    label: str
    group: str
    chosen_for: dict[str, str]
    capped_variant: bool


@dataclass(frozen=True)
class Settings(SpecimenSettings, StateSettings, WindowSettings, MeasuredSettings, ReportSettings):
    """All settings of a specimen, as the atlas keeps them; ``twins`` of a scan, 0 for none."""

    material: Material
    twins: int


@dataclass(frozen=True)
class Solver:
    """Settings of the contact solver; accuracy None for a study of all states."""

    rtol: float
    kernel: str
    accuracy: dict[str, float] | None


def read(section: type[S], stated: Mapping[str, Any]) -> S:
    """The part of some settings that a class names.

    Parameters
    ----------
    section : type
        Of this module.
    stated : mapping
        By key, such as ``dataclasses.asdict`` of :class:`Settings`; other keys are passed over.
    """
    types = get_type_hints(section)
    return section(
        **{
            key: _read(types[key], stated[key])
            for key in (field.name for field in fields(section))  # type: ignore[arg-type]
        }
    )


def _read(kind: Any, value: Any) -> Any:
    """A value, or each of a list, as its class where it has one."""
    if get_origin(kind) is list and is_dataclass(of := get_args(kind)[0]):
        return [read(of, one) for one in value]  # type: ignore[arg-type]
    return read(kind, value) if is_dataclass(kind) else value  # type: ignore[arg-type]
