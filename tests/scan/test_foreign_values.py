"""Values that are hardly heights: each kind refused or warned of, none of them silently read."""

import struct

import numpy as np
import pytest
from scan_writers import nodes
from stated import ARRAY, COMMAS, POINTS, read_faces, read_scan

from fractalcontact.core.errors import InputError
from fractalcontact.core.labels import listed, on_one_line
from fractalcontact.core.text import plain
from fractalcontact.core.units import length_factor
from fractalcontact.scan import read
from fractalcontact.scan.undeclared import find_marks
from fractalcontact.surface.synthesis import self_affine

#: A sidecar that states a mark of missing cells, and not the one in the file.
MATRIX = {**ARRAY, "unit": "mm", "spacing": 0.1, "missing": 12345}
CLOUD = {key: value for key, value in POINTS.items() if key not in COMMAS} | {"missing": 12345}
N = 48


def rough(seed=1, n=N, hurst=0.8, rms=0.1):
    return self_affine((n, n), 0.1, hurst, rms=rms, seed=seed)


def saved(path, values):
    np.save(path, values)
    return path


def warnings_for(path, options=MATRIX):
    return read_scan(path, options).attrs["warnings"]


# --- numbers that mark missing cells, undeclared -----------------------------------------------

BLOCK = (slice(5, 12), slice(8, 20))
FAR = {
    "a block of -9999": (-9999.0, BLOCK),
    "a block of -32768": (-32768.0, BLOCK),
    "a block of 1e20": (1e20, BLOCK),
    "rows of 99999": (99999.0, (slice(0, 3), slice(None))),
    "one cell of -9999": (-9999.0, (slice(7, 8), slice(9, 10))),
    "scattered cells of 40": (40.0, (slice(None, None, 7), slice(3, None, 11))),
    "more than half of -9999": (-9999.0, (slice(0, 30), slice(None))),
}


@pytest.mark.parametrize("tilt", [0.0, pytest.param(0.5, marks=pytest.mark.full)])
@pytest.mark.parametrize("kind", FAR)
def test_a_number_far_outside_is_refused_with_the_key_that_reads_it(tmp_path, kind, tilt):
    mark, place = FAR[kind]
    z = rough() + tilt * 0.1 * np.arange(N)
    truth = z.copy()
    z[place], truth[place] = mark, np.nan
    path = saved(tmp_path / "rock.npy", z)
    with pytest.raises(
        InputError, match=r"rock\.npy: .*probably a mark for missing cells"
    ) as error:
        read_scan(path, MATRIX)
    key = str(error.value).split("write 'missing: ")[1].split("'")[0]
    np.testing.assert_array_equal(read_scan(path, {**MATRIX, "missing": float(key)}), truth)


def test_two_marks_are_named_together_and_both_can_be_written(tmp_path):
    z = rough()
    z[:3], z[20:24, 5:9] = -9999.0, -32768.0
    path = saved(tmp_path / "rock.npy", z)
    with pytest.raises(InputError, match=r"missing: \[-32768, -9999\]"):
        read_scan(path, MATRIX)
    heights = read_scan(path, {**MATRIX, "missing": [-32768, -9999]})
    assert int(heights.isnull().sum()) == 3 * N + 16


def test_points_have_marks_too(tmp_path):
    points = nodes(rough(), 0.1, 0.1)
    points[40:60, 2] = -9999.0
    path = saved(tmp_path / "rock.npy", points)
    with pytest.raises(InputError, match=r"20 x -9999, far.*'missing: -9999'"):
        read_scan(path, CLOUD)
    heights = read_scan(path, CLOUD | {"missing": -9999})
    assert int(heights.isnull().sum()) == 20


RIM = np.ones((N, N), bool)
RIM[4:-4, 4:-4] = False
AMONG = {
    "zeros around the rim": (RIM, 0.0),
    "a disc in a square of zeros": (
        np.hypot(*(np.indices((N, N)) - N / 2 + 0.5)) > N / 2 - 1,
        0.0,
    ),
    "scattered zeros": (np.random.default_rng(0).random((N, N)) < 0.03, 0.0),
    "heights cut off": (rough() > 0.1, 0.1),
}


