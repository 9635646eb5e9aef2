"""Keys of a study, a class a section: schemas, tables of keys and errors follow from them."""

from functools import cache
from typing import Annotated, Any, Literal, get_type_hints

from pydantic import Field, create_model, model_validator
from pydantic_core import PydanticCustomError

from ..core.keys import (
    MAX_NODES_PER_SIDE,
    Angle,
    Label,
    Length,
    Natural,
    PositiveLength,
    Pressure,
    Section,
    Share,
    different,
    key,
    matching,
    schema_of,
)
from ..core.limits import MOST_INTERMITTENT
from ..core.settings import Settings
from ..core.tolerance import ACCURACY
from ..core.units import share_of
from ..scan.keys import ScanKeys
from .laboratory_keys import Tests
from .scan_files import LONGEST_NAME

#: Seed of random numbers; results store it in eight bytes.
Seed = Annotated[int, key("a whole number from 0, of up to 18 digits", ge=0, le=10**18 - 1)]
Seeds = Annotated[list[Seed], key("two or more different whole numbers", min_length=2), *different]
_Count = Annotated[int, key("a whole number from 1 to 16384", ge=1, le=MAX_NODES_PER_SIDE)]
Sizes = Annotated[
    list[_Count], key("one or more whole numbers from 1 to 16384", min_length=1), *different
]
_Side = Annotated[int, key("nodes along a side, from 16 to 16384", ge=16, le=MAX_NODES_PER_SIDE)]
_Fraction = Annotated[float, key("a number between 0 and 1", gt=0, lt=1)]
_FRACTIONS = "one or more numbers between 0 and 1, with a decimal point (1.0e-3)"
Fractions = Annotated[list[_Fraction], key(_FRACTIONS, min_length=1), *different]
_Positive = Annotated[float, key("a number above 0", gt=0)]
Positives = Annotated[list[_Positive], key("one or more numbers above 0", min_length=1)]
Wavelength = Annotated[
    float, key("a wavelength in nodes, from 2 to 16384", ge=2, le=MAX_NODES_PER_SIDE)
]
_Surfaces = Annotated[int, key("a number of surfaces from 2 to 10000", ge=2, le=10000)]


class MaterialKeys(Section):
    """A material."""

    modulus: Annotated[Pressure, key("a pressure with its unit, such as 20 GPa")]
    r"""Young's modulus of both blocks; E\* = E / (2 (1 - nu²))"""
    poisson: Annotated[float, key("Poisson's ratio, above -1 and up to 0.5", gt=-1, le=0.5)]
    """Poisson's ratio nu, above -1 and up to 0.5"""
    basic_friction_angle: Angle = float("nan")
    """friction angle of a flat face of the rock, such as `30 deg`; the shear strength needs it"""
    basic_friction_angle_is: Annotated[
        Literal["measured", "assumed"], key("measured or assumed")
    ] = "assumed"
    """`measured` on flat faces of this rock, or `assumed`: the interval of a strength contains
    factors of 0.87 to 1.13, or of 0.9 to 1.9 by Barton's law and 10 degrees by the other rules"""
    joint_wall_strength: Annotated[Pressure, key("a pressure with its unit, such as 80 MPa")] = (
        float("nan")
    )
    """Barton's JCS, such as `80 MPa`; the shear strength needs it"""
    hardness: Annotated[
        Literal["none"] | Pressure,
        key(
            'a quantity such as "80 MPa", or none',
            unsaid="`joint_wall_strength` of a scan that has one; else none",
        ),
    ] = float("nan")
    """largest pressure that a contact bears before it crushes (elastic, perfectly plastic);
    `none` keeps contacts elastic, as in the paper"""


_KEYS: Any = {
    name: (hint, None)
    for name, hint in get_type_hints(Settings, include_extras=True).items()
    if hasattr(hint, "__metadata__")
}
_FromSettings: Any = create_model("_FromSettings", __base__=Section, **_KEYS)
_FromSettings.texts_of = Settings


class SettingsKeys(_FromSettings):
    """Settings of a specimen: every key of :class:`core.settings.Settings`."""

    material: Annotated[
        str | MaterialKeys,
        key(
            "the name of a material of the study, or a mapping with modulus and poisson",
            unsaid="required in `defaults`: it holds for a scan whose sidecar states none",
        ),
    ] = ""
    """a name from `materials`, or a mapping with the keys of a material"""
    measured: Annotated[
        Tests, key("laboratory tests by kind, closure, flow, dilatancy, shear or strength")
    ] = Tests()
    """laboratory tests of the specimen, by kind: `closure`, `flow`, `dilatancy`, `shear`,
    `strength`, each a test or a list of tests"""


