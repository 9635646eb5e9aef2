"""Files become specimens by their names alone."""

import re

import pytest

from fractalcontact.catalogue import find_scans, specimen_name
from fractalcontact.errors import InputError


def touch(folder, *names):
    for name in names:
        (folder / name).write_text("")


def test_one_face_two_faces_and_sidecars(tmp_path):
    touch(tmp_path, "rock.x3p", "joint.lower.txt", "joint.upper.csv", "joint.yaml", "a.1.xyz")
    scans = find_scans(tmp_path)
    assert list(scans) == ["a.1", "joint", "rock"]
    assert scans["rock"].lower == tmp_path / "rock.x3p"
    assert scans["rock"].upper is None
    assert scans["rock"].sidecar is None
    assert scans["joint"].lower == tmp_path / "joint.lower.txt"
    assert scans["joint"].upper == tmp_path / "joint.upper.csv"
    assert scans["joint"].sidecar == tmp_path / "joint.yaml"


def test_what_is_no_scan_is_passed_over(tmp_path):
    touch(
        tmp_path, "README.md", "LICENSE", "LICENSE.txt", ".DS_Store", ".rock.npy.swp", "b.unknown"
    )
    (tmp_path / "older").mkdir()
    touch(tmp_path / "older", "rock.npy")
    assert list(find_scans(tmp_path)) == ["b"]


def test_a_missing_folder_holds_no_scans(tmp_path):
    assert find_scans(tmp_path / "nowhere") == {}


@pytest.mark.parametrize("original", ["--rock", "a b/c", "Stein 3 (über)", "{x}", "-.-a", "..b"])
def test_names_are_safe_for_paths_and_wildcards(original):
    assert re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", specimen_name(original))


def test_a_made_safe_name_keeps_its_original(tmp_path):
    touch(tmp_path, "my rock.npy", "my rock.yaml")
    scan = find_scans(tmp_path)["my_rock"]
    assert scan.original_name == "my rock"
    assert scan.sidecar.name == "my rock.yaml"


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (["rock.npy", "rock.x3p"], "both claim the specimen name 'rock'"),
        (["my rock.npy", "my_rock.npy"], "both claim the specimen name 'my_rock'"),
        (["rock.npy", "rock.lower.npy", "rock.upper.npy"], "both claim"),
        (["rock.yaml", "rock.yml", "rock.npy"], "both claim"),
        (["rock.lower.npy"], r"upper face is missing; add rock\.upper\.npy"),
        (["rock.upper.xyz"], r"lower face is missing; add rock\.lower\.xyz"),
        (["rock.yaml"], "this sidecar has no scan"),
        (["--.npy"], "letters or digits"),
    ],
)
def test_names_that_do_not_go_together_are_refused(tmp_path, names, message):
    touch(tmp_path, *names)
    with pytest.raises(InputError, match=message):
        find_scans(tmp_path)


def test_links_stay_inside_the_folder(tmp_path):
    folder = tmp_path / "scans"
    folder.mkdir()
    touch(tmp_path, "outside.npy")
    touch(folder, "inside.npy")
    (folder / "link.npy").symlink_to(folder / "inside.npy")
    assert list(find_scans(folder)) == ["inside", "link"]
    (folder / "bad.npy").symlink_to(tmp_path / "outside.npy")
    with pytest.raises(InputError, match=r"bad\.npy: this link leads out"):
        find_scans(folder)


def test_a_broken_link_is_named(tmp_path):
    (tmp_path / "rock.npy").symlink_to(tmp_path / "gone.npy")
    with pytest.raises(InputError, match=r"rock\.npy: not a readable file"):
        find_scans(tmp_path)
