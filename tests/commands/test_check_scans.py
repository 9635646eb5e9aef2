"""`make check-scans`: every file of a folder in one table, whatever is wrong with some of them."""

import shutil

import numpy as np
import pytest
from places import ROOT
from stated import COMMAS, CORONA, GRANITE, MAP, NANOVEA, POINTS, array_sidecar, sidecar

from fractalcontact.commands.check_scans import WIDTH, check_scans, main
from fractalcontact.study.embedded import write_scan
from fractalcontact.study.scan_files import list_scans
from fractalcontact.surface.synthesis import self_affine

SCANS = ROOT.parent / "shared" / "scans"
ARGUMENTS = ("--study", "config/paper.yaml")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    return tmp_path / "scans"


@pytest.fixture
def check(folder, capsys):
    def run():
        code = main([str(folder), *ARGUMENTS])
        return code, capsys.readouterr().out

    return run


#: The sidecar of a contact map in three files.
FILM = sidecar(
    {key: value for key, value in MAP.items() if key != "first_row"},
    **COMMAS,
    unit="mm",
    x="film_x.csv",
    y="film_y.csv",
)


def surface(n=64, noise=0.0, seed=1):
    rng = np.random.default_rng(seed)
    return self_affine((n, n), 0.2, 0.8, rms=0.1, seed=seed) + noise * rng.normal(size=(n, n))


def test_a_good_scan_is_ok(folder, check):
    write_scan(folder / "slab.npy", surface(), 0.2, sidecar={})
    code, out = check()
    assert code == 0
    assert "64 x 64     0.2 mm     12.8 x 12.8" in out
    assert "lower face: numpy" in out
    assert "1 ok, 0 with warnings, 0 refused" in out


def test_faces_that_overlap_are_warned_of(folder, check):
    lower, spiked = surface(), surface()
    spiked[32, 32] += 1.0
    for name, face in (("sound", lower), ("spiked", spiked)):
        options = {"registration": "none"}
        write_scan(folder / f"{name}.lower.npy", face, 0.2, sidecar={})
        write_scan(folder / f"{name}.upper.npy", lower + 0.4, 0.2, sidecar={})
        for side in ("lower", "upper"):
            (folder / f"{name}.{side}.yaml").unlink()
        text = "".join(f"{key}: {value}\n" for key, value in options.items())
        (folder / f"{name}.yaml").write_text(array_sidecar(0.2) + text)
    code, out = check()
    out = " ".join(out.split())
    assert code == 0
    assert "1 ok, 1 with warnings" in out
    assert "the faces overlap in no cell of the window (0 in the whole scan)" in out
    assert "WARNING: the faces overlap as scanned in 1 cell of the window" in out
    assert out.count("the faces overlap as scanned") == 1
    assert "suspicious: 1 lone spikes" in out


def test_one_bad_file_keeps_no_other_from_being_read(folder, check):
    for name in ("a", "z"):
        write_scan(folder / f"{name}.npy", surface(), 0.2, sidecar={})
    np.save(folder / "unitless.npy", surface())
    (folder / "empty.csv").write_text("")
    (folder / "lonely.yaml").write_text("unit: mm\n")
    (folder / "half.lower.xyz").write_text("1 2 3\n")
    (folder / "two.csv").write_text("1")
    (folder / "two.txt").write_text("1")
    write_scan(folder / "typo.npy", surface(), 0.2, sidecar={"spacng": 1})
    code, out = check()
    assert code == 1
    assert "2 ok, 0 with warnings, 6 refused" in out
    for words in (
        "is read only with a complete sidecar, and it has no sidecar",
        "unit: # FILL IN: of x, y and z",
        "empty",
        "this sidecar has no scan",
        "the upper face is missing",
        "both claim",
        "unknown key 'spacng'",
    ):
        assert " ".join(words.split()) in " ".join(out.split())  # wherever lines are broken


def test_a_noisy_scan_is_warned_of(folder, check):
    write_scan(folder / "noisy.npy", surface(128, noise=0.05), 0.2, sidecar={})
    code, out = check()
    assert code == 0
    assert "WARNING: spacings of 0.2" in out
    assert "0 ok, 1 with warnings" in out


