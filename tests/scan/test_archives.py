"""Zip archives that are damaged or made to do harm are refused, none is unpacked to disk."""

import io
import struct
import zipfile

import numpy as np
import pytest
from stated import read_scan

from fractalcontact.core.errors import InputError
from fractalcontact.scan import files
from fractalcontact.scan.files import inflated_size, require_whole


def pack(path, members, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in members:
            archive.writestr(name, content)
    return path


def npy_bytes():
    buffer = io.BytesIO()
    np.save(buffer, np.random.default_rng(0).normal(size=(10, 12)))
    return buffer.getvalue()


@pytest.mark.parametrize("name", ["/etc/passwd", "../z.npy", "C:\\z.npy", "bindata\\z.npy"])
def test_no_member_is_written_anywhere(tmp_path, name):
    path = pack(tmp_path / "rock.npz", [(name, b"1")])
    require_whole(path)
    with pytest.raises(InputError, match=r"rock\.npz: "):
        read_scan(path, {"unit": "mm", "spacing": 1})
    assert [path.name for path in tmp_path.iterdir()] == ["rock.npz"]


def test_encrypted_members_are_refused(tmp_path):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())])
    content = bytearray(path.read_bytes())
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.index(signature) + offset] |= 1
    path.write_bytes(content)
    with pytest.raises(InputError, match="is encrypted"):
        require_whole(path)


def test_a_bomb_is_refused_by_its_ratio_alone(tmp_path):
    path = pack(tmp_path / "rock.npz", [("z.npy", bytes(files.UNSUSPICIOUS + 1))])
    assert path.stat().st_size < 100_000
    with pytest.raises(InputError, match=r"inflates \d+ times"):
        inflated_size(path)


@pytest.mark.parametrize("change", [-50, +50])
def test_a_directory_that_lies_about_a_size_is_found_out(tmp_path, change):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())])
    content = bytearray(path.read_bytes())
    for signature, offset in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):  # uncompressed size
        at = content.index(signature) + offset
        (size,) = struct.unpack_from("<I", content, at)
        struct.pack_into("<I", content, at, size + change)
    path.write_bytes(content)
    if change < 0:
        with pytest.raises(InputError, match=r"Bad CRC-32|is damaged"):
            require_whole(path)
    else:
        heights = read_scan(path, {"unit": "mm", "spacing": 1})  # all that was stored is there
        np.testing.assert_array_equal(heights, np.load(io.BytesIO(npy_bytes())))


def test_flipped_bytes_are_found_by_the_checksum(tmp_path):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())], zipfile.ZIP_STORED)
    content = bytearray(path.read_bytes())
    content[200] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"Bad CRC-32|is damaged"):
        require_whole(path)


def laughs(depth=30):
    of_each = ["ha", *(10 * f"&a{i};" for i in range(depth - 1))]
    entities = "".join(f'<!ENTITY a{i} "{words}">' for i, words in enumerate(of_each))
    return f"<!DOCTYPE a [{entities}]><ISO5436_2>&a{depth - 1};</ISO5436_2>"


@pytest.mark.parametrize(
    "xml",
    [laughs(), '<!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>', "<a>" * 10**6, "<a><b></a>"],
    ids=["laughs", "outside", "deep", "broken"],
)
@pytest.mark.parametrize("name", ["rock.x3p", "rock.plux"])
def test_xml_that_would_make_a_parser_run_away_is_refused(tmp_path, xml, name):
    members = [("main.xml", xml), ("index.xml", xml), ("LAYER_0.raw", bytes(100))]
    path = pack(tmp_path / name, members)
    with pytest.raises(InputError, match=rf"{name}: "):
        read_scan(path)


def test_what_is_no_archive_passes(tmp_path):
    path = tmp_path / "rock.txt"
    path.write_text("1 2 3\n")
    require_whole(path)
    assert inflated_size(path) == 6
