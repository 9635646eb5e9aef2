"""Campaigns of small synthetic twins, and what the workflow takes for so many specimens.

python benchmarks/campaign.py 1000            writes the scans and the study of 1,000 twins
python benchmarks/campaign.py 1000 --measure  measures dry run, rerun without work and gather too

Everything goes to results/campaigns/N: `scans/GROUP/twin_00001.npy`, a sidecar for each group,
`study.yaml`. One twin of each group is computed as any specimen is. To measure what only depends on
how many there are, the others then get copies of it under their own names (links to the same file,
but for the atlas of each, in which the names of its groups are changed): their numbers are
those of the first, and say nothing.
"""

import argparse
import contextlib
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import yaml

from fractalcontact.core import checksums
from fractalcontact.core.atomic import atomic_write
from fractalcontact.surface.synthesis import self_affine

ROOT = Path(__file__).resolve().parents[1]
SPACING, NODES = 0.1, 80  # mm, nodes along a side
#: Groups of twins and the surface dimension of each.
GROUPS = {"smooth": 2.2, "rough": 2.4}
#: Twins of each group that are computed.
COMPUTED = 1
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
    parser.add_argument("--database", action="store_true", help="metadata in one file")
    options = parser.parse_args()
    folder = ROOT / f"results/campaigns/{options.specimens}"
    names = write_campaign(folder, options.specimens, options.figures)
    print(f"{folder.relative_to(ROOT)}: {len(names)} twins in {len(GROUPS)} groups")
    if options.run:
        snakemake(folder, database=options.database)
    if options.measure:
        measure(folder, names, options.database)


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
        sidecar = {"unit": "mm", "spacing": f"{SPACING} mm", "label": label}
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


def snakemake(folder: Path, *words: str, database: bool = False) -> dict[str, float]:
    """Run Snakemake on the campaign: seconds, seconds of CPU and the largest memory, MB.

    Raises
    ------
    RuntimeError
        With the last of what it said, if it fails.
    """
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(ROOT / "Snakefile")]
    command += ["--directory", str(folder), "--configfile", str(folder / "study.yaml")]
    command += ["--workflow-profile", str(ROOT / "workflow/profiles/default"), "--cores", "1"]
    command += ["--persistence-backend", "db"] if database else []
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
            found = re.search(r"VmHWM:\s+(\d+)", status.read_text())
            peak = max(peak, int(found[1]) / 1024 if found else 0.0)
        time.sleep(0.02)
    return child.returncode, peak


def measure(folder: Path, names: list[str], database: bool) -> None:
    """Dry run, rerun without work, gather and comparison, and files and bytes: a table in JSON."""
    results = folder / f"results/campaign_{len(names)}"
    found = {"specimens": len(names), "database": database}
    found["dry run"] = snakemake(folder, "--dry-run", "--quiet", database=database)
    donors = {
        group: [name for name in names if name.startswith(f"{group}_")][:COMPUTED]
        for group in GROUPS
    }
    parts = [f"results/{results.name}/atlas/{name}.nc" for some in donors.values() for name in some]
    found["computed"] = snakemake(folder, *parts, database=database) | {"specimens": len(parts)}
    begin = time.perf_counter()
    for name in names:
        group = name.partition("_")[0]
        if name not in donors[group]:
            _copy(results, donors[group][0], name)
    found["copies"] = {"s": time.perf_counter() - begin}
    undrawn = [f"results/{results.name}/undrawn/{name}.txt" for name in names]
    _write(folder / "targets.txt", "\n".join(undrawn))
    found["touch"] = snakemake(folder, "--touch", *undrawn, database=database)
    found["gather and figures"] = snakemake(folder, database=database)
    for job in ("atlas", "study_figures"):
        found[job] = _benchmark(results / f"benchmarks/{job}.tsv")
    found["rerun without work"] = snakemake(folder, "--quiet", database=database)
    found["results"] = _files(results)
    found["metadata"] = _files(folder / ".snakemake")
    text = json.dumps(found, indent=1)
    _write(folder / ("database.json" if database else "measured.json"), text + "\n")
    print(text)


def _copy(results, donor, name):
    """Give a specimen the files of another: links, but for the atlas, whose groups are renamed."""
    import netCDF4

    # Snakemake's --touch asks for what is drawn of nobody and for logs too.
    for path in [*results.glob(f"*/{donor}.*"), *results.glob(f"checksums/*/{donor}.sha256")]:
        target = path.with_name(path.name.replace(donor, name))
        if target.exists():
            continue
        if path.suffix == ".sha256":
            _write(target, path.read_text().replace(donor, name))
        elif path.parent.name == "atlas":
            shutil.copyfile(path, target)
            with netCDF4.Dataset(target, "a") as file:
                for stage in file.groups.values():
                    if donor in stage.groups:
                        stage.renameGroup(donor, name)
        else:
            os.link(path, target)
    for folder in (results / "contact", results / "checksums/contact"):
        for path in (folder / donor).glob("*"):
            target = folder / name / path.name
            target.parent.mkdir(parents=True, exist_ok=True)
            if not target.exists():
                if path.suffix == ".sha256":
                    _write(target, path.read_text().replace(donor, name))
                else:
                    os.link(path, target)
    atlas = results / f"atlas/{name}.nc"
    record = results / f"checksums/atlas/{name}.sha256"
    _write(record, f"{checksums.sha256(atlas)}  atlas/{name}.nc\n")


def _benchmark(path):
    head, row = (line.split("\t") for line in path.read_text().splitlines()[:2])
    told = dict(zip(head, row, strict=True))
    return {"s": float(told["s"]), "MB": float(told["max_rss"])}


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