def test_a_scan_that_has_no_dimension_is_warned_of(folder, check):
    y, x = np.mgrid[-1:1:128j, -1:1:128j]
    hill = np.exp(-(x**2) - y**2)
    write_scan(folder / "hill.npy", hill, 0.2, sidecar={})
    rolled = self_affine((256, 256), 0.2, 0.8, rms=0.1, seed=1, roll_off=6.4)
    write_scan(folder / "rolled.npy", rolled, 0.2, sidecar={})
    code, out = check()
    text = " ".join(out.split())
    assert code == 0
    assert "WARNING: no surface dimension: Delta_g" in text
    assert "does not lie between 2 and 3" in text
    assert text.count("no surface dimension") == 1
    assert "by roughness length, lags" in text
    assert "up to a quarter of the roll-off at" in text


def test_a_pair_and_a_contact_map(folder, check):
    for face, seed in (("lower", 1), ("upper", 2)):
        z = surface() + 0.01 * surface(seed=seed) + 0.3 * (face == "upper")
        write_scan(folder / f"joint.{face}.npy", z, 0.2, sidecar={})
        (folder / f"joint.{face}.yaml").rename(folder / "joint.yaml")
    film = MAP
    np.save(folder / "film.npy", (surface() > 0.1).astype(float))
    (folder / "film.yaml").write_text(sidecar(film, unit="mm", spacing=0.2))
    code, out = check()
    assert code == 0
    assert "gap: mean 0.3 mm" in out
    assert "% in contact above 0.5" in out
    assert "no load stated" in out


def test_a_map_shows_its_area_and_pressure_and_its_coordinates_are_no_scans(folder, check):
    folder.mkdir()
    x, y = 0.5 * np.arange(40), 0.5 * np.arange(32)
    values = np.zeros((32, 40))
    values[8:24, 12:28] = 7.0
    for name, numbers in (("film_x", [x]), ("film_y", [y]), ("film", values)):
        np.savetxt(folder / f"{name}.csv", numbers, delimiter=",")
    stated = f"{FILM}threshold: [3, 5]\nload: 640 N\nseries: films\n"
    (folder / "film.yaml").write_text(stated)
    code, out = check()
    text = " ".join(out.split())
    assert code == 0
    assert "0 ok, 1 with warnings, 0 refused" in text
    assert "A_0 = 320 mm2 (outline: rectangle), 20 % in contact above 3, series films" in text
    assert "F = 640 N, F/A_0 = 2 MPa" in text
    assert "in contact 20 % above 3, 20 % above 5" in text
    assert "write 'outline: disc'" in text
    (folder / "film.yaml").write_text(f"{stated}outline: {{disc: {{diameter: 12 mm}}}}\n")
    _, out = check()
    assert "1 ok, 0 with warnings" in out
    assert "(outline: disc of diameter 12 mm)" in " ".join(out.split())
    (folder / "film.yaml").write_text(stated.replace("film_x.csv", "nothing.csv"))
    code, out = check()
    assert code == 1
    assert "x: no file nothing.csv beside it" in " ".join(out.split())


def test_a_file_of_coordinates_that_a_link_takes_elsewhere_is_not_read(folder, check, tmp_path):
    folder.mkdir()
    np.savetxt(tmp_path / "secret.csv", [0.5 * np.arange(40)], delimiter=",")
    (folder / "film_x.csv").symlink_to(tmp_path / "secret.csv")
    np.savetxt(folder / "film_y.csv", [0.5 * np.arange(32)], delimiter=",")
    np.savetxt(folder / "film.csv", np.eye(32, 40), delimiter=",")
    (folder / "film.yaml").write_text(FILM)
    code, out = check()
    assert code == 1
    assert "film_x.csv: this link leads out of" in " ".join(out.split())
    assert "A_0" not in out


def test_two_faces_that_do_not_match_or_share_no_frame_are_told(folder, check):
    z = surface()
    folder.mkdir()
    y, x = (0.2 * index for index in np.indices(z.shape))
    for name, upper in (("strange", surface(seed=9)), ("mounted", z)):
        for face, heights, shift in (("lower", z, 0.0), ("upper", upper, 70.0)):
            points = np.column_stack([x.ravel() + shift, y.ravel(), heights.ravel() + shift])
            np.savetxt(folder / f"{name}.{face}.xyz", points)
        (folder / f"{name}.yaml").write_text(sidecar(POINTS, delimiter="blank"))
    code, out = check()
    text = " ".join(out.split())
    assert code == 1
    assert "sd before unknown" in text
    assert "strange.lower.xyz" in text
    assert ", 1 refused" in text