class EmbeddedKeys(Section):
    """A synthetic specimen of the study itself."""

    label: Label
    """what it is, in words: one line of up to 200 characters, without `$`; stands in every
    figure"""
    size: PositiveLength
    """side of the square, or diameter of the disc: 2 to 16384 times the spacing"""
    spacing: PositiveLength
    """distance of neighbouring nodes"""
    outline: Annotated[Literal["square", "disc"], key("square or disc")] = "square"
    """`square` (default) or `disc`"""
    construction: Annotated[
        Literal["spectrum", "weierstrass-mandelbrot", "random-midpoint", "cantor-punch"],
        key("spectrum, weierstrass-mandelbrot, random-midpoint or cantor-punch"),
    ] = "spectrum"
    """`spectrum` (default: spectral synthesis), `weierstrass-mandelbrot` (a sum of waves),
    `random-midpoint` (a random iterated function) or `cantor-punch` (steps upon steps, the same
    along y; 3^n nodes per side, contact dimension 1 + ln 2/ln 3)"""
    dimension: Annotated[
        float, key("surface dimension Delta_g = 3 - H, between 2 and 3", gt=2, lt=3)
    ]
    """Delta_g = 3 - H"""
    rms: PositiveLength
    """standard deviation of the heights"""
    roll_off: Annotated[
        PositiveLength | None,
        key("a length, or null for a surface that is self-affine at every scale"),
    ] = None
    """wavelength above which the spectrum is flat; `null` for none, as it is for all other
    constructions"""
    anisotropy: Annotated[
        float, key("distance along y over that along x, from 0.1 to 10", ge=0.1, le=10)
    ] = 1.0
    """of a `spectrum`: distance along y over the distance along x within which heights differ as
    much (default 1: isotropic). The rms slope along x is that along y times `anisotropy` to the
    power H"""
    intermittency: Annotated[
        float, key(f"from 0 to {MOST_INTERMITTENT}", ge=0, le=MOST_INTERMITTENT)
    ] = 0.0
    """of a `spectrum`: how unevenly roughness is spread over the face. 0 (default) is a Gaussian
    surface; 0.15 gives the heavy-tailed slopes of a granite face ([Twins](../docs/twins.md))"""
    seed: Seed
    """the same seed gives the same bits; a `cantor-punch` has no chance in it"""
    realisations: Annotated[int, key("surfaces of the ensemble, from 3 to 1000", ge=3, le=1000)] = 0
    """number of surfaces of its ensemble (3 or more): its own seed and those that follow, solved
    at the reported offset under a few loads. Statements on joints of a kind are then judged on
    their mean"""
    chosen_for: Annotated[
        dict[str, Label],
        key("how the specimen was chosen for what the paper says, by statement of the atlas"),
    ] = {}
    """how the specimen was chosen for a statement of the paper, `{STATEMENT: how}`. The verdict
    on that statement is then marked circular. The names are those of `statement` in the
    atlas"""


class SidecarKeys(SettingsKeys, ScanKeys):
    """A sidecar: how to read the file, and settings of the specimen."""


# -- sections of the laboratory --------------------------------------------------------------------


class RollOffKeys(Section):
    """Synthetic joints with and without a roll-off."""

    embedded: Annotated[str, key("name of an embedded specimen with a roll_off")]
    """the specimen whose recipe is used; it must have a `roll_off`"""
    window: Length
    """side of the window"""
    seeds: Seeds
    """two or more"""


class AreaSlopeKeys(Section):
    """Real contact area at light load."""

    dimension: Annotated[float, key("surface dimension, between 2 and 3", gt=2, lt=3)]
    """Delta_g"""
    nodes: Annotated[int, key("nodes along a side", ge=16, le=MAX_NODES_PER_SIDE)]
    """nodes per side"""
    seeds: Seeds
    """two or more"""
    roll_off_share: Annotated[
        float, key("roll-off length as a share of the side, between 0 and 1", gt=0, lt=1)
    ]
    """roll-off length as a fraction of the side"""
    loads: Annotated[
        list[Annotated[float, key("p / (E* h'_rms), above 0 and up to 0.02", gt=0, le=0.02)]],
        key("numbers p / (E* h'_rms), above 0 and up to 0.02", min_length=1),
    ]
    r"""reduced pressures p / (E\* h'_rms), up to 0.02"""


