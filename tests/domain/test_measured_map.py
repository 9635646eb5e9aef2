"""Measured contact maps: read as they stand, judged as a computed domain is."""

import numpy as np
import pytest
import yaml
from stated import COMMAS, MAP

from fractalcontact.core.errors import InputError
from fractalcontact.core.verdicts import UNDETERMINED
from fractalcontact.domain.measured_map import CELLS, read_contact_map
from fractalcontact.gridding.outline import outline_words
from fractalcontact.study.sidecar import is_contact_map

OPTIONS = {**MAP, "unit": "mm", "spacing": 0.5}


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


@pytest.mark.parametrize("side", [8, 11, 12])
def test_a_map_too_small_for_local_slopes_is_read(side, tmp_path):
    """Below 12 cells a third of the window holds no box of the local slopes, below 24 no two."""
    cells = np.ones((side, side))
    cells[0, 0] = 0
    path = tmp_path / "small.npy"
    np.save(path, cells)
    found = read_contact_map(path, OPTIONS, label="small")
    assert found["area_share"] == 1 - 1 / side**2
    assert found["null_verdict"] == UNDETERMINED


def test_stresses_above_the_threshold_are_in_contact(carpet, tmp_path):
    stresses = tmp_path / "film.csv"
    np.savetxt(stresses, 12.0 * np.load(carpet) + 1, delimiter=",")
    same = read_contact_map(carpet, OPTIONS, label="film")
    found = read_contact_map(stresses, OPTIONS | COMMAS | {"threshold": 5}, label="film")
    np.testing.assert_array_equal(found["in_contact"], same["in_contact"])
    with pytest.raises(InputError, match=r"film.csv: .*sidecar, for example 'threshold: 5'"):
        read_contact_map(stresses, OPTIONS | COMMAS, label="film")
    with pytest.raises(InputError, match="no cell lies above the threshold of 50"):
        read_contact_map(stresses, OPTIONS | COMMAS | {"threshold": 50}, label="film")


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
    keys = {**MAP, **COMMAS, "delimiter": "blank", "layout": "points", "unit": "mm"}
    with pytest.raises(InputError, match="lacks spacing"):
        read_contact_map(path, keys, label="x")


def test_the_sidecar_says_what_is_a_map():
    assert is_contact_map(yaml.safe_load("kind: contact-map"))
    assert not is_contact_map(yaml.safe_load("unit: mm"))


@pytest.mark.parametrize(
    ("outline", "words"),
    [
        ("rectangle", "rectangle"),
        ({"disc": {}}, "disc"),
        ({"disc": {"centre": [4, "1 cm"]}}, "disc about x = 4 mm, y = 1 cm"),
        ({"polygon": [[2, 2], [40, 3], [42, 44], [3, 40]]}, "polygon of 4 corners"),
        ({"mask": -1}, "all but cells of -1"),
    ],
)
def test_an_outline_is_put_into_words(outline, words):
    assert outline_words(outline) == words


# -- outline, thresholds, coordinates --------------------------------------------------------------


def random_map(tmp_path, n=64, contact=0.2, seed=1, name="film"):
    """Cells in contact at random."""
    values = (np.random.default_rng(seed).random((n, n)) < contact).astype(float)
    path = tmp_path / f"{name}.npy"
    np.save(path, values)
    return path, values


CENTRES = 0.5 * (np.arange(64) + 0.5)  # mm
FROM_CENTRE = np.hypot(*np.meshgrid(CENTRES - 16, CENTRES - 16))


