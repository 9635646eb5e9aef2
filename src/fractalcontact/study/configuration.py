"""A study as its configuration file states it, checked and turned into mm, N and MPa."""

import difflib
import math
import re
from collections.abc import Mapping
from pathlib import Path

import jsonschema
import yaml

from ..core.errors import InputError
from ..core.file_names import specimen_name
from ..core.tolerance import tolerance
from ..core.units import load, quantity, share
from .sidecar import read_yaml, unreadable

#: Keys of a sidecar that say how to read the scan; its other keys are settings of the specimen.
_SCAN_DEFINITION, _SETTINGS_DEFINITION = "scan", "settings"

#: Nodes per side of an embedded specimen: a surface of that many takes some 35 GB to make.
FEWEST_NODES, MOST_NODES = 2, 16384

_TEMPLATE = "__use_yte__"
_MOST_VALUES = 100_000
_LONGEST_QUOTE = 80  # characters of what the user wrote, in a message
#: What a study that does not mention it gets; everything else must be stated.
SOLVER = {"kernel": "love"}
ACCURACY = {"closure": "1 %", "delta_sigma": 0.02}
#: Tolerance of a study that asks for everything.
FULL_RTOL = 1e-6
#: Experiments on synthetic surfaces: stages that a study has once, where it has their key.
EXPERIMENTS = ("roll_off", "area_slope", "dimension_test", "estimator_bias")


def read_study(path):
    """A study's own file, or its schema: all of YAML, since its user wrote it.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    dict

    Raises
    ------
    InputError
        If it cannot be read, is no mapping, or is more than plain data: Snakemake would run Python
        that stands in a study which asks for it, and studies come from colleagues and supplements.
    """
    try:
        document = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except yaml.YAMLError as error:
        raise unreadable(path, error) from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not text in UTF-8 ({error.reason}); save it as that") from error
    except ValueError as error:  # a day that no month has, an integer of thousands of digits
        raise InputError(f"{path}: a date or number that is none ({error})") from error
    if not isinstance(document, dict):
        raise InputError(f"{path}: expected 'key: value' lines, found {type(document).__name__}")
    if _TEMPLATE in document:
        raise InputError(
            f"{path}: the key '{_TEMPLATE}' makes Snakemake run what the file says as Python; a "
            "study is plain data, so remove it and write the values themselves"
        )
    if _expanded(document) > _MOST_VALUES:
        raise InputError(
            f"{path}: more than {_MOST_VALUES} values once its aliases (*) are written out; a "
            "study is no longer than a few pages"
        )
    return document


def study_name(document, source):
    """Name of a study, which its results stand under.

    Parameters
    ----------
    document : mapping
        From :func:`read_study`.
    source : str
        For errors.

    Raises
    ------
    InputError
        If there is none, or one that could lead anywhere else.
    """
    name = document.get("study")
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,99}", name):
        raise InputError(
            f"{source}: key 'study': found {_shortened(repr(name))}, expected the study's name: up "
            "to 100 letters, digits, _ and -"
        )
    return name


def _expanded(value, known=None):
    """How many values a document has once every alias is written out."""
    known = {} if known is None else known
    if not isinstance(value, (dict, list)):
        return 1
    if id(value) not in known:
        known[id(value)] = 1  # an alias of itself adds nothing more
        parts = value.values() if isinstance(value, dict) else value
        known[id(value)] = 1 + sum(_expanded(part, known) for part in parts)
    return known[id(value)]


def check_study(config, schema, source):
    """Check a study against its schema.

    Parameters
    ----------
    config : mapping
        The study as read from YAML.
    schema : mapping
        config/schema/study.schema.yaml.
    source : str
        The file it came from, for errors.

    Raises
    ------
    InputError
        For the first thing found wrong: the file, the key, what was expected.
    """
    _validate(config, schema, source)
    check_names({}, config, None, source)
    for name in config.get("specimens", {}):
        resolve_settings(config, name, {}, source)
    if "defaults" in config:
        resolve_settings(config, None, {}, source)
    for name, recipe in config.get("embedded", {}).items():
        resolve_embedded(recipe, f"{source}: embedded.{name}")
    resolve_roll_off(config, source)


