"""Settings of a study as its configuration states them, turned into mm, N and MPa."""

import math
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

from ..core.directions import APERTURE, slides
from ..core.errors import InputError
from ..core.keys import MAX_NODES_PER_SIDE, nearest, validate
from ..core.settings import FREE, MIRRORED, Material, Settings, Solver
from ..core.tolerance import tolerance
from .keys import (
    AccuracyKeys,
    EmbeddedKeys,
    MaterialKeys,
    RollOffKeys,
    SettingsKeys,
    SolverKeys,
    stated,
    unsaid_settings,
)
from .laboratory_tests import resolve_tests
from .scan_files import ScanFiles
from .selection import BESIDE_SURFACE, is_capped_variant

#: Least nodes per side of an embedded specimen.
MIN_NODES_PER_SIDE = 2
#: Largest pressure among the loads of the defaults that a specimen carries, over its hardness.
LARGEST_SHARE = 0.95
#: Relative tolerance of a study of full accuracy.
FULL_RTOL = 1e-6
#: Kernel of the contact solver that knows every boundary.
LOVE = "love"


def resolve_settings(
    config: Mapping, name: str | None, own: Mapping, source: str, scan: ScanFiles | None = None
) -> Settings:
    """Settings of one specimen: the defaults, then the study's for it, then its sidecar's.

    Parameters
    ----------
    config : mapping
        A study that passed :func:`study.checks.check_study`.
    name : str or None
        The specimen; None for the defaults alone.
    own : mapping
        Settings of its sidecar.
    source : str
        The file of the study, for errors.
    scan : ScanFiles, optional
        Of a specimen that was scanned. With both faces ``opposite`` has no effect.

    Raises
    ------
    InputError
        If a quantity has the wrong unit, a material no definition, or a needed key is missing.
    """
    layers = _Layers(config, name, own, source, scan)
    said = layers.values
    opposite = "match" if scan and scan.upper else said["opposite"]
    flat = not slides(opposite)
    directions = ["none"] if flat else said["directions"]
    material = _material(config, said["material"], layers.where("material"), scan is not None)
    loads = layers.solved_loads(material.hardness)
    recipe = config.get("embedded", {}).get(name, {})
    folder = scan.lower.parent if scan else Path(config.get("scans") or ".")
    follows = {
        "label": said.get("label", recipe.get("label", name)),
        "group": said.get("group", scan.group if scan else ""),
        "known_dimension": float(recipe.get("dimension", math.nan)),
        "chosen_for": dict(recipe.get("chosen_for", {})),
        "twins": layers.twins(),
        "block_lengths": sorted(said.get("block_lengths", [])),
        "capped_variant": is_capped_variant(config, name),
        # Its contact has a known dimension by construction: a control, and no joint.
        "known_contact": recipe.get("construction") == "cantor-punch",
        "material": material,
        "boundary": said.get("boundary", layers.boundary()),
        "opposite": opposite,
        "outliers": layers.outliers(),
        "directions": directions,
        "contact_directions": directions if flat else said.get("contact_directions", directions),
        "offsets": [0.0] if flat else layers.offsets(),
        "loads": loads,
        "resolutions": sorted(said["resolutions"]),
        "dilatancy_loads": layers.chosen_loads("dilatancy_loads", loads),
        "map_load": layers.chosen_loads("map_load", loads)[-1],
        "map_offset": None if flat else layers.reported_offset(),
        "measured": resolve_tests(said.get("measured"), layers.where("measured"), folder),
    }
    plain = {field.name: said.get(field.name) for field in fields(Settings)}
    settings = Settings(**plain | follows)
    _refuse_contradictions(settings, layers.where)
    kernel = config.get("solver", {}).get("kernel", LOVE)
    if settings.boundary != FREE and kernel != LOVE:
        raise InputError(
            f"{layers.where('boundary')}: the kernel {kernel!r} of `solver` is that of a free "
            "window; write 'boundary: free', or 'kernel: love'"
        )
    return settings