@pytest.mark.parametrize(
    ("outline", "inside"),
    [
        ("rectangle", FROM_CENTRE >= 0),
        ("disc", FROM_CENTRE <= 16),
        ({"disc": {"diameter": "20 mm"}}, FROM_CENTRE <= 10),
        (
            {"disc": {"centre": [4, "0.6 cm"], "diameter": 5}},
            np.hypot(*np.meshgrid(CENTRES - 4, CENTRES - 6)) <= 2.5,
        ),
        # A triangle below the diagonal, either way round; and one that is not convex.
        ({"polygon": [[0, 0], [32, 0], [32, 32]]}, np.tri(64, k=-1, dtype=bool).T),
        ({"polygon": [[32, 32], [32, 0], [0, 0]]}, np.tri(64, k=-1, dtype=bool).T),
        (
            {"polygon": [[0, 0], [32, 0], [32, 32], [16, 0.001]]},
            np.add.outer(-CENTRES / 2, CENTRES - 16) > 0,
        ),
    ],
    ids=str,
)
def test_an_outline_says_what_was_measured(tmp_path, outline, inside):
    path, values = random_map(tmp_path)
    found = read_contact_map(path, OPTIONS | {"outline": outline, "load": "1 kN"}, label="film")
    # The diagonal runs through centres, where either side is right.
    doubtful = np.isclose(*np.meshgrid(CENTRES, CENTRES)) if "polygon" in outline else False
    np.testing.assert_array_equal(found["measured"] | doubtful, inside | doubtful)
    np.testing.assert_array_equal(found["in_contact"], found["measured"] & (values == 1))
    cells = int(found["measured"].sum())
    assert float(found["nominal_area"]) == pytest.approx(cells * 0.25)
    assert float(found["nominal_pressure"]) == pytest.approx(1000 / (cells * 0.25))
    assert float(found["force"]) == pytest.approx(1000)
    assert float(found["area"]) == pytest.approx(float(found["in_contact"].sum()) * 0.25)
    assert "no contact all round" not in found.attrs["warning"]


def test_cells_of_a_mask_and_missing_cells_lie_outside(tmp_path):
    _, values = random_map(tmp_path)
    outside = FROM_CENTRE > 16
    np.save(tmp_path / "nan.npy", np.where(outside, np.nan, values))
    np.save(tmp_path / "marked.npy", np.where(outside, -1, values))
    found = [
        read_contact_map(tmp_path / name, OPTIONS | keys, label="film")
        for name, keys in (
            ("nan.npy", {}),
            ("marked.npy", {"outline": {"mask": -1}}),
            ("film.npy", {"outline": "disc"}),
        )
    ]
    for of_map in found:
        assert float(of_map["area_share"]) == pytest.approx(float(found[0]["area_share"]))
        np.testing.assert_array_equal(of_map["measured"], ~outside)


@pytest.mark.parametrize(
    "outline",
    [
        {"polygon": [[0, 0], [1, 1], [2, 2]]},
        {"disc": {"diameter": 0}},
        {"disc": {"centre": [99, 99], "diameter": 1}},
    ],
    ids=str,
)
def test_an_outline_without_area_is_refused(tmp_path, outline):
    path, _ = random_map(tmp_path)
    with pytest.raises(InputError, match="outline: "):
        read_contact_map(path, OPTIONS | {"outline": outline}, label="film")


def test_zeros_around_a_round_film_are_warned_of(tmp_path):
    path, values = random_map(tmp_path)
    np.save(path, np.where(FROM_CENTRE < 15, values, 0))
    found = read_contact_map(path, OPTIONS, label="film")
    assert "write 'outline: disc'" in found.attrs["warning"]
    for outline in ("disc", "rectangle"):
        said = read_contact_map(path, OPTIONS | {"outline": outline}, label="film")
        assert "no contact all round" not in said.attrs["warning"]
    ratio = float(said["nominal_area"]) / (np.pi * 16**2)
    assert ratio == pytest.approx(4 / np.pi)


def test_thresholds_give_a_band(tmp_path):
    path = tmp_path / "film.npy"
    np.save(path, np.random.default_rng(2).random((64, 64)))
    found = read_contact_map(path, OPTIONS | {"threshold": [0.9, 0.5, 0.99]}, label="film")
    alone = {
        level: read_contact_map(path, OPTIONS | {"threshold": level}, label="film")
        for level in (0.5, 0.9, 0.99)
    }
    assert found["threshold"].values.tolist() == [0.5, 0.9, 0.99]
    assert found.attrs["threshold"] == 0.9
    for name in ("delta_sigma", "delta_sigma_low", "area_share", "clusters"):
        assert float(found[name]) == float(alone[0.9][name])
    dimensions = [float(of_map["delta_sigma"]) for of_map in alone.values()]
    np.testing.assert_array_equal(found["threshold_delta_sigma"], dimensions)
    assert float(found["delta_sigma_least"]) == np.nanmin(dimensions)
    assert float(found["delta_sigma_most"]) == np.nanmax(dimensions)
    assert np.isnan(alone[0.9]["delta_sigma_least"])
    with pytest.raises(InputError, match="no cell lies above the threshold of 2"):
        read_contact_map(path, OPTIONS | {"threshold": [0.5, 2]}, label="film")


