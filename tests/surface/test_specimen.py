"""Levelling, window and reach of a specimen."""

import re

import numpy as np
import pytest
import xarray as xr
from samples import scan_of

from fractalcontact.core.errors import InputError
from fractalcontact.core.window import faces, window_slices
from fractalcontact.surface.specimen import largest_offset, make_specimen


def rough(shape=(40, 60), seed=1):
    return np.random.default_rng(seed).normal(size=shape)


def test_a_plane_is_recovered_and_removed():
    scan = scan_of(np.zeros((30, 50)), x0=1000.25)
    scan = scan + 0.03 * scan.x - 0.02 * scan.y + 7.0
    scan.attrs = scan_of(np.zeros((2, 2))).attrs
    specimen = make_specimen(scan, name="plane")
    assert np.abs(specimen.lower.values).max() < 1e-12
    assert specimen.attrs["plane_slope_x"] == pytest.approx(0.03, abs=1e-12)
    assert specimen.attrs["plane_slope_y"] == pytest.approx(-0.02, abs=1e-12)
    assert specimen.attrs["plane_offset_mm"] == pytest.approx(7.0, abs=1e-9)
    assert "NOTE" not in specimen.attrs["levelling"]


def test_a_steep_tilt_is_noted():
    z = np.arange(50) * 0.5 * np.tan(np.radians(6.0)) + rough((30, 50)) * 1e-6
    specimen = make_specimen(scan_of(z))
    assert specimen.attrs["tilt_degrees"] == pytest.approx(6.0, abs=1e-3)
    assert "above 5 degrees" in specimen.attrs["levelling"]


def test_levelling_leaves_the_gap_between_two_faces_unchanged():
    z_l, z_u = rough(seed=1), rough(seed=2) + 0.1 * np.arange(60) + 3.0
    z_l[3, 4] = z_u[20, 30] = np.nan
    specimen = make_specimen(scan_of(z_l), scan_of(z_u))
    lower, upper = faces(specimen)
    np.testing.assert_allclose(upper - lower, z_u - z_l, atol=1e-12)
    both = np.isfinite(z_l) & np.isfinite(z_u)
    np.testing.assert_array_equal(specimen.valid.values, both)
    # What the least-squares plane of the mean face leaves is orthogonal to 1, x and y.
    mean_face = ((lower + upper) / 2)[both]
    x, y = np.meshgrid(specimen.x, specimen.y)
    for term in (np.ones(both.sum()), x[both], y[both]):
        assert abs(mean_face @ term) < 1e-8
    assert specimen.attrs["opposite"] == "scanned"
    assert specimen.attrs["faces"] == 2


def test_the_face_that_was_not_scanned():
    scan = scan_of(rough())
    z_l, z_u = faces(make_specimen(scan, opposite="match"))
    assert z_u is z_l
    flat = make_specimen(scan, opposite="flat")
    z_l, z_u = faces(flat)
    assert not z_u.any()
    assert [largest_offset(flat, d) for d in "ENWS"] == [0, 0, 0, 0]
    assert flat.attrs["window_ny"] == flat.attrs["window_nx"] == 40


def test_automatic_window_can_slide_by_a_quarter_of_the_largest_square():
    z = rough((80, 100))
    z[:, :20] = np.nan  # leaves one 80 x 80 square
    specimen = make_specimen(scan_of(z))
    rows, columns = window_slices(specimen)
    assert (rows.start, rows.stop, columns.start, columns.stop) == (20, 60, 40, 80)
    assert [largest_offset(specimen, d) for d in "ENWS"] == [20, 20, 20, 20]


@pytest.mark.parametrize("seed", range(5))
def test_automatic_window_is_found_as_brute_force_finds_it(seed):
    rng = np.random.default_rng(seed)
    z = rough((25, 31), seed)
    z[rng.integers(0, 25, 12), rng.integers(0, 31, 12)] = np.nan
    side = max(
        n
        for n in range(1, 26)
        for y in range(26 - n)
        for x in range(32 - n)
        if np.isfinite(z[y : y + n, x : x + n]).all()
    )
    specimen = make_specimen(scan_of(z), opposite="flat")
    assert specimen.attrs["window_ny"] == specimen.attrs["window_nx"] == side
    assert specimen.valid.values[window_slices(specimen)].all()


def oblong(z, spacing):
    """A scan on cells (dy, dx)."""
    coords = {a: d * (np.arange(n) + 0.5) for a, d, n in zip("yx", spacing, z.shape, strict=True)}
    attrs = {"spacing_y": spacing[0], "spacing_x": spacing[1], "source": "rock.npy"}
    return xr.DataArray(z, coords, ("y", "x"), attrs=attrs)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("spacing", [(0.5, 0.2), (0.2, 0.5), (0.3, 0.7)])