class ArmKeys(Section):
    """An arm of the experiment on the size effect."""

    sizes: Sizes
    surfaces: Annotated[
        list[_Surfaces], key("as many numbers of surfaces as there are sizes", min_length=1)
    ]
    cut_offs: Annotated[
        list[Wavelength], key("two or more wavelengths in nodes", min_length=2), *different
    ] = []
    constructions: Annotated[
        list[Literal["weierstrass-mandelbrot", "random-midpoint", "cantor-punch"]],
        key("a list of weierstrass-mandelbrot, random-midpoint or cantor-punch", min_length=1),
        *different,
    ] = []


_ARM = key("a mapping with sizes and surfaces, cut_offs of the arm R and constructions of G")
_Arm = Annotated[ArmKeys, _ARM]
_OptionalArm = Annotated[ArmKeys | None, _ARM]


class ArmsKeys(Section):
    """Arms of the experiment on the size effect."""

    R: _Arm
    S1: _Arm
    S2: _OptionalArm = None
    S3: _OptionalArm = None
    W: _OptionalArm = None
    G: _OptionalArm = None


class SizeEffectKeys(Section):
    """Resolution, size and geometry of the contact, varied one by one."""

    hurst: Fractions
    """Hurst exponents H of the surfaces"""
    loads: Positives
    r"""p/(E\* h'_rms); h'_rms is that of the arm and size with its shortest cut-off, from the
    spectrum"""
    cut_off: Wavelength
    """shortest wavelength of the arms S1, S2 and S3"""
    roll_off: Wavelength
    """wavelength above which the spectrum is flat, of arm S1; sizes from 4 of it on enter the
    exponents"""
    roll_off_fraction: Annotated[
        float, key("roll-off length as a fraction of the side, above 0 and up to 1", gt=0, le=1)
    ]
    """the same as a fraction of the side, of the arms R and S2; S3 has none"""
    arms: Annotated[ArmsKeys, key("a mapping with the arms R and S1, and S2, S3, W or G if wanted")]
    """by name, `R` and `S1` at least; `S2`, `S3`, `W`, `G`. Each has `sizes` (nodes per side)
    and `surfaces` (one number for each size), `R` also `cut_offs` (shortest wavelengths), `G`
    also `constructions`"""


class SizeStrengthKeys(Section):
    """Strength of synthetic mated joints over their size."""

    hurst: Fractions
    """Hurst exponents H of the faces"""
    loads: Annotated[
        list[Annotated[float, Field(gt=0, le=1)]],
        key("one or more numbers p / (E* h'_rms), above 0 and up to 1", min_length=1),
        *different,
    ]
    r"""p/(E\* h'_rms), h'_rms = √2 `rms_slope`, that of the composite topography far beyond the
    cut-off"""
    hardness: Annotated[float, key("a number H / (E* h'_rms) above 0", gt=0)] = float("inf")
    r"""H/(E\* h'_rms) of capped contact; without it only elastic contact is solved"""
    cut_off: Wavelength
    """shortest wavelength, nodes"""
    roll_off: Wavelength
    """wavelength above which the spectrum is flat, nodes; sizes from 4 roll-offs on enter the
    exponents"""
    rms_slope: Annotated[
        float, key("rms slope h'_rms of a face, above 0 and up to 10", gt=0, le=10)
    ]
    """h'_rms of a face: sets the heights, and so the angles"""
    basic_friction_angle: Annotated[
        float, key("basic friction angle, degrees, from 0 and below 90", ge=0, lt=90)
    ]
    """φ_b, degrees (a plain number)"""
    offsets: Sizes
    """displacements v, nodes. Where they and the sizes double, intervals of v are equal
    fractions of several sizes"""
    sizes: Annotated[
        list[_Side],
        key("two or more whole numbers from 16 to 16384, nodes along a side", min_length=2),
        *different,
    ]
    """nodes per side"""
    surfaces: Annotated[
        list[_Surfaces], key("as many numbers of surfaces as there are sizes", min_length=2)
    ]
    """number of joints of each size"""


class EstimatorBiasKeys(Section):
    """Bias of the estimators of Delta_g."""

    hurst: Annotated[Fractions, key("Hurst exponents H of the surfaces")]
    sizes: Annotated[Sizes, key("nodes per side, whole numbers from 1 to 16384")]
    seeds: Seeds
    roll_offs: Annotated[
        list[Annotated[float, Field(gt=0, le=1)] | None],
        key("one or more fractions of the side above 0, or null for none", min_length=1),
        *different,
    ] = [None]


