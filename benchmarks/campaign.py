"""Campaigns of small synthetic twins, and what the workflow takes for that many specimens.

python benchmarks/campaign.py 1000            writes the scans and the study of 1,000 twins
python benchmarks/campaign.py 6 --run         computes six, which the next needs once
python benchmarks/campaign.py 1000 --measure  measures dry run, rerun without work and gather too

Everything goes to results/campaigns/N: `scans/GROUP/twin_00001.npy`, a sidecar for each group,
`study.yaml`. To measure what only depends on how many specimens there are, each gets copies of the
results of one of the six under its own name (links to the same file, but for its atlas, which
gets its name): their numbers are those of six twins, and say nothing.
"""

import argparse
import base64
import contextlib
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from functools import cache
from pathlib import Path

import netCDF4
import numpy as np
import yaml

from fractalcontact.core import checksums
from fractalcontact.core.atomic import atomic_write
from fractalcontact.study.sidecar import sidecar_of_matrix
from fractalcontact.surface.synthesis import self_affine

ROOT = Path(__file__).resolve().parents[1]
SPACING, NODES = 0.1, 80  # mm, nodes along a side
#: Groups of twins and the surface dimension of each.
GROUPS = {"smooth": 2.2, "rough": 2.4}
#: Twins of the campaign whose results the others get copies of.
COMPUTED = 6
STUDY = {
    "materials": {
        "sandstone": {
            "modulus": "20 GPa",
            "poisson": 0.2,
            "basic_friction_angle": "30 deg",
            "joint_wall_strength": "80 MPa",
        }
    },
    "defaults": {
        "material": "sandstone",
        "window": "4.8 mm",
        "directions": ["E", "W"],
        "contact_directions": ["W"],
        "offsets": ["0.1 mm", "0.3 mm", "1 mm"],
        "loads": ["0.1 MPa", "1 MPa", "5 MPa", "12.5 MPa", "25 MPa"],
        "resolutions": [1, 2],
    },
}


