"""Verdicts in worlds whose truth is known by construction: one where a claim is true, one not."""

from dataclasses import asdict
from functools import cache

import numpy as np
import pytest
from made_stages import scan, stages_of
from materials import ROCK

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.verdicts import FAILS, HOLDS, PARTLY
from fractalcontact.statements.judge import Joint, rule_of
from fractalcontact.study.configuration import (
    resolve_embedded,
    resolve_settings,
    solver_settings,
)
from fractalcontact.surface.embedded import embedded_surface
from fractalcontact.surface.known_dimension import cantor_punch

SPACING = 0.1
SOLVER = solver_settings({}, "worlds")
STUDY = {
    "study": "worlds",
    "materials": {"rock": ROCK},
    "defaults": {"material": "rock", "map_load": "10 MPa", "dilatancy_loads": ["10 MPa"]},
}
#: Of the Cantor punch: two parts, each three times smaller, times a line.
PUNCH_DIMENSION = 1 + np.log(2) / np.log(3)
TILT = 0.1
#: Slope and period of a saw whose faces climb each other, mm: windows hold whole periods.
CLIMB, PERIOD = 0.2, 3.2


def joint_of(heights, later, **own):
    settings = resolve_settings(STUDY, "world", own, "worlds")
    stages = stages_of("world", [scan(heights, SPACING)], settings, SOLVER, later=later)
    return Joint(stages, asdict(settings))


def rough(nodes, rms, roll_off):
    """A random isotropic face."""
    recipe = {
        "size": f"{nodes * SPACING} mm",
        "spacing": f"{SPACING} mm",
        "dimension": 2.2,
        "rms": rms,
        "roll_off": roll_off,
        "seed": 1,
        "label": "synthetic",
    }
    return embedded_surface(resolve_embedded(recipe, "world"))


def along_x(nodes):
    """Places of the nodes from the middle of the face, mm (nodes, nodes)."""
    return np.tile((np.arange(nodes) - (nodes - 1) / 2) * SPACING, (nodes, 1))


def pressed(heights):
    own = {"opposite": "flat", "resolutions": [1, 3, 9], "loads": ["1 MPa", "10 MPa", "40 MPa"]}
    return joint_of(heights, ("closure",), **own)


def cut(heights):
    """A surface pressed against a plane, whole and in windows."""
    own = {"opposite": "flat", "resolutions": [1, 3, 9], "loads": ["1 MPa", "10 MPa", "40 MPa"]}
    return joint_of(heights, ("window_states", "closure", "windows"), **own)


def slid(heights):
    own = {"window": "12.8 mm", "offsets": ["0.1 mm", "1 mm", "6 mm"], "loads": ["10 MPa"]}
    return joint_of(heights, (), directions=[*"ENWS"], resolutions=[1], **own)


def sized(heights):
    own = {
        "window": "12.8 mm",
        "offsets": ["0.1 mm", "0.2 mm", "0.4 mm", "0.8 mm", "1.6 mm"],
        "directions": ["E"],
        "contact_directions": ["E"],
        "loads": ["1 MPa", "10 MPa"],
        "resolutions": [1],
    }
    return joint_of(heights, ("window_states", "closure", "windows"), **own)


def tilted_in_the_middle(nodes):
    """A plane in the middle and the opposite slope beyond it, so that the face has no tilt."""
    x = along_x(nodes)
    middle = np.abs(x) < 12.5
    back = (x[middle] ** 2).sum() / (x[~middle] ** 2).sum()
    return TILT * np.where(middle, x, -back * x)


def quadrants(nodes):
    """Short roughness, of which two opposite quadrants lie far below the others."""
    x = along_x(nodes)
    return rough(nodes, "0.005 mm", "0.8 mm") + np.where(x * x.T < 0, -2.0, 0.0)


def saw(nodes):
    return CLIMB * np.abs((along_x(nodes) + PERIOD / 4) % PERIOD - PERIOD / 2)


