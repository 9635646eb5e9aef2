"""Verdicts on the paper's statements: each rule on numbers made to meet it and to miss it."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.statements.judge import (
    FAILS,
    HOLDS,
    PARTLY,
    UNKNOWN,
    Joint,
    judge,
    statements_for,
)

V = np.array([0.1, 0.2, 0.4, 1.2, 1.4, 5.0, 10.0])
# Correlated up to 0.5 mm by 1/e, not at all from 2 mm on.
RIGID = np.linspace(0, 10, 101)
LOADS = [10.0, 100.0, 1000.0, 10000.0]
SETTINGS = {"map_load": (1000.0, "force"), "map_offset": 0.4}


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
        "delta_area": [0.2, 0.8, 1.4, 1.9],
        "delta_box": [0.2, 0.8, 1.4, 1.9],
        "half": 0.05,
        "disagree": np.zeros(4, bool),
        "difference_half": 0.1,
        "density_exponent": -0.3,
        "size_verdict": [["agrees"] * 2, ["agrees", "undecided"]],
        "strength_exponent": np.full((2, 1), -0.3),
        "length": 0.5,
        "uncorrelated": 2.0,
    } | changes
    dims = ("direction", "offset", "resolution", "normal_force")
    coords = {"direction": ["W"], "offset": V, "resolution": [1], "normal_force": LOADS}

    def states(name):
        """Values over the offsets, the same under every load."""
        of_offset = np.reshape(np.asarray(values[name], float), (1, len(V), 1, 1))
        return dims, np.broadcast_to(of_offset, (1, len(V), 1, len(LOADS)))

    def over_loads(found):
        """Values over the loads, the same at every offset."""
        shape = (1, len(V), len(LOADS))
        return ("direction", "offset", "normal_force"), np.broadcast_to(found, shape)

    area, box = (np.asarray(values[f"delta_{key}"], float) for key in ("area", "box"))
    half = values["half"]
    scaling = {
        "delta_area": area,
        "delta_box": box,
        "delta_sigma": area,
        "delta_sigma_low": area - half,
        "delta_sigma_high": area + half,
        "difference": area - box,
        "difference_low": area - box - values["difference_half"],
        "difference_high": area - box + values["difference_half"],
        "disagree": values["disagree"],
        "n": np.full(4, 4),
        "r2": np.full(4, 0.99),
    }
    of_box = {"": box, "_low": box - half, "_high": box + half}

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
    windows = {"nominal_pressure": ("normal_force", [10.0])}
    for end, by in ends.items():
        windows[f"closure_exponent{end}"] = (
            ("offset", "normal_force"),
            np.asarray(values["window_exponent"])[:, np.newaxis] + by,
        )
        density = np.full((len(V), 1), values["density_exponent"] + by)
        windows[f"area_exponent{end}"] = (("offset", "normal_force"), density)
        windows[f"similar_strength_exponent{end}"] = (
            ("share", "normal_force"),
            values["strength_exponent"] + by,
        )
    specimen = xr.Dataset(
        attrs={"window_ny": 10, "window_nx": 10, "spacing_y": 1.0, "spacing_x": 1.0}
    )
    return {
        "specimens": specimen,
        "joints": slid,
        "closure": xr.Dataset(
            {
                "interface_closure": states("closure"),
                "area_share": states("area"),
                "hyperbola_misfit": (of_offsets, np.reshape(values["misfit"], (1, len(V), 1))),
            },
            coords,
        ),
        "domains": xr.Dataset(
            {
                "morisita": states("morisita"),
                **{
                    f"delta_sigma{end}": (
                        dims,
                        np.broadcast_to(found, (1, len(V), len(LOADS)))[:, :, np.newaxis],
                    )
                    for end, found in of_box.items()
                },
                "fit_min": (dims, np.full((1, len(V), 1, len(LOADS)), 0.1)),
                "fit_max": (dims, np.full((1, len(V), 1, len(LOADS)), 5.0)),
                "reason": (dims, np.full((1, len(V), 1, len(LOADS)), "too few")),
            },
            coords,
        ),
        "scaling": xr.Dataset(
            {name: over_loads(found) for name, found in scaling.items()},
            {"direction": ["W"], "offset": V, "normal_force": LOADS},
        ),
        "area": xr.Dataset(
            {"exponent": (("direction", "offset"), [values["exponent"]])},
            {"direction": ["W"], "offset": V},
        ),
        "size_test": xr.Dataset(
            {
                "verdict": (("estimator", "normal_force"), values["size_verdict"]),
                "slope": ("normal_force", [-0.6, -0.4]),
            },
            {"estimator": ["area", "box"]},
        ),
        "windows": xr.Dataset(windows, {"offset": V, "normal_force": [1000.0]}),
    }


def verdict(name, **changes):
    found = judge(stages(**changes), SETTINGS).sel(statement=name)
    return found["verdict"].item()


def test_a_joint_as_the_paper_has_it():
    found = judge(stages(), SETTINGS)
    assert found.sizes["statement"] == len(statements_for(True))
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
        ("area_is_lacunar", {"delta_area": np.full(4, 1.98)}, PARTLY),
        ("area_is_lacunar", {"delta_area": np.full(4, 2.1)}, FAILS),
        ("area_is_lacunar", {"delta_area": np.full(4, np.nan)}, UNKNOWN),
        ("boxes_follow_one_law", {"half": 0.2}, PARTLY),
        ("boxes_follow_one_law", {"half": 0.5}, FAILS),
        ("boxes_follow_one_law", {"delta_box": np.full(4, np.nan)}, FAILS),
        ("estimates_agree", {"disagree": np.array([0, 1, 1, 0], bool)}, PARTLY),
        ("estimates_agree", {"disagree": np.ones(4, bool)}, FAILS),
        ("estimates_agree", {"delta_box": np.full(4, np.nan)}, UNKNOWN),
        ("estimates_agree", {"difference_half": 0.6}, UNKNOWN),
        ("dimension_rises_by_area", {"delta_area": np.linspace(1.9, 1.2, 4)}, FAILS),
        ("dimension_rises_by_boxes", {"delta_box": np.array([1, 1.9, 0.9, 1.9])}, PARTLY),
        ("dimension_rises_by_boxes", {"delta_box": np.full(4, np.nan)}, UNKNOWN),
        ("dimension_spans_all", {"delta_box": np.linspace(0.5, 1.9, 4)}, PARTLY),
        ("dimension_spans_all", {"delta_box": np.linspace(0.5, 1.5, 4)}, FAILS),
        (
            "size_effect_follows",
            {"size_verdict": [["agrees"] * 2, ["measured flatter"] * 2]},
            PARTLY,
        ),
        ("size_effect_follows", {"size_verdict": [["measured steeper"] * 2] * 2}, FAILS),
        ("size_effect_follows", {"size_verdict": [["not tested", "ambiguous"]] * 2}, UNKNOWN),
        ("larger_domains_are_less_dense", {"density_exponent": -0.05}, PARTLY),
        ("larger_domains_are_less_dense", {"density_exponent": 0.3}, FAILS),
        ("strength_falls_with_size", {"strength_exponent": np.array([[-0.3], [0.0]])}, PARTLY),
        ("strength_falls_with_size", {"strength_exponent": np.full((2, 1), 0.3)}, FAILS),
        ("strength_falls_with_size", {"strength_exponent": np.full((2, 1), np.nan)}, UNKNOWN),
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
