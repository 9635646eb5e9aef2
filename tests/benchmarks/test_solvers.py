"""What the table of solvers says of the way a solve went."""

import sys
from types import SimpleNamespace

import pytest
from places import BENCHMARKS

from fractalcontact import HalfSpace
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact import candidates, operator

sys.path.insert(0, str(BENCHMARKS))
from solvers import Ours


@pytest.fixture
def problem(monkeypatch):
    """A window so small that candidates are looked for on it for the test alone."""
    monkeypatch.setattr(candidates, "MIN_WINDOW", 16)
    monkeypatch.setattr(candidates, "MIN_SIDE", 8)
    monkeypatch.setattr(candidates, "MAX_CANDIDATES", 1.0)
    monkeypatch.setattr(candidates, "BATCH", 0.0)
    shape = 48, 48
    height = self_affine(shape, 0.1, 0.8, rms=0.2, seed=3)
    return SimpleNamespace(height=height, space=HalfSpace(shape, 0.1, 1e4))


@pytest.mark.parametrize(
    ("most_pairs", "rtol", "words"),
    [(10**9, 1e-6, "pair by pair"), (0, 1e-6, "multipole"), (0, 1e-9, "convolution")],
)
def test_the_path_names_the_operator_that_was_used(monkeypatch, problem, most_pairs, rtol, words):
    monkeypatch.setattr(operator, "MAX_PAIRS", dict.fromkeys(operator.MAX_PAIRS, most_pairs))
    solver = Ours(problem, "closure")
    answer = solver.solve(SimpleNamespace(closure=0.1), rtol, None)
    said = solver.path()
    assert [w for w in ("pair by pair", "multipole", "convolution") if w in said] == [words]
    assert str(answer.state.iterations) in said
    # The operators are those of the package again.
    assert "Counted" not in operator.DirectOperator.__name__ + operator.MultipoleOperator.__name__