@pytest.mark.parametrize("name", ["a\x1b[31mred", "two\nlines", "-rf", "x" * 200, "Zürich 岩"])
def test_names_that_act_on_a_terminal_are_escaped_and_lines_stay_short(folder, check, name):
    folder.mkdir()
    (folder / f"{name}.csv").write_text("")
    code, out = check()
    assert code == 1
    assert "\x1b" not in out
    lines = out.splitlines()
    assert sum(line.strip().startswith("REFUSED") for line in lines) == 1
    assert max(map(len, lines)) <= max(WIDTH, len(str(folder)) + 8)


def test_a_missing_folder_is_one_error(folder, capsys):
    assert main([str(folder), *ARGUMENTS]) == 1
    assert capsys.readouterr().err.startswith(f"error: {folder}: no such folder (not mounted?)")


def test_an_empty_folder_is_no_error(folder, check):
    folder.mkdir()
    code, out = check()
    assert code == 0
    assert "0 ok, 0 with warnings, 0 refused" in out


def test_a_wrong_study_is_one_error(folder, capsys):
    folder.mkdir(parents=True)
    (folder / "study.yaml").write_text("scans: null\n")
    assert main([str(folder), "--study", str(folder / "study.yaml"), *ARGUMENTS[2:]]) == 1
    assert "missing key" in capsys.readouterr().err


def test_a_refused_file_takes_its_specimen_with_it_but_no_other(folder):
    folder.mkdir()
    for name in ("a.csv", "a.npy", "b.csv"):
        (folder / name).write_text("1")
    scans, refused = list_scans(folder)
    assert list(scans) == ["b"]
    assert list(refused) == ["a"]


@pytest.mark.full
@pytest.mark.scans
@pytest.mark.skipif(not SCANS.is_dir(), reason="the real scans are not beside the project")
def test_real_scans_are_read_with_the_sidecars_their_readme_asks_for(folder, check):
    folder.mkdir()
    granite = SCANS / "cnl_granite_pair"
    shutil.copy(granite / "Extracted_M_CNL_SideA_bottom.txt", folder / "granite.lower.txt")
    shutil.copy(granite / "Extracted_M_CNL_SideB_top.txt", folder / "granite.upper.txt")
    (folder / "granite.yaml").write_text(sidecar(GRANITE))
    shutil.copy(SCANS / "corona_fault/coronaA_grids.npz", folder / "corona.npz")
    (folder / "corona.yaml").write_text(sidecar(CORONA, spacing=0.0056858))
    shutil.copy(SCANS / "nanovea/test4.txt", folder / "test4.txt")
    (folder / "test4.yaml").write_text(sidecar(NANOVEA))
    instruments = SCANS / "instruments/surfacetopography"
    shutil.copy(instruments / "di_corrupted.di", folder)
    code, out = check()
    assert code == 1
    assert out.count("REFUSED") == 1
    assert "di_corrupted.di" in out
    assert "gap: mean 0.6" in out
    assert "537 x 388" in out
    assert "5.69 mm    3050 x 2210" in out
    assert "0.515 mm" in out


# --- what the study would refuse, and what files hold that is hardly right ---------------------


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"offsets": ["40 mm"]}, "slides the window out of the scan"),
        pytest.param(
            {"offsets": ["0.01 mm"]}, "less than half its spacing", marks=pytest.mark.full
        ),
        pytest.param({"window": "90 mm"}, "key 'window' asks for", marks=pytest.mark.full),
        pytest.param(
            {"window": "12.8 mm", "offsets": "auto"},
            "cannot slide by even one cell",
            marks=pytest.mark.full,
        ),
        ({"window_centre": ["50 mm", "5 mm"]}, "outside the scan, which covers x = 0.1"),
        pytest.param({"offsets": ["-1 mm"]}, "is negative", marks=pytest.mark.full),
        pytest.param(
            {"loads": ["1 kN"]}, "slab.yaml: loads: ['1 kN'] lacks", marks=pytest.mark.full
        ),
        pytest.param({"threshold": 5}, "key 'threshold' has no meaning", marks=pytest.mark.full),
    ],
)
def test_what_the_study_refuses_is_refused_here(folder, check, keys, said):
    write_scan(folder / "slab.npy", surface(), 0.2, sidecar=keys)
    code, out = check()
    text = " ".join(out.split())
    assert code == 1
    assert said in text
    assert "slab" in text
    assert "0 ok, 0 with warnings, 1 refused" in text


