"""Numbers of the real granite pair agree over its treatments, or say that they are undetermined."""

import shutil
import subprocess
import sys

import pytest
from places import BENCHMARKS, SCANS
from stated import GRANITE, sidecar

STUDY = """
study: variants
scans: {folder}
materials:
  granite: {{modulus: 50 GPa, poisson: 0.25}}
defaults:
  material: granite
  contact_directions: [W]
  loads: [0.1 MPa, 1 MPa, 3 MPa, 5 MPa, 10 MPa, 15 MPa, 25 MPa, 50 MPa, 100 MPa]
  resolutions: [1, 2]
  map_load: 25 MPa
"""
QUANTITIES = ("k_ni", "stiffness", "closure", "separation", "area_corrected")


@pytest.mark.scans
@pytest.mark.full
@pytest.mark.skipif(not SCANS.is_dir(), reason="the folder of real scans is absent")
@pytest.mark.parametrize("offset", ["0", "0.6"])
def test_the_granite_pair_is_within_its_errors_or_undetermined(tmp_path, offset):
    folder = tmp_path / "scans"
    folder.mkdir()
    for face, name in (("lower", "A_bottom"), ("upper", "B_top")):
        file = SCANS / "cnl_granite_pair" / f"Extracted_M_CNL_Side{name}.txt"
        shutil.copyfile(file, folder / f"granite.{face}.txt")
    (folder / "granite.yaml").write_text(sidecar(GRANITE))
    study = tmp_path / "study.yaml"
    study.write_text(STUDY.format(folder=folder))
    command = [sys.executable, BENCHMARKS / "pair_variants.py", study, "granite"]
    options = ["--offset", offset, "--output", tmp_path]
    done = subprocess.run([*command, *options], check=True, capture_output=True, text=True)
    verdicts = dict(line.split(": ", 1) for line in done.stdout.splitlines()[-len(QUANTITIES) :])
    assert verdicts.keys() == set(QUANTITIES)
    assert not [words for words in verdicts.values() if "NOT WITHIN" in words]
    if offset == "0":  # overlaps carry it, filled or not
        assert all(words.startswith("determined in 0 of 6") for words in verdicts.values())
    else:  # once filled
        assert verdicts["k_ni"].startswith("determined in 0 of 6")
        assert verdicts["separation"].startswith("determined in 3 of 6")
