"""Verdicts on the paper's statements: each rule on numbers made to meet it and to miss it."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.statements import FAILS, HOLDS, PARTLY, STATEMENTS, UNKNOWN, Joint, judge

V = np.array([0.1, 0.2, 0.4, 1.2, 1.4, 5.0, 10.0])
# Correlated up to 0.5 mm by 1/e, not at all from 2 mm on.
RIGID = np.linspace(0, 10, 101)
SETTINGS = {"map_load": (1000.0, "force")}


def stages(**changes):
    """A joint of which everything the paper says holds, but for what is changed."""
    values = {
        "closure": [1, 1.8, 3.2, 4, 4.1, 5, 5],
        "area": [9, 8, 7, 5, 5.1, 5.2, 4.95],
        "dimension": [2.0, 2.05, 2.1, 2.2, 2.21, 2.3, 2.35],
        "morisita": [1, 1.5, 2, 4, 4.5, 9, 18],
        "exponent": np.full(7, 1.02),
        "misfit": np.full(7, 0.01),
        "window_exponent": np.full(7, 0.4),
        "dilatancy": [1 - np.exp(-RIGID), 1.5 * (1 - np.exp(-RIGID))],
        "limit": 0.1,
        "length": 0.5,
        "uncorrelated": 2.0,
    } | changes
    dims = ("direction", "offset", "resolution", "load")
    coords = {"direction": ["W"], "offset": V, "resolution": [1], "load": [1000.0]}

    def states(name):
        return dims, np.reshape(np.asarray(values[name], float), (1, len(V), 1, 1))

    of_offsets = ("direction", "offset", "resolution")
    slid = xr.Dataset(
        {
            "rigid_dilatancy": (("direction", "rigid_offset"), values["dilatancy"]),
            "face_correlation": (("direction", "rigid_offset"), [np.exp(-2 * RIGID)] * 2),
            "correlation_length": ("direction", [values["length"]] * 2),
            "uncorrelated_offset": ("direction", [values["uncorrelated"]] * 2),
            "correlation_limit": values["limit"],
            "composite_dimension": ("offset", values["dimension"]),
        },
        {"direction": ["W", "E"], "contact_direction": ["W"], "rigid_offset": RIGID, "offset": V},
    )
    ends = {"": 0, "_low": -0.1, "_high": 0.1}
    windows = {
        f"closure_exponent{end}": (
            ("offset", "load"),
            np.asarray(values["window_exponent"])[:, np.newaxis] + by,
        )
        for end, by in ends.items()
    }
    specimen = xr.Dataset(
        attrs={"window_ny": 10, "window_nx": 10, "spacing_y": 1.0, "spacing_x": 1.0}
    )
    return {
        "specimen": specimen,
        "joint": slid,
        "closure": xr.Dataset(
            {
                "interface_closure": states("closure"),
                "area_share": states("area"),
                "hyperbola_misfit": (of_offsets, np.reshape(values["misfit"], (1, len(V), 1))),
            },
            coords,
        ),
        "domains": xr.Dataset({"morisita": states("morisita")}, coords),
        "area": xr.Dataset(
            {"exponent": (("direction", "offset"), [values["exponent"]])},
            {"direction": ["W"], "offset": V},
        ),
        "windows": xr.Dataset(windows, {"offset": V, "load": [1000.0]}),
    }


def verdict(name, **changes):
    found = judge(stages(**changes), SETTINGS).sel(statement=name)
    return found["verdict"].item()


def test_a_joint_as_the_paper_has_it():
    found = judge(stages(), SETTINGS)
    assert found.sizes["statement"] == len(STATEMENTS)
    assert set(found["verdict"].values) == {HOLDS}
    assert found.attrs == {"direction": "W", "force": 1000.0}


RISING = [1 - np.exp(-RIGID), 0.2 * RIGID]
ALIKE = [1 - np.exp(-RIGID)] * 2


@pytest.mark.parametrize(
    ("name", "changes", "expected"),
    [
        ("compliance_rises_at_first", {"closure": [3, 2, 1, 4, 4, 5, 5]}, FAILS),
        ("compliance_rises_at_first", {"closure": [1, 9, 2, 4, 4, 5, 5]}, PARTLY),
        ("compliance_rises_at_first", {"length": 0.15}, UNKNOWN),
        ("curves_overlap", {"closure": [1, 1.8, 3.2, 4, 4.8, 5, 5]}, PARTLY),
        ("curves_overlap", {"closure": [1, 1.8, 3.2, 4, 8, 5, 5]}, FAILS),
        ("curves_overlap", {"length": 1.3}, UNKNOWN),
        ("compliance_rises_again", {"closure": [1, 1.8, 3.2, 4, 4, 4.2, 4.2]}, PARTLY),
        ("compliance_rises_again", {"closure": [1, 1.8, 3.2, 4, 4, 3, 3]}, FAILS),
        ("compliance_rises_again", {"uncorrelated": np.nan}, UNKNOWN),
        ("closure_is_hyperbolic", {"misfit": [0.01, *[0.05] * 6]}, PARTLY),
        ("closure_is_hyperbolic", {"misfit": np.full(7, 0.05)}, FAILS),
        ("closure_is_hyperbolic", {"misfit": np.full(7, np.nan)}, FAILS),
        ("area_is_linear", {"exponent": [0.95, *[0.8] * 6]}, PARTLY),
        ("area_is_linear", {"exponent": np.full(7, 0.8)}, FAILS),
        ("area_is_linear", {"exponent": np.full(7, np.nan)}, UNKNOWN),
        ("area_falls", {"area": [4, 5, 6, 7, 8, 9, 9]}, FAILS),
        ("area_falls", {"area": [9, 1, 9, 1, 9, 1, 8]}, PARTLY),
        ("area_settles", {"area": [9, 8, 7, 5, 5, 5, 4]}, PARTLY),
        ("area_settles", {"area": [9, 8, 7, 5, 5, 5, 2]}, FAILS),
        ("composite_dimension_rises", {"dimension": np.linspace(2.8, 2.2, 7)}, FAILS),
        ("composite_dimension_rises", {"dimension": [2.1, 2.9, 2.1, 2.9, 2.1, 2.9, 2.2]}, PARTLY),
        ("compliance_goes_with_dimension", {"dimension": np.linspace(2.8, 2.2, 7)}, FAILS),
        ("compliance_goes_with_dimension", {"dimension": np.full(7, np.nan)}, UNKNOWN),
        ("larger_samples_close_more", {"window_exponent": [0.4] * 6 + [0.05]}, PARTLY),
        ("larger_samples_close_more", {"window_exponent": np.full(7, -0.3)}, FAILS),
        ("larger_samples_close_more", {"window_exponent": np.full(7, np.nan)}, UNKNOWN),
        ("dilatancy_flattens", {"dilatancy": RISING}, PARTLY),
        ("dilatancy_flattens", {"dilatancy": [0.1 * RIGID, 0.2 * RIGID]}, FAILS),
        ("dilatancy_is_anisotropic", {"dilatancy": ALIKE}, FAILS),
        ("domains_cluster", {"morisita": np.full(7, 2.0) - 0.1 * np.arange(7)}, FAILS),
        ("no_correlation_is_left", {"limit": -0.1}, FAILS),
        ("no_correlation_is_left", {"limit": np.nan}, UNKNOWN),
    ],
)
def test_what_does_not_hold_is_said(name, changes, expected):
    assert verdict(name, **changes) == expected


def test_numbers_stand_with_every_verdict():
    found = judge(stages(length=np.nan, uncorrelated=np.nan), SETTINGS)
    assert all(len(text) > 10 for text in found["numbers"].values)


def test_flush_faces_are_left_out():
    joint = Joint(stages(), SETTINGS)
    assert not joint.initial[joint.offset == 0].any()
