"""Drafts of sidecars: written beside scans, drawn, never read by a study, kept by their owner."""

import numpy as np
import pytest
import yaml
from places import ROOT

from fractalcontact.commands.describe import main
from fractalcontact.core.errors import InputError
from fractalcontact.scan.draft import written
from fractalcontact.scan.options import of_face
from fractalcontact.scan.read import read_scan
from fractalcontact.study.checks import read_sidecar
from fractalcontact.study.scan_files import list_scans

ARGUMENTS = ["--study", str(ROOT / "config/paper.yaml"),
             "--schema", str(ROOT / "config/schema/study.schema.yaml")]  # fmt: skip
SCHEMA = yaml.safe_load((ROOT / "config/schema/study.schema.yaml").read_text())


def heights(seed=1, shape=(20, 30)):
    return np.random.default_rng(seed).normal(size=shape).cumsum(0).cumsum(1) * 1e-3


def export(folder, name, z):
    """A matrix in um as an instrument of the test writes it."""
    lines = "# joint spacing: 20 mm\n# z in um\n"
    rows = "\n".join(";".join(f"{1e3 * v:.4f}" for v in row) for row in z)
    (folder / f"{name}.txt").write_text(lines + rows + "\n")


def filled(text):
    """A draft with its empty lines filled in."""
    for key, value in {"unit_xy": "mm", "spacing": "0.1 mm", "first_row": "top"}.items():
        text = text.replace(f"{key}: ", f"{key}: {value} ")
    return text


def describe(*arguments):
    return main([*map(str, arguments), *ARGUMENTS])


def test_a_draft_shows_where_each_line_comes_from_and_is_kept_by_renaming(tmp_path, capsys):
    export(tmp_path, "granite", heights())
    assert describe(tmp_path) == 0
    out = capsys.readouterr().out
    draft = tmp_path / "granite.draft.yaml"
    text = draft.read_text()
    assert 'line 1: "# joint spacing: 20 mm"' in text  # a wrong one is seen
    assert 'line 2: "# z in um"' in text
    assert "first_row:" in text
    assert "fill in unit_xy, spacing, first_row\n" in out
    assert "30 x 20" in out
    assert (tmp_path / "granite.draft.png").read_bytes().startswith(b"\x89PNG")
    # Neither a sidecar nor a scan to any study.
    scans, refused = list_scans(tmp_path)
    assert (list(scans), refused) == (["granite"], {})
    assert scans["granite"].sidecar is None
    draft.write_text(filled(text))
    assert describe(tmp_path) == 0  # what was mended stays
    assert yaml.safe_load(draft.read_text())["spacing"] == "0.1 mm"
    draft.rename(tmp_path / "granite.yaml")
    keys, _ = read_sidecar(tmp_path / "granite.yaml", SCHEMA)
    assert keys["confirmed"]["shape"] == [20, 30]
    np.testing.assert_allclose(
        read_scan(tmp_path / "granite.txt", keys), heights()[::-1], atol=1e-7
    )


def test_an_empty_line_of_a_sidecar_is_named(tmp_path):
    export(tmp_path, "granite", heights())
    describe(tmp_path)
    (tmp_path / "granite.draft.yaml").rename(tmp_path / "granite.yaml")
    with pytest.raises(InputError, match=r"granite\.yaml: key 'unit_xy' is empty; fill it in"):
        read_sidecar(tmp_path / "granite.yaml", SCHEMA)


def test_files_of_one_instrument_take_the_sidecar_of_one(tmp_path, capsys):
    for number in range(6):
        export(tmp_path, f"s{number}", heights(number))
    export(tmp_path, "other", 1e3 * heights(7))
    np.save(tmp_path / "array.npy", heights())
    assert describe("--file", tmp_path / "s0.txt") == 0
    draft = tmp_path / "s0.draft.yaml"
    assert not (tmp_path / "s1.draft.yaml").exists()
    text = filled(draft.read_text())
    assert describe("--like", draft) == 1  # a line is empty
    assert "'unit_xy' is empty" in capsys.readouterr().err
    draft.write_text(text)
    assert describe("--like", draft) == 1  # one is not alike
    out = capsys.readouterr().out
    assert "1 refused, 6 written" in out
    assert "other.txt: the relief is" in out
    for number in range(6):
        keys, _ = read_sidecar(tmp_path / f"s{number}.yaml", SCHEMA)
        found = read_scan(tmp_path / f"s{number}.txt", keys)
        np.testing.assert_allclose(found, heights(number)[::-1], atol=1e-7)
    assert (tmp_path / "scans.draft.html").read_text().count("<img") == 6
    assert not (tmp_path / "array.yaml").exists()


