"""A small study with its result page: hostile labels, pictures of one dot."""

import shutil
import struct
import zlib

import pytest
from page_study import STUDY, write_pages

from fractalcontact.study.figure_list import figures_of


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
def results(cards_folder, tmp_path_factory):
    """Folder of the results of a study of two scanned faces and of a surface against a plane."""

    folder = tmp_path_factory.mktemp("project") / "results/tiny"
    shutil.copytree(cards_folder, folder)
    for name, stated in STUDY["specimens"].items():
        figures = folder / "figures" / name
        figures.mkdir(parents=True)
        for figure in figures_of("flat" if name == "flat.1" else "match"):
            png_of(figures / f"{figure}.png")
            (figures / f"{figure}.csv").write_text("a,b\n1,2\n")
            words = f"Supplementary figure: {stated['label']}. It. Found.\n"
            (figures / f"{figure}.txt").write_text(words)
    (folder / "logs").mkdir()
    (folder / "logs/one.log").write_text(
        "worked 61.500 s, of which 2.000 s on 9 contact problems\n"
    )
    assert write_pages(folder) == ["flat.1", "pair"]
    return folder