def test_automatic_window_is_square_but_for_a_part_of_the_smaller_cell_side(seed, spacing):
    rng = np.random.default_rng(seed)
    z = rough((45, 51), seed)
    z[rng.integers(0, 45, 9), rng.integers(0, 51, 9)] = np.nan
    specimen = make_specimen(oblong(z, spacing), opposite="flat")
    sides = specimen.attrs["window_mm"]
    assert abs(sides[0] - sides[1]) < min(spacing) * (1 + 1e-9)
    assert specimen.valid.values[window_slices(specimen)].all()


REACH = {"E": 1.1, "N": 2.3, "W": 0.0, "S": 0.4}
EXCHANGED = {"N": "E", "E": "N", "S": "W", "W": "S"}


def with_holes(seed):
    """Heights with holes that the window meets in the middle, or on its way."""
    rng = np.random.default_rng(seed)
    z = rough((41, 63), seed)
    z[rng.integers(0, 41, 8), rng.integers(0, 63, 8)] = np.nan
    return z


@pytest.mark.parametrize("seed", range(10))
def test_with_x_for_y_a_window_finds_the_same_place(seed):
    z = with_holes(seed)
    here = make_specimen(oblong(z, (0.31, 0.2)), window=(3.1, 4.0), reach=REACH)
    reach = {EXCHANGED[way]: distance for way, distance in REACH.items()}
    there = make_specimen(oblong(z.T, (0.2, 0.31)), window=(4.0, 3.1), reach=reach)
    assert window_slices(here) == window_slices(there)[::-1]
    for way, distance in REACH.items():
        slides = largest_offset(here, way)
        assert slides == largest_offset(there, EXCHANGED[way])
        assert slides * (0.2 if way in "EW" else 0.31) >= distance


@pytest.mark.parametrize("spacing", [(0.3, 0.1), (0.1, 0.3)])
@pytest.mark.parametrize("seed", range(5))
def test_a_window_goes_to_the_place_that_is_nearest_in_mm(seed, spacing):
    z = with_holes(seed)
    z[20, 31] = np.nan  # in the middle
    cells = (8, 12)
    window = tuple(n * s for n, s in zip(cells, spacing, strict=True))
    rows, columns = window_slices(make_specimen(oblong(z, spacing), window=window))

    def away(y, x):
        off = (y + cells[0] / 2 - 41 / 2, x + cells[1] / 2 - 63 / 2)
        return np.hypot(*np.multiply(off, spacing))

    free = [
        away(y, x)
        for y in range(41 - cells[0] + 1)
        for x in range(63 - cells[1] + 1)
        if np.isfinite(z[y : y + cells[0], x : x + cells[1]]).all()
    ]
    assert away(rows.start, columns.start) == pytest.approx(min(free))


def test_window_of_a_given_side_is_central_and_rounded_down():
    specimen = make_specimen(scan_of(rough((40, 60))), window=10.3, multiple=8)
    rows, columns = window_slices(specimen)
    assert (rows.start, rows.stop, columns.start, columns.stop) == (12, 28, 22, 38)
    assert specimen.attrs["window_mm"] == [8.0, 8.0]
    assert "cut from 20 x 20 to 16 x 16 cells" in specimen.attrs["window_note"]


def test_a_side_that_is_whole_cells_loses_none_to_rounding():
    specimen = make_specimen(scan_of(rough((60, 60)), spacing=0.1), window=4.1)
    assert specimen.attrs["window_ny"] == 41


def test_window_centre_is_in_millimetres_y_x():
    specimen = make_specimen(scan_of(rough()), window=(4.0, 5.0), window_centre=(5.0, 20.0))
    rows, columns = window_slices(specimen)
    assert specimen.y[rows].mean() == pytest.approx(5.0, abs=0.26)
    assert specimen.x[columns].mean() == pytest.approx(20.0, abs=0.26)
    assert (rows.stop - rows.start, columns.stop - columns.start) == (8, 10)


def test_window_moves_to_the_nearest_place_without_a_hole():
    z = rough((40, 60))
    z[20, 25] = np.nan  # the central 10 x 10 window is rows 15-24, columns 25-34
    specimen = make_specimen(scan_of(z), window=5.0, window_centre=(10.0, 15.0))
    rows, columns = window_slices(specimen)
    assert (rows.start, columns.start) == (15, 26)
    assert "because of a hole" in specimen.attrs["window_note"]


def test_window_prefers_a_place_it_can_slide_from():
    z = rough((40, 60))
    z[:, 38] = np.nan  # central window: columns 25-34, only 3 cells free to the East
    scan = scan_of(z)
    here = make_specimen(scan, window=5.0, window_centre=(10.0, 15.0), reach={"E": 5.0})
    assert largest_offset(here, "E") == 3
    moved = make_specimen(scan, window=5.0, reach={"E": 5.0})
    assert largest_offset(moved, "E") == 10
    assert "because of the offsets asked for" in moved.attrs["window_note"]


