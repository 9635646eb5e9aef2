"""Measured contact maps: read as they stand, judged as a computed domain is."""

import numpy as np
import pytest
import yaml

from fractalcontact.core.errors import InputError
from fractalcontact.domain.measured_map import CELLS, read_contact_map
from fractalcontact.study.sidecar import is_contact_map

OPTIONS = {"kind": "contact-map", "unit": "mm", "spacing": 0.5}


@pytest.fixture
def carpet(tmp_path):
    """Sierpinski's carpet, 81 x 81: of dimension ln 8 / ln 3."""
    cell = np.ones((1, 1))
    hole = np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]])
    for _ in range(4):
        cell = np.kron(hole, cell)
    path = tmp_path / "carpet.npy"
    np.save(path, cell)
    return path


def test_a_map_of_known_dimension(carpet):
    found = read_contact_map(carpet, OPTIONS | {"load": "85 MPa"}, label="a carpet")
    assert float(found["delta_sigma"]) == pytest.approx(np.log(8) / np.log(3), abs=0.03)
    assert float(found["area_share"]) == pytest.approx((8 / 9) ** 4)
    assert float(found["nominal_pressure"]) == 85
    assert int(found["clusters"]) == 1
    assert found.attrs["label"] == "a carpet"


def test_stresses_above_the_threshold_are_in_contact(carpet, tmp_path):
    stresses = tmp_path / "film.csv"
    np.savetxt(stresses, 12.0 * np.load(carpet) + 1, delimiter=",")
    same = read_contact_map(carpet, OPTIONS, label="film")
    found = read_contact_map(stresses, OPTIONS | {"threshold": 5}, label="film")
    np.testing.assert_array_equal(found["in_contact"], same["in_contact"])
    with pytest.raises(InputError, match=r"film.csv: .*'threshold: 5', in its sidecar"):
        read_contact_map(stresses, OPTIONS, label="film")
    with pytest.raises(InputError, match="no cell lies above the threshold of 50"):
        read_contact_map(stresses, OPTIONS | {"threshold": 50}, label="film")


def test_what_a_cell_stands_for_may_be_said(tmp_path):
    """A turned dust, every cell marked that it meets: more than it is if taken for centres."""
    corner = np.array([[0, 0], [0, 2], [2, 0], [2, 2]]) / 3
    points = np.zeros((1, 2))
    for level in range(8):
        points = (points[:, np.newaxis] + corner / 3**level).reshape(-1, 2)
    cosine, sine = np.cos(np.radians(20)), np.sin(np.radians(20))
    row, column = np.floor(
        512 * (0.7 * (points - 0.5) @ [[cosine, sine], [-sine, cosine]] + 0.5)
    ).T.astype(int)
    dust = np.zeros((512, 512))
    dust[row, column] = 1
    path = tmp_path / "dust.npy"
    np.save(path, dust)
    exact = np.log(4) / np.log(3)
    found = {
        cells: read_contact_map(path, OPTIONS | {"cells": cells}, label="dust") for cells in CELLS
    }
    dimension = {cells: float(of_map["delta_sigma"]) for cells, of_map in found.items()}
    assert dimension["any contact"] == pytest.approx(exact, abs=0.02)
    assert dimension["contact at the centre"] > dimension["any contact"] + 0.02
    assert {of_map.attrs["cells"] for of_map in found.values()} == set(CELLS)
    assert "cells" not in read_contact_map(path, OPTIONS, label="dust").attrs


def test_a_force_is_spread_over_what_was_measured(carpet, tmp_path):
    values = np.load(carpet)
    values[:, :41] = np.nan
    path = tmp_path / "half.npy"
    np.save(path, values)
    found = read_contact_map(path, OPTIONS | {"load": "1620 N"}, label="half")
    assert float(found["nominal_pressure"]) == pytest.approx(1620 / (81 * 40 * 0.25))
    assert int(found["measured"].sum()) == 81 * 40
    assert np.isnan(read_contact_map(path, OPTIONS, label="half")["nominal_pressure"])


def test_a_map_without_a_spacing_is_refused(carpet):
    with pytest.raises(InputError, match="spacing"):
        read_contact_map(carpet, {"kind": "contact-map", "unit": "mm"}, label="x")


def test_points_are_no_map(tmp_path):
    path = tmp_path / "cloud.xyz"
    path.write_text("".join(f"{x} {y} 1\n" for x in range(9) for y in range(9)))
    with pytest.raises(InputError, match="holds points, a matrix is needed"):
        read_contact_map(path, {"unit": "mm"}, label="x")


def test_the_sidecar_says_what_is_a_map():
    assert is_contact_map(yaml.safe_load("kind: contact-map"))
    assert not is_contact_map(yaml.safe_load("unit: mm"))
