# What every rule file uses: the checked study, its specimens, and digests of scans and code.
import os
import re
import sys
from pathlib import Path

import yaml
from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

# The code of this checkout, wherever its environment was installed from: it may have been moved.
PACKAGE = Path(workflow.basedir) / "src/fractalcontact"
SCRIPTS = Path(workflow.basedir) / "workflow/scripts"
sys.path.insert(0, str(PACKAGE.parent))
sys.path.append(str(SCRIPTS))
os.environ["PYTHONPATH"] = os.pathsep.join(
    filter(None, [str(PACKAGE.parent), os.environ.get("PYTHONPATH")])
)

import _running

# Light modules, without xarray, numba or matplotlib: on a cluster every job reads the workflow.
from fractalcontact.core import checksums, sources
from fractalcontact.study.scan_files import find_scans
from fractalcontact.core.directions import AUTOMATIC_OFFSETS
from fractalcontact.core.errors import InputError
from fractalcontact.study.figure_list import all_figures, figures_of, study_figures_of
from fractalcontact.study.sidecar import is_contact_map, sidecar_of_matrix
from fractalcontact.study.configuration import (
    EXPERIMENTS,
    check_names,
    check_study,
    read_sidecar,
    resolve_embedded,
    resolve_roll_off,
    resolve_settings,
    solver_settings,
)

SCHEMA = yaml.safe_load((Path(workflow.basedir) / "config/schema/study.schema.yaml").read_text())
SOURCE = str(workflow.configfiles[-1]) if workflow.configfiles else "config/paper.yaml"
# Said by whoever runs it, never by a study.
MAY_DROP = "FRACTALCONTACT_DROP" in os.environ
if workflow.is_main_process and "FRACTALCONTACT_ALONE" not in os.environ:
    # Held as long as this process lives; jobs hold their own. workflow/run.py alone lets nobody
    # else work while it looks at what killed runs left.
    AT_WORK = _running.mark()


def read_study():
    """Scan files; settings and reading options by specimen; contact maps; the solver's settings."""
    check_study(config, SCHEMA, SOURCE)
    folder = config.get("scans", "scans")
    scans = find_scans(folder) if folder else {}
    check_names(scans, config, folder, SOURCE)
    unknown = sorted(
        set(config.get("specimens", {})) - set(scans) - set(config.get("embedded", {}))
    )
    if unknown:
        raise InputError(
            f"{SOURCE}: specimens.{unknown[0]}: neither embedded nor a scan in {folder}"
        )
    settings, options, maps = {}, {}, {}
    for name, scan in scans.items():
        options[name], own = read_sidecar(scan.sidecar, SCHEMA)
        if is_contact_map(options[name]):
            maps[name] = own.get("label", name)
        else:
            settings[name] = resolve_settings(config, name, own, SOURCE)
    for name in config.get("embedded", {}):
        settings[name] = resolve_settings(config, name, {}, SOURCE)
    if folder and not scans and workflow.is_main_process:
        logger.warning(f"{folder}: no scan files there; only what the study itself makes is used")
    return scans, settings, options, maps, solver_settings(config, SOURCE)


def refuse_loss(results, names):
    """Keep an atlas from losing specimens unless that is what the user wants.

    A folder that is not mounted, or half copied, looks like one from which scans were removed.
    """
    results = Path(results)
    places = [results, results / checksums.ASIDE]
    if MAY_DROP or not any((place / "atlas.nc").exists() for place in places):
        return
    listed = results / "specimens.txt"
    if listed.is_file():
        had = set(listed.read_text(encoding="utf-8").split())
    else:  # of an earlier version, or damaged: those of which anything is there
        stages = [place / stage for place in places for stage in ("specimens", "contact_maps")]
        had = {path.stem for stage in stages for path in stage.glob("*.nc")}
    lost = sorted(had - set(names))
    if lost:
        raise InputError(
            f"{results}/atlas.nc has specimens that the study no longer has: {', '.join(lost)}; "
            "put their scans back or, if they are to go, run 'make DROP=yes' (with snakemake: "
            "set FRACTALCONTACT_DROP=yes in the environment). The atlas was not changed"
        )


