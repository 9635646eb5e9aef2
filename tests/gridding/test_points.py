"""Clouds and meshes onto grids: tiles, levelling, overhangs, density, far coordinates."""

import re
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from ensembles import ensemble
from places import BENCHMARKS
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay
from stated import drafted, read_faces, read_scan

from fractalcontact.core.errors import InputError
from fractalcontact.gridding import density, levelling, overhangs, points
from fractalcontact.gridding import triangles as tri
from fractalcontact.scan.options import parse_options
from fractalcontact.scan.readers import text

SIDE = 20.0  # mm
BENCHMARK = BENCHMARKS / "gridding.py"


def waves(x, y):
    """A smooth surface, mm: its slopes stay below 0.5 and its curvature below 0.6 / mm."""
    return 0.3 * np.sin(1.3 * x + 0.4 * y) + 0.2 * np.cos(1.1 * y - 0.6 * x)


def cloud(n=4000, seed=0, height=waves):
    xy = np.random.default_rng(seed).uniform(0, SIDE, (n, 2))
    return np.column_stack([xy, height(*xy.T)])


def level(cloud):
    """The cloud without its least-squares plane: that of all principal axes is level then too."""
    terms = np.column_stack([cloud[:, :2], np.ones(len(cloud))])
    plane = terms @ np.linalg.lstsq(terms, cloud[:, 2], rcond=None)[0]
    return cloud - np.column_stack([np.zeros((len(cloud), 2)), plane])


def raised(cloud, by):
    return cloud + np.array([0, 0, by])


def lean(degrees, azimuth=30.0):
    """Matrix of a turn about a horizontal axis."""
    axis = [np.cos(np.radians(azimuth)), np.sin(np.radians(azimuth)), 0]
    return trimesh.transformations.rotation_matrix(np.radians(degrees), axis)[:3, :3]


def mesh_of(points, triangles, path):
    trimesh.Trimesh(points, triangles, process=False).export(path)
    return path


def saved(folder, points, name="rock.npy"):
    np.save(folder / name, points)
    return folder / name


def read(folder, points, **options):
    return read_scan(saved(folder, points), {"unit": "mm"} | options)


def exact(heights, height):
    """Heights of a function at the nodes."""
    return height(*np.meshgrid(heights.x, heights.y))


# --- exact solutions ---------------------------------------------------------------------------


def test_means_over_cells_are_exact_on_a_plane(tmp_path):
    def plane(x, y):
        return 0.05 * x - 0.02 * y + 3.0

    heights = read(tmp_path, cloud(height=plane), grid="1.0 mm")
    assert "averaged over 4 x 4 places" in heights.attrs["gridding"]  # 10 points to a cell
    np.testing.assert_allclose(heights, np.where(heights.isnull(), np.nan, exact(heights, plane)))
    assert float(heights[1:-1, 1:-1].isnull().mean()) < 0.01


def test_a_fold_that_delaunay_would_cut_is_kept_by_its_mesh(tmp_path):
    # A roof with a long ridge: the vertices at its eaves are nearer to each other than those on it.
    n = 24
    ridge = np.column_stack([np.zeros(n), 4.0 * np.arange(n)])
    eaves = [ridge[:-1] + np.array([x, 2.0]) for x in (-1.0, 1.0)]
    xy = np.concatenate([ridge, *eaves])
    vertices = np.column_stack([xy, 5 - np.abs(xy[:, 0])])
    first = np.arange(n - 1)
    strips = []
    for eave in (n + first, 2 * n - 1 + first):
        strips += [np.column_stack([first, first + 1, eave])]
        strips += [np.column_stack([eave[:-1], eave[1:], first[1:]])]
    path = mesh_of(vertices, np.concatenate(strips), tmp_path / "roof.ply")
    heights = read_scan(path, {"unit": "mm", "grid": "0.25 mm"})
    middle = heights.sel(x=slice(-0.9, 0.9), y=slice(2.5, 89.5))
    roof = exact(middle, lambda x, _: 5 - np.abs(x))
    np.testing.assert_allclose(middle, roof, rtol=1e-6)
    vertices_alone = read_scan(saved(tmp_path, vertices), {"unit": "mm", "grid": "0.25 mm"})
    cut = vertices_alone.sel(x=slice(-0.9, 0.9), y=slice(2.5, 89.5))
    assert float(np.abs(cut - roof).max()) > 0.5