def test_outliers_are_not_the_only_word_on_a_misread_file(folder, check):
    z = surface()
    z[10, 10], z[30, 40] = 500.0, -300.0
    write_scan(folder / "misread.npy", z, 0.2, sidecar={})
    z = surface()
    z[10, 10] += 1.0
    write_scan(folder / "spiked.npy", z, 0.2, sidecar={})
    _, out = check()
    misread, spiked = (" ".join(part.split()) for part in out.split("spiked.npy"))
    assert (
        "2 outliers filled in the study, up to 500 mm from the mean plane where the relief of all"
        in misread
    )
    assert "probably mark missing cells, or the file is misread" in misread
    assert "1 outlier filled in the study, up to" in spiked
    write_scan(folder / "spiked.npy", z, 0.2, sidecar={"outliers": "keep"})
    assert "1 outlier kept, up to" in " ".join(check()[1].split())
    assert "misread" not in spiked


def alternating(n):
    return 0.05 * (-1.0) ** np.arange(n)


SUSPICIOUS = {
    " x exactly 0, many": lambda z: np.where(np.indices(z.shape).min(axis=0) < 4, 0.0, z),
    "alternate columns of the lower": lambda z: z + alternating(len(z)),
    "alternate rows of the lower": lambda z: z + alternating(len(z))[:, np.newaxis],
    "52 % of the cells are missing": lambda z: np.where(np.arange(len(z)) > 30, np.nan, z),
}


@pytest.mark.parametrize(
    "said",
    [
        pytest.param(said, marks=() if i < 2 else pytest.mark.full)
        for i, said in enumerate(SUSPICIOUS)
    ],
)
def test_what_is_suspicious_about_a_file_is_warned_of(folder, check, said):
    keys = {"window": "auto", "offsets": "auto"}
    folder.mkdir()
    np.save(folder / "slab.npy", SUSPICIOUS[said](surface()))
    (folder / "slab.yaml").write_text(array_sidecar(0.2, **keys, missing=-1))
    code, out = check()
    text = " ".join(out.split())
    assert code == 0
    assert "WARNING: " in text
    assert said in text


def test_two_tables_in_one_file_are_warned_of(folder, check):
    z = surface()
    tables = np.vstack([z, z[::-1] + 3.0])
    keys = {"window": "auto", "offsets": "auto"}
    write_scan(folder / "slab.npy", tables, 0.2, sidecar=keys)
    code, out = check()
    assert code == 0
    assert "rows 64 and 65 differ" in out
    assert "0 ok, 1 with warnings" in out


def test_faces_in_the_wrong_order_are_named(folder, check):
    z = surface()
    for face, heights in (("lower", z + 0.3), ("upper", z + 0.01 * surface(seed=2))):
        write_scan(folder / f"joint.{face}.npy", heights, 0.2, sidecar={})
        (folder / f"joint.{face}.yaml").rename(folder / "joint.yaml")
    code, out = check()
    assert code == 0
    assert "exchange 'lower' and 'upper' in their names" in " ".join(out.split())
    with (folder / "joint.yaml").open("a") as sidecar:
        sidecar.write("registration: none\n")
    code, out = check()
    assert code == 1
    assert "REFUSED" in out
    assert "exchange 'lower' and 'upper' in the names of the files" in " ".join(out.split())


def test_what_is_passed_over_and_likely_pairs_stand_below_the_table(folder, check):
    for name in ("rock_lower", "rock_upper"):
        write_scan(folder / f"{name}.npy", surface(), 0.2, sidecar={})
    (folder / "Thumbs.db").write_text("")
    code, out = check()
    text = " ".join(out.split())
    assert code == 0
    assert "NOTE: " in text
    assert "passed over, as systems and editors leave such files: Thumbs.db" in text
    assert "rename them rock.lower.npy and rock.upper.npy" in text
    assert "2 ok, 0 with warnings, 0 refused" in text


