"""The gap between two scanned faces, without a study."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml

from fractalcontact.commands.gap_of_scans import main
from fractalcontact.scan import read as scan_read
from fractalcontact.surface.synthesis import self_affine

STATED = {
    "kind": "face",
    "layout": "matrix",
    "axes": "none",
    "unit": "mm",
    "spacing": [0.1, 0.2],
    "first_row": "bottom",
    "heights": "up",
    "missing": "none",
    "registration": "none",
}
OPENING = np.linspace(0.2, 0.5, 40)  # along x, mm


@pytest.fixture
def pair(tmp_path):
    """Two faces that open along x, and a sidecar with a key of studies too."""
    lower = self_affine((30, 40), 0.8, 0.1, rms=0.1, seed=3)
    np.save(tmp_path / "lower.npy", lower)
    np.save(tmp_path / "upper.npy", lower + OPENING)
    (tmp_path / "keys.yaml").write_text(yaml.safe_dump({**STATED, "label": "granite"}))
    return [str(tmp_path / name) for name in ("lower.npy", "upper.npy")]


def run(pair, tmp_path, out, *more):
    keys = str(tmp_path / "keys.yaml")
    return main([*pair, "--keys", keys, "--out", str(tmp_path / out), *more])


def test_the_map_is_the_opening_at_its_places(pair, tmp_path, capsys):
    assert run(pair, tmp_path, "gap.nc") == 0
    with xr.open_dataset(tmp_path / "gap.nc") as found:
        gap = found["aperture"].load()
    np.testing.assert_allclose(gap, np.broadcast_to(OPENING, (30, 40)), atol=1e-9)
    np.testing.assert_allclose(np.diff(gap.x), 0.1)
    np.testing.assert_allclose(np.diff(gap.y), 0.2)
    said = capsys.readouterr().out
    assert "40 x 30 cells of 0.1 x 0.2 mm" in said
    assert "mean 0.35 mm" in said
    assert (tmp_path / "gap.png").read_bytes().startswith(b"\x89PNG")
    assert run(pair, tmp_path, "gap.csv") == 0
    table = pd.read_csv(tmp_path / "gap.csv")
    by_place = table.sort_values(["y_mm", "x_mm"])["aperture_mm"].to_numpy().reshape(30, 40)
    np.testing.assert_allclose(by_place, gap.values, rtol=1e-6)


def test_files_that_their_keys_describe_are_read_once(pair, tmp_path, monkeypatch):
    read, confined = [], scan_read.read_confined

    def counted(path, options):
        read.append(path.name)
        return confined(path, options)

    monkeypatch.setattr(scan_read, "read_confined", counted)
    assert run(pair, tmp_path, "gap.nc") == 0
    assert sorted(read) == ["lower.npy", "upper.npy"]


@pytest.fixture
def clouds(tmp_path, monkeypatch):
    """Two clouds as text, the first alone with a heading, none with a unit."""
    monkeypatch.chdir(tmp_path)
    z = self_affine((24, 24), 0.8, 0.1, rms=0.1, seed=4)
    y, x = 0.1 * np.mgrid[:24, :24]
    for name, heights, head in (("a.txt", z, "x,y,z\n"), ("b.txt", z + 0.25, "")):
        rows = np.column_stack([x.ravel(), y.ravel(), heights.ravel()])
        text = "\n".join(f"{a:.4f},{b:.4f},{c:.6f}" for a, b, c in rows)
        (tmp_path / name).write_text(head + text + "\n")
    return ["a.txt", "b.txt"]


def test_two_clouds_need_their_unit_alone(clouds, tmp_path, capsys):
    assert main([*clouds, "--unit", "um"]) == 0
    assert "gap.csv: the gap in mm" in capsys.readouterr().out
    gap = pd.read_csv(tmp_path / "gap.csv")["aperture_mm"].dropna()
    np.testing.assert_allclose(gap, 0.25e-3, rtol=1e-3)
    assert (tmp_path / "gap.png").is_file()


def test_clouds_without_a_unit_are_refused_in_one_line_that_says_what_to_write(clouds, capsys):
    assert main(clouds) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("the files do not state unit; write --unit mm")
    assert main([clouds[0], "none.txt", "--unit", "mm"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: none.txt: no such file")


def test_faces_in_the_wrong_order_are_refused_and_nothing_is_written(pair, tmp_path, capsys):
    assert run(pair[::-1], tmp_path, "gap.nc") == 1
    assert "the upper face lies below the lower one" in capsys.readouterr().err
    assert not list(tmp_path.glob("gap.*"))


def test_a_spike_is_filled_where_that_is_asked(pair, tmp_path):
    upper = np.load(pair[1])
    upper[15, 20] += 50.0
    np.save(pair[1], upper)
    peaks = []
    for outliers in ("keep", "fill"):
        assert run(pair, tmp_path, "gap.nc", "--outliers", outliers) == 0
        with xr.open_dataset(tmp_path / "gap.nc") as found:
            peaks.append(float(found["aperture"].max()))
    assert peaks[0] > 50.0
    assert peaks[1] == pytest.approx(0.5, abs=0.1)


def test_registration_finds_the_displacement_of_a_face(tmp_path, capsys):
    z = self_affine((128, 128), 0.8, 0.1, rms=0.2, seed=5)
    np.save(tmp_path / "a.npy", z[4:, :-6])
    np.save(tmp_path / "b.npy", z[:-4, 6:] + 0.3)
    keys = {**STATED, "spacing": 0.1, "registration": "translation"}
    (tmp_path / "keys.yaml").write_text(yaml.safe_dump(keys))
    assert run([str(tmp_path / "a.npy"), str(tmp_path / "b.npy")], tmp_path, "gap.nc") == 0
    with xr.open_dataset(tmp_path / "gap.nc") as found:
        assert float(found["aperture"].std()) < 1e-3
    assert "moved by 0.6" in capsys.readouterr().out


@pytest.mark.parametrize("out", ["gap.xyz", "gap"])
def test_another_ending_is_refused_before_anything_is_read(tmp_path, capsys, out):
    assert main(["no.npy", "none.npy", "--out", str(tmp_path / out)]) == 1
    assert ".csv, .nc, .vtk" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_key_that_is_none_is_refused(pair, tmp_path, capsys):
    (tmp_path / "keys.yaml").write_text(yaml.safe_dump({**STATED, "registraton": "none"}))
    assert run(pair, tmp_path, "gap.nc") == 1
    assert "did you mean 'registration'?" in capsys.readouterr().err