@pytest.mark.parametrize("digits", [16, pytest.param(4, marks=pytest.mark.full)])
@pytest.mark.parametrize("kind", AMONG)
def test_a_number_that_repeats_among_the_heights_is_warned_of(tmp_path, kind, digits):
    where, mark = AMONG[kind]
    z = np.round(rough(), digits)
    z[where] = mark
    path = saved(tmp_path / "rock.npy", z)
    found = warnings_for(path)
    assert f" x exactly {mark:g}, many times as often" in found
    assert f"'missing: {mark:g}'" in found
    np.testing.assert_array_equal(read_scan(path, MATRIX), z)  # nothing is changed
    assert "many times" not in warnings_for(path, {**MATRIX, "missing": "none"})


HONEST = {
    "rough": rough(),
    "very rough": rough(hurst=0.2),
    "smooth": rough(hurst=0.99),
    "tilted": rough() + 0.3 * np.arange(N),
    "of few digits": np.round(rough(), 2),
    "of eight bits": np.round(rough() * 300),
    "with a spike": np.where(np.arange(N * N).reshape(N, N) == 1000, 30.0, rough()),
    "with two spikes": rough() + 30.0 * (np.arange(N * N).reshape(N, N) % 1100 == 7),
    "a step": rough() + 5.0 * (np.arange(N) > 20),
    "far from zero": rough() - 9999.0,
    "a checkerboard": 0.01 * (np.indices((N, N)).sum(axis=0) % 2),
    "two plateaus": 0.02 * (np.indices((N, N)).max(axis=0) > 30),
    "one peak on a plane": np.where(np.arange(N * N).reshape(N, N) == 1000, 0.1, 0.0),
}


@pytest.mark.parametrize("kind", HONEST)
def test_honest_heights_have_no_mark(kind):
    assert find_marks(HONEST[kind]) == []


def test_marks_are_found_in_a_sample_of_a_large_scan():
    z = np.random.default_rng(3).normal(size=(1500, 1500))
    z[3:9, 4:10] = -9999.0
    (mark,) = find_marks(z)
    assert (mark.value, mark.cells, mark.outside) == (-9999.0, 36, True)


# --- no surface at all -------------------------------------------------------------------------

GRID_Y, GRID_X = 0.1 * np.indices((N, N))
COORDINATES = {
    "x of a grid": GRID_X,
    "y of a grid": GRID_Y,
    "uneven x": GRID_X**2 + 0.3 * GRID_X,
    "falling y": 7.0 - GRID_Y,
    "x with three digits": np.round(GRID_X / 3, 3),
}


@pytest.mark.parametrize("kind", COORDINATES)
def test_coordinates_are_refused(tmp_path, kind):
    path = saved(tmp_path / "grid.npy", COORDINATES[kind])
    with pytest.raises(InputError, match=r"grid\.npy: all heights are equal .*'variable'"):
        read_scan(path, MATRIX)


DOUBTFUL = {
    "a tilted plane": (0.1 * GRID_X + 0.05 * GRID_Y, "on one plane to within rounding"),
    "a plane far off": (1e4 + 0.1 * GRID_X + 0.2 * GRID_Y, "on one plane to within rounding"),
    "a plane with holes": (
        np.where(rough() > 0.15, np.nan, 0.3 * GRID_X - GRID_Y),
        "on one plane to within rounding",
    ),
    "a profile along x": (np.tile(rough()[5], (N, 1)), "the same all along y: a profile"),
    "a profile along y": (np.tile(rough()[5], (N, 1)).T, "the same all along x: a profile"),
    "grooves": (0.2 * np.sin(GRID_X), "the same all along y: a profile"),
    "99 % missing": (
        np.where(np.indices((N, N)).max(axis=0) > 8, np.nan, rough()),
        "96 % of the cells are missing",
    ),
    "two thirds missing": (
        np.where(np.arange(N)[:, None] > 15, np.nan, rough()),
        "67 % of the cells are missing",
    ),
    "half of it and a bit": (
        np.where(np.arange(N)[:, None] >= 22, np.nan, rough()),
        "54 % of the cells are missing",
    ),
    "two tables beside each other": (
        np.hstack([rough(1), rough(2) - 2.0]),
        "columns 48 and 49 differ",
    ),
    "two tables of other levels": (
        np.vstack([rough(1)[:20] + 1.0, rough(2) + 3.0]),
        "rows 20 and 21 differ",
    ),
}


@pytest.mark.parametrize("kind", DOUBTFUL)
def test_what_is_hardly_a_scan_is_warned_of(tmp_path, kind):
    z, said = DOUBTFUL[kind]
    assert said in warnings_for(saved(tmp_path / "rock.npy", z))