def check_names(scans, config, folder, source):
    """Refuse embedded specimens whose results would be taken for others.

    Parameters
    ----------
    scans : collection of str
        Names of the specimens that are scanned.
    config : mapping
        A study that passed the schema.
    folder : path-like
        Where the scans are, for errors.
    source : str
        The file the study came from, for errors.

    Raises
    ------
    InputError
        If one has the name of a scan or of another, upper and lower case being alike: on many
        discs they would be one file. Or a name that no scan could have either.
    """
    known = {name.lower(): (name, f"a scan in {folder}") for name in scans}
    for name in config.get("embedded", {}):
        where = f"{source}: embedded.{_shortened(name)}"
        safe = specimen_name(name)
        if safe != name:
            raise InputError(f"{where}: no name for files on every computer; write {safe!r}")
        other, what = known.setdefault(name.lower(), (name, None))
        if other == name and what is not None:
            raise InputError(f"{where}: has the name of {what}; rename one")
        if other != name:
            raise InputError(
                f"{where}: differs from {what or 'the embedded specimen'} {other} in upper and "
                "lower case alone; rename one"
            )


def read_sidecar(path, schema):
    """Scan keys and settings of a sidecar, checked.

    Returns
    -------
    scan : dict
        How to read the file, for :func:`scan.read.read_faces`.
    settings : dict
        What differs from the study's defaults.

    Raises
    ------
    InputError
    """
    if path is None:
        return {}, {}
    document = read_yaml(path)
    definitions = schema["$defs"]
    scan_keys = definitions[_SCAN_DEFINITION]["properties"]
    properties = {**scan_keys, **definitions[_SETTINGS_DEFINITION]["properties"]}
    sidecar_schema = {
        "$defs": definitions,
        "type": "object",
        "additionalProperties": False,
        "properties": properties,
    }
    _validate(document, sidecar_schema, str(path))
    scan = {key: value for key, value in document.items() if key in scan_keys}
    settings = {key: value for key, value in document.items() if key not in scan_keys}
    return scan, settings


def resolve_settings(config, name, sidecar, source):
    """Settings of one specimen: the defaults, then the study's own for it, then its sidecar's.

    Parameters
    ----------
    config : mapping
        A study that passed the schema.
    name : str or None
        The specimen; None for the defaults alone.
    sidecar : mapping
        Settings of its sidecar.
    source : str
        For errors.

    Returns
    -------
    dict
        Plain numbers in mm, N and MPa; ``None`` stands for "auto". Loads are pairs (value, kind).

    Raises
    ------
    InputError
        If a quantity has the wrong unit, a material no definition, or a needed key is missing.
    """
    of_study = config.get("specimens", {}).get(name, {})
    merged = {**config["defaults"], **of_study, **sidecar}

    def where(key):
        if key in sidecar:
            return f"sidecar of {name}: {key}"
        return f"{source}: " + (f"specimens.{name}.{key}" if key in of_study else f"defaults.{key}")

    for key in ("material", "loads", "resolutions"):
        if key not in merged:
            raise InputError(f"{source}: missing key 'defaults.{key}'")
    loads = [load(text, where("loads")) for text in merged["loads"]]
    flat = merged.get("opposite", "match") == "flat"
    directions = merged.get("directions", ["E", "N", "W", "S"])
    settings = {
        "label": merged.get("label", config.get("embedded", {}).get(name, {}).get("label", name)),
        "material": _material(config, merged["material"], where("material"), source),
        "opposite": merged.get("opposite", "match"),
        "outliers": merged.get("outliers", "keep"),
        "fill_holes": merged.get("fill_holes", 0),
        "window": _optional(merged.get("window", "auto"), where("window")),
        "window_centre": None,
        "directions": ["none"] if flat else directions,
        "contact_directions": ["none"] if flat else merged.get("contact_directions", directions),
        "offsets": [0.0] if flat else _optional(merged.get("offsets", "auto"), where("offsets")),
        "loads": loads,
        "resolutions": sorted(merged["resolutions"]),
        "dilatancy_loads": _chosen_loads(merged, "dilatancy_loads", loads, where),
        "map_load": _chosen_loads(merged, "map_load", loads, where)[-1],
        "map_offset": None,
        "hyperbola_range": None,
    }
    for key in ("surface_range", "box_range", "scaling_range"):
        settings[key] = _optional(merged.get(key, "auto"), where(key))
    if merged.get("hyperbola_range", "auto") != "auto":
        settings["hyperbola_range"] = [
            load(text, where("hyperbola_range")) for text in merged["hyperbola_range"]
        ]
    if "window_centre" in merged:
        settings["window_centre"] = _lengths(merged["window_centre"], where("window_centre"))
    if "map_offset" in merged and not flat:
        settings["map_offset"] = quantity(merged["map_offset"], "length", where("map_offset"))
    for direction in settings["contact_directions"]:
        if direction not in settings["directions"]:
            raise InputError(
                f"{where('contact_directions')}: {direction} is not among the directions "
                f"{settings['directions']}; add it there, the rigid dilatancy is needed too"
            )
    for offset in settings["offsets"] or ():
        if offset < 0:
            raise InputError(f"{where('offsets')}: {offset} mm is negative; slide the other way")
    for value, kind in loads:
        if value <= 0:
            raise InputError(f"{where('loads')}: a {kind} of {value}; loads must be positive")
    return settings