#: Worlds by name, each made once.
WORLDS = {
    "Cantor punch": lambda: pressed(np.tile(cantor_punch(5), (243, 1))),
    # A third of a punch of five generations is one of four, or a gap.
    "Cantor punch in thirds": lambda: cut(np.tile(cantor_punch(5), (243, 1))),
    "rough face": lambda: pressed(rough(243, "0.03 mm", "1 mm")),
    # All windows of it are alike.
    "cut of a long surface": lambda: cut(rough(128, "0.002 mm", "0.8 mm")),
    "quadrants": lambda: cut(quadrants(128)),
    "level isotropic face": lambda: slid(rough(256, "0.1 mm", "1 mm")),
    "tilted face": lambda: slid(rough(320, "0.1 mm", "1 mm") + tilted_in_the_middle(320)),
    "waves along x": lambda: slid(
        rough(256, "0.02 mm", "1 mm") + 0.2 * np.sin(along_x(256) * 2 * np.pi / 12.8)
    ),
    "short roughness": lambda: sized(rough(160, "0.05 mm", "0.8 mm")),
    "saw": lambda: sized(saw(160) + rough(160, "0.002 mm", "0.8 mm")),
}


@cache
def world(name):
    return WORLDS[name]()


@pytest.mark.parametrize(
    ("claim", "true", "false"),
    [
        ("domains_are_fractal", "Cantor punch", "rough face"),
        # The tops of a punch are what a plane at one height cuts off.
        ("domains_differ_from_cuts", "rough face", "Cantor punch"),
        ("domains_are_isotropic", "rough face", "Cantor punch"),
        ("dilatancy_is_anisotropic", "waves along x", "level isotropic face"),
        ("size_effect_follows", "Cantor punch in thirds", "cut of a long surface"),
        ("larger_domains_are_less_dense", "Cantor punch in thirds", "saw"),
    ],
)
def test_a_verdict_is_right_where_its_claim_is_true_and_where_it_is_false(claim, true, false):
    found = {name: rule_of(claim)(world(name)) for name in (true, false)}
    assert {name: one.verdict for name, one in found.items()} == {true: HOLDS, false: FAILS}, found


@pytest.mark.parametrize(
    ("claim", "name", "expected"),
    [
        ("estimates_agree", "Cantor punch", HOLDS),
        ("area_is_lacunar", "Cantor punch", HOLDS),
        ("dimension_rises_by_boxes", "Cantor punch", FAILS),
        ("dimension_rises_by_area", "Cantor punch", FAILS),
        ("dilatancy_flattens", "level isotropic face", HOLDS),
        # A tilt opens one direction for good.
        ("dilatancy_flattens", "tilted face", PARTLY),
        ("size_effect_follows", "saw", FAILS),
        ("strength_falls_with_size", "saw", FAILS),
        ("friction_angle_falls_with_size", "saw", FAILS),
        ("closure_grows_as_roughness", "quadrants", HOLDS),
        ("voids_grow_with_size", "quadrants", HOLDS),
        ("dimension_rises_by_boxes", "Cantor punch in thirds", FAILS),
        ("elimination_finds_the_set", "rough face", HOLDS),
        ("elimination_finds_the_set", "Cantor punch", HOLDS),
    ],
)
def test_a_verdict_is_that_of_its_world(claim, name, expected):
    found = rule_of(claim)(world(name))
    assert found.verdict == expected, found


def test_a_cantor_punch_has_its_dimension_by_both_estimates_under_every_load():
    for stage in ("scaling", "domains"):
        delta = Estimate.read(world("Cantor punch").states(stage), "delta_sigma")
        np.testing.assert_allclose(delta.value, PUNCH_DIMENSION, atol=0.03)
        assert (delta.low <= PUNCH_DIMENSION).all()
        assert (delta.high >= PUNCH_DIMENSION).all()


@pytest.mark.parametrize(("name", "expected"), [("tilted face", TILT), ("waves along x", 0.0)])
def test_the_odd_part_of_the_dilatancy_is_a_tilt_only_where_there_is_one(name, expected):
    """Waves tilt the window's plane as well, but do not open one direction alone."""
    odd = world(name)["joints"]["odd_slope"].sel(axis="E-W")
    assert odd == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize("claim", ["strength_falls_with_size", "friction_angle_falls_with_size"])
def test_strength_falls_where_larger_windows_have_slid_beyond_all_that_is_rough(claim):
    found = rule_of(claim)(world("short roughness"))
    assert found.verdict in (HOLDS, PARTLY), found
