# What every rule file uses: the checked study, its specimens, and digests of the code.
import ast
import hashlib
import re
from functools import cache
from pathlib import Path

import yaml
from snakemake.exceptions import WorkflowError

# Light modules, without xarray, numba or matplotlib: on a cluster every job reads the workflow.
from fractalcontact.catalogue import find_scans
from fractalcontact.directions import AUTOMATIC_OFFSETS
from fractalcontact.errors import InputError
from fractalcontact.figure_names import EXPERIMENTS, figures_of, study_figures_of
from fractalcontact.sidecar import is_contact_map
from fractalcontact.study import (
    check_study,
    read_sidecar,
    resolve_embedded,
    resolve_roll_off,
    resolve_settings,
    solver_settings,
)

SCHEMA_FILE = workflow.source_path("../../config/schema/study.schema.yaml")
SCHEMA = yaml.safe_load(Path(SCHEMA_FILE).read_text())
SOURCE = str(workflow.configfiles[-1]) if workflow.configfiles else "config/paper.yaml"


def read_study():
    """Scan files, settings of every specimen, embedded ones too, contact maps, and the solver's."""
    check_study(config, SCHEMA, SOURCE)
    folder = config.get("scans", "scans")
    scans = find_scans(folder) if folder else {}
    twice = sorted(set(scans) & set(config.get("embedded", {})))
    if twice:
        raise InputError(
            f"{folder}: specimen '{twice[0]}' is also embedded in {SOURCE}; rename one"
        )
    unknown = sorted(
        set(config.get("specimens", {})) - set(scans) - set(config.get("embedded", {}))
    )
    if unknown:
        raise InputError(
            f"{SOURCE}: specimens.{unknown[0]}: neither embedded nor a scan in {folder}"
        )
    settings, maps = {}, {}
    for name, scan in scans.items():
        options, own = read_sidecar(scan.sidecar, SCHEMA)
        if is_contact_map(options):
            maps[name] = scan
        else:
            settings[name] = resolve_settings(config, name, own, SOURCE)
    for name in config.get("embedded", {}):
        settings[name] = resolve_settings(config, name, {}, SOURCE)
    return scans, settings, maps, solver_settings(config, SOURCE)


try:
    SCANS, SETTINGS, MAPS, SOLVER = read_study()
except InputError as error:
    raise WorkflowError(str(error))

RESULTS = f"results/{config['study']}"
SPECIMENS = sorted(SETTINGS)


def one_of(names):
    """Pattern that matches these names and no others; no specimen at all matches nothing."""
    return "|".join(map(re.escape, names)) or "(?!)"


wildcard_constraints:
    specimen=one_of(SPECIMENS),
    map=one_of(MAPS),
    directions=r"\d+",
    offsets=r"\d+",
    resolutions=r"\d+",
    part=r"\d+",


def settings_of(wildcards):
    return SETTINGS[wildcards.specimen]


def is_pair(specimen):
    """Whether both faces of a specimen were scanned."""
    return specimen in SCANS and SCANS[specimen].upper is not None


#: Surfaces against a plane, which cannot slide, and all others.
FLAT = [name for name in SPECIMENS if SETTINGS[name]["opposite"] == "flat" and not is_pair(name)]
SLIDING = [name for name in SPECIMENS if name not in FLAT]


def figure_modules(opposite):
    return [f"figures/{name}" for name in figures_of(opposite)]


def grain(key, n):
    """Slices of n things for as many jobs as the study's grain asks for."""
    share = config.get("grain", {}).get(key, "all")
    size = n if share == "all" else share
    return [[start, min(start + size, n)] for start in range(0, n, size)]


def code(*modules):
    """Digest of modules of the package and of all they import from it: a change reruns the rule."""
    package = Path(workflow.basedir) / "src/fractalcontact"
    digest = hashlib.sha256()
    for path in sorted(sources(package, [package / f"{module}.py" for module in modules])):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def sources(package, paths):
    """These files of the package, and every file of it they import, near or far."""
    seen = set()
    queue = [path if path.exists() else path.with_suffix("") / "__init__.py" for path in paths]
    while queue:
        path = queue.pop()
        if path not in seen:
            seen.add(path)
            queue += imported(package, path)
    return seen


# Three dozen rules ask for the same files, in every process that reads the workflow.
@cache
def imported(package, path):
    """Files of the package that one of them imports."""
    found = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = path.parents[node.level - 1]
            base = folder.joinpath(*(node.module or "").split("."))
            names = [base] if node.module else []
            names += [base / alias.name for alias in node.names]
            files = [f for n in names for f in (n.with_suffix(".py"), n / "__init__.py")]
            found += [file for file in files if file.is_file() and package in file.parents]
    return found
