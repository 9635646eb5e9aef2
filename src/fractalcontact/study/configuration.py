"""Settings of a study as its configuration states them, turned into mm, N and MPa."""

import math
from collections.abc import Mapping
from pathlib import Path

from ..core.directions import slides
from ..core.errors import InputError
from ..core.settings import Material, Settings, Solver
from ..core.tolerance import ACCURACY, tolerance
from ..core.units import load, quantity, share
from .measured import resolve_tests
from .scan_files import ScanFiles
from .schema import nearest
from .selection import BESIDE_SURFACE, is_capped_variant

#: Nodes per side of an embedded specimen: a surface of that many takes some 35 GB to make.
MIN_NODES_PER_SIDE, MAX_NODES_PER_SIDE = 2, 16384

#: What a study that does not mention it gets; everything else must be stated.
SPECIMEN = {
    "opposite": "match",
    "outliers": "keep",
    "fill_holes": 0,
    "directions": ["E", "N", "W", "S"],
    "seating_pressure": "0.25 MPa",
    "twins": 0,
}
#: Of its hardness, up to which a specimen carries the loads that the study's defaults name.
LARGEST_SHARE = 0.95
SOLVER = {"kernel": "love"}
#: Tolerance of a study that asks for everything.
FULL_RTOL = 1e-6


def resolve_settings(
    config: Mapping, name: str | None, own: Mapping, source: str, scan: ScanFiles | None = None
) -> Settings:
    """Settings of one specimen: the defaults, then the study's for it, then its sidecar's.

    Parameters
    ----------
    config : mapping
        A study that passed the schema.
    name : str or None
        The specimen; None for the defaults alone.
    own : mapping
        Settings of its sidecar.
    source : str
        For errors.
    scan : ScanFiles, optional
        Of a specimen that was scanned. With both faces ``opposite`` has no effect.

    Raises
    ------
    InputError
        If a quantity has the wrong unit, a material no definition, or a needed key is missing.
    """
    stated = _Stated(config, name, own, source, scan)
    opposite = "match" if scan and scan.upper else stated["opposite"]
    flat = not slides(opposite)
    directions = ["none"] if flat else stated["directions"]
    where = stated.where("material")
    material = _material(config, stated["material"], where, source, scanned=scan is not None)
    loads = stated.solved_loads(material.hardness)
    recipe = config.get("embedded", {}).get(name, {})
    settings = Settings(
        label=stated.get("label", recipe.get("label", name)),
        group=stated.get("group", scan.group if scan else ""),
        known_dimension=float(recipe.get("dimension", math.nan)),
        chosen_for=dict(recipe.get("chosen_for", {})),
        twins=stated.twins(),
        capped_variant=is_capped_variant(config, name),
        material=material,
        opposite=opposite,
        outliers=stated["outliers"],
        fill_holes=stated["fill_holes"],
        window=stated.lengths("window"),
        window_centre=stated.lengths("window_centre"),
        directions=directions,
        contact_directions=directions if flat else stated.get("contact_directions", directions),
        offsets=[0.0] if flat else stated.lengths("offsets"),
        loads=loads,
        resolutions=sorted(stated["resolutions"]),
        dilatancy_loads=stated.chosen_loads("dilatancy_loads", loads),
        map_load=stated.chosen_loads("map_load", loads)[-1],
        map_offset=None if flat else stated.reported_offset(),
        hyperbola_range=stated.loads("hyperbola_range"),
        seating_pressure=stated.positive("seating_pressure", "pressure"),
        surface_range=stated.range("surface_range"),
        box_range=stated.range("box_range"),
        scaling_range=stated.range("scaling_range"),
        measured=resolve_tests(
            stated.get("measured", {}),
            stated.where("measured"),
            scan.lower.parent if scan else Path(config.get("scans") or "."),
        ),
    )
    _refuse_contradictions(settings, stated.where)
    return settings


