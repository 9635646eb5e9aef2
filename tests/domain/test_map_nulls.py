"""Random cells beside a map, and the trend of its dimension with load."""

import numpy as np
import pytest
from ensembles import ensemble

from fractalcontact.domain.box_dimension import contact_dimension
from fractalcontact.domain.map_nulls import (
    BEYOND,
    FALLS,
    LIKE_RANDOM,
    RISES,
    UNDETERMINED,
    Random,
    null_verdict,
    pressure_trend,
    random_cells,
)

WHOLE = np.ones((48, 48), bool)


def judged(domain, measured=WHOLE):
    box = contact_dimension(domain, 0.1)
    return null_verdict(box.dimension, box.low, box.high, random_cells(domain, measured, 0.1))


@pytest.mark.parametrize("seed", range(ensemble("maps at random")))
def test_random_cells_are_not_distinguishable_from_random(seed):
    rng = np.random.default_rng(seed)
    domain = rng.random(WHOLE.shape) < rng.choice([0.03, 0.1, 0.3])
    # Of nearly full maps no dimension is known.
    assert judged(domain) in (LIKE_RANDOM, UNDETERMINED)


def test_a_square_is_beyond_random_and_a_line_of_as_few_cells_is_not():
    line, square = np.zeros((2, 48, 48), bool)
    line[20] = True
    square[10:30, 10:30] = True
    assert judged(square) == BEYOND
    # Of dimension 1 exactly, as 48 cells at random are, too: the number alone shows no line.
    assert judged(line) == LIKE_RANDOM


def test_random_cells_are_as_many_and_lie_where_something_was_measured(monkeypatch):
    seen = []
    monkeypatch.setattr(
        "fractalcontact.domain.map_nulls.contact_dimension",
        lambda cells, *_, **__: seen.append(cells) or contact_dimension(cells, 0.1),
    )
    domain, measured = np.zeros((2, 48, 48), bool)
    measured[:, :20] = True
    domain[::4, 3:12] = True
    random_cells(domain, measured, 0.1, draws=5)
    assert [int(cells.sum()) for cells in seen] == [int(domain.sum())] * 5
    assert not any((cells & ~measured).any() for cells in seen)
    assert len({cells.tobytes() for cells in seen}) == 5


def test_no_verdict_without_numbers():
    assert null_verdict(np.nan, np.nan, np.nan, Random(1, 0.9, 1.1)) == UNDETERMINED
    assert null_verdict(1.0, 0.9, 1.1, Random(*[np.nan] * 3)) == UNDETERMINED
    assert null_verdict(1.0, 0.95, 1.05, Random(1.2, 1.1, 1.3)) == BEYOND
    assert null_verdict(1.0, 0.95, 1.15, Random(1.2, 1.1, 1.3)) == LIKE_RANDOM


def test_a_trend_has_the_sign_of_its_interval():
    pressure = np.array([0.1, 1, 10, 100])
    noise = np.array([0.01, -0.02, 0.015, -0.005])
    rising = 1 + 0.2 * np.log10(pressure) + noise
    assert pressure_trend(pressure, rising, rising - 0.3).verdict == RISES
    assert pressure_trend(pressure, rising, rising - 0.3 + noise).beyond_random == LIKE_RANDOM
    assert pressure_trend(pressure, rising, np.ones(4)).beyond_random == BEYOND
    assert pressure_trend(pressure, -rising, np.ones(4)).verdict == FALLS
    assert pressure_trend(pressure, 1 + noise, np.ones(4)).verdict == UNDETERMINED
    # Two maps show no trend, nor do maps without a load.
    assert pressure_trend(pressure[:2], rising[:2], rising[:2]).verdict == UNDETERMINED
    none = pressure_trend(np.full(4, np.nan), rising, rising)
    assert (none.verdict, none.beyond_random) == (UNDETERMINED, UNDETERMINED)
    # Other units of pressure shift the line, and nothing else.
    in_kpa = pressure_trend(1e3 * pressure, rising, np.ones(4))
    assert in_kpa.line.slope == pytest.approx(pressure_trend(pressure, rising, rising).line.slope)
