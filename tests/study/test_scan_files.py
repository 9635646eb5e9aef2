"""Files become specimens by their names alone."""

import os
import re
import unicodedata

import pytest
import yaml
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.core.file_names import specimen_name
from fractalcontact.study.checks import read_scans
from fractalcontact.study.scan_files import folder_notes, list_scans

SCHEMA = yaml.safe_load((ROOT / "config/schema/study.schema.yaml").read_text())


def find_scans(folder):
    """Scans of a folder; what is wrong with any file of it is raised."""
    scans, refused = list_scans(folder)
    for error in refused.values():
        raise error
    return scans


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


def test_a_missing_folder_is_an_error_and_an_empty_one_is_not(tmp_path):
    with pytest.raises(InputError, match=r"nowhere: no such folder \(not mounted\?\); make it"):
        find_scans(tmp_path / "nowhere")
    assert find_scans(tmp_path) == {}


@pytest.mark.parametrize("original", ["--rock", "a b/c", "Stein 3 (über)", "{x}", "-.-a", "..b"])
def test_names_are_safe_for_paths_and_wildcards(original):
    assert re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]*", specimen_name(original))


def test_a_made_safe_name_keeps_its_files(tmp_path):
    touch(tmp_path, "my rock.npy", "my rock.yaml")
    scan = find_scans(tmp_path)["my_rock"]
    assert scan.lower.name == "my rock.npy"
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
        (["{specimen}.npy"], "braces"),
        (["rock.draft.npy"], r"taken for a draft; rename the file, such as rock_draft\.npy"),
        (["rock.draft.lower.npy", "rock.draft.upper.npy"], "taken for a draft"),
        (["Rock.npy", "rock.x3p"], "differ in upper and lower case alone"),
        (["Rock.yaml", "rock.x3p"], "spell both the same if they belong together"),
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


def test_links_in_a_circle_are_named(tmp_path):
    (tmp_path / "a.npy").symlink_to(tmp_path / "b.npy")
    (tmp_path / "b.npy").symlink_to(tmp_path / "a.npy")
    with pytest.raises(InputError, match=r"a\.npy: not a readable file"):
        find_scans(tmp_path)


def test_the_folder_itself_may_be_a_link(tmp_path):
    (tmp_path / "data").mkdir()
    touch(tmp_path / "data", "rock.npy")
    (tmp_path / "data" / "twin.npy").symlink_to("rock.npy")
    (tmp_path / "scans").symlink_to("data")
    assert list(find_scans(tmp_path / "scans")) == ["rock", "twin"]


def test_a_pipe_is_refused_unopened(tmp_path):
    os.mkfifo(tmp_path / "rock.x3p")
    with pytest.raises(InputError, match=r"rock\.x3p: a pipe"):
        find_scans(tmp_path)


HOSTILE = [
    *("a b", 'it\'s "x"', "--help", "$(touch x)", "`ls`;|&<>", "*?[a]", "~a", "c\\d"),
    *("50%", "Stein (über)", "岩石", "x" * 200, "a..b", "%(x)s", "- - -e", "E", "null", "1e3"),
]


def test_hostile_names_become_safe_and_keep_their_files(tmp_path):
    touch(tmp_path, *(f"{name}.npy" for name in HOSTILE))
    scans = find_scans(tmp_path)
    assert len(scans) == len(HOSTILE)
    assert {scan.lower.name for scan in scans.values()} == {f"{name}.npy" for name in HOSTILE}
    for name in scans:
        assert re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9_.-]{0,219}", name)


def test_accents_written_in_two_ways_are_one_name(tmp_path):
    composed, decomposed = (unicodedata.normalize(form, "Öl") for form in ("NFC", "NFD"))
    assert composed != decomposed
    touch(tmp_path, f"{composed}.npy", f"{decomposed}.yaml")
    assert find_scans(tmp_path)["_l"].sidecar.name == f"{decomposed}.yaml"
    touch(tmp_path, f"{decomposed}.npy")
    with pytest.raises(InputError, match="both claim the specimen name '_l'"):
        find_scans(tmp_path)


@pytest.mark.parametrize("name", ["con", "NUL", "aux.old", "com1", "Lpt9.x"])
def test_names_of_windows_devices_are_set_apart(name):
    assert specimen_name(name) == f"_{name}"
    assert specimen_name(f"{name}crete"[:3] + "crete") == f"{name}crete"[:3] + "crete"


@pytest.mark.parametrize(
    "name",
    ["two\nlines", "\x1b[31mred", "right\u202eleft", "zero\u200bwidth", "bell\a", b"\xff\xfe"],
)
def test_invisible_characters_are_refused_and_not_repeated(tmp_path, name):
    if isinstance(name, bytes):
        try:
            (tmp_path / os.fsdecode(name + b".npy")).write_text("")
        except OSError:
            pytest.skip("this disc takes no such name")
    else:
        touch(tmp_path, f"{name}.npy")
    with pytest.raises(InputError, match="invisible characters") as error:
        find_scans(tmp_path)
    assert str(error.value).isprintable()


@pytest.mark.parametrize("original", ["x" * 200, "поверхность-" + "я" * 20, "ab" * 20])
def test_endings_that_repeat_are_broken_off(original):
    name = specimen_name(original)
    assert not re.search(r"(.+?)\1{19}$", name)
    assert name != specimen_name(f"{original}é" if original.isascii() else original.upper())
    assert specimen_name("x" * 19) == "x" * 19