class _Stated(dict):
    """Settings of one specimen as they are written: defaults, the study's own, its sidecar's."""

    def __init__(self, config, name, own, source, scan):
        for key in ("materials", "defaults"):
            if key not in config:
                raise InputError(
                    f"{source}: missing key '{key}', which the specimen {name} needs (contact maps "
                    "say 'kind: contact-map' in their sidecar)"
                )
        self._study, self._own = config.get("specimens", {}).get(name, {}), own
        self._name, self._source, self._scan = name, source, scan
        super().__init__({**SPECIMEN, **config["defaults"], **self._study, **own})
        for key in ("material", "loads", "resolutions"):
            if key not in self:
                raise InputError(f"{source}: missing key 'defaults.{key}'")

    def where(self, key):
        """Place of a setting, for errors."""
        if key in self._own:
            said_in = self._scan.said_in if self._scan else f"sidecar of {self._name}"
            return f"{said_in}: {key}"
        place = f"specimens.{self._name}" if key in self._study else "defaults"
        return f"{self._source}: {place}.{key}"

    def lengths(self, key):
        """None for "auto", one length, or a list of lengths, mm."""
        return self._each(key, lambda text: quantity(text, "length", self.where(key)))

    def range(self, key):
        """None for "auto", or two lengths, mm."""
        return None if self.get(key, "auto") == "auto" else tuple(self.lengths(key))

    def positive(self, key, kind):
        """A quantity above 0, MPa or mm."""
        value = quantity(self[key], kind, self.where(key))
        if value <= 0:
            raise InputError(f"{self.where(key)}: {self[key]!r} must be positive")
        return value

    def loads(self, key):
        """None for "auto", or a list of loads."""
        return self._each(key, lambda text: load(text, self.where(key)))

    def _each(self, key, resolved):
        value = self.get(key, "auto")
        if value == "auto":
            return None
        return [*map(resolved, value)] if isinstance(value, list) else resolved(value)

    def twins(self):
        """Number of twins of a scan, the defaults' too; embedded specimens have realisations."""
        if self._scan is None and "twins" in self._study:
            raise InputError(
                f"{self.where('twins')}: {self._name} is no scan; write 'realisations: "
                f"{self['twins']}' in embedded.{self._name}"
            )
        return self["twins"] if self._scan else 0

    def solved_loads(self, hardness):
        """Loads that are solved; of the defaults only those that the hardness can carry."""
        loads = self.loads("loads")
        if "loads" in self._own or "loads" in self._study:
            return loads
        most = LARGEST_SHARE * hardness
        return [one for one in loads if one[1] == "force" or one[0] <= most] or loads

    def reported_offset(self):
        """Offset that is reported: of two faces as they were scanned, unless something is said."""
        offsets = self.lengths("offsets")
        as_scanned = self._scan and self._scan.upper and (offsets is None or 0.0 in offsets)
        return 0.0 if as_scanned and "map_offset" not in self else self.lengths("map_offset")

    def chosen_loads(self, key, loads):
        """Loads of a figure: the named ones, which must be solved, or the largest three.

        Of those that the study's defaults name, the ones that the hardness of a specimen can carry.
        """
        if key not in self:
            return loads[-3:]
        named = self[key] if isinstance(self[key], list) else [self[key]]
        chosen = [load(text, self.where(key)) for text in named]
        for pair, text in zip(chosen, named, strict=True):
            if pair not in self.loads("loads"):
                raise self._not_solved(key, text)
        return [pair for pair in chosen if pair in loads] or loads[-len(chosen) :]

    def _not_solved(self, key, text):
        """Error of a load that is drawn but not solved, in the later file of both."""
        if "loads" in self._own and key not in self._own:
            return InputError(
                f"{self.where('loads')}: {self['loads']} lacks {text!r}, which {self.where(key)} "
                f"names; add it, or write '{key}' here too"
            )
        return InputError(f"{self.where(key)}: {text!r} is not among the loads {self['loads']}")


def _refuse_contradictions(settings, where):
    """Refuse directions, offsets and loads that do not go with each other or with the problem."""
    for direction in settings.contact_directions:
        if direction not in settings.directions:
            raise InputError(
                f"{where('contact_directions')}: {direction} is not among the directions "
                f"{settings.directions} of {where('directions')}; add it there, as its "
                "rigid dilatancy is needed too"
            )
    for offset in settings.offsets or ():
        if offset < 0:
            raise InputError(f"{where('offsets')}: {offset} mm is negative; slide the other way")
    for value, kind in settings.loads:
        if value <= 0:
            raise InputError(f"{where('loads')}: a {kind} of {value}; loads must be positive")


