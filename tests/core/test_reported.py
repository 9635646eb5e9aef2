"""States that are published: chosen once, stored, and read again."""

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import fractalcontact
from fractalcontact.core.reported import Reported

FORCES = np.array([1.0, 3.0, 10.0, 30.0])


@pytest.fixture
def curves():
    dims = ("direction", "offset", "resolution", "normal_force")
    values = np.arange(2 * 3 * 2 * 4, dtype=float).reshape(2, 3, 2, 4)
    coords = {
        "direction": ["W", "E"],
        "offset": [0.1, 0.2, 0.5],
        "resolution": [1, 2],
        "normal_force": FORCES,
    }
    return xr.Dataset({"closure": (dims, values)}, coords=coords)


@pytest.fixture
def reported(curves):
    return Reported.choose(curves, direction="E", offset=0.2, loads=[2.9, 9.0], reference=31.0)


def test_loads_are_the_nearest_to_those_asked_for(reported):
    assert reported.loads == (1, 2)
    assert reported.quoted == [1, 2, 3]
    assert (reported.reference, reported.force, reported.resolution) == (3, 30.0, 1)


def test_the_reference_load_is_quoted_once(curves):
    found = Reported.choose(curves, direction="E", offset=0.2, loads=[10.0, 30.0], reference=30.0)
    assert found.quoted == [2, 3]


def test_what_is_stored_is_read_again(curves, reported):
    found = Reported.read(curves.assign(reported.variables()))
    for name in ("direction", "offset", "resolution", "loads", "reference"):
        assert getattr(found, name) == getattr(reported, name)
    np.testing.assert_array_equal(found.forces, FORCES)


def test_a_stage_is_cut_to_what_it_has_of_the_reported_state(curves, reported):
    expected = curves["closure"].sel(direction="E", resolution=1)
    np.testing.assert_array_equal(reported.curves(curves)["closure"], expected)
    np.testing.assert_array_equal(reported.states(curves)["closure"], expected.sel(offset=0.2))
    assert float(reported.state(curves)["closure"]) == float(expected.sel(offset=0.2)[3])
    sliding = curves.rename(direction="contact_direction").isel(resolution=0, offset=1)
    expected = expected.sel(offset=0.2)
    np.testing.assert_array_equal(reported.states(sliding)["closure"], expected)


def test_the_reported_offset_of_a_variable_is_the_nearest(curves, reported):
    found = reported.at_offset(curves["closure"])
    np.testing.assert_array_equal(found, curves["closure"].sel(offset=0.2))
    alone = curves["closure"].isel(offset=0)
    assert reported.at_offset(alone) is alone


def test_the_reported_state_is_selected_in_one_module():
    """So is the state nearest to any offset: others ask Reported, or :func:`states_at`."""
    inside = r"(?:[^()]|\([^()]*\))*"
    asked = re.compile(rf"\.sel\({inside}\boffset\s*=({inside}\bmethod|\s*\w+\.offset\b)")
    source = Path(fractalcontact.__file__).parent
    found = [
        path.relative_to(source).as_posix()
        for path in source.rglob("*.py")
        if asked.search(path.read_text(encoding="utf-8"))
    ]
    assert found == ["core/reported.py"]