def test_the_top_of_a_mesh_is_what_is_seen(tmp_path):
    ball = trimesh.creation.icosphere(subdivisions=5, radius=5.0)
    path = tmp_path / "ball.stl"
    ball.export(path)
    heights = read_scan(path, {"unit": "mm", "grid": "0.1 mm"})
    inside = exact(heights, np.hypot) < 4.5
    top = exact(heights, lambda x, y: np.sqrt(np.maximum(25 - x**2 - y**2, 0)))
    np.testing.assert_allclose(heights.values[inside], top[inside], atol=0.02)
    assert heights.attrs["overhang_share"] == pytest.approx(0.5, abs=0.01)
    assert heights.attrs["levelled_degrees"] == 0.0  # a body has no plane
    assert "faces down" in heights.attrs["notes"]


def test_points_in_a_cell_are_counted_where_it_is_measured():
    lattice = points.Lattice(0.0, 0.0, 1.0, 1.0, 3, 2)
    heights = np.array([[0.0, 0.0, np.nan], [0.0, 0.0, 0.0]])
    places = np.array([[0.1, 0.1], [0.2, -0.3], [1.0, 1.4], [2.0, 0.0], [2.0, 0.1], [9.0, 9.0]])
    cloud = np.column_stack([places, np.ones(6)])
    assert density.points_per_cell(cloud, heights, lattice) == 0.0  # 2, 0, 0, 1, 0
    heights[1] = np.nan, 0.0, np.nan
    assert density.points_per_cell(cloud, heights, lattice) == 1.0  # 2, 0, 1


# --- an independent method: the whole triangulation by scipy -----------------------------------


@pytest.mark.parametrize("share", [1.0, 0.5, 0.25])
@pytest.mark.parametrize("pitch", [(0.5, 0.2), (0.2, 0.5)])
def test_points_on_a_quarter_of_the_nodes_still_lie_on_their_lattice(pitch, share):
    cells = np.argwhere(np.random.default_rng(0).random((40, 50)) < share)[:, ::-1]
    cloud = np.column_stack([np.array([3.0, -1.0]) + cells * pitch, np.arange(len(cells))])
    distance = density.neighbour_distance(cloud, density.plane_tree(cloud))
    found = points.find_lattice(cloud, distance)
    assert (found.dx, found.dy) == pytest.approx(pitch)
    heights = points.place_on_lattice(cloud, found)
    np.testing.assert_array_equal(heights[np.isfinite(heights)], np.arange(len(cells)))


def test_points_that_were_rounded_to_few_digits_lie_on_no_lattice():
    cloud = np.unique(np.random.default_rng(0).uniform(0, SIDE, (2000, 2)).round(1), axis=0)
    cloud = np.column_stack([cloud, np.zeros(len(cloud))])
    distance = density.neighbour_distance(cloud, density.plane_tree(cloud))
    assert points.find_lattice(cloud, distance) is None


def whole_triangulation(cloud, lattice, circle):
    triangles = Delaunay(cloud[:, :2])
    x = lattice.x0 + lattice.dx * np.arange(lattice.nx)
    y = lattice.y0 + lattice.dy * np.arange(lattice.ny)
    nodes = np.stack(np.meshgrid(x, y), axis=-1)
    within = triangles.find_simplex(nodes)
    small = tri.circumradius(cloud[:, :2], triangles.simplices) <= circle
    heights = LinearNDInterpolator(triangles, cloud[:, 2])(nodes)
    return np.where((within >= 0) & small[within], heights, np.nan)