@pytest.fixture
def check_groups(folder, capsys, tmp_path):
    """`make check-scans` of a study whose specimens are in groups."""

    def run(groups):
        study = (ROOT / "config/paper.yaml").read_text()
        (tmp_path / "study.yaml").write_text(f"{study}\ngroups: {groups}\n")
        code = main([str(folder), "--study", str(tmp_path / "study.yaml"), *ARGUMENTS[2:]])
        return code, " ".join(capsys.readouterr().out.split())

    return run


def test_scans_in_folders_of_groups_are_read_with_what_their_group_says(folder, check_groups):
    for name in ("hard/a", "soft/a"):
        write_scan(folder / f"{name}.npy", surface(), 0.2, sidecar={})
        (folder / f"{name}.yaml").unlink()  # the group says it
    (folder / "hard.yaml").write_text(array_sidecar(0.2))
    (folder / "soft.yaml").write_text(array_sidecar(0.2, hieghts=3))
    code, out = check_groups("folders")
    assert code == 1
    assert "hard_a 1 64 x 64" in out
    assert "group hard: a.npy + hard.yaml" in out
    assert "REFUSED: " in out
    assert "soft.yaml: " in out
    assert "1 ok" in out
    assert "1 refused" in out


def test_scans_of_a_table_are_read_with_what_their_row_says(folder, check_groups, tmp_path):
    write_scan(folder / "a.npy", surface(), 0.2, sidecar={})
    write_scan(folder / "unlisted.npy", surface(), 0.2, sidecar={})
    table = tmp_path / "table.csv"
    table.write_text("file,name,group,material\na.npy,one,hard,sandstone\nb.npy,two,soft,\n")
    code, out = check_groups(table)
    assert code == 1
    assert "one 1 64 x 64" in out
    assert f"{table}: line 2" in out
    assert "line 3: file: no file" in out
    assert "unlisted" not in out
    assert "1 refused" in out


# --- checks that see what a file means ---------------------------------------------------------


def write_pair(folder, name, lower, upper, **keys):
    folder.mkdir(exist_ok=True)
    for face, heights in (("lower", lower), ("upper", upper)):
        np.save(folder / f"{name}.{face}.npy", heights)
    (folder / f"{name}.yaml").write_text(array_sidecar(0.2, **keys))


def test_one_file_given_as_both_faces_is_warned_of(folder, check):
    write_pair(folder, "twice", surface(), surface())
    write_pair(folder, "joint", surface(), surface() + 0.3)
    _, out = check()
    joint, twice = (" ".join(part.split()) for part in out.split("twice.lower.npy"))
    assert "both faces are one file, byte for byte" in twice
    assert "both faces are one file" not in joint


def test_a_name_that_speaks_of_no_face_is_warned_of(folder, check):
    for name in ("granite_aperture", "gap-3", "stopgap"):
        write_scan(folder / f"{name}.npy", surface(), 0.2, sidecar={})
    _, out = check()
    assert " ".join(out.split()).count("its name suggests the opening") == 2
    assert "1 ok, 2 with warnings" in out


def test_a_pair_in_one_frame_that_registration_moves_is_warned_of(folder, check):
    whole = self_affine((96, 96), 0.2, 0.8, rms=0.3, seed=4, roll_off=8.0)
    moved, still = whole[3:83, 3:83], whole[2:82, 2:82]
    noise = 1e-4 * np.random.default_rng(0).normal(size=moved.shape)
    write_pair(folder, "moved", still, moved + 0.5 + noise)
    write_pair(folder, "still", still, still + 0.5 + noise)
    _, out = check()
    moved, still = (" ".join(part.split()) for part in out.split("still.lower.npy"))
    assert "registration moves the upper one by" in moved
    assert "write 'registration: none' if the files share one frame" in moved
    assert "registration moves the upper one by" not in still