def refuse_unknown_origin(results):
    """Snakemake knows in its own folder alone what its files were made from."""
    made = any(Path(results, checksums.FOLDER).rglob(f"*{checksums.ENDING}"))
    known = any(Path(".snakemake/metadata").glob("*")) or any(Path(".snakemake").glob("*.db"))
    if made and not known:
        raise InputError(
            f"{results}: nothing says from which scans, settings and code these results were made, "
            "since .snakemake is not with them; bring it back, or remove the results"
        )


def refuse_damage(results):
    """Stop before a damaged file is read, or what is good is removed to be made from it again."""
    # workflow/run.py has set them aside; jobs that a killed run left half done, whose files may be
    # newer than their checksums, Snakemake runs again by itself.
    unfinished = any(Path(".snakemake/incomplete").glob("*"))
    if "FRACTALCONTACT_CHECKED" not in os.environ and not unfinished:
        damaged = checksums.check(results, DIGESTS.of).damaged
        if damaged:
            raise InputError(
                f"{damaged[0]}: damaged or replaced after it was made"
                + (f", and {len(damaged) - 1} more files" if len(damaged) > 1 else "")
                + "; run 'make', which sets it aside and makes it again, or remove it yourself"
            )


DIGESTS = checksums.Digests(".snakemake/fractalcontact-digests.json")
try:
    SCANS, SETTINGS, OPTIONS, LABELS, SOLVER = read_study()
    RESULTS = f"results/{config['study']}"
    if workflow.is_main_process:
        refuse_unknown_origin(RESULTS)
        refuse_damage(RESULTS)
        refuse_loss(RESULTS, [*SETTINGS, *LABELS])
except InputError as error:
    raise WorkflowError(str(error))

#: Measured contact maps, which have no settings.
MAPS = {name: SCANS[name] for name in LABELS}
SPECIMENS = sorted(SETTINGS)


def digest_of(path):
    """SHA-256 of a scan file; none of one that cannot be read, which its job explains."""
    try:
        return DIGESTS.of(path)
    except OSError:
        return ""


def digests_of(scan):
    """SHA-256 of the scan files of a specimen, by path: parameters of the rules that read them.

    Times say nothing of a file that was moved, copied or unpacked over another.
    """
    return {str(path): DIGEST_OF_SCAN[path] for path in (scan.lower, scan.upper) if path}


# Taken now, before any job: a scan that is replaced meanwhile belongs to the next run.
DIGEST_OF_SCAN = {
    path: digest_of(path) for scan in SCANS.values() for path in (scan.lower, scan.upper) if path
}
if workflow.is_main_process:
    DIGESTS.save()


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
    """Settings of a specimen for what is computed: its label changes no number."""
    settings = SETTINGS[wildcards.specimen]
    return {key: value for key, value in settings.items() if key != "label"}


def is_pair(specimen):
    """Whether both faces of a specimen were scanned."""
    return specimen in SCANS and SCANS[specimen].upper is not None


#: Surfaces against a plane, which cannot slide, and all others.
FLAT = [name for name in SPECIMENS if SETTINGS[name]["opposite"] == "flat" and not is_pair(name)]
SLIDING = [name for name in SPECIMENS if name not in FLAT]


def figure_modules(names):
    """Modules that draw figures, for `code`: they are imported by name when they are called."""
    return [all_figures()[name].module for name in names]


def grain(key, n):
    """Slices of n things for as many jobs as the study's grain asks for."""
    share = config.get("grain", {}).get(key, "all")
    size = n if share == "all" else share
    return [[start, min(start + size, n)] for start in range(0, n, size)]


def code(script, *modules):
    """Digest of all that a script runs: a change of it reruns the rule.

    Parameters
    ----------
    script : str
        Of workflow/scripts; with it count all files it imports, of the package and beside it, and
        the versions of the libraries that any of them imports.
    *modules : str
        Of the package, which are imported by names that only exist when it runs.
    """
    if (script, *modules) not in CODE:
        paths = [SCRIPTS / f"{script}.py", *(PACKAGE / f"{module}.py" for module in modules)]
        files = sources.source_files(paths, package=PACKAGE)
        versions = sources.versions_of(sources.libraries(files))
        CODE[script, *modules] = sources.digest(files, root=workflow.basedir, versions=versions)
    return CODE[script, *modules]


# Two rules may run one script, in every process that reads the workflow.
CODE = {}