def main():
    """Write a campaign and, if asked, measure it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("specimens", type=int)
    parser.add_argument("--measure", action="store_true")
    parser.add_argument("--run", action="store_true", help="compute all of it")
    parser.add_argument("--figures", default="none", choices=["none", "all"], help="of specimens")
    options = parser.parse_args()
    folder = ROOT / f"results/campaigns/{options.specimens}"
    names = write_campaign(folder, options.specimens, options.figures)
    print(f"{folder.relative_to(ROOT)}: {len(names)} twins in {len(GROUPS)} groups")
    if options.run:
        snakemake(folder)
    if options.measure:
        measure(folder, names)


def write_campaign(folder: Path, n: int, figures: str = "none") -> list[str]:
    """Scans, sidecars and the study of n twins, those that are there already left as they are.

    Returns
    -------
    list of str
        Names of the specimens.
    """
    names = []
    for group, dimension in GROUPS.items():
        path = folder / f"scans/{group}"
        path.mkdir(parents=True, exist_ok=True)
        label = f"synthetic twin of no rock, surface dimension {dimension}"
        sidecar = {**sidecar_of_matrix(SPACING), "label": label}
        _write(folder / f"scans/{group}.yaml", yaml.safe_dump(sidecar, sort_keys=False))
        for number in range(list(GROUPS).index(group), n, len(GROUPS)):
            name = f"twin_{number:05d}"
            names.append(f"{group}_{name}")
            if not (path / f"{name}.npy").exists():
                heights = self_affine(
                    (NODES, NODES), SPACING, 3 - dimension, rms=0.15, seed=number, roll_off=2.0
                )
                with atomic_write(path / f"{name}.npy") as temporary:
                    np.save(temporary, heights.astype("float32"))
                    if not temporary.exists():  # numpy adds an ending
                        os.replace(f"{temporary}.npy", temporary)
    scans = {"study": f"campaign_{n}", "scans": "scans", "groups": "folders", "atlas": "parts"}
    study = {**scans, "figures": figures, **STUDY}
    _write(folder / "study.yaml", yaml.safe_dump(study, sort_keys=False))
    return sorted(names)


def _write(path, text):
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        with atomic_write(path) as temporary:
            temporary.write_text(text, encoding="utf-8")


def snakemake(folder: Path, *words: str) -> dict[str, float]:
    """Run Snakemake on the campaign: seconds, seconds of CPU and the largest memory, MB.

    Raises
    ------
    RuntimeError
        With the last of what it said, if it fails.
    """
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--directory", str(folder), "--configfile", str(folder / "study.yaml")]
    command += ["--workflow-profile", str(ROOT / "workflow/profiles/default"), "--cores", "1"]
    begin, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    with open(folder / "log.txt", "a+", encoding="utf-8") as log:
        print(f"$ {' '.join(command[3:] + list(words))}", file=log, flush=True)
        with subprocess.Popen(
            [*command, *words], stdout=log, stderr=log, env=environment, cwd=folder
        ) as child:
            status, peak = _watched(child)
        if status:
            log.seek(0)
            raise RuntimeError("".join(log.readlines()[-30:]))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"s": time.perf_counter() - begin, "cpu_s": cpu, "MB": peak}


def _watched(child):
    """Exit code of a process, and the largest resident memory that it had itself, MB."""
    peak = 0.0
    status = Path(f"/proc/{child.pid}/status")
    while child.poll() is None:
        with contextlib.suppress(OSError):
            found = re.search(r"VmHWM:\s+(\d+)", status.read_text(encoding="utf-8"))
            peak = max(peak, int(found[1]) / 1024 if found else 0.0)
        time.sleep(0.02)
    return child.returncode, peak


def measure(folder: Path, names: list[str]) -> None:
    """Dry run, rerun without work, gather and comparison, and files and bytes: a table in JSON."""
    study = f"campaign_{len(names)}"
    results, donors = folder / f"results/{study}", ROOT / f"results/campaigns/{COMPUTED}"
    made_by = sorted((donors / f"results/campaign_{COMPUTED}/atlas").glob("*.nc"))
    if len(made_by) < COMPUTED:
        raise SystemExit(f"run first: python {Path(__file__).name} {COMPUTED} --run")
    found = {"specimens": len(names)}
    found["dry run"] = snakemake(folder, "--dry-run", "--quiet", "all")
    begin = time.perf_counter()
    for number, name in enumerate(names):
        of_group = [path.stem for path in made_by if path.stem.startswith(name.partition("_")[0])]
        donor = of_group[number % len(of_group)]
        _copy(made_by[0].parents[1], results, donor, name)
        _copy_records(donors, folder, donor, name, study)
    found["copies"] = {"s": time.perf_counter() - begin}
    found["gather and figures"] = snakemake(folder)
    for job in ("atlas", "study_figures"):
        found[job] = _spent(results / f"logs/{job}.log")
    found["rerun without work"] = snakemake(folder, "--quiet", "all")
    found["results"], found["metadata"] = _files(results), _files(folder / ".snakemake")
    found["one more"] = _one_more(folder, len(names))
    text = json.dumps(found, indent=1)
    _write(folder / "measured.json", text + "\n")
    print(text)


def _one_more(folder, n):
    """Jobs that a dry run names once a specimen is added, by rule."""
    extra = folder / "scans/rough/added.npy"
    shutil.copyfile(folder / "scans/rough/twin_00001.npy", extra)
    try:
        cost = snakemake(folder, "--dry-run")
        told = (folder / "log.txt").read_text(encoding="utf-8").rpartition("Job stats:")[2]
    finally:
        extra.unlink()
    return cost | {"jobs": dict(re.findall(r"^(\w+) +(\d+)$", told, re.MULTILINE))}


def _copy(origin, results, donor, name):
    """Give a specimen the files of another: links, but for the atlas, which gets its name."""
    paths = [*origin.glob(f"*/{donor}.*"), *origin.glob(f"contact/{donor}/*")]
    for path in paths:
        target = results / str(path.relative_to(origin)).replace(donor, name)
        if target.exists():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        if path.parent.name == "atlas":
            shutil.copyfile(path, target)
            _rename(target, donor, name)
            # It is as old as what was made of it, so that no card is made again.
            os.utime(target, ns=(path.stat().st_atime_ns, path.stat().st_mtime_ns))
            record = results / f"checksums/atlas/{name}.sha256"
            record.parent.mkdir(parents=True, exist_ok=True)
            record.write_text(f"{checksums.sha256(target)}  atlas/{name}.nc\n", encoding="utf-8")
        else:
            os.link(path, target)
    for path in [
        *origin.glob(f"checksums/*/{donor}.sha256"),
        *origin.glob(f"checksums/*/{donor}/*"),
    ]:
        target = results / str(path.relative_to(origin)).replace(donor, name)
        if path.parent.name != "atlas":
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(
                path.read_text(encoding="utf-8").replace(donor, name), encoding="utf-8"
            )


def _rename(atlas, donor, name):
    """Name the specimen of an atlas anew: its settings, the digests of its scan, its groups."""
    with netCDF4.Dataset(atlas, "a") as file:
        for attribute in ("configuration", "scan_checksums"):
            file.setncattr(attribute, file.getncattr(attribute).replace(donor, name))
        for stage in file.groups.values():
            if donor in stage.groups and donor != name:
                stage.renameGroup(donor, name)


def _copy_records(origin, folder, donor, name, study):
    """Give a specimen what Snakemake noted of another, as if it had been made so."""
    group, twin = (word.partition("_") for word in (donor, name))
    scans = f"scans/{group[0]}/{group[2]}.npy", f"scans/{twin[0]}/{twin[2]}.npy"
    digests = checksums.sha256(origin / scans[0]), checksums.sha256(folder / scans[1])
    study_of_origin = f"campaign_{COMPUTED}"
    for path in _records(origin):
        made = base64.urlsafe_b64decode(path.name).decode()
        if donor not in made:
            continue
        text = path.read_text(encoding="utf-8")
        pairs = ((donor, name), scans, digests, (study_of_origin, study))
        for old, new in pairs:
            text, made = text.replace(old, new), made.replace(old, new)
        target = folder / ".snakemake/metadata" / base64.urlsafe_b64encode(made.encode()).decode()
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")


@cache
def _records(folder):
    return sorted((folder / ".snakemake/metadata").iterdir())


def _spent(log):
    line = log.read_text(encoding="utf-8").splitlines()[-1]
    seconds, *_, megabytes = re.findall(r"([\d.]+) (?:s|MB)\b", line)
    return {"s": float(seconds), "MB": float(megabytes)}


def _files(folder):
    """Files of a folder and their bytes, each counted once however many names it has."""
    seen, count, size = set(), 0, 0
    for path in folder.rglob("*"):
        if path.is_file():
            count += 1
            found = path.stat()
            if found.st_ino not in seen:
                seen.add(found.st_ino)
                size += found.st_blocks * 512
    return {"files": count, "MB": size / 1e6}


if __name__ == "__main__":
    main()