@pytest.mark.parametrize("hurst", [0.2, 0.5, 0.9])
@pytest.mark.parametrize("seed", [1, *(pytest.param(n, marks=pytest.mark.full) for n in (2, 3))])
def test_rough_surfaces_are_warned_of_nothing(tmp_path, hurst, seed):
    z = rough(seed, hurst=hurst) + seed * 0.02 * GRID_X
    assert warnings_for(saved(tmp_path / "rock.npy", z)) == ""
    points = np.column_stack([GRID_X.ravel(), GRID_Y.ravel(), z.ravel()])
    points[:, :2] += np.random.default_rng(seed).uniform(-0.03, 0.03, (N * N, 2))
    assert warnings_for(saved(tmp_path / "cloud.npy", points), {"unit": "mm"}) == ""


def ball(flat=1.0, n=40):
    """Vertices and triangles of a rough ellipsoid: a boulder, or a cobble."""
    rows, around = np.meshgrid(
        np.linspace(0, np.pi, n + 1)[1:-1],
        np.linspace(0, 2 * np.pi, 2 * n, endpoint=False),
        indexing="ij",
    )
    radius = 50 * (1 + 0.02 * np.random.default_rng(1).normal(size=rows.shape))
    points = radius * [
        np.sin(rows) * np.cos(around),
        np.sin(rows) * np.sin(around),
        flat * np.cos(rows),
    ]
    points = np.vstack([points.reshape(3, -1).T, [[0, 0, 50 * flat], [0, 0, -50 * flat]]])
    m, triangles = 2 * n, []
    for i in range(n - 2):
        for j in range(m):
            a, b = i * m + j, i * m + (j + 1) % m
            triangles += [(a, a + m, b), (b, a + m, b + m)]
    top, bottom, last = len(points) - 2, len(points) - 1, (n - 2) * m
    for j in range(m):
        triangles += [(top, j, (j + 1) % m), (bottom, last + (j + 1) % m, last + j)]
    return points, np.array(triangles)


def write_stl(path, points, triangles):
    record = np.zeros(
        len(triangles), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]
    )
    record["corners"] = points[triangles]
    path.write_bytes(b"made".ljust(80) + struct.pack("<I", len(triangles)) + record.tobytes())
    return path


@pytest.mark.parametrize(
    "flat", [1.0, *(pytest.param(part, marks=pytest.mark.full) for part in (0.3, 0.1))]
)
def test_closed_bodies_are_named(tmp_path, flat):
    points, triangles = ball(flat)
    path = write_stl(tmp_path / "boulder.stl", points, triangles)
    assert "a closed body, such as a boulder" in warnings_for(path, {"unit": "mm"})
    refused_cloud(tmp_path / "boulder.npy", points)
    upper_half = triangles[(points[triangles][:, :, 2] > 5 * flat).all(axis=1)]
    path = write_stl(tmp_path / "dome.stl", points, upper_half)
    assert "closed body" not in warnings_for(path, {"unit": "mm"})


def refused_cloud(path, points):
    with pytest.raises(InputError, match="two faces or scans in one file, or a body; save each"):
        read_scan(saved(path, points), {"unit": "mm"})


@pytest.mark.parametrize("gap", [0.5, 5.0])
def test_two_faces_in_one_cloud_are_refused(tmp_path, gap):
    """At the same x and y, between each other, scattered, and one over half of the other."""
    lower, upper = nodes(rough(1), 0.1, 0.1), nodes(rough(1) + gap, 0.1, 0.1)
    refused_cloud(tmp_path / "same.npy", np.vstack([lower, upper]))
    half = upper[upper[:, 0] < np.median(upper[:, 0])]
    refused_cloud(tmp_path / "half.npy", np.vstack([lower, half]))
    upper[:, :2] += 0.043
    lower[:, 0] += 0.02 * np.sin(np.arange(len(lower)))
    refused_cloud(tmp_path / "between.npy", np.vstack([lower, upper]))
    scattered = np.random.default_rng(2).normal(0, 0.02, (len(lower), 2))
    lower[:, :2] += scattered
    refused_cloud(tmp_path / "scattered.npy", np.vstack([lower, upper]))


