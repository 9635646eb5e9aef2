"""A small study with its result page: hostile labels, pictures of one dot."""

import struct
import zlib
from dataclasses import asdict

import pytest
from made_stages import scan, stages_of
from page_study import STUDY

from fractalcontact.pages.result_page import Place, write_result_page
from fractalcontact.stages.atlas import join_stages
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.study.figure_list import figures_of
from fractalcontact.study.stages import STAGES
from fractalcontact.surface.synthesis import self_affine


def png_of(path):
    """A picture of one dot, 3 wide and 2 high."""
    chunks = (
        (b"IHDR", struct.pack(">IIBBBBB", 3, 2, 8, 0, 0, 0, 0)),
        (b"IDAT", zlib.compress(bytes(8))),
        (b"IEND", b""),
    )
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + b"".join(
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
            for kind, data in chunks
        )
    )


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    """Folder of the results of a study of two scanned faces and of a surface against a plane."""

    def surface(cells, seed):
        return self_affine((cells, cells), 0.1, 0.8, rms=0.1, seed=seed, roll_off=1.5)

    lower = surface(80, 1)
    scans = {
        "pair": (scan(lower, 0.1), scan(lower + 0.2 * surface(80, 2) + 0.02, 0.1)),
        "flat.1": (scan(surface(48, 4), 0.1), None),
    }
    parts = {stage: {} for stage in STAGES}
    settings = {name: resolve_settings(STUDY, name, {}, "tiny") for name in scans}
    for name, faces in scans.items():
        made = stages_of(name, faces, settings[name], solver_settings({}, "tiny"))
        for stage, dataset in made.items():
            parts[stage][name] = dataset
    folder = tmp_path_factory.mktemp("project") / "results/tiny"
    folder.mkdir(parents=True)
    records = {name: asdict(stated) for name, stated in settings.items()}
    join_stages(parts, folder / "atlas.nc", {"study": STUDY, "settings": records})
    for name in scans:
        figures = folder / "figures" / name
        figures.mkdir(parents=True)
        for figure in figures_of("flat" if name == "flat.1" else "match"):
            png_of(figures / f"{figure}.png")
            (figures / f"{figure}.csv").write_text("a,b\n1,2\n")
            label = settings[name].label
            (figures / f"{figure}.txt").write_text(f"Supplementary figure: {label}. It. Found.\n")
    (folder / "benchmarks").mkdir()
    (folder / "benchmarks/one.tsv").write_text("s\th:m:s\n61.5\t0:01:01\n")
    assert write_result_page(Place.of(folder)) == ["flat.1", "pair"]
    return folder
