"""A joint of which everything the paper says holds, as the stages that statements are judged on."""

import numpy as np
import xarray as xr

from fractalcontact.core.reported import Reported
from fractalcontact.domain.cluster_laws import localisation
from fractalcontact.joint.plateau import opposite_parts, rigid_plateaus, undecided_plateaus

V = np.array([0.1, 0.2, 0.4, 0.6, 1.2, 1.9, 10.0])
# Correlated up to 0.5 mm by 1/e, not at all from 2 mm on.
RIGID = np.linspace(0, 10, 101)
LOADS = [10.0, 100.0, 1000.0, 10000.0]
ROCK = {"name": "sandstone", "hardness": np.inf}
SETTINGS = {
    "map_load": (1000.0, "force"),
    "map_offset": 0.4,
    "material": ROCK,
    "opposite": "match",
    "chosen_for": {},
    "capped_variant": False,
    "known_contact": False,
}


def local_slopes(values, over_boxes):
    """Curves of local slopes over one octave after another, the same under every load."""
    slopes, sides = np.asarray(values["local_slopes"]), np.asarray(values["box_sides"])
    curves = {
        "": slopes,
        "_low": slopes - values["local_slope_half"],
        "_high": slopes + values["local_slope_half"],
        "_random": np.linspace(0, 2, slopes.size),
        "_cut": slopes + 0.2,
        "_cut_difference": np.full(slopes.size, -values["slope_cut_less"]),
        "_cut_difference_low": np.full(slopes.size, -values["slope_cut_less"] - 0.05),
        "_cut_difference_high": np.full(slopes.size, -values["slope_cut_less"] + 0.05),
    }
    ends = {"": np.sqrt(sides[1:] * sides[:-1]), "_min": sides[:-1], "_max": sides[1:]}
    return {
        **{
            f"local_slope{name}": (("normal_force", "null_octave"), np.tile(curve, (len(LOADS), 1)))
            for name, curve in curves.items()
        },
        **{f"local_slope_side{end}": ("null_octave", side) for end, side in ends.items()},
        "local_slope_random_p": over_boxes(values["random_p"]),
        "local_slope_random_side": over_boxes(ends[""][0]),
        "local_slope_cut_p": over_boxes(values["cut_p"]),
        "local_slope_cut_side": over_boxes(ends[""][-1]),
    }


