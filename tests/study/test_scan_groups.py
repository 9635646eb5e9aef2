"""Specimens in folders of groups, or named by a table: names, groups, what each is told, errors."""

import pytest

from fractalcontact.core.errors import InputError
from fractalcontact.study.checks import resolve_study
from fractalcontact.study.scan_groups import FOLDERS, grouped_notes, list_grouped

STUDY = {
    "study": "test",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
    "defaults": {"material": "rock", "loads": ["1 MPa", "5 MPa"], "resolutions": [1]},
}


def touch(folder, *names):
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")


def study(folder, **keys):
    return resolve_study({**STUDY, "scans": str(folder), **keys}, "test.yaml")


@pytest.fixture
def folders(tmp_path):
    """Two groups of two, a specimen beside them, and what is passed over."""
    touch(tmp_path, "hard/s1.npy", "hard/s2.lower.npy", "hard/s2.upper.npy", "soft/s1.npy")
    touch(tmp_path, "soft/s2.npy", "alone.npy", ".hidden/s1.npy", "README/s1.npy")
    (tmp_path / "hard.yaml").write_text("unit: um\nlabel: of the hard ones\nmaterial: rock\n")
    (tmp_path / "hard/s1.yaml").write_text("unit: mm\nwindow: 5 mm\n")
    (tmp_path / "soft/s2.yaml").write_text("group: other\n")
    return tmp_path


def test_folders_are_groups_and_give_their_names(folders):
    found = study(folders, groups=FOLDERS)
    assert sorted(found.settings) == ["alone", "hard_s1", "hard_s2", "soft_s1", "soft_s2"]
    groups = {name: settings.group for name, settings in found.settings.items()}
    assert groups == {
        "alone": "",
        "hard_s1": "hard",
        "hard_s2": "hard",
        "soft_s1": "soft",
        "soft_s2": "other",
    }
    assert found.scans["hard_s2"].upper == folders / "hard/s2.upper.npy"


def test_a_group_has_one_sidecar_and_a_specimens_own_comes_first(folders):
    found = study(folders, groups=FOLDERS)
    assert found.options["hard_s2"] == {"unit": "um"}
    assert found.options["hard_s1"] == {"unit": "mm"}
    assert found.settings["hard_s1"].window == 5
    assert found.settings["hard_s1"].label == "of the hard ones"
    assert found.settings["soft_s1"].label == "soft_s1"


def test_without_the_key_folders_are_passed_over(folders):
    (folders / "hard.yaml").unlink()
    assert sorted(list_grouped(folders, None)[0]) == ["alone"]


def test_a_study_may_say_the_group_itself(folders):
    found = study(folders, groups=FOLDERS, specimens={"soft_s1": {"group": "mine"}})
    assert found.settings["soft_s1"].group == "mine"


def test_two_specimens_of_one_name_are_refused(tmp_path):
    touch(tmp_path, "a_b/c.npy", "a/b_c.npy", "d.npy", "D/x.npy")
    with pytest.raises(InputError, match=r"called 'a_b_c'.*rename one"):
        study(tmp_path, groups=FOLDERS)


def test_links_out_of_the_folder_are_refused(tmp_path):
    touch(tmp_path, "out/s1.npy", "scans/in/s1.npy")
    (tmp_path / "scans/linked").symlink_to(tmp_path / "out")
    (tmp_path / "scans/in/s2.npy").symlink_to(tmp_path / "out/s1.npy")
    scans, refused = list_grouped(tmp_path / "scans", FOLDERS)
    assert sorted(scans) == ["in_s1"]
    assert all("link" in str(error) for error in refused.values())
    assert len(refused) == 2


def test_notes_are_of_every_folder(folders):
    touch(folders, "hard/Thumbs.db", "soft/x_lower.npy", "soft/x_upper.npy")
    notes = grouped_notes(folders, FOLDERS)
    assert any("Thumbs.db" in note for note in notes)
    assert any("x.lower.npy" in note for note in notes)


TABLE = """\
name;file;lower;upper;group;unit;window;resolutions
first;a/s1.npy;;;hard;um;5 mm;
;a/s2.npy;;;"soft; 2";mm;;[1, 2]

pair;;b/s1.npy;b/s2.npy;3;mm;;
"""


@pytest.fixture
def table(tmp_path):
    touch(tmp_path, "scans/a/s1.npy", "scans/a/s2.npy", "scans/b/s1.npy", "scans/b/s2.npy")
    touch(tmp_path, "scans/not_named.npy")
    (tmp_path / "scans/a/s2.yaml").write_text("unit: um\nlabel: of its sidecar\n")
    path = tmp_path / "table.csv"
    path.write_text(TABLE, encoding="utf-8-sig")
    return path


def test_a_table_names_files_groups_and_keys(table):
    found = study(table.parent / "scans", groups=str(table))
    assert sorted(found.settings) == ["first", "pair", "s2"]
    assert [found.settings[name].group for name in ("first", "pair", "s2")] == [
        "hard",
        "3",
        "soft; 2",
    ]
    assert found.settings["first"].window == 5
    assert found.settings["s2"].resolutions == [1, 2]
    assert found.options["s2"] == {"unit": "mm"}
    assert found.settings["s2"].label == "of its sidecar"
    assert found.scans["pair"].upper.name == "s2.npy"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("name,group\na,b\n", "names no files"),
        ("file,group,group\na/s1.npy,b,c\n", "two columns are called 'group'"),
        ("file,group\na/s1.npy\n", "line 2: 1 cells, expected 2"),
        ("file,group\na/s3.npy,x\n", "line 2: file: no file"),
        ("file\n../table.csv\n", "leads out of"),
        ("file\n/etc/passwd\n", "leads out of"),
        ("file,lower,upper\na/s1.npy,a/s1.npy,a/s2.npy\n", "one face under 'file'"),
        ("lower,upper\na/s1.npy,\n", "one face under 'file'"),
        ("file,wndow\na/s1.npy,5 mm\n", "line 2: unknown key 'wndow'; did you mean 'window'"),
        ("file,window\na/s1.npy,5\n", "line 2: window: 5 is not right"),
        ("file,window\na/s1.npy,[1\n", "line 2: window: not readable"),
        ("file\na/s1.npy\nb/s1.npy\n", "line 3: a second specimen 's1'"),
        ("file,threshold\na/s1.npy,3\n", "line 2: key 'threshold' has no meaning"),
        ('file\n"a/s1.npy\n', "no table of cells"),
    ],
)
def test_what_is_wrong_with_a_table_is_named(table, text, words):
    table.write_text(text)
    with pytest.raises(InputError, match=words) as found:
        study(table.parent / "scans", groups=str(table))
    assert "table.csv" in str(found.value)


def test_a_table_that_is_none_is_refused(table):
    table.write_bytes(b"file\n\xff\xfe\n")
    with pytest.raises(InputError, match="not text in UTF-8"):
        study(table.parent / "scans", groups=str(table))
    with pytest.raises(InputError, match=r"nowhere\.csv: cannot be read"):
        study(table.parent / "scans", groups="nowhere.csv")


def test_a_bad_row_leaves_out_itself_alone(table):
    table.write_text("file,group\na/s1.npy,x\na/s3.npy,y\n")
    found = resolve_study(
        {**STUDY, "scans": str(table.parent / "scans"), "groups": str(table)},
        "test.yaml",
        leave_out=True,
    )
    assert sorted(found.settings) == ["s1"]
    assert len(found.refused) == 1
