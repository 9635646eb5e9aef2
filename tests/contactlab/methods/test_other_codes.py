"""The page that solves one problem in several codes: each gives the same pressures."""

import numpy as np
import pytest
from code_blocks import run_code


@pytest.fixture(scope="module")
def problem():
    return run_code("packages/roughcontact/docs/other_codes.md", "The problem")


@pytest.fixture(scope="module")
def ours(problem):
    return run_code(
        "packages/roughcontact/docs/other_codes.md", "By roughcontact", **given(problem)
    )


def given(problem):
    """Names of the problem, without those that a module has by itself."""
    return {name: value for name, value in problem.items() if not name.startswith("__")}


def check(theirs, ours):
    difference = np.abs(theirs["pressure"] - ours["pressure"]).max()
    assert difference < 1e-6 * ours["pressure"].max()
    np.testing.assert_array_equal(theirs["contact"], ours["contact"])


def test_ours_carries_the_mean_pressure_on_a_part_of_the_window(problem, ours):
    assert ours["pressure"].mean() == pytest.approx(problem["mean_pressure"])
    assert 0.02 < ours["contact"].mean() < 0.05


def test_tamaas_gives_the_same_pressures(problem, ours):
    pytest.importorskip("tamaas")
    check(
        run_code("packages/roughcontact/docs/other_codes.md", "By Tamaas", **given(problem)), ours
    )


def test_contact_mechanics_gives_the_same_pressures(problem, ours):
    pytest.importorskip("ContactMechanics")
    check(
        run_code(
            "packages/roughcontact/docs/other_codes.md", "By ContactMechanics", **given(problem)
        ),
        ours,
    )


def test_aspher_gives_the_same_pressures_in_a_window_alone(problem, ours):
    here = {**given(problem), **given(ours)}
    alone = run_code(
        "packages/roughcontact/docs/other_codes.md",
        "By roughcontact, a window that stands alone",
        **here,
    )
    assert alone["pressure"].mean() == pytest.approx(problem["mean_pressure"])
    pytest.importorskip("aspher")
    theirs = run_code(
        "packages/roughcontact/docs/other_codes.md",
        "By ASPHER, a window that stands alone",
        **given(problem),
    )
    check(theirs, alone)