class _Layers:
    """Settings of one specimen by layer: defaults, the study's own, its sidecar's.

    ``values`` and ``texts`` hold by key the value of the last layer that states it, in mm, N and
    MPa and as its user wrote it.
    """

    def __init__(self, config, name, own, source, scan):
        for key in ("materials", "defaults"):
            if key not in config:
                raise InputError(
                    f"{source}: missing key '{key}', which the specimen {name} needs (contact maps "
                    "say 'kind: contact-map' in their sidecar)"
                )
        self._study, self._own = config.get("specimens", {}).get(name, {}), own
        self._solver = config.get("solver", {})
        self._name, self._source, self._scan = name, source, scan
        layers = (
            (unsaid_settings(), source, ""),
            (config["defaults"], source, "defaults"),
            (self._study, source, f"specimens.{name}"),
            (own, self._said_in(), ""),
        )
        self._outliers_unsaid = not any("outliers" in texts for texts, *_ in layers[1:])
        self.texts, self.values = {}, {}
        for texts, said_in, above in layers:
            self.texts |= texts
            # The program alone states this value, of aperture maps; no study or sidecar can.
            is_map = texts.get("opposite") == APERTURE
            said = {key: text for key, text in texts.items() if not (is_map and key == "opposite")}
            self.values |= stated(validate(SettingsKeys, said, said_in, above))
            if is_map:
                self.values["opposite"] = APERTURE
        for key in ("material", "loads", "resolutions"):
            if key not in self.values:
                raise InputError(f"{source}: missing key 'defaults.{key}'")

    def _said_in(self):
        return str(self._scan.said_in) if self._scan else f"sidecar of {self._name}"

    def where(self, key):
        """File and key of a setting, for errors."""
        if key in self._own:
            return f"{self._said_in()}: {key}"
        place = f"specimens.{self._name}" if key in self._study else "defaults"
        return f"{self._source}: {place}.{key}"

    def boundary(self):
        """Boundary where none is stated: no half-space stands beside the face of a real joint.

        The paper's rigid-plate kernels are those of a free window alone.
        """
        kernel = self._solver.get("kernel", LOVE)
        return MIRRORED if self._scan and kernel == LOVE else FREE

    def twins(self):
        """Number of twins of a scan; embedded specimens have realisations."""
        if self._scan is None and "twins" in self._study:
            raise InputError(
                f"{self.where('twins')}: {self._name} is no scan; write 'realisations: "
                f"{self.values['twins']}' in embedded.{self._name}"
            )
        return self.values.get("twins", 0) if self._scan else 0

    def outliers(self):
        """Treatment of outliers; a scanned face against its own match fills them unless told.

        Each spike would meet the copy of itself in the other face and hold the two apart.
        """
        own_match = self._scan and not self._scan.upper and slides(self.values["opposite"])
        return "fill" if self._outliers_unsaid and own_match else self.values["outliers"]

    def solved_loads(self, hardness):
        """Loads to be solved: of those in the defaults only what the hardness can carry."""
        loads = self.values["loads"]
        if "loads" in self._own or "loads" in self._study:
            return loads
        most = LARGEST_SHARE * hardness
        return [load for load in loads if load[1] == "force" or load[0] <= most] or loads

    def _is_pair(self):
        return bool(self._scan and self._scan.upper)

    def offsets(self):
        """Offsets that are solved, mm; two faces are solved as they were scanned, too."""
        offsets = self.values.get("offsets")
        if offsets is None or not self._is_pair() or "map_offset" in self.values:
            return offsets
        return sorted({0.0, *offsets})

    def reported_offset(self):
        """Offset that is reported; by default two faces are reported as they were scanned."""
        return self.values.get("map_offset", 0.0 if self._is_pair() else None)

    def chosen_loads(self, key, loads):
        """Loads that a key names among the solved ones; the three largest without it.

        Loads that the defaults name and the hardness of the specimen cannot carry are left out.
        """
        if key not in self.values:
            return loads[-3:]
        chosen, texts = self.values[key], self.texts[key]
        if not isinstance(chosen, list):
            chosen, texts = [chosen], [texts]
        for pair, text in zip(chosen, texts, strict=True):
            if pair not in self.values["loads"]:
                raise self._not_solved(key, text)
        return [pair for pair in chosen if pair in loads] or loads[-len(chosen) :]

    def _not_solved(self, key, text):
        """Error of a load that is drawn but not solved; names the file of the later layer."""
        if "loads" in self._own and key not in self._own:
            return InputError(
                f"{self.where('loads')}: {self.texts['loads']} lacks {text!r}, which "
                f"{self.where(key)} names; add it, or write '{key}' here too"
            )
        return InputError(
            f"{self.where(key)}: {text!r} is not among the loads {self.texts['loads']}"
        )


def _refuse_contradictions(settings, where):
    """Refuse contact in directions whose rigid dilatancy is not computed."""
    for direction in settings.contact_directions:
        if direction not in settings.directions:
            raise InputError(
                f"{where('contact_directions')}: {direction} is not among the directions "
                f"{settings.directions} of {where('directions')}; add it there, as its "
                "rigid dilatancy is needed too"
            )