def resolve_embedded(recipe: Mapping, where: str) -> dict:
    """Recipe of an embedded specimen with its lengths in mm, without labels.

    Raises
    ------
    InputError
        If a length has no unit of length or is not positive, the nodes are too few or too many, or
        the construction has no such surface.
    """
    numbers = {key: value for key, value in recipe.items() if key not in BESIDE_SURFACE}
    for key in ("size", "spacing", "rms", "roll_off"):
        if recipe.get(key) is not None:
            numbers[key] = quantity(recipe[key], "length", f"{where}.{key}")
            if numbers[key] <= 0:
                raise InputError(f"{where}.{key}: {recipe[key]!r} must be positive")
    nodes = numbers["size"] / numbers["spacing"]
    if not MIN_NODES_PER_SIDE <= round(nodes) <= MAX_NODES_PER_SIDE:
        raise InputError(
            f"{where}.size: {recipe['size']!r} at a spacing of {recipe['spacing']!r} are "
            f"{nodes:.4g} nodes per side; expected from {MIN_NODES_PER_SIDE} to "
            f"{MAX_NODES_PER_SIDE}, so change size or spacing"
        )
    numbers.setdefault("outline", "square")
    numbers.setdefault("roll_off", None)
    construction = numbers.setdefault("construction", "spectrum")
    if construction != "spectrum" and numbers["roll_off"] is not None:
        raise InputError(
            f"{where}.roll_off: a surface by {construction} has none; write null, or the "
            "construction spectrum"
        )
    if construction == "cantor-punch" and 3 ** round(math.log(nodes, 3)) != round(nodes):
        raise InputError(
            f"{where}.size: a cantor-punch has 3^n nodes per side, not {round(nodes)}; "
            f"write a size of {3 ** round(math.log(nodes, 3)) * numbers['spacing']:g} mm"
        )
    return numbers


def resolve_roll_off(config: Mapping, source: str) -> dict:
    """Recipe, window (mm) and seeds of synthetic joints with and without a roll-off.

    Raises
    ------
    InputError
        If the specimen named is not embedded or has no roll-off.
    """
    stated, where = config["roll_off"], f"{source}: roll_off"
    embedded = config.get("embedded", {})
    name = stated["embedded"]
    if name not in embedded:
        raise InputError(f"{where}.embedded: no embedded {name!r}{nearest(name, embedded)}")
    recipe = resolve_embedded(embedded[name], f"{source}: embedded.{name}")
    if recipe["roll_off"] is None:
        raise InputError(f"{where}.embedded: {name} has no roll_off; name one that has")
    window = quantity(stated["window"], "length", f"{where}.window")
    return {"recipe": recipe, "window": window, "seeds": stated["seeds"]}


def solver_settings(config: Mapping, source: str) -> Solver:
    """Settings of the contact solver; ``rtol`` follows from the accuracy where it is not stated.

    Parameters
    ----------
    config : mapping
        A study that passed the schema.
    source : str
        For errors.

    Raises
    ------
    InputError
        If an accuracy is no fraction.
    """
    stated = config.get("accuracy", {})
    if stated == "full":
        accuracy, rtol = None, FULL_RTOL
    else:
        wanted = ACCURACY | stated
        accuracy = {key: share(wanted[key], f"{source}: accuracy.{key}") for key in ACCURACY}
        rtol = tolerance(accuracy)
    return Solver(**{"rtol": rtol, **SOLVER, **config.get("solver", {})}, accuracy=accuracy)


def _material(config, material, where, source, *, scanned: bool) -> Material:
    """Material with E* of two like bodies and its optional properties.

    The contacts of a scanned rock crush at the joint wall strength, unless its hardness is stated.
    """
    if isinstance(material, Mapping):
        label, definition = "own", material
    else:
        if material not in config["materials"]:
            raise InputError(
                f"{where}: no material {material!r}{nearest(material, config['materials'])}"
            )
        label, definition = material, config["materials"][material]
        where = f"{source}: materials.{material}"
    modulus = quantity(definition["modulus"], "pressure", f"{where}.modulus")
    if modulus <= 0:
        raise InputError(f"{where}.modulus: {definition['modulus']!r} must be positive")
    poisson = float(definition["poisson"])
    strength = _if_stated(definition, "joint_wall_strength", "pressure", where)
    if definition.get("hardness") == "none":
        hardness = math.inf
    else:
        unsaid = strength if scanned and math.isfinite(strength) else math.inf
        hardness = _if_stated(definition, "hardness", "pressure", where, unsaid)
    return Material(
        name=label,
        modulus=modulus,
        poisson=poisson,
        e_star=modulus / (2 * (1 - poisson**2)),
        basic_friction_angle=_if_stated(definition, "basic_friction_angle", "angle", where),
        joint_wall_strength=strength,
        hardness=hardness,
    )


def _if_stated(definition, key, kind, where, otherwise=math.nan):
    """Optional quantity; NaN or another default if it is not stated."""
    if key not in definition:
        return otherwise
    value = quantity(definition[key], kind, f"{where}.{key}")
    if not 0 < value < (90 if kind == "angle" else math.inf):
        raise InputError(f"{where}.{key}: {definition[key]!r} must be positive, an angle below 90")
    return value