def test_what_needs_no_sidecar_is_drawn_on_request(tmp_path, capsys):
    (tmp_path / "rock.csv").write_text(
        "x [mm],y [mm],z [um]\n"
        + "".join(f"{x},{y},{1e3 * heights()[y, x]:.4f}\n" for y in range(20) for x in range(30))
    )
    assert describe(tmp_path) == 0
    assert not (tmp_path / "rock.draft.png").exists()
    assert describe("--file", tmp_path / "rock.csv") == 0
    assert "complete" in capsys.readouterr().out
    assert (tmp_path / "rock.draft.png").exists()
    assert not (tmp_path / "rock.draft.yaml").exists()


def test_a_mark_of_missing_cells_deep_in_the_file_is_drafted(tmp_path):
    z = heights(shape=(3000, 12))
    z[2900:2950, 5] = -9.999
    export(tmp_path, "granite", z)
    describe(tmp_path)
    assert yaml.safe_load((tmp_path / "granite.draft.yaml").read_text())["missing"] == -9999


def drafted(folder, header, rows="1.1;2.2;3.3\n4.4;5.5;6.5\n7.7;8.8;9.1\n" * 4):
    (folder / "rock.txt").write_text(header + rows)
    describe(folder)
    return yaml.safe_load((folder / "rock.draft.yaml").read_text())


def test_a_unit_of_all_lengths_reaches_the_draft(tmp_path):
    assert drafted(tmp_path, "# all lengths in um\n")["unit"] == "um"


def test_units_of_columns_are_told_apart(tmp_path):
    found = drafted(tmp_path, "# x [mm], y [mm], height [um]\n")
    assert (found["unit_xy"], found["unit_z"], found.get("unit")) == ("mm", "um", None)


def test_a_word_that_ends_in_dy_is_no_spacing(tmp_path):
    assert drafted(tmp_path, "# Study of block 7, 50 mm\n").get("spacing") is None


@pytest.mark.parametrize("value", ["null", "NULL", "1", "1e5", "-9999", "yes", "rock 7", "NaN"])
def test_a_word_is_written_so_that_it_is_read_as_one(value):
    assert yaml.safe_load(f"key: {written(value)}") == {"key": value}


def test_what_is_refused_by_its_name_is_told_with_its_reason(tmp_path, capsys):
    export(tmp_path, "granite", heights())
    for ending in ("csv", "txt"):
        (tmp_path / f"twice.{ending}").write_text("1 2\n")
    describe(tmp_path)
    assert "twice" in (out := capsys.readouterr().out)
    assert out.index("twice") < out.index("granite")
    assert describe("--file", tmp_path / "granite.txt") == 0


def test_pairs_of_one_instrument_take_the_sidecar_of_one_face_by_face(tmp_path):
    for seed, name in enumerate(("a", "b")):
        for face in ("lower", "upper"):
            export(tmp_path, f"{name}.{face}", (1 + 3 * (face == "upper")) * heights(seed))
    assert describe("--file", tmp_path / "a.lower.txt") == 0
    draft = tmp_path / "a.draft.yaml"
    draft.write_text(filled(draft.read_text()))
    assert describe("--like", draft) == 0
    keys, _ = read_sidecar(tmp_path / "b.yaml", SCHEMA)
    for face in ("lower", "upper"):
        confirmed = of_face(keys, face)["confirmed"]
        own = read_scan(tmp_path / f"b.{face}.txt", of_face(keys, face))
        assert confirmed["shape"] == [20, 30] == list(own.shape)
        assert confirmed["relief"] == pytest.approx(1e3 * float(own.max() - own.min()), rel=1e-3)
