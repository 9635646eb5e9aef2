"""Cards of profiles: known slopes and dimensions, of files that state their units."""

import json

import jsonschema
import numpy as np
import pytest

from fractalcontact.cards.write import SCHEMA, read_card
from fractalcontact.commands.profile_card import main
from fractalcontact.core.errors import InputError
from fractalcontact.joint.jrc import FITS
from fractalcontact.joint.profile import profile_coefficients
from fractalcontact.scan.columns import read_profile


def self_affine_profile(n, hurst, seed):
    """A part of a periodic profile with random phases and spectrum k^-(1 + 2H)."""
    k = np.arange(1, 4 * n)
    phases = np.exp(2j * np.pi * np.random.default_rng(seed).random(k.size))
    return np.fft.irfft(np.r_[0, k ** -(hurst + 0.5) * phases, 0])[:n]


@pytest.mark.parametrize("hurst", [0.5, 0.8])
def test_the_dimension_of_a_self_affine_profile_lies_in_its_interval(hurst):
    made = [profile_coefficients(self_affine_profile(800, hurst, seed), 0.25) for seed in range(20)]
    low, high = (
        np.array([float(one[f"recommended_dimension_{end}"]) for one in made])
        for end in ("low", "high")
    )
    assert ((low <= 3 - hurst) & (3 - hurst <= high)).sum() >= 17
    mean = np.mean([float(one["recommended_dimension"]) for one in made])
    assert mean == pytest.approx(3 - hurst, abs=0.08)


def test_a_saw_has_the_roughness_of_its_slope_whatever_its_units(tmp_path):
    x = 0.25 * np.arange(400)
    saw = 0.2 * np.abs((x + 4) % 8 - 4)
    path = tmp_path / "saw.csv"
    np.savetxt(path, np.c_[1e3 * saw, x], delimiter=";", header="z [um]; x [mm]")
    heights, spacing = read_profile(path)
    assert spacing == pytest.approx(0.25)
    np.testing.assert_allclose(heights, saw, atol=1e-12)
    assert main([str(path), "--out", str(tmp_path)]) == 0
    card = read_card(tmp_path / "cards/saw.yaml")
    jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8"))).validate(card)
    rows = {row["at"]["fit"]: row for row in card["entries"]["jrc_by_fit"]["values"]}
    step, fit = FITS["Yu and Vayssade 1991, 0.25 mm"]
    assert step == spacing
    assert rows["Yu and Vayssade 1991, 0.25 mm"]["value"] == pytest.approx(fit(0.2), abs=0.1)
    assert card["kind"] == "profile"
    for key in ("k_ni", "tangent_stiffness", "peak_strength", "mean_gap"):
        assert "no contact" in card["entries"][key]["missing"]
    page = (tmp_path / "cards/saw.html").read_text(encoding="utf-8")
    assert "No contact" in page
    assert "Normal stiffness" not in page


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1,2\n3,4\n", "expected their names and units"),
        ("x,z\n1,2\n2,3\n", "expected their names and units"),
        ("x [mm], z [MPa]\n1,2\n2,3\n", "z"),
        ("x [mm], z [um]\n1,2\n2,b\n", "line 3, column 'z [um]': 'b' is no finite number"),
        ("x [mm], z [um]\n1,2\n2,3\n4,4\n", "even steps"),
        ("x [mm], z [um]\n1,2\n2,nan\n3,4\n", "'nan' is no finite number"),
        ("", "expected their names and units"),
    ],
)
def test_what_is_no_profile_is_refused_in_a_sentence(tmp_path, capsys, text, words):
    path = tmp_path / "one.csv"
    path.write_text(text, encoding="utf-8")
    assert main([str(path), "--out", str(tmp_path)]) == 1
    assert words in capsys.readouterr().err
    assert not (tmp_path / "cards").exists()


def test_a_spreadsheet_is_refused_with_what_to_do(tmp_path):
    with pytest.raises(InputError, match="save the sheet as CSV"):
        read_profile(tmp_path / "one.xlsx")