@pytest.mark.parametrize(
    ("tile", "places"),
    [
        pytest.param(60, 10**6, marks=pytest.mark.full),
        (400, 10**6),
        pytest.param(10**6, 10**6, marks=pytest.mark.full),
        (10**6, 900),
    ],
)
@pytest.mark.parametrize("clumped", [pytest.param(False, marks=pytest.mark.full), True])
def test_tiles_give_the_heights_of_the_whole_triangulation(monkeypatch, tile, places, clumped):
    monkeypatch.setattr(tri, "TILE_POINTS", tile)
    monkeypatch.setattr(tri, "TILE_PLACES", places)
    n = ensemble("scattered points")
    rough = cloud(n, seed=3, height=lambda x, y: np.random.default_rng(4).normal(size=len(x)))
    if clumped:
        rough[: n // 2, :2] = SIDE * (rough[: n // 2, :2] / SIDE) ** 3
    hole = np.hypot(rough[:, 0] - 8, rough[:, 1] - 11) < 3
    corner = (rough[:, 0] > 14) & (rough[:, 1] < 5)
    rough = rough[~(hole | corner)]
    circle = 0.5 * np.sqrt(6000 / n)
    lattice = points.covering_lattice(rough, 0.26 * circle, "rock")
    heights = tri.interpolate_points(rough, lattice, circle, 1, "rock")
    whole = whole_triangulation(rough, lattice, circle)
    np.testing.assert_allclose(heights, whole, rtol=1e-7, atol=1e-7)
    assert 0.05 < np.isnan(heights).mean() < 0.7


# --- properties --------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [pytest.param(10, marks=pytest.mark.full), 45, 80])
@pytest.mark.parametrize("azimuth", [pytest.param(0.0, marks=pytest.mark.full), 75.0])
def test_a_leaning_cloud_comes_back_in_its_own_frame(tmp_path, degrees, azimuth):
    flat = level(cloud(12_000))
    matrix = lean(degrees, azimuth)
    heights = read(tmp_path, flat @ matrix.T, grid="0.25 mm")
    assert heights.attrs["levelled_degrees"] == pytest.approx(degrees, abs=1e-6)
    assert f"turned by {degrees} degrees" in heights.attrs["notes"]
    moved = flat.mean(axis=0) @ matrix.T - flat.mean(axis=0)
    back = heights.assign_coords(x=heights.x - moved[0], y=heights.y - moved[1]) - moved[2]
    interior = back.sel(x=slice(1, SIDE - 1), y=slice(1, SIDE - 1))
    plane = np.linalg.lstsq(
        np.column_stack([flat[:, :2], np.ones(len(flat))]), waves(*flat.T[:2]), rcond=None
    )[0]
    own = exact(interior, lambda x, y: waves(x, y) - plane[0] * x - plane[1] * y - plane[2])
    # Linear interpolation: the square of the distance of points times an eighth of the curvature.
    assert float(np.abs(interior - own).max()) < 0.05
    assert float(np.sqrt(((interior - own) ** 2).mean())) < 0.005
    assert not interior.isnull().any()


def test_a_turn_is_no_mirror_and_the_smallest():
    for normal in ([0.3, -0.2, 0.9], [1, 0, 0], [0, 0, -1], [0.1, 0.5, -0.2]):
        normal = np.array(normal, dtype=float) / np.linalg.norm(normal)
        matrix = levelling.turning_matrix(normal)
        np.testing.assert_allclose(matrix @ normal, [0, 0, 1], atol=1e-12)
        np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(matrix) == pytest.approx(1)
        assert np.trace(matrix) == pytest.approx(1 + 2 * normal[2])  # 1 + 2 cos of the angle


def test_faces_turn_together_and_keep_their_gap(tmp_path):
    matrix = lean(40)
    lower, upper = level(cloud(12_000, seed=1)), level(cloud(10_000, seed=2))
    upper = raised(upper[upper[:, 0] < 15], 0.3)
    z_l, z_u = read_faces(
        saved(tmp_path, lower @ matrix.T, "rock.lower.npy"),
        saved(tmp_path, upper @ matrix.T, "rock.upper.npy"),
        {"unit": "mm"},
    )
    assert z_l.attrs["levelled_degrees"] == z_u.attrs["levelled_degrees"]
    assert z_l.attrs["levelled_degrees"] == pytest.approx(40, abs=0.5)
    gap = (z_u - z_l).values[5:-5, 5:-5]
    assert np.nanmean(gap) == pytest.approx(0.3, abs=0.02)
    assert np.nanstd(gap) < 0.02


def test_gentle_tilts_lattices_and_spikes_turn_nothing(tmp_path):
    gentle = cloud(height=lambda x, y: 0.08 * x + waves(x, y))  # 4.6 degrees
    gentle[::50, 2] = -9999.0
    normal, _ = levelling.common_plane([gentle])
    assert levelling.tilt_degrees(normal) == pytest.approx(4.6, abs=0.3)
    assert not levelling.is_steep(normal)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(30.0), np.arange(20.0)))
    lattice = np.column_stack([x, y, 0.5 * x + np.random.default_rng(0).normal(size=600)])
    heights = read(tmp_path, lattice)
    assert heights.attrs["levelled_degrees"] == 0.0
    np.testing.assert_array_equal(heights.values.ravel(), lattice[:, 2])