def resolve_embedded(recipe: Mapping, where: str) -> dict:
    """Recipe of an embedded specimen with its lengths in mm, without labels.

    Raises
    ------
    InputError
        If a length is wrong, the nodes are too few or too many, or the construction has no such
        surface.
    """
    source, _, above = where.rpartition(": ")
    parsed = validate(EmbeddedKeys, recipe, source, above)
    numbers = {key: value for key, value in parsed if key not in BESIDE_SURFACE}
    nodes = numbers["size"] / numbers["spacing"]
    if not MIN_NODES_PER_SIDE <= round(nodes) <= MAX_NODES_PER_SIDE:
        raise InputError(
            f"{where}.size: {recipe['size']!r} at a spacing of {recipe['spacing']!r} are "
            f"{nodes:.4g} nodes per side; expected from {MIN_NODES_PER_SIDE} to "
            f"{MAX_NODES_PER_SIDE}, so change size or spacing"
        )
    construction = numbers["construction"]
    if construction != "spectrum" and numbers["roll_off"] is not None:
        raise InputError(
            f"{where}.roll_off: a surface by {construction} has none; write null, or the "
            "construction spectrum"
        )
    for key, plain in (("anisotropy", 1), ("intermittency", 0)):
        if construction != "spectrum" and numbers[key] != plain:
            raise InputError(
                f"{where}.{key}: a surface by {construction} has none; leave it out, or write the "
                "construction spectrum"
            )
    if construction == "cantor-punch" and 3 ** round(math.log(nodes, 3)) != round(nodes):
        raise InputError(
            f"{where}.size: a cantor-punch has 3^n nodes per side, not {round(nodes)}; "
            f"write a size of {3 ** round(math.log(nodes, 3)) * numbers['spacing']:g} mm"
        )
    return numbers


def resolve_roll_off(config: Mapping, source: str) -> dict:
    """Recipe, window (mm) and seeds of synthetic joints with and without a roll-off."""
    stated, where = config["roll_off"], f"{source}: roll_off"
    embedded = config.get("embedded", {})
    name = stated["embedded"]
    if name not in embedded:
        raise InputError(f"{where}.embedded: no embedded {name!r}{nearest(name, embedded)}")
    recipe = resolve_embedded(embedded[name], f"{source}: embedded.{name}")
    if recipe["roll_off"] is None:
        raise InputError(f"{where}.embedded: {name} has no roll_off; name one that has")
    parsed = validate(RollOffKeys, stated, source, "roll_off")
    return {"recipe": recipe, "window": parsed.window, "seeds": parsed.seeds}


def solver_settings(config: Mapping, source: str) -> Solver:
    """Settings of the contact solver; ``rtol`` follows from the accuracy where it is not stated."""
    stated = config.get("accuracy", {})
    solver = dict(validate(SolverKeys, config.get("solver", {}), source, "solver"))
    if stated == "full":
        accuracy, rtol = None, FULL_RTOL
    else:
        accuracy = dict(validate(AccuracyKeys, stated, source, "accuracy"))
        rtol = tolerance(accuracy)
    if math.isnan(solver["rtol"]):
        solver["rtol"] = rtol
    return Solver(**solver, accuracy=accuracy)


def _material(config, material, where, scanned: bool) -> Material:
    """Material with E* = E / (2 (1 - nu^2)) of two like bodies and its optional properties.

    The contacts of a scanned rock crush at the joint wall strength, unless its hardness is stated.
    """
    name = "own"
    if isinstance(material, str):
        if material not in config["materials"]:
            raise InputError(
                f"{where}: no material {material!r}{nearest(material, config['materials'])}"
            )
        name, definition = material, config["materials"][material]
        material = validate(MaterialKeys, definition, where.partition(": ")[0], f"materials.{name}")
    modulus, poisson, strength = material.modulus, material.poisson, material.joint_wall_strength
    hardness = math.inf if material.hardness == "none" else material.hardness
    if math.isnan(hardness):
        hardness = strength if scanned and math.isfinite(strength) else math.inf
    return Material(
        name=name,
        modulus=modulus,
        poisson=poisson,
        e_star=modulus / (2 * (1 - poisson**2)),
        basic_friction_angle=material.basic_friction_angle,
        basic_friction_angle_is=material.basic_friction_angle_is,
        joint_wall_strength=strength,
        hardness=hardness,
    )