def window_arguments(settings):
    """How :func:`surface.specimen.make_specimen` is to clean faces and place the window.

    The window is cut to whole cells of the coarsest pre-fractal, so that all resolutions cover the
    same area, and placed where the offsets of the study can slide it.
    """
    centre = settings["window_centre"]
    reach = max(settings["offsets"] or [0.0])
    flat = settings["opposite"] == "flat"
    return {
        "opposite": settings["opposite"],
        "outliers": settings["outliers"],
        "fill_holes": settings["fill_holes"],
        "window": settings["window"],
        "window_centre": None if centre is None else (centre[1], centre[0]),
        "multiple": math.lcm(*settings["resolutions"]),
        "reach": 0.0 if flat else dict.fromkeys(settings["directions"], reach),
    }


def resolve_embedded(recipe, where):
    """Numbers of an embedded specimen: lengths in mm.

    Raises
    ------
    InputError
        If a length has no unit of length or is not positive, or the nodes are too few or too many.
    """
    numbers = dict(recipe)
    for key in ("size", "spacing", "rms", "roll_off"):
        if recipe.get(key) is not None:
            numbers[key] = quantity(recipe[key], "length", f"{where}.{key}")
            if numbers[key] <= 0:
                raise InputError(f"{where}.{key}: {recipe[key]!r} must be positive")
    nodes = numbers["size"] / numbers["spacing"]
    if not FEWEST_NODES <= round(nodes) <= MOST_NODES:
        raise InputError(
            f"{where}.size: {recipe['size']!r} at a spacing of {recipe['spacing']!r} are "
            f"{nodes:.4g} nodes per side; expected from {FEWEST_NODES} to {MOST_NODES}, so change "
            "size or spacing"
        )
    numbers.setdefault("outline", "square")
    numbers.setdefault("roll_off", None)
    return numbers


def resolve_roll_off(config, source):
    """Recipe, window (mm) and seeds of the joints made with and without a roll-off; or None.

    Raises
    ------
    InputError
        If the specimen named is not embedded or has no roll-off.
    """
    if "roll_off" not in config:
        return None
    asked, where = config["roll_off"], f"{source}: roll_off"
    embedded = config.get("embedded", {})
    name = asked["embedded"]
    if name not in embedded:
        raise InputError(f"{where}.embedded: no embedded {name!r}{_near(name, embedded)}")
    recipe = resolve_embedded(embedded[name], f"{source}: embedded.{name}")
    if recipe["roll_off"] is None:
        raise InputError(f"{where}.embedded: {name} has no roll_off; name one that has")
    window = quantity(asked["window"], "length", f"{where}.window")
    return {"recipe": recipe, "window": window, "seeds": asked["seeds"]}


def solver_settings(config, source):
    """How the contact solver is used.

    Parameters
    ----------
    config : mapping
        A study that passed the schema.
    source : str
        For errors.

    Returns
    -------
    dict
        ``kernel``; ``accuracy``, a dict of shares, or None where the study asks for everything; and
        ``rtol``, which follows from it unless the study states its own.

    Raises
    ------
    InputError
        If an accuracy is no share.
    """
    stated = config.get("accuracy", {})
    if stated == "full":
        accuracy, rtol = None, FULL_RTOL
    else:
        asked = ACCURACY | stated
        accuracy = {key: share(asked[key], f"{source}: accuracy.{key}") for key in ACCURACY}
        rtol = tolerance(accuracy)
    return {"rtol": rtol, **SOLVER, **config.get("solver", {}), "accuracy": accuracy}