def test_an_upright_cloud_is_turned_and_its_side_is_said_to_be_unknown(tmp_path):
    heights = read(tmp_path, level(cloud()) @ lean(90).T)
    assert heights.attrs["levelled_degrees"] == pytest.approx(90)
    assert "do not determine which side is up" in heights.attrs["notes"]


def test_an_upright_mesh_knows_its_upper_side(tmp_path):
    flat = level(cloud(2000))
    triangles = Delaunay(flat[:, :2]).simplices  # counter-clockwise: normals point up
    for degrees in (90, 89, -89):
        path = mesh_of(flat @ lean(degrees).T, triangles, tmp_path / "wall.ply")
        heights = read_scan(path, {"unit": "mm", "grid": "0.3 mm"})
        assert heights.attrs["overhang_share"] == 0.0
        assert "face down" not in heights.attrs["notes"]
        assert float(heights.std()) == pytest.approx(flat[:, 2].std(), rel=0.1)


def hidden_share(cloud):
    share, _ = overhangs.find_hidden(cloud, density.plane_tree(cloud))
    return share


def test_the_lower_half_of_a_sphere_is_hidden():
    ball = np.random.default_rng(1).normal(size=(30_000, 3))
    ball *= 5 / np.linalg.norm(ball, axis=1, keepdims=True)
    _, hidden = overhangs.find_hidden(ball, density.plane_tree(ball))
    assert not hidden[ball[:, 2] > 0].any()
    deep = ball[:, 2] < -1.0  # nearer to the rim the halves are too close to tell
    assert hidden[deep].mean() > 0.95


def test_of_overhanging_points_the_top_is_gridded(tmp_path):
    roof = raised(cloud(8000, seed=5), 6.0)
    roof = roof[(np.abs(roof[:, :2] - 10) < 4).all(axis=1)]
    heights = read(tmp_path, np.concatenate([cloud(8000), roof]), grid="0.3 mm")
    share = heights.attrs["overhang_share"]
    true_share = 8000 * 64 / 400 / (8000 + len(roof))
    assert 0.75 * true_share < share < 1.05 * true_share  # at the roof's edge it is seen less well
    assert "left out" in heights.attrs["notes"]
    under = heights.sel(x=slice(7, 13), y=slice(7, 13))
    error = np.abs(under - exact(under, waves) - 6.0)
    assert float((error < 0.2).mean()) > 0.98


@pytest.mark.parametrize("slope", [1.0, np.tan(np.radians(60))])
def test_steep_noisy_and_spiky_surfaces_hide_nothing(slope):
    rng = np.random.default_rng(2)
    steep = cloud(20_000, height=lambda x, y: slope * 3 * np.sin(x / 3) + slope * y)
    steep[:, 2] += rng.normal(0, 0.1, len(steep))
    steep[rng.random(len(steep)) < 0.01, 2] += 30.0
    steep[rng.random(len(steep)) < 0.01, 2] -= 30.0
    assert hidden_share(steep) < 2e-4