CLOSURE = {"file": "load.csv", "gauge": "joint", "seat": "0.25 MPa", "branch": "load", "cycle": 1}
GOOD = "pressure [MPa], displacement [um]\n" + "".join(
    f"{n},{np.log(n):.3f}\n" for n in range(1, 9)
)
HELD = {"file": "load.csv", "pressure": "25 MPa", "direction": "W"}
SLIDING = "displacement [mm], dilation [mm]\n" + "".join(f"{n},{{}}{n}\n" for n in range(6))


@pytest.mark.parametrize(
    ("stated", "text", "words"),
    [
        ({"closure": CLOSURE}, GOOD.replace("4,", "04. Apr,"), "line 5, column 'pressure [MPa]'"),
        ({"closure": CLOSURE}, GOOD.replace("[um]", "[m]"), "more than the relief of its faces"),
        ({"closure": CLOSURE | {"branch": "unload"}}, GOOD, "rises again from 1 MPa (line 2)"),
        ({"dilatancy": HELD}, SLIDING.format(*"------"), "the dilation falls while the joint"),
        ({"dilatancy": HELD | {"pressure": "900 MPa"}}, SLIDING.format(*6 * [""]), "lies outside"),
        ({"dilatancy": HELD | {"direction": "E"}}, SLIDING.format(*6 * [""]), "towards E was not"),
    ],
)
def test_a_table_that_would_stop_the_study_is_refused(folder, check, stated, text, words):
    write_scan(folder / "slab.npy", surface(), 0.2, sidecar={"measured": stated})
    (folder / "load.csv").write_text(text)
    code, out = check()
    assert code == 1
    assert "0 ok, 0 with warnings, 1 refused" in out
    assert words in " ".join(out.split())


def test_tables_are_listed_and_what_is_odd_in_them_is_said(folder, check):
    stated = {"closure": CLOSURE, "dilatancy": HELD | {"file": "slid.csv"}}
    write_scan(folder / "slab.npy", surface(), 0.2, sidecar={"measured": stated})
    (folder / "load.csv").write_text(GOOD + "7.9,2.07\n")
    (folder / "slid.csv").write_text(SLIDING.format(*6 * [""]))
    code, out = check()
    out = " ".join(out.split())
    assert code == 0
    assert "0 ok, 1 with warnings, 0 refused" in out
    assert "closure test load, cycle 1: load.csv, 9 readings" in out
    assert "falls back from one reading to the next in 1 of 8 steps" in out
    assert "slid.csv: the dilation equals the displacement" in out


def test_tables_of_embedded_specimens_are_read(folder, tmp_path):
    study = {
        "study": "made",
        "scans": str(folder),
        "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
        "defaults": {"material": "rock", "loads": ["1 MPa"], "resolutions": [1]},
        "embedded": {"made": {"grid": 64, "spacing": "0.2 mm", "hurst": 0.8, "rms": "0.1 mm"}},
        "specimens": {"made": {"measured": {"closure": CLOSURE}}},
    }
    folder.mkdir()
    (folder / "load.csv").write_text(GOOD)
    (row,) = check_scans(folder, study, "study.yaml")
    assert (row.name, row.refusal) == ("made", "")
    (folder / "load.csv").unlink()
    (row,) = check_scans(folder, study, "study.yaml")
    assert "no such file, which 'measured' names" in row.refusal
    (folder / "load.csv").write_text(GOOD.replace("4,", "four,"))
    (row,) = check_scans(folder, study, "study.yaml")
    assert "line 5, column 'pressure [MPa]': 'four' is no finite number" in row.refusal


@pytest.mark.parametrize(
    ("factor", "noise", "spacing", "warned"),
    [(1, 0, 0.2, False), (1e-3, 0, 0.2, True), (1e-3, 0, 2e-4, True), (1, 0.8, 0.2, True)],
)
def test_a_unit_that_makes_no_rock_joint_is_warned_of(
    folder, check, factor, noise, spacing, warned
):
    """Heights a thousand times too small, a side below 1 mm, slopes above 3: with the numbers."""
    write_scan(folder / "slab.npy", surface(noise=noise) * factor, spacing, sidecar={})
    _, out = check()
    words = " ".join(out.split())
    assert ("is this a rock joint? Its side is" in words) == warned
    if warned:
        assert "its rms height" in words
        assert "its rms slope" in words