def _material(config, material, where, source):
    """Name, E (MPa), Poisson's ratio, E* of two like bodies (MPa), and what may be stated."""
    if isinstance(material, Mapping):
        label, definition = "own", material
    else:
        if material not in config["materials"]:
            raise InputError(
                f"{where}: no material {material!r}{_near(material, config['materials'])}"
            )
        label, definition = material, config["materials"][material]
        where = f"{source}: materials.{material}"
    modulus = quantity(definition["modulus"], "pressure", f"{where}.modulus")
    if modulus <= 0:
        raise InputError(f"{where}.modulus: {definition['modulus']!r} must be positive")
    poisson = float(definition["poisson"])
    return {
        "name": label,
        "modulus": modulus,
        "poisson": poisson,
        "e_star": modulus / (2 * (1 - poisson**2)),
        "basic_friction_angle": _if_stated(definition, "basic_friction_angle", "angle", where),
        "joint_wall_strength": _if_stated(definition, "joint_wall_strength", "pressure", where),
        "hardness": _if_stated(definition, "hardness", "pressure", where, math.inf),
    }


def _if_stated(definition, key, kind, where, otherwise=math.nan):
    """A quantity that not every study needs; NaN, or something else, where it is not stated."""
    if key not in definition:
        return otherwise
    value = quantity(definition[key], kind, f"{where}.{key}")
    if not 0 < value < (90 if kind == "angle" else math.inf):
        raise InputError(f"{where}.{key}: {definition[key]!r} must be positive, an angle below 90")
    return value


def _chosen_loads(merged, key, loads, where):
    """Loads picked for a figure: those named, which must be solved, or the largest three."""
    if key not in merged:
        return loads[-3:]
    named = merged[key] if isinstance(merged[key], list) else [merged[key]]
    chosen = [load(text, where(key)) for text in named]
    for pair, text in zip(chosen, named, strict=True):
        if pair not in loads:
            raise InputError(f"{where(key)}: {text!r} is not among the loads {merged['loads']}")
    return chosen


def _optional(value, where):
    """None for "auto", one length, or a list of lengths."""
    if value == "auto":
        return None
    return _lengths(value, where) if isinstance(value, list) else quantity(value, "length", where)


def _lengths(values, where):
    return [quantity(text, "length", where) for text in values]


def _is_integer(_checker, value):
    """Whether a value is an integer; for JSON 512.0 is one, for numpy it is no number of nodes."""
    return isinstance(value, int) and not isinstance(value, bool)


_Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine("integer", _is_integer),
)


def _validate(document, schema, source):
    errors = list(_Validator(schema).iter_errors(document))
    if not errors:
        return
    first = min(errors, key=lambda error: [str(part) for part in error.absolute_path])
    others = f" ({len(errors) - 1} more to see after this one)" if len(errors) > 1 else ""
    raise InputError(f"{source}: {_explain(first)}{others}")


def _explain(error):
    """One sentence for one schema error: the key, what was expected, the nearest known key."""
    key = ".".join(str(part) for part in error.absolute_path)
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        unknown = sorted(set(error.instance) - set(known), key=str)[0]
        full = f"{key}.{unknown}" if key else unknown
        return f"unknown key '{_shortened(full)}'{_near(unknown, known)}"
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in error.instance)
        full = f"{key}.{missing}" if key else missing
        expected = error.schema["properties"].get(missing, {})
        return f"missing key '{full}'{_expected(expected)}"
    return f"{key}: {_shortened(repr(error.instance))} is not right{_expected(error.schema)}"


def _shortened(text):
    """A text of any length and content as one that fits into a message."""
    text = str(text) if str(text).isprintable() else ascii(text)
    return text if len(text) <= _LONGEST_QUOTE else f"{text[:_LONGEST_QUOTE]}..."


def _expected(schema):
    if schema.get("$ref", "").endswith("quantity"):
        return "; expected a number with its unit, such as 20 mm, 10 kN or 25 GPa"
    return f"; expected {schema['description']}" if "description" in schema else ""


def _near(word, known):
    """The nearest known word, for a hint."""
    near = difflib.get_close_matches(str(word), [str(k) for k in known], n=1)
    return f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(map(str, known))}"
