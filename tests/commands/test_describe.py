"""Drafts of sidecars: written beside scans, drawn, never read by a study, kept by their owner."""

import numpy as np
import pytest
import yaml
from places import ROOT

from fractalcontact.commands.describe import main
from fractalcontact.core.errors import InputError
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
    assert "fill in first_row" in out
    assert "30 x 20" in out
    assert (tmp_path / "granite.draft.png").read_bytes().startswith(b"\x89PNG")
    # Neither a sidecar nor a scan to any study.
    scans, refused = list_scans(tmp_path)
    assert (list(scans), refused) == (["granite"], {})
    assert scans["granite"].sidecar is None
    mended = text.replace("spacing: 20 mm ", "spacing: 0.1 mm").replace(
        "first_row: ", "first_row: top "
    )
    draft.write_text(mended)
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
    with pytest.raises(InputError, match=r"granite\.yaml: key 'first_row' is empty; fill it in"):
        read_sidecar(tmp_path / "granite.yaml", SCHEMA)


def test_files_of_one_instrument_take_the_sidecar_of_one(tmp_path, capsys):
    for number in range(6):
        export(tmp_path, f"s{number}", heights(number))
    export(tmp_path, "other", 1e3 * heights(7))
    np.save(tmp_path / "array.npy", heights())
    assert describe("--file", tmp_path / "s0.txt") == 0
    draft = tmp_path / "s0.draft.yaml"
    assert not (tmp_path / "s1.draft.yaml").exists()
    text = draft.read_text().replace("20 mm ", "0.1 mm").replace("first_row: ", "first_row: top ")
    assert describe("--like", draft) == 1  # a line is empty
    assert "'first_row' is empty" in capsys.readouterr().err
    draft.write_text(text)
    assert describe("--like", draft) == 1  # one is not alike
    out = capsys.readouterr().out
    assert "1 refused, 6 written" in out
    assert "other.txt: a relief of" in out
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