def test_a_name_too_long_for_its_results_is_refused(tmp_path):
    touch(tmp_path, "xy" * 120 + ".npy")
    with pytest.raises(InputError, match="247 characters, more than the 220"):
        find_scans(tmp_path)


def test_a_folder_with_the_name_of_a_scan_file_is_refused_others_are_passed_over(tmp_path):
    for name in ("old", "2021.old", "notes.yaml.d"):
        (tmp_path / name).mkdir()
    assert find_scans(tmp_path) == {}
    touch(tmp_path, "old.yaml")
    with pytest.raises(InputError, match=r"old\.yaml: .*old is a folder"):
        find_scans(tmp_path)
    (tmp_path / "old.yaml").unlink()
    (tmp_path / "granite.x3p").mkdir()
    with pytest.raises(InputError, match=r"granite\.x3p: a folder, not a file"):
        find_scans(tmp_path)


def test_files_of_coordinates_belong_to_their_map(tmp_path):
    for name in ("film.csv", "film_x.csv", "film_y.csv", "other.csv", "slab.csv"):
        (tmp_path / name).write_text("1")
    sidecar, config = tmp_path / "film.yaml", {"study": "films", "scans": str(tmp_path)}
    sidecar.write_text("kind: contact-map\nx: film_x.csv\ny: film_y.csv\n")
    found, _, refused = read_scans(config, SCHEMA)
    assert refused == {}
    assert sorted(found) == ["film", "other", "slab"]
    assert [path.name for path in found["film"].files] == ["film.csv", "film_x.csv", "film_y.csv"]
    assert found["slab"].files == (tmp_path / "slab.csv",)
    sidecar.write_text("kind: contact-map\nx: absent.csv\ny: film_y.csv\n")
    refused = read_scans(config, SCHEMA)[2]
    assert "x: no file absent.csv beside it" in str(refused["film"])


LEFT = [
    *("rock.npy~", "Thumbs.db", "desktop.ini", "~$table.csv", "rock.npy.bak", "._rock.npy"),
    *(
        "#rock.npy#",
        "#rock.yaml#",
        "rock.npy.~1~",
        "rock.yaml.save",
        "rock.npy.save.1",
        "rock.npy.swo",
    ),
    *("rock.npy.partial", "rock.npy.filepart", "rock.npy.download"),
]


@pytest.mark.parametrize("name", LEFT)
def test_what_systems_and_editors_leave_is_passed_over_with_a_note(tmp_path, name):
    touch(tmp_path, name, "rock.npy")
    scans, refused = list_scans(tmp_path)
    assert (list(scans), refused) == (["rock"], {})
    if not name.startswith("."):
        (note,) = folder_notes(tmp_path)
        assert note.endswith(f"passed over, as systems and editors leave such files: {name}")
    (tmp_path / name).unlink()
    assert folder_notes(tmp_path) == []


@pytest.mark.parametrize(
    ("lower", "upper", "stem"),
    [
        ("rock_lower.xyz", "rock_upper.xyz", "rock"),
        ("my rock-Lower.csv", "my rock-Upper.csv", "my rock"),
        ("rock_bottom.x3p", "rock_top.x3p", "rock"),
        ("rockLower.npy", "rockUpper.npy", "rock"),
    ],
)
def test_faces_called_otherwise_are_hinted_at(tmp_path, lower, upper, stem):
    touch(tmp_path, lower, upper)
    ending = os.path.splitext(lower)[1]
    (note,) = folder_notes(tmp_path)
    assert f"{lower} and {upper} are taken as two specimens" in note
    assert note.endswith(f"rename them {stem}.lower{ending} and {stem}.upper{ending}")
    assert len(find_scans(tmp_path)) == 2
    touch(tmp_path, f"{stem}.yaml")
    with pytest.raises(InputError, match=rf"are its faces if they are called {stem}\.lower"):
        find_scans(tmp_path)


@pytest.mark.parametrize("names", [("flower.csv", "fupper.csv"), ("a_lower.csv",), ("blower.npy",)])
def test_names_that_only_end_alike_are_not(tmp_path, names):
    touch(tmp_path, *names)
    assert folder_notes(tmp_path) == []


@pytest.mark.parametrize("face", ["lower", "upper", "Lower"])
def test_a_sidecar_of_one_face_is_told_its_name(tmp_path, face):
    touch(tmp_path, "own.lower.xyz", "own.upper.xyz", f"own.{face}.yaml")
    scans, refused = list_scans(tmp_path)
    assert list(scans) == ["own"]
    (error,) = refused.values()
    assert str(error).endswith("one sidecar serves both faces of a joint; rename it own.yaml")


@pytest.mark.parametrize(
    ("lower", "upper", "common"),
    [
        ("rock_bottom.x3p", "rock_top.x3p", "rock"),
        ("M_CNL_SideA_bottom.txt", "M_CNL_SideB_top.txt", "M_CNL"),
        ("SampleSideA.csv", "SampleSideB.csv", "Sample"),
    ],
)
def test_how_others_name_the_faces_of_a_joint_is_seen(tmp_path, lower, upper, common):
    for name in (lower, upper):
        (tmp_path / name).write_text("1")
    (note,) = folder_notes(tmp_path)
    ending = lower.rpartition(".")[2]
    assert f"rename them {common}.lower.{ending} and {common}.upper.{ending}" in note