def stages(**changes):
    """A joint of which everything the paper says holds, but for what is changed."""
    values = {
        "compliance": [1, 1.8, 3.2, 4, 4.1, 4.1, 5],
        "nodes": np.full(7, 100.0),
        "closure_change": 0.05,
        "area_change": 0.05,
        "compliance_half": 0.0,
        "bend": 0.0,
        "bend_half": 0.05,
        "slope_cut_less": 0.2,
        "seated_misfits": [np.full(7, 0.01), np.full(7, 0.05)],
        "null": "different from random nodes and from the bearing-area cut",
        "local_slopes": [1.06, 1.1, 1.0, 1.08, 1.15],
        "local_slope_half": 0.1,
        "box_sides": 0.1 * 2.0 ** np.arange(6),
        "random_p": 0.005,
        "cut_p": 0.01,
        "cut_less": 0.15 * (np.arange(4) - 1.5),
        "random": np.array([0.1, 0.5, 0.9, 1.2]),
        "along": 0.4,
        "across": 0.42,
        "interval_half": 0.05,
        "cut_half": 0.05,
        "area": [40, 25, 15, 5, 5.1, 5.2, 4.95],
        "dimension": [2.0, 2.05, 2.1, 2.2, 2.21, 2.3, 2.35],
        "morisita": [1, 1.5, 2, 4, 4.5, 9, 18],
        "exponent": np.full(7, 1.02),
        "window_exponent": np.full(7, 0.4),
        "closure_exponent": 0.5,
        "gap_exponent": 0.45,
        "roughness_exponent": 0.5,
        "known_dimension": 2.2,
        "spectrum": 2.2,
        "dilatancy": [1 - np.exp(-RIGID), 1.5 * (1 - np.exp(-RIGID))] * 2,
        "limit": 0.1,
        "delta_sigma_area": [0.2, 0.8, 1.4, 1.9],
        "delta_sigma_box": [0.2, 0.8, 1.4, 1.9],
        "half": 0.05,
        "difference_half": 0.1,
        "density_exponent": -0.3,
        "eq6_less": 0.0,
        "eq6_half": 0.05,
        "beyond": [False, False],
        "strength_exponent": np.full((2, 1), -0.3),
        "bounded": False,
        "equal_v_exponent": -0.3,
        "length": 0.5,
        "uncorrelated": 2.0,
        "face_hurst": 0.8,
        "void_exponent": 0.6,
        "long_share": [0.1, 0.2, 0.6, 0.7],
        "star": [1.0, 2.0, 4.0, 8.0],
        "slope_angles": [70.0, 65.0, 60.0, 55.0],
        "truncated": 0.0,
        "wrong": [0.0, 0.0, 0.0],
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

    def over_boxes(found):
        """As over_loads, at one resolution."""
        return dims, over_loads(found)[1][:, :, np.newaxis]

    area, box = (np.asarray(values[f"delta_sigma_{key}"], float) for key in ("area", "box"))
    half = values["half"]
    scaling = {
        "delta_sigma_area": area,
        "delta_sigma_box": box,
        "delta_sigma": area,
        "delta_sigma_low": area - half,
        "delta_sigma_high": area + half,
        "difference": area - box,
        "difference_low": area - box - values["difference_half"],
        "difference_high": area - box + values["difference_half"],
        "n": np.full(4, 4),
        "r2": np.full(4, 0.99),
        "area_bend": np.full(4, values["bend"]),
        "area_bend_low": np.full(4, values["bend"] - values["bend_half"]),
        "area_bend_high": np.full(4, values["bend"] + values["bend_half"]),
    }
    of_box = {"": box, "_low": box - half, "_high": box + half}

    of_offsets = ("direction", "offset", "resolution")
    slid = xr.Dataset(
        {
            "rigid_dilatancy": (("direction", "rigid_offset"), values["dilatancy"]),
            "face_correlation": (("direction", "rigid_offset"), [np.exp(-2 * RIGID)] * 4),
            "correlation_length": ("direction", [values["length"]] * 4),
            "uncorrelated_offset": ("direction", [values["uncorrelated"]] * 4),
            "correlation_limit": values["limit"],
            "lag_dimension": (
                ("offset", "lag_range"),
                np.transpose([values["dimension"]] * 3),
            ),
            "lag_min": ("lag_range", [0.2, 0.2, 0.5]),
            "lag_max": ("lag_range", [1.2, 0.5, 1.2]),
        },
        {"direction": [*"WENS"], "contact_direction": ["W"], "rigid_offset": RIGID, "offset": V},
    )
    ends = {"": 0, "_low": -0.1, "_high": 0.1}
    windows = {"nominal_pressure": ("normal_force", [10.0])}
    for end, by in ends.items():
        windows[f"compliance_exponent{end}"] = (
            ("offset", "normal_force"),
            np.asarray(values["window_exponent"])[:, np.newaxis] + by,
        )
        closing = np.full((len(V), 1), values["closure_exponent"] + by / 2)
        windows[f"closure_exponent{end}"] = ("offset", "normal_force"), closing
        density = np.full((len(V), 1), values["density_exponent"] + by)
        windows[f"area_exponent{end}"] = (("offset", "normal_force"), density)
        of_void = np.full((len(V), 1), values["void_exponent"] + by)
        windows[f"void_exponent{end}"] = ("offset", "normal_force"), of_void
        windows[f"random_void_exponent{end}"] = ("offset", "normal_force"), of_void
        of_gap = np.full((len(V), 1), values["gap_exponent"] + by / 2)
        windows[f"gap_exponent{end}"] = ("offset", "normal_force"), of_gap
        of_heights = np.full((len(V), 1), values["roughness_exponent"] + by / 100)
        windows[f"roughness_exponent{end}"] = ("offset", "normal_force"), of_heights
        windows[f"strength_at_equal_v_over_b_exponent{end}"] = (
            ("share", "normal_force"),
            np.asarray(-np.inf if values["bounded"] and by < 0 else by)
            + values["strength_exponent"],
        )
        at_one_v = np.full((2, 1), values["equal_v_exponent"] + by / 2)
        windows[f"slope_at_equal_v_exponent{end}"] = ("share", "normal_force"), at_one_v
    angles = np.reshape(values["slope_angles"], (1, 4, 1)) + np.zeros((2, 1, 1))
    of_sizes = "share", "part", "normal_force"
    truncated = np.reshape(np.broadcast_to(values["truncated"], 4), (1, 4, 1))
    windows |= {
        "side": ("part", [20.0, 10.0, 5.0, 2.5][::-1]),
        "limit_slope_angle": (of_sizes, angles),
        "truncated_fraction_at_equal_v_over_b": (of_sizes, np.broadcast_to(truncated, (2, 4, 1))),
    }
    slid = slid.assign(rigid_plateaus(RIGID, values["dilatancy"], [*"WENS"]))
    lost = np.full(4, values["uncorrelated"])
    slid = slid.assign(undecided_plateaus(RIGID, slid["face_correlation"].values, lost))
    slid = slid.assign(opposite_parts(RIGID, values["dilatancy"], [*"WENS"]))
    slid["window_tilt"] = "axis", [0.0, 0.0]
    specimen = xr.Dataset(
        attrs={"window_ny": 10, "window_nx": 10, "spacing_y": 1.0, "spacing_x": 1.0}
    )
    reported = Reported.choose(
        xr.Dataset(coords=coords),
        direction="W",
        offset=SETTINGS["map_offset"],
        loads=[],
        reference=SETTINGS["map_load"][0],
    )
    dimensions = [3 - values["face_hurst"], values["spectrum"]]
    surface = {"known_dimension": values["known_dimension"], "range_min": 0.2, "range_max": 2.0}
    for end, by in ends.items():
        surface[f"hurst{end}"] = "estimator", [3 - one + by / 2 for one in dimensions]
        surface[f"dimension{end}"] = "estimator", [one + by / 2 for one in dimensions]
    made = {
        "specimens": specimen,
        "surface_dimension": xr.Dataset(
            surface, {"estimator": ["roughness_length", "power_spectrum"]}
        ),
        "joints": slid,
        "closure": xr.Dataset(
            {
                **reported.variables(),
                "interface_compliance": (dims, states("compliance")[1]),
                "area_corrected": states("area"),
                "nodes": states("nodes"),
                "composite_spread": (("direction", "offset"), [np.linspace(1, 2, 7)]),
                "interface_compliance_low": (
                    dims,
                    states("compliance")[1] - values["compliance_half"],
                ),
                "interface_compliance_high": (
                    dims,
                    states("compliance")[1] + values["compliance_half"],
                ),
                "area_corrected_error": (dims, np.zeros((1, len(V), 1, len(LOADS)))),
                "interface_closure": over_boxes([0.1, 0.2, 0.3, 0.4]),
                "seating_pressure": (of_offsets, np.full((1, len(V), 1), 0.1)),
                "hyperbola_misfit": (of_offsets, np.full((1, len(V), 1), 0.05)),
                **{
                    f"seated_{law}_misfit": (of_offsets, np.reshape(misfit, (1, len(V), 1)))
                    for law, misfit in zip(
                        ("hyperbola", "logarithm"), values["seated_misfits"], strict=True
                    )
                },
            },
            coords,
        ),
        "domains": xr.Dataset(
            {
                "morisita": states("morisita"),
                "long_share": over_boxes(values["long_share"]),
                **{f"delta_sigma{end}": over_boxes(found) for end, found in of_box.items()},
                "fit_min": (dims, np.full((1, len(V), 1, len(LOADS)), 0.1)),
                "fit_max": (dims, np.full((1, len(V), 1, len(LOADS)), 5.0)),
                "reason": (dims, np.full((1, len(V), 1, len(LOADS)), "too few")),
                "delta_sigma_cut": over_boxes(box - values["cut_less"]),
                **{
                    f"{name}_cut_difference{end}": over_boxes(
                        values["cut_less"] + np.sign(by) * values["cut_half"] * np.ones(4)
                    )
                    for name in ("delta_sigma", "correlation_dimension")
                    for end, by in ends.items()
                },
                "null_verdict": (dims, np.full((1, len(V), 1, len(LOADS)), values["null"])),
                "null_reason": (dims, np.full((1, len(V), 1, len(LOADS)), "too few")),
                **local_slopes(values, over_boxes),
                "delta_sigma_random": over_boxes(values["random"]),
            },
            coords,
        ),
        "scaling": xr.Dataset(
            {name: over_loads(found) for name, found in scaling.items()}
            | {
                "eq6_sigma_star": (
                    ("estimator", *over_loads(0)[0]),
                    [over_loads(values["star"])[1]],
                )
            },
            {"direction": ["W"], "offset": V, "normal_force": LOADS, "estimator": ["box"]},
        ),
        "error_budget": xr.Dataset(
            {
                "elimination_wrong": ("tentative", values["wrong"]),
                "elimination_steps": ("tentative", [3.0, 4.0, 5.0]),
                "elimination_side": 20.0,
            }
        ),
        "area": xr.Dataset(
            {
                f"corrected_exponent{end}": (
                    ("direction", "offset"),
                    [np.asarray(values["exponent"]) + by / 5],
                )
                for end, by in ends.items()
            },
            {"direction": ["W"], "offset": V},
        ),
        "domain_measures": xr.Dataset(
            {
                f"interval_dimension_{way}{end}": (
                    "normal_force",
                    np.full(4, values[way] + np.sign(by) * values["interval_half"]),
                )
                for way in ("along", "across")
                for end, by in ends.items()
            },
            {"normal_force": LOADS},
        ),
        "size_test": xr.Dataset(
            {
                **{
                    f"area_difference{end}": (
                        ("estimator", "normal_force"),
                        np.broadcast_to(values["eq6_less"], (2, 2))
                        + np.sign(by) * values["eq6_half"],
                    )
                    for end, by in ends.items()
                },
                **{
                    f"area_exponent{end}": ("normal_force", [-0.1 + by, 0.0 + by])
                    for end, by in ends.items()
                },
                "beyond_study": ("normal_force", values["beyond"]),
            },
            {
                "estimator": ["area", "box"],
                "nominal_pressure": ("normal_force", [25.0, 75.0]),
            },
        ),
        "windows": xr.Dataset(windows, {"offset": V, "normal_force": [1000.0]}),
    }
    made["closure"] = _with_coarse_states(made["closure"], values)
    nodes = states("nodes")[1]
    used, powers = localisation(made["domains"], nodes)
    made["domains"] = made["domains"].assign({"morisita_used": used} | powers)
    return made


def _with_coarse_states(curves, values):
    """The closure stage with states at twice the spacing, of a larger closure and area."""
    coarse = curves.assign_coords(resolution=[2])
    seated = curves["interface_closure"] - curves["interface_closure"][..., 0]
    return xr.concat(
        [
            curves,
            coarse.assign(
                interface_closure=coarse["interface_closure"].copy(
                    data=0.1 + seated / (1 + np.asarray(values["closure_change"]))
                ),
                area_corrected=coarse["area_corrected"] / (1 + values["area_change"]),
            ),
        ],
        "resolution",
        data_vars="minimal",
    )