def three_files(tmp_path, x, y, values):
    for key, numbers in (("x", x), ("y", y), ("z", values)):
        np.savetxt(tmp_path / f"film_{key}.csv", np.atleast_2d(numbers), delimiter=",")
    return tmp_path / "film_z.csv", {
        **COMMAS,
        **{key: value for key, value in MAP.items() if key != "first_row"},
        "unit": "mm",
        "x": "film_x.csv",
        "y": "film_y.csv",
    }


@pytest.mark.parametrize("form", ["lines", "matrices", "downwards"])
def test_coordinates_may_be_files_of_their_own(tmp_path, form):
    _, values = random_map(tmp_path, 20)
    values = values[:, :16]
    x, y = 3 + 0.2 * np.arange(16), 7 + 0.4 * np.arange(20)
    written = (x, y, values)
    if form == "matrices":
        written = (*np.meshgrid(x, y), values)
    if form == "downwards":
        written = (x, y[::-1], values[::-1])
    path, options = three_files(tmp_path, *written)
    corners = [[3, 6], [7, 6], [7, 9], [3, 9]]
    found = read_contact_map(path, options | {"outline": {"polygon": corners}}, label="film")
    np.testing.assert_allclose(found["x"], x)
    np.testing.assert_allclose(found["y"], y)
    inside = (y < 9)[:, np.newaxis] & (x < 7)
    np.testing.assert_array_equal(found["in_contact"], (values == 1) & inside)
    assert (found.attrs["spacing_x"], found.attrs["spacing_y"]) == pytest.approx((0.2, 0.4))


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"x": "../film_x.csv"}, "plain name"),
        ({"x": "/etc/passwd"}, "plain name"),
        ({"x": "folder\\film_x.csv"}, "plain name"),
        ({"x": ".hidden.csv"}, "plain name"),
        ({"x": ".."}, "plain name"),
        ({"x": "film_z.csv"}, "plain name"),
        ({"x": "absent.csv"}, "no such file"),
        ({"x": None}, "key 'x' is missing"),
        ({"spacing": 0.1}, "remove 'spacing'"),
        ({"unit": None}, "unit"),
        ({"y": "film_x.csv"}, "16 coordinates y"),
        ({"x": "film_z2.csv"}, "no coordinates x"),
        ({"x": "uneven.csv"}, "an even grid is needed"),
    ],
    ids=str,
)
def test_files_of_coordinates_are_plain_names_of_even_grids(tmp_path, keys, message):
    _, values = random_map(tmp_path, 20)
    path, options = three_files(tmp_path, np.arange(16.0), np.arange(20.0), values[:, :16])
    np.savetxt(tmp_path / "film_z2.csv", values[:, :16], delimiter=",")
    np.savetxt(tmp_path / "uneven.csv", np.arange(16.0)[:, np.newaxis] ** 2)
    options = {key: value for key, value in (options | keys).items() if value is not None}
    with pytest.raises(InputError, match=message):
        read_contact_map(path, options, label="film")


def test_coordinates_of_the_cells_are_their_centres(carpet):
    found = read_contact_map(carpet, OPTIONS, label="a carpet")
    np.testing.assert_allclose(found["x"], 0.5 * (np.arange(81) + 0.5))
    assert found["y"].attrs["units"] == "mm"


def test_an_outline_that_cuts_off_contact_is_warned_of(tmp_path):
    """The largest disc sits in the middle of the map, the film in a corner."""
    values = np.zeros((40, 60))
    y, x = np.indices(values.shape)
    film = np.hypot(x - 15, y - 20) < 14
    values[film] = 2.0
    np.save(tmp_path / "film.npy", values)
    keys = OPTIONS | {"threshold": 1}
    cut = read_contact_map(tmp_path / "film.npy", keys | {"outline": "disc"}, label="film")
    lost = 1 - float(cut["in_contact"].sum()) / film.sum()
    assert lost > 0.1
    assert f"{100 * lost:.0f} % of the contact lies outside the outline" in cut.attrs["warning"]
    disc = {"disc": {"centre": ["7.75 mm", "10.25 mm"], "diameter": "15 mm"}}
    whole = read_contact_map(tmp_path / "film.npy", keys | {"outline": disc}, label="film")
    assert whole.attrs["warning"] == ""
    assert whole.attrs["integral"] == pytest.approx(2.0 * film.sum() * 0.25)