def test_steps_and_upright_walls_hide_nothing():
    rng = np.random.default_rng(3)
    step = cloud(20_000, height=lambda x, y: np.where(x > 10, 6.0, 0.0) + waves(x, y))
    assert hidden_share(step) == 0.0
    wall = np.column_stack(
        [np.full(5000, 10.0), rng.uniform(0, SIDE, 5000), rng.uniform(0, 6, 5000)]
    )
    assert hidden_share(np.concatenate([step, wall])) < 0.005


def test_a_mesh_wound_at_random_says_that_overhangs_cannot_be_told(tmp_path):
    flat = cloud(1000)
    triangles = Delaunay(flat[:, :2]).simplices
    upward = mesh_of(flat, triangles, tmp_path / "rock.ply")
    assert read_scan(upward, {"unit": "mm"}).attrs["overhang_share"] == 0.0
    downward = read_scan(mesh_of(flat, triangles[:, ::-1], upward), {"unit": "mm"})
    assert downward.attrs["overhang_share"] == 0.0
    assert "wound to face down" in downward.attrs["notes"]
    triangles[::3] = triangles[::3, ::-1]
    mixed = read_scan(mesh_of(flat, triangles, upward), {"unit": "mm"})
    assert np.isnan(mixed.attrs["overhang_share"])
    np.testing.assert_allclose(mixed, downward)


def test_noise_finer_than_the_grid_is_averaged_not_aliased(tmp_path):
    rng = np.random.default_rng(6)
    noisy = cloud(10_000, height=lambda x, y: 0.02 * np.sin(x))
    noisy[:, 2] += rng.normal(size=len(noisy))
    scatter = {
        grid: float(read(tmp_path, noisy, grid=f"{grid} mm").std()) for grid in (0.3, 1.0, 2.0)
    }
    assert scatter[0.3] > 0.6  # two points in a cell, three in its triangle: hardly an average
    assert scatter[1.0] < 1.5 / np.sqrt(25)
    assert scatter[2.0] < 1.5 / np.sqrt(100)


def test_lines_far_apart_choose_the_area_of_a_point(tmp_path):
    rng = np.random.default_rng(7)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0, 20, 0.05), np.arange(0, 20, 1.0)))
    x, y = x + rng.uniform(-0.02, 0.02, x.size), y + rng.uniform(-0.02, 0.02, x.size)
    heights = read(tmp_path, np.column_stack([x, y, waves(x, y)]))
    assert heights.attrs["spacing_x"] == pytest.approx(np.sqrt(0.05), rel=0.03)
    assert "unevenly" in heights.attrs["notes"]
    assert heights.attrs["missing_share"] < 0.03  # between the lines nothing is missing


@pytest.mark.parametrize("uneven", [False, True])
def test_points_at_random_choose_the_area_of_a_point(tmp_path, uneven):
    rng = np.random.default_rng(8)
    at = np.arange(0, 20, 0.1) + 0.05
    x, y = (axis.ravel() for axis in np.meshgrid(at, at))
    if uneven:
        x, y = rng.uniform(0, 20, (2, x.size))
    else:  # a lattice that is not quite one, as scanners leave it
        x, y = np.array([x, y]) + rng.uniform(-0.02, 0.02, (2, x.size))
    heights = read(tmp_path, np.column_stack([x, y, waves(x, y)]))
    assert ("unevenly" in heights.attrs["notes"]) == uneven
    # Many cells a point would hold nothing measured: 4.4 at the nearest distance of random points.
    assert 0.7 < x.size / heights.size < 1.1


