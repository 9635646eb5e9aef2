"""Zip archives made to do harm are refused before any library opens them."""

import io
import stat
import struct
import zipfile

import numpy as np
import pytest
from stated import read_scan

from fractalcontact.core.errors import InputError
from fractalcontact.scan import archives
from fractalcontact.scan.archives import check_archive


def pack(path, members, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in members:
            archive.writestr(name, content)
    return path


def npy_bytes():
    buffer = io.BytesIO()
    np.save(buffer, np.random.default_rng(0).normal(size=(10, 12)))
    return buffer.getvalue()


@pytest.mark.parametrize(
    "name", ["/etc/passwd", "../z.npy", "a/../../z.npy", "C:\\z.npy", "..\\z.npy", "\\z.npy"]
)
def test_members_outside_the_archive_are_refused(tmp_path, name):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes()), (name, b"1")])
    with pytest.raises(
        InputError, match=r"rock\.npz: its member .* points to a path outside the archive"
    ):
        read_scan(path, {"unit": "mm", "spacing": 1})


def test_backslashes_that_only_part_folders_pass(tmp_path):
    """Windows programs write them, and the standard of X3P names vendors' files so."""
    check_archive(pack(tmp_path / "rock.zip", [("bindata\\data.bin", b"1")]))


def test_links_are_refused(tmp_path):
    link = zipfile.ZipInfo("z.npy")
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    path = pack(tmp_path / "rock.npz", [(link, "/etc/passwd")])
    with pytest.raises(InputError, match="is a link"):
        check_archive(path)


def test_encrypted_members_are_refused(tmp_path):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())])
    content = bytearray(path.read_bytes())
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.index(signature) + offset] |= 1
    path.write_bytes(content)
    with pytest.raises(InputError, match="is encrypted"):
        check_archive(path)


def test_one_name_twice_is_refused(tmp_path):
    with pytest.warns(UserWarning, match="Duplicate"):
        path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())] * 2)
    with pytest.raises(InputError, match=r"two members 'z\.npy'"):
        check_archive(path)


def test_uncommon_methods_are_refused(tmp_path):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())], zipfile.ZIP_LZMA)
    with pytest.raises(InputError, match="'deflate'"):
        check_archive(path)


def test_too_many_members_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(archives, "MAX_MEMBERS", 5)
    path = pack(tmp_path / "rock.npz", [(f"{i}.npy", b"") for i in range(6)])
    with pytest.raises(InputError, match="6 members"):
        check_archive(path)


def test_a_bomb_is_refused_by_its_ratio_alone(tmp_path):
    path = pack(tmp_path / "rock.npz", [("z.npy", bytes(archives.UNSUSPICIOUS + 1))])
    assert path.stat().st_size < 100_000
    with pytest.raises(InputError, match=r"inflates \d+ times"):
        check_archive(path)


@pytest.mark.parametrize(("change", "message"), [(-50, "more than"), (+50, "less than")])
def test_a_directory_that_lies_about_a_size_is_found_out(tmp_path, change, message):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())])
    content = bytearray(path.read_bytes())
    for signature, offset in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):  # uncompressed size
        at = content.index(signature) + offset
        (size,) = struct.unpack_from("<I", content, at)
        struct.pack_into("<I", content, at, size + change)
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        check_archive(path)


def test_flipped_bytes_are_found_by_the_checksum(tmp_path):
    path = pack(tmp_path / "rock.npz", [("z.npy", npy_bytes())], zipfile.ZIP_STORED)
    content = bytearray(path.read_bytes())
    content[200] ^= 0xFF
    path.write_bytes(content)
    with pytest.raises(InputError, match="Bad CRC-32"):
        check_archive(path)


@pytest.mark.parametrize(
    ("xml", "message"),
    [
        ('<!DOCTYPE a [<!ENTITY b "c">]><a>&b;</a>', "declares entities"),
        ('<!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>', "declares entities"),
        ("<a>" * 200 + "</a>" * 200, "nested more than 100"),
        ("<a><b></a>", "not a readable archive"),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_xml_that_would_make_a_parser_run_away_is_refused(tmp_path, xml, message, encoding):
    """Also in members of formats that other libraries parse, such as .plux."""
    path = pack(tmp_path / "rock.plux", [("index.xml", xml.encode(encoding))])
    with pytest.raises(InputError, match=message):
        check_archive(path)


def test_what_is_no_archive_passes(tmp_path):
    path = tmp_path / "rock.txt"
    path.write_text("1 2 3\n")
    check_archive(path)