class SpeedKeys(Section):
    """Solvers and cheaper models timed."""

    sizes: Annotated[
        list[_Side],
        key("one or more whole numbers from 16 to 16384, nodes along a side", min_length=1),
        *different,
    ]
    """nodes per side, from 16"""
    hurst: Fractions
    """H of the surfaces"""
    contact: Fractions
    """fractions of the nodes in contact"""
    seed: Seed
    """of the surfaces"""
    tolerances: Fractions
    """tried from loose to tight"""
    runs: Natural
    """of each solver or model, in turn; the median counts"""
    longest: Annotated[float, key("a number of seconds above 0", gt=0)]
    """seconds: a method that takes longer is run once, and (except ours) at no tighter tolerance"""
    slow_nodes: Annotated[int, key("a whole number from 0", ge=0)]
    """methods that need the influence of every node on every other are tried up to this many
    interpenetrating nodes"""
    error: Annotated[float, key("a number between 0 and 1, such as 1e-4", gt=0, lt=1)]
    """error of the force at which sizes are compared"""


class ConvergenceKeys(Section):
    """The solver compared with exact solutions."""

    cells: Sizes
    """cells across the contact radius"""
    placements: Natural
    """positions of the centre within a cell, each way"""
    trials: Natural
    """cases in which Richardson's extrapolation is tried"""
    trial_cells: Annotated[
        list[Annotated[float, Field(ge=4)]],
        key("two numbers [fewest, most] from 4", min_length=2, max_length=2),
    ]
    """`[fewest, most]` cells across the radius there, at the finest spacing"""
    seed: Seed
    """of the cases"""


class StabilityKeys(Section):
    """Solvers judged on problems that methods fail on."""

    draws: Natural
    """test problems of each kind"""
    elimination: Natural
    """rough test problems per kernel, on which dropping nodes in tension alone is tried, as the
    paper does"""


# -- the study -------------------------------------------------------------------------------------


class AccuracyKeys(Section):
    """Requested accuracy."""

    closure: Annotated[Share, key("a share, such as 1 % or 0.01")] = share_of(ACCURACY["closure"])
    delta_sigma: Annotated[Share, key("a share, such as 2 % or 0.02")] = share_of(
        ACCURACY["delta_sigma"]
    )


class SolverKeys(Section):
    """The contact solver."""

    rtol: Annotated[
        float,
        key(
            "a number between 0 and 0.01, such as 1e-6",
            unsaid="follows from `accuracy`; `1.0e-6` where that is `full`",
            gt=0,
            le=0.01,
        ),
    ] = float("nan")
    """largest KKT residual (violation of the contact conditions), as a fraction of the closure,
    such as `1e-6`"""
    kernel: Annotated[
        Literal["love", "rigid square", "equal-area disc", "inscribed disc"],
        key("love, or the paper's rigid plate as rigid square, equal-area disc or inscribed disc"),
    ] = "love"
    """`love`, or the paper's rigid plate read as `rigid square`, `equal-area disc` or
    `inscribed disc`"""


_Part = Annotated[
    Literal["all"] | Natural, key("all, or how many one job takes (a whole number from 1)")
]


class GrainKeys(Section):
    """Work of one job."""

    directions: _Part = "all"
    """how many directions one job solves, or `all`"""
    offsets: _Part = "all"
    """how many offsets one job solves, or `all`"""
    resolutions: _Part = "all"
    """how many resolutions one job solves, or `all`"""


_MATERIAL = matching(
    r"[^$\x00-\x1f\x7f-\x9f]{1,200}",
    "the name of a material, up to 200 characters on one line, without $",
)
_SPECIMEN = matching(
    rf"[A-Za-z0-9][A-Za-z0-9_.-]{{0,{LONGEST_NAME - 1}}}",
    "the name of a specimen, up to 220 letters, digits, _ . and - (a letter or digit first)",
)
_Names = Annotated[list[str], *different]