@pytest.mark.parametrize("direction", "ENWS")
def test_largest_offset_stops_before_the_first_hole(direction):
    z = rough((41, 41))
    hole = {"E": (20, 35), "W": (20, 5), "N": (35, 20), "S": (5, 20)}[direction]
    z[hole] = np.nan
    specimen = make_specimen(scan_of(z), window=5.5, window_centre=(10.25, 10.25))
    assert window_slices(specimen) == (slice(15, 26), slice(15, 26))
    expected = dict.fromkeys("ENWS", 15) | {direction: 9}
    assert {d: largest_offset(specimen, d) for d in "ENWS"} == expected


def test_a_window_larger_than_the_scan_names_the_key_and_the_largest():
    with pytest.raises(InputError, match=r"granite: key 'window'.*at most 'window: 20 mm'"):
        make_specimen(scan_of(rough((40, 60))), window=25.0, name="granite")


def test_no_hole_free_place_says_where_the_holes_are_and_what_fits():
    z = rough((40, 40))
    z[10, :] = np.nan
    z[30, 0] = np.nan  # the bottom 29 rows are free of holes from column 1 on
    with pytest.raises(InputError) as error:
        make_specimen(scan_of(z), window=15.0, name="granite")
    message = str(error.value)
    for part in ("granite (rock.npy)", "2.6 %", "y = 5.25 and 15.25", "'window: 14.5 mm'"):
        assert part in message
    # What the message says to write does work.
    specimen = make_specimen(scan_of(z), window=14.5)
    assert specimen.attrs["window_ny"] == 29
    assert specimen.valid.values[window_slices(specimen)].all()


@pytest.mark.parametrize("seed", range(4))
def test_the_place_that_a_refusal_names_is_free(seed):
    z = rough((40, 60), seed)
    z[np.random.default_rng(seed).random(z.shape) < 0.02] = np.nan
    with pytest.raises(InputError) as error:
        make_specimen(scan_of(z), window=15.0)
    side, x, y = re.search(
        r"a side of (\S+) mm, centred on x = (\S+), y = (\S+) mm", str(error.value)
    ).groups()
    found = make_specimen(scan_of(z), window=float(side), window_centre=(float(y), float(x)))
    assert found.attrs["window_note"] == ""  # it did not have to move
    # Nor is there room for a larger one.
    with pytest.raises(InputError, match="no hole-free place"):
        make_specimen(scan_of(z), window=float(side) + 0.5)


def test_a_window_that_holes_leave_too_small_names_the_key_that_fills_them():
    z = rough((40, 40))
    z[3:-3:4, 3:-3:4] = np.nan
    with pytest.raises(InputError, match=r"a window of 4 x 4 cells .*'fill_holes: 1' fills"):
        make_specimen(scan_of(z), opposite="flat")
    filled = make_specimen(scan_of(z), opposite="flat", fill_holes=1)
    assert filled.attrs["window_ny"] == 40
    z = rough((9, 9))  # of a scan this small a small window is all there is
    assert make_specimen(scan_of(z)).attrs["window_ny"] == 4


def test_faces_on_different_grids_are_refused():
    with pytest.raises(InputError, match="not on one grid"):
        make_specimen(scan_of(rough()), scan_of(rough(), x0=0.5))


def test_fewer_cells_than_the_multiple_is_refused():
    with pytest.raises(InputError, match="fewer than the multiple of 16"):
        make_specimen(scan_of(rough()), window=5.0, multiple=16)


def test_a_specimen_survives_netcdf(tmp_path):
    specimen = make_specimen(scan_of(rough()), scan_of(rough(seed=2)), window=5.0, name="granite")
    specimen.to_netcdf(tmp_path / "specimen.nc")
    with xr.open_dataset(tmp_path / "specimen.nc") as again:
        xr.testing.assert_equal(again, specimen)
        assert again.valid.dtype == bool
        assert window_slices(again) == window_slices(specimen)
        assert largest_offset(again, "E") == largest_offset(specimen, "E")
    for variable in specimen.variables.values():
        assert {"units", "long_name"} <= set(variable.attrs) or variable.name in "xy"


@pytest.mark.parametrize("window", [None, 6.0])
def test_the_key_that_fills_holes_is_named_where_holes_leave_no_window(window):
    """A tenth of the cells are missing singly; the refusal's own key gives a window."""
    rng = np.random.default_rng(3)
    z = rng.normal(0, 0.01, (60, 60))
    z[1:-1, 1:-1][rng.random((58, 58)) < 0.1] = np.nan
    at = 0.25 * np.arange(60)
    attrs = {"spacing_x": 0.25, "spacing_y": 0.25, "source": "holes.xyz"}
    lower = xr.DataArray(z, {"y": at, "x": at}, ("y", "x"), attrs=attrs)
    stated = {"window": window, "multiple": 8}
    with pytest.raises(InputError, match="'fill_holes: ") as error:
        make_specimen(lower, **stated)
    largest = int(re.search(r"'fill_holes: (\d+)'", str(error.value))[1])
    filled = make_specimen(lower, fill_holes=largest, **stated)
    assert filled.attrs["window_nx"] >= 8