@pytest.mark.parametrize("noise", [0.001, 0.05, 1.0])
def test_a_noisy_cloud_scanned_twice_is_one_face(tmp_path, noise):
    """However large the noise, white or rounded to steps; and so is a face of steps."""
    rng = np.random.default_rng(3)
    rough_face = rough(1)

    def once(heights):
        points = nodes(heights, 0.1, 0.1)
        return points + np.c_[rng.normal(0, 0.02, (len(points), 2)), np.zeros(len(points))]

    noisy = [rough_face + noise * rng.normal(size=rough_face.shape) for _ in range(2)]
    same = np.vstack([nodes(one, 0.1, 0.1) for one in noisy])
    steps = 0.1 * rough_face + 2.0 * (np.arange(rough_face.shape[1]) // 5 % 2)
    clouds = {
        "same": same,
        "between": np.vstack([once(one) for one in noisy]),
        "rounded": np.vstack([once(np.round(one / noise) * noise) for one in noisy]),
        "steps": once(steps),
    }
    for name, points in clouds.items():
        heights = read_scan(saved(tmp_path / f"{name}.npy", points), {"unit": "mm"})
        assert np.isfinite(heights.values).mean() > 0.9, name


def sheet(heights, step=0.5):
    """Vertices and triangles of a face on a grid."""
    ny, nx = heights.shape
    first = (np.arange(ny - 1)[:, None] * nx + np.arange(nx - 1)).ravel()
    halves = [[first, first + 1, first + nx + 1], [first, first + nx + 1, first + nx]]
    return nodes(heights, step, step), np.concatenate([np.transpose(half) for half in halves])


def together(*parts):
    """One mesh of several."""
    before = np.cumsum([0, *(len(points) for points, _ in parts)])
    triangles = [part + n for (_, part), n in zip(parts, before, strict=False)]
    return np.concatenate([points for points, _ in parts]), np.concatenate(triangles)


@pytest.mark.parametrize("shift", [0.0, 0.13, 0.25])
@pytest.mark.parametrize("wound", [1, -1])
def test_two_faces_in_one_mesh_are_refused(tmp_path, shift, wound):
    """At the same x, y, between them, and on one finer lattice; wound alike or not."""
    lower, (points, triangles) = sheet(rough(1)), sheet(rough(1) + 1.3)
    upper = points + np.array([shift, shift, 0.0]), triangles[:, ::wound]
    path = write_stl(tmp_path / "two.stl", *together(lower, upper))
    with pytest.raises(
        InputError, match=r"two\.stl: the mesh has (1\.9|2\.\d) heights at each x, y"
    ):
        read_scan(path, {"unit": "mm"})
    beside = points + np.array([100.0, 0.0, 0.0]), triangles
    side_by_side = read_scan(
        write_stl(tmp_path / "beside.stl", *together(lower, beside)), {"unit": "mm"}
    )
    assert side_by_side.attrs["missing_share"] > 0.5


def block(heights, depth, step=0.5):
    """A face on a box with a flat bottom, which is one sheet of as many vertices."""
    ny, nx = heights.shape
    top, bottom = sheet(heights, step), sheet(np.full(heights.shape, -depth), step)
    rim = np.arange(nx * ny).reshape(ny, nx)
    rim = np.concatenate([rim[0], rim[1:, -1], rim[-1, -2::-1], rim[-2:0:-1, 0]])
    following, below = np.roll(rim, -1), nx * ny
    walls = np.concatenate(
        [np.column_stack([rim, rim + below, following]),
         np.column_stack([following, rim + below, following + below])]
    )  # fmt: skip
    points, triangles = together(top, (bottom[0], bottom[1][:, ::-1]))
    return points, np.concatenate([triangles, walls]), walls


def test_the_flat_bottom_of_a_body_is_no_mark_of_missing_cells(tmp_path):
    """A closed block is read from above with a warning; one without walls is named a body."""
    heights = rough(1)
    points, triangles, walls = block(heights, 60.0)
    path = write_stl(tmp_path / "block.stl", points, triangles)
    assert "a closed body, such as a boulder" in warnings_for(path, {"unit": "mm"})
    read = read_scan(path, {"unit": "mm"})
    inner = read.values[2:-2, 2:-2]
    assert np.ptp(inner) == pytest.approx(np.ptp(heights[2:-2, 2:-2]), rel=1e-5)
    path = write_stl(tmp_path / "open.stl", points, triangles[: -len(walls)])
    with pytest.raises(InputError, match=r"probably the flat bottom of a body, whose face you"):
        read_scan(path, {"unit": "mm"})


@pytest.mark.parametrize("axes", [[0, 1], [0], [1]])
def test_points_on_one_place_or_line_are_refused(tmp_path, axes):
    """As single precision leaves coordinates of a country's grid: no division by their distance."""
    points = nodes(rough(1), 0.001, 0.001)
    points[:, axes] = np.array([500_000.1, 5_800_000.0])[axes]
    path = saved(tmp_path / "one.npy", points.astype(np.float32))
    reason = "stand on one place, x = 500000" if len(axes) == 2 else "one line|one place|points"
    with pytest.raises(InputError, match=reason):
        read_scan(path, {"unit": "m"})


# --- steep scans, units ------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [40, 50, 60, 75])
@pytest.mark.parametrize("axis", [0, pytest.param(1, marks=pytest.mark.full)])
def test_steep_matrices_are_judged_level(tmp_path, degrees, axis):
    z = rough() + np.tan(np.radians(degrees)) * (GRID_Y, GRID_X)[axis]
    heights = read_scan(saved(tmp_path / "steep.npy", z), MATRIX)
    np.testing.assert_array_equal(heights, z)


def test_a_slope_that_no_scan_has_is_refused(tmp_path):
    z = rough() + 30 * GRID_X
    with pytest.raises(InputError, match="88 degrees, where at most 80 are read"):
        read_scan(saved(tmp_path / "rock.npy", z), MATRIX)


@pytest.mark.parametrize("unit", ["-1 um", "-0.5 mm", "0 um"])
def test_a_unit_that_is_not_above_zero_is_refused(tmp_path, unit):
    with pytest.raises(InputError, match="is not above zero"):
        length_factor(unit, "rock.yaml: unit_z")
    path = saved(tmp_path / "rock.npy", rough())
    with pytest.raises(InputError, match=r"rock\.npy: unit_z: .* is not above zero"):
        read_scan(path, {"unit_xy": "mm", "unit_z": unit, "spacing": 0.1})


# --- two faces ---------------------------------------------------------------------------------


def faces(folder, gap, registration="rigid", kind="npy", seed=2):
    lower = rough()
    upper = lower + gap + 0.1 * rough(seed)
    paths = [folder / f"{name}.{kind}" for name in ("joint.lower", "joint.upper")]
    for path, z in zip(paths, (lower, upper), strict=True):
        saved(path, z)
    return read_faces(*paths, {**MATRIX, "registration": registration})


@pytest.mark.parametrize(
    "gap", [-0.2, *(pytest.param(gap, marks=pytest.mark.full) for gap in (-1.0, -30.0))]
)
def test_faces_in_the_wrong_order_are_named(tmp_path, gap):
    with pytest.raises(InputError, match=r"below the lower one in .* exchange 'lower' and 'upper'"):
        faces(tmp_path, gap, "none")
    for registration in ("rigid", "translation"):
        _, upper = faces(tmp_path, gap, registration)
        assert "exchange 'lower' and 'upper' in their names" in upper.attrs["registration"]
        assert '"gap_mean_before_mm": null' in upper.attrs["registration"]


@pytest.mark.parametrize(
    "gap", [-0.005, *(pytest.param(gap, marks=pytest.mark.full) for gap in (0.0, 0.2, 5.0))]
)
def test_faces_in_order_keep_their_gap(tmp_path, gap):
    for registration in ("rigid", "none"):
        lower, upper = faces(tmp_path, gap, registration)
        assert "exchange" not in upper.attrs["registration"]
        assert float((upper - lower).mean()) == pytest.approx(gap, abs=2e-3)


@pytest.mark.parametrize("swapped", [False, True])
def test_a_cloud_beside_a_matrix_has_one_advice(tmp_path, swapped):
    cloud = saved(tmp_path / "joint.lower.npy", nodes(rough(), 0.1, 0.1))
    matrix = saved(tmp_path / "joint.upper.npy", rough())
    pair = (matrix, cloud) if swapped else (cloud, matrix)
    stated = (MATRIX, CLOUD) if swapped else (CLOUD, MATRIX)
    options = dict(zip(("lower", "upper"), stated, strict=True))
    with pytest.raises(InputError, match=r"export joint\.upper\.npy as points x, y, z too"):
        read.read_faces(*pair, options)


# --- numbers and names in sentences ------------------------------------------------------------


def test_lengths_are_those_a_person_reads():
    lengths = (12345.0, -300000.0, 0.00001234, 100.0, 99.96, 5e8, 0.0)
    assert [plain(length) for length in lengths] == [
        "12300", "-300000", "0.0000123", "100", "100", "500000000", "0",
    ]  # fmt: skip


def test_quotes_end_at_words_and_lists_say_how_many_more():
    text = "one two three " * 40
    short = on_one_line(text, 50)
    assert len(short) <= 52
    assert short.endswith((" one …", " two …", " three …"))
    assert on_one_line("short") == "short"
    assert listed(["a", "b"]) == "a, b"
    assert listed(range(100), most=3) == "0, 1, 2 and 97 more"