def test_what_was_read_stands_in_the_attributes(tmp_path):
    flat = cloud(5000)
    flat = flat[np.hypot(flat[:, 0] - 10, flat[:, 1] - 10) > 4]
    heights = read(tmp_path, np.concatenate([flat, flat[:7], raised(flat[:3], 1.0)]), grid="0.5 mm")
    attrs = heights.attrs
    assert (attrs["points"], attrs["duplicated_points"], attrs["stacked_points"]) == (
        len(flat) + 10,
        7,
        3,
    )
    assert attrs["missing_share"] == pytest.approx(float(heights.isnull().mean()))
    assert attrs["missing_share"] == pytest.approx(np.pi * 16 / 400, rel=0.2)
    assert attrs["points_per_cell"] == pytest.approx(0.25 * 5000 / 400, abs=1)
    assert all(isinstance(value, str | int | float) for value in attrs.values())


def test_the_repeats_of_stl_are_no_news(tmp_path):
    flat = cloud(1000)
    path = mesh_of(flat, Delaunay(flat[:, :2]).simplices, tmp_path / "rock.stl")
    attrs = read_scan(path, {"unit": "mm"}).attrs
    assert (attrs["points"], attrs["duplicated_points"]) == (1000, 0)


def test_coordinates_far_from_the_origin_lose_no_digits(tmp_path):
    near = np.round(cloud(), 6)
    far = near + np.array([5e8, 5e9, 0])  # mm: UTM
    here, there = (read(tmp_path, c, grid="0.25 mm") for c in (near, far))
    np.testing.assert_allclose(there.values, here.values, atol=1e-5)
    assert "single precision" not in there.attrs["notes"]


def test_coarse_single_precision_is_noted(tmp_path):
    far = (cloud() + np.array([5e5, 0, 0])).astype(np.float32)
    assert "rounded to 0.031" in read(tmp_path, far).attrs["notes"]
    assert "single precision" not in read(tmp_path, cloud().astype(np.float32)).attrs["notes"]


def test_large_clouds_are_sampled_to_the_same_density(monkeypatch):
    even = cloud(20_000)
    tree = density.plane_tree(even)
    whole = density.measure_density(even, tree)
    monkeypatch.setattr(density, "PATCH_POINTS", 500)
    monkeypatch.setattr(density, "SAMPLE", 4000)
    sampled = density.measure_density(even, tree)
    assert whole.area == pytest.approx(SIDE**2 / 20_000, rel=0.03)
    for name in ("area", "circle", "distance"):
        assert getattr(sampled, name) == pytest.approx(getattr(whole, name), rel=0.05)


# --- bad input ---------------------------------------------------------------------------------


def test_points_on_one_line_are_no_surface(tmp_path):
    x = np.random.default_rng(0).uniform(0, 10, 500)
    line = np.column_stack([x, 3 * x + 1, 0.01 * np.sin(x)])
    notes = read(tmp_path, line).attrs["notes"]  # an upright plane has points, and hardly any area
    assert "stood upright" in notes
    assert re.search(r"NOTE: 99\.\d+ % of the cells are missing", notes)
    lattice = points.covering_lattice(line, 0.5, "rock")
    with pytest.raises(InputError, match=r"rock: the points span no area"):
        tri.interpolate_points(line, lattice, 1.0, 1, "rock")


def test_a_spot_with_far_too_many_points_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(tri, "TILE_POINTS", 100)
    monkeypatch.setattr(tri, "_MAX_IN_TILE", 1000)
    spot = cloud(3000)
    spot[:1400, :2] = 3.0 + spot[:1400, :2] / 1e4
    with pytest.raises(InputError, match=r"rock\.npy: 1\d\d\d points, more than 1000, lie around"):
        read(tmp_path, spot, grid="0.5 mm")


def test_triangles_without_vertices_are_refused(tmp_path):
    flat = cloud(100)
    path = mesh_of(flat, [[0, 1, 2], [3, 4, 99]], tmp_path / "rock.ply")
    content = path.read_bytes()
    path.write_bytes(content.replace((99).to_bytes(4, "little"), (9999).to_bytes(4, "little")))
    with pytest.raises(InputError, match=r"rock\.ply: .*mesh"):
        read_scan(path, {"unit": "mm"})