class StudyKeys(Section):
    """A study."""

    study: Annotated[
        str,
        key(
            "the study's name, up to 100 letters, digits, _ and - (it names the folder under "
            "results)",
            pattern="^[A-Za-z0-9][A-Za-z0-9_-]{0,99}$",
        ),
    ]
    """its name, up to 100 letters, digits, `_` and `-`; everything goes to `results/NAME/`"""
    scans: Annotated[
        str | None, key("the folder whose files become specimens, or null for none")
    ] = "scans"
    """folder whose files become specimens; `null` for none. A missing folder is an error, an
    empty one a warning"""
    groups: Annotated[
        str,
        key(
            "the word folders (each folder in that of the scans is a group) or the path of a "
            "table (CSV)",
            unsaid="files of the folder itself alone",
            min_length=1,
        ),
    ] = ""
    """how the scans of many specimens are distinguished: `folders` (each folder in that of the
    scans is a group) or the path of a table (CSV); see `scans/README.md`"""
    atlas: Annotated[
        Literal["whole", "parts"],
        key(
            "whole (one file) or parts (one file a specimen)",
            unsaid="`whole` up to 30 specimens, else `parts`",
        ),
    ] = "whole"
    """`whole`: one file, `atlas.nc`. `parts`: one file for each specimen, `atlas/SPECIMEN.nc`,
    and `atlas.nc` for what they have together. `open_atlas` reads both"""
    figures: Annotated[
        Literal["all", "joint", "none"] | _Names,
        key(
            "all, joint, none, or a list of names of figures",
            unsaid="`all`; `none` for an atlas in parts",
        ),
    ] = "all"
    """figures of each specimen: `all`; `joint`, those that the owner of a joint needs, with the
    statements of the paper on the index alone; `none`; or a list of their names"""
    explorer: Annotated[
        _Names, key("a list of names of specimens", unsaid="all; none for an atlas in parts")
    ] = []
    """names of the specimens whose contact states the explorer shows, such as `[granite,
    joint_3]`"""
    materials: Annotated[
        dict[Annotated[str, _MATERIAL], MaterialKeys],
        key(
            "materials by name",
            unsaid="required where there are specimens, not for contact maps alone",
            min_length=1,
        ),
    ] = {}
    """materials by name (up to 200 characters on one line, without `$`)"""
    embedded: Annotated[
        dict[Annotated[str, _SPECIMEN], EmbeddedKeys],
        key("specimens the study makes for itself, by name"),
    ] = {}
    """synthetic specimens of the study itself, by name (up to 220 letters, digits, `_`, `.` and
    `-`). Two names must differ in more than upper and lower case"""
    defaults: Annotated[
        SettingsKeys | None, key("", unsaid="required where there are specimens")
    ] = None
    """settings of every specimen"""
    specimens: Annotated[
        dict[str, SettingsKeys], key("settings that differ from the defaults, by specimen name")
    ] = {}
    """name: settings that differ from the defaults"""
    roll_off: RollOffKeys | None = None
    """synthetic joints with and without a roll-off, to see what makes the plateau of the
    dilatancy"""
    size_effect: SizeEffectKeys | None = None
    """synthetic surfaces on which resolution, size and geometry of the contact are varied one
    by one"""
    size_strength: SizeStrengthKeys | None = None
    """synthetic mated joints that slide, whose strength is compared over their size"""
    estimator_bias: EstimatorBiasKeys | None = None
    """synthetic surfaces of known dimension on which the bias of the estimators of Delta_g is
    measured"""
    area_slope: AreaSlopeKeys | None = None
    """synthetic surfaces on which the real contact area at light load is compared with the
    theories"""
    speed: SpeedKeys | None = None
    """solvers and cheaper models timed on test problems"""
    convergence: ConvergenceKeys | None = None
    """the solver compared with exact solutions"""
    stability: StabilityKeys | None = None
    """solvers judged on test problems that methods fail on"""
    accuracy: Annotated[
        Literal["full"] | AccuracyKeys,
        key(
            "full, or a mapping with closure (1 %) and delta_sigma (0.02)",
            unsaid="`{closure: 1 %, delta_sigma: 0.02}`",
        ),
    ] = AccuracyKeys()
    """`{closure, delta_sigma}`: the requested accuracy of a closure, as a fraction of it (`1 %`
    or `0.01`), and of a Delta_sigma. Or `full`: all states are solved, whatever it costs"""
    solver: SolverKeys = SolverKeys()
    grain: GrainKeys = GrainKeys()

    @model_validator(mode="after")
    def _needs_materials(self) -> "StudyKeys":
        """A study with specimens needs materials and defaults; one that only measures does not."""
        if {"embedded", "specimens"} & self.model_fields_set:
            for name, words in (("materials", "; expected materials by name"), ("defaults", "")):
                if name not in self.model_fields_set:
                    raise PydanticCustomError(
                        "missing_key", "missing key '{name}'{words}", {"name": name, "words": words}
                    )
        return self


def stated(section: Section) -> dict[str, Any]:
    """Values of the keys that a section states."""
    return {name: getattr(section, name) for name in section.model_fields_set}


@cache
def unsaid_settings() -> dict[str, Any]:
    """Settings of a specimen that no layer states, as a user would write them."""
    properties = schema_of(SettingsKeys)["properties"]
    return {name: node["default"] for name, node in properties.items() if "default" in node}
