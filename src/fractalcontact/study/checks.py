"""Checks of a study before anything runs: its configuration, sidecars, names and scan files."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

from ..core.claims import claims_of
from ..core.directions import APERTURE
from ..core.errors import InputError
from ..core.file_names import specimen_name
from ..core.keys import nearest, shortened, validate
from ..core.settings import Settings, Solver
from ..scan.keys import OLD_KINDS, ScanKeys
from ..scan.options import coordinate_files
from .configuration import resolve_embedded, resolve_roll_off, resolve_settings, solver_settings
from .figure_list import figures_of
from .idle_keys import refuse_idle_keys
from .keys import SidecarKeys, StudyKeys
from .laboratory_tests import require_files, test_files
from .scan_files import ScanFiles, refuse_outside_link
from .scan_groups import list_grouped
from .sidecar import is_contact_map, read_yaml


@dataclass(frozen=True)
class Study:
    """A study that passed all checks, by names of its specimens.

    Attributes
    ----------
    scans : dict of str to ScanFiles
        Specimens and measured contact maps.
    settings : dict of str to Settings
        Specimens, scanned or embedded.
    options : dict of str to dict
        Scan keys of the sidecars of all scans.
    labels : dict of str to str
        Measured contact maps, which have no settings.
    refused : dict of str to InputError
        Error of each scan that was left out, by specimen or file name.
    """

    scans: dict[str, ScanFiles]
    settings: dict[str, Settings]
    options: dict[str, dict]
    labels: dict[str, str]
    solver: Solver
    refused: dict[str, InputError] = field(default_factory=dict)


def resolve_study(config: Mapping, source: str, *, leave_out: bool = False) -> Study:
    """Check a study with its scan files and sidecars, and resolve all settings.

    With ``leave_out``, faulty scans are left out; else the first fault raises InputError.
    """
    check_study(config, source)
    scans, stated, refused = read_scans(config)
    folder = config.get("scans", "scans")
    check_names(scans, config, folder, source)
    names = {*scans, *refused, *config.get("embedded", {})}
    for key in ("specimens", "explorer"):
        if unknown := sorted(set(config.get(key, {})) - names):
            raise InputError(
                f"{source}: {key}.{unknown[0]}: neither embedded nor a scan in {folder}"
            )
    settings, options, labels = {}, {}, {}
    for name in sorted(stated.keys() - refused.keys()):
        with _refusing(refused, name):
            keys, own = stated[name]
            if is_contact_map(keys):
                labels[name] = own.get("label", name)
            else:
                settings[name] = resolve_settings(config, name, own, source, scans[name])
                require_files(settings[name].measured)
            options[name] = keys
    if refused and not leave_out:
        raise refused[min(refused)]
    scans = {name: scan for name, scan in scans.items() if name in options}
    for name in config.get("embedded", {}):
        settings[name] = resolve_settings(config, name, {}, source)
        require_files(settings[name].measured)
    return Study(scans, settings, options, labels, solver_settings(config, source), refused)


def read_scans(
    config: Mapping,
) -> tuple[dict[str, ScanFiles], dict[str, tuple[dict, dict]], dict[str, InputError]]:
    """Scan files of a checked study, their scan keys and settings, and errors of faulty ones.

    Keys of a group are overridden by those of the sidecar, and these by those of the table. Errors
    are by specimen or file name.
    """
    folder = config.get("scans", "scans")
    scans, refused = list_grouped(folder, config.get("groups")) if folder else ({}, {})
    stated: dict[str, tuple[dict, dict]] = {}
    shared: dict[Path | None, tuple[dict, dict]] = {None: ({}, {})}
    for name, scan in scans.items():
        with _refusing(refused, name):
            if scan.shared not in shared:
                shared[scan.shared] = read_sidecar(scan.shared)
            said = _stated_of(scan, shared[scan.shared])
            scans[name] = replace(scan, coordinates=_coordinates(scan, said[0]))
            stated[name] = said
    named = {path for scan in scans.values() for path in scan.coordinates}
    named |= _test_files(scans, {name: own for name, (_, own) in stated.items()}, config)
    scans = {name: scan for name, scan in scans.items() if scan.lower not in named}
    return scans, {name: stated[name] for name in stated if name in scans}, refused


def _stated_of(scan: ScanFiles, of_group: tuple[dict, dict]) -> tuple[dict, dict]:
    """Scan keys and settings of one specimen; keys of its group need not apply to every member."""
    of_file = read_sidecar(scan.sidecar)
    of_row = _split(dict(scan.row), scan.row_of) if scan.row else ({}, {})
    own = ({**of_file[0], **of_row[0]}, {**of_file[1], **of_row[1]})
    refuse_idle_keys(scan, *own)
    keys, settings = {**of_group[0], **own[0]}, {**of_group[1], **own[1]}
    # The contact of an aperture map is that of its negative with a plane.
    return keys, settings | ({"opposite": APERTURE} if keys.get("kind") == APERTURE else {})


@contextmanager
def _refusing(refused: dict[str, InputError], name: str) -> Iterator[None]:
    """Collect the error of one scan and continue with the others."""
    try:
        yield
    except InputError as error:
        refused.setdefault(name, error)


def _coordinates(scan: ScanFiles, keys: Mapping) -> tuple[Path, ...]:
    """Files of x and y that the sidecar of a map names, which are no scans themselves."""
    files = coordinate_files(scan.lower, keys) if is_contact_map(keys) else {}
    for key, path in files.items():
        if not path.is_file():
            raise InputError(f"{scan.said_in}: {key}: no file {path.name} beside it")
        refuse_outside_link(path, path.parent)
    return tuple(files.values())


def _test_files(
    scans: Mapping[str, ScanFiles], own: Mapping[str, Mapping], config: Mapping
) -> set[Path]:
    """Files of laboratory tests named by sidecars or the study, which are no scans either."""
    files: set[Path] = set()
    for name, stated in ({name: {} for name in config.get("embedded", {})} | dict(own)).items():
        folder = scans[name].lower.parent if name in scans else Path(config.get("scans") or ".")
        for said in (stated, config.get("specimens", {}).get(name, {})):
            files |= {*test_files(said.get("measured", {}), folder)}
    return files


def check_study(config: Mapping, source: str) -> None:
    """Check the keys of a study, as read from YAML, and their combinations.

    Raises
    ------
    InputError
        For the first fault: the file, the key, what was expected.
    """
    validate(StudyKeys, config, source)
    check_names({}, config, None, source)
    for name in config.get("specimens", {}):
        resolve_settings(config, name, {}, source)
    if "defaults" in config:
        resolve_settings(config, None, {}, source)
    for name, recipe in config.get("embedded", {}).items():
        resolve_embedded(recipe, f"{source}: embedded.{name}")
        _check_statements(recipe.get("chosen_for", {}), f"{source}: embedded.{name}")
    if "roll_off" in config:
        resolve_roll_off(config, source)
    _check_figures(config.get("figures", ()), source)


def _check_statements(names, source: str) -> None:
    """Refuse statements of the paper that are judged on no specimen."""
    statements = claims_of("one")
    for name in names:
        if name not in statements:
            raise InputError(
                f"{source}.chosen_for: no statement {name!r}{nearest(name, statements)}"
            )


def _check_figures(names, source: str) -> None:
    """Refuse names that are no figure of a specimen."""
    figures = figures_of("match")
    for name in () if isinstance(names, str) else names:
        if name not in figures:
            raise InputError(
                f"{source}: figures: no figure {name!r} of specimens{nearest(name, figures)}"
            )


def check_names(
    scans: Iterable[str], config: Mapping, folder: Path | str | None, source: str
) -> None:
    """Refuse embedded specimens whose results would be taken for others.

    Names must differ from each other and from those of the scans in more than upper and lower case,
    because on many disks they would be one file, and a scan must be able to have such a name.
    """
    taken: dict[str, tuple[str, str | None]] = {
        name.lower(): (name, f"a scan in {folder}") for name in scans
    }
    for name in config.get("embedded", {}):
        where = f"{source}: embedded.{shortened(name)}"
        safe = specimen_name(name)
        if safe != name:
            raise InputError(f"{where}: no name for files on every computer; write {safe!r}")
        other, what = taken.setdefault(name.lower(), (name, None))
        if other == name and what is not None:
            raise InputError(f"{where}: has the name of {what}; rename one")
        if other != name:
            raise InputError(
                f"{where}: differs from {what or 'the embedded specimen'} {other} in upper and "
                "lower case alone; rename one"
            )


def read_sidecar(path: Path | None) -> tuple[dict, dict]:
    """Scan keys and settings of a sidecar, checked; empty without a sidecar."""
    if path is None:
        return {}, {}
    return _split(read_yaml(path), str(path))


def _split(document: dict, source: str) -> tuple[dict, dict]:
    """Scan keys and settings from a sidecar or a row of a table."""
    scan_keys = ScanKeys.model_fields
    for key, value in document.items():
        if value is None and key in scan_keys:
            raise InputError(f"{source}: key '{key}' is empty; fill it in")
    validate(SidecarKeys, document, source)
    if (kind := document.get("kind")) in OLD_KINDS:
        document = {**document, "kind": OLD_KINDS[kind]}
    scan = {key: value for key, value in document.items() if key in scan_keys}
    settings = {key: value for key, value in document.items() if key not in scan_keys}
    return scan, settings