def test_a_mesh_that_covers_its_area_without_end_is_refused(tmp_path):
    flat = cloud(1000)
    triangles = np.random.default_rng(0).integers(0, len(flat), (3000, 3))
    with pytest.raises(InputError, match="cover its area more than 200 times"):
        read_scan(mesh_of(flat, triangles, tmp_path / "rock.ply"), {"unit": "mm", "grid": "0.1 mm"})


# --- text in blocks ----------------------------------------------------------------------------


BLOCK_FILES = {
    "plain": ["0.5,1.5,2.25", "1,2,3"] * 20,
    "trailing commas": ["0.5,1.5,2.25,"] * 40,
    "header again": ["x,y,z", *["0.5,1.5,2.25"] * 20, "x,y,z", *["7,8,9,"] * 20],
    "comments, gaps": ["# a", *["1 2 3"] * 20, "# b", "", *["  4  5 6"] * 3],
    "missing": ["1;2;nan", "1;2;-", "1;2;3"] * 10,
    "German": ["1,5;2;3"] * 30,
    "cut short": [*["1.5 2.5 3.5"] * 20, "1.5 2"],
}


@pytest.mark.parametrize("lines", BLOCK_FILES.values(), ids=BLOCK_FILES.keys())
@pytest.mark.parametrize("end", ["", "\n"])
def test_blocks_of_text_read_like_the_whole(tmp_path, monkeypatch, lines, end):
    path = tmp_path / "rock.xyz"
    path.write_text("\n".join(lines) + end)
    keys = drafted(path, {"unit": "mm", "layout": "points", "columns": [0, 1, 2]})
    options = parse_options(keys, "rock")
    whole = text.read_text(path, options)
    for block in (1, 30, 170):
        monkeypatch.setattr(text, "_BLOCK", block)
        parts = text.read_text(path, options)
        np.testing.assert_array_equal(parts.values, whole.values)
        assert parts.notes == whole.notes


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("1 2 3 4", "line 30 has 4 values, earlier lines have 3"),
        ("1 2", "line 30 has 2 values, earlier lines have 3"),
        ("1 2 broken", "line 30 holds 'broken', which is no number"),
    ],
)
def test_a_bad_line_in_a_later_block_is_named(tmp_path, monkeypatch, line, message):
    monkeypatch.setattr(text, "_BLOCK", 50)
    path = tmp_path / "rock.xyz"
    path.write_text("1 2 3\n" * 29 + line + "\n" + "1 2 3\n" * 29)
    with pytest.raises(InputError, match=rf"rock\.xyz: {message}"):
        text.read_text(
            path, parse_options({**drafted(path, {"unit": "mm"}), "missing": "none"}, "")
        )


def test_heights_at_one_place_are_averaged_and_counted():
    # Two unmeasured, two measured and once not, one measured twice alike and once otherwise,
    # and one without a place.
    stacked = [[0, 0, np.nan], [0, 0, np.nan], [1, 0, 2], [1, 0, np.nan], [1, 0, 4]]
    stacked += [[2, 0, 5], [2, 0, 8], [2, 0, 5], [0, 1, np.nan], [np.nan, 1, 1]]
    for order in (range(10), range(9, -1, -1)):
        merged, repeats = points.merge_points(np.array(stacked, float)[list(order)])
        expected = [[0, 0, np.nan], [1, 0, 3], [2, 0, 6.5], [0, 1, np.nan]]
        np.testing.assert_array_equal(merged, expected)
        assert repeats == points.Repeats(duplicated=1, stacked=2)


@pytest.mark.parametrize("pitch", [(0.5, 2.0), (2.0, 0.5)])
@pytest.mark.parametrize("share", [1.0, 0.1])
def test_the_points_of_a_cell_are_counted_whichever_side_of_it_is_longer(pitch, share):
    dx, dy = pitch
    lattice = points.Lattice(1.0, -3.0, dx, dy, 30, 20)
    measured = np.zeros((20, 30), bool)
    measured.flat[: round(share * measured.size)] = True
    rows, columns = np.nonzero(measured)
    one = np.column_stack([1 + dx * columns, -3 + dy * rows, 0 * rows])
    beside = np.array([0.4 * dx, 0.4 * dy, 0.0])
    three = np.concatenate([one - beside, one, one + beside])
    heights = np.where(measured, 0.0, np.nan)
    for cloud, expected in ((one, 1), (three, 3)):
        assert density.points_per_cell(cloud, heights, lattice) == expected


def test_a_cell_is_far_from_points_by_the_larger_of_its_side_and_theirs():
    lattice = points.Lattice(0.0, 0.0, 1.0, 1.0, 8, 1)
    first = np.zeros((1, 3))
    for area, reach in ((0.01, 1.5), (1.0, 1.5), (4.0, 3.0), (9.0, 4.5)):
        far = density.far_from_points(first, lattice, area)
        np.testing.assert_array_equal(far, [np.arange(8) >= reach])


@pytest.mark.parametrize(("shift", "kept"), [(3.0, True), (-2.0, True), (0.3, False)])
def test_clouds_on_one_lattice_stay_on_their_nodes(tmp_path, shift, kept):
    y, x = (part.ravel() * 0.5 for part in np.mgrid[:40, :40])
    for name, by in (("rock_lower.npy", 0.0), ("rock_upper.npy", 0.5 * shift)):
        saved(tmp_path, np.column_stack([x + by, y, waves(x + by, y)]), name)
    options = {"unit": "mm", "registration": "none"}
    faces = read_faces(tmp_path / "rock_lower.npy", tmp_path / "rock_upper.npy", options)
    for face in faces:
        assert face.attrs["gridding"].startswith("the points lie on a regular grid") == kept


@pytest.mark.parametrize(
    ("lower", "upper", "expected"),
    [((0.5, 0.8), (0.5, 0.8), 0.5), ((0.8, 0.5), (0.8, 0.5), 0.5), ((0.5, 0.5), (0.7, 0.7), 0.7)],
)
def test_clouds_on_two_lattices_get_the_finer_side_of_the_coarser_one(
    tmp_path, lower, upper, expected
):
    for name, (dx, dy), by in (("lower", lower, 0.0), ("upper", upper, 0.15)):
        rows, columns = (part.ravel() for part in np.mgrid[:40, :40])
        x, y = by + dx * columns, dy * rows
        saved(tmp_path, np.column_stack([x, y, waves(x, y)]), f"rock_{name}.npy")
    options = {"unit": "mm", "registration": "none"}
    for face in read_faces(tmp_path / "rock_lower.npy", tmp_path / "rock_upper.npy", options):
        assert face.attrs["spacing_x"] == face.attrs["spacing_y"] == pytest.approx(expected)


@pytest.mark.parametrize("share", [0.3, 3.0])
def test_cells_are_far_from_points_whichever_side_of_theirs_is_longer(share):
    cell = 1.0, 4.0
    scattered = cloud(60, height=lambda x, y: np.where(x < 15, 0.0, np.nan))
    far = {
        pitch: density.far_from_points(
            scattered[:, order], points.Lattice(0, 0, *pitch, *nodes), share * np.prod(cell)
        )
        for pitch, nodes, order in (
            (cell, (21, 6), [0, 1, 2]),
            (cell[::-1], (6, 21), [1, 0, 2]),
        )
    }
    np.testing.assert_array_equal(far[cell], far[cell[::-1]].T)
    assert 0 < far[cell].mean() < 1


# --- the benchmark -----------------------------------------------------------------------------


@pytest.mark.full
def test_the_benchmark_of_gridding_measures_time_and_peak():
    command = [sys.executable, BENCHMARK, "--points", "3000", "--clouds", "jittered"]
    run = subprocess.run([*command, "--formats", "ply"], check=True, capture_output=True, text=True)
    seconds, _, peak = run.stdout.splitlines()[1].split()[3:6]
    assert float(seconds) > 0
    assert 0 < float(peak) < 4
