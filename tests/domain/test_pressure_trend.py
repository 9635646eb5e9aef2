"""The trend of a dimension with load, over measured maps."""

import numpy as np
import pytest

from fractalcontact.core.verdicts import BEYOND_RANDOM, LIKE_RANDOM, UNDETERMINED
from fractalcontact.domain.pressure_trend import FALLS, RISES, pressure_trend


def test_a_trend_has_the_sign_of_its_interval():
    pressure = np.array([0.1, 1, 10, 100])
    noise = np.array([0.01, -0.02, 0.015, -0.005])
    rising = 1 + 0.2 * np.log10(pressure) + noise
    assert pressure_trend(pressure, rising, rising - 0.3).verdict == RISES
    assert pressure_trend(pressure, rising, rising - 0.3 + noise).beyond_random == LIKE_RANDOM
    assert pressure_trend(pressure, rising, np.ones(4)).beyond_random == BEYOND_RANDOM
    assert pressure_trend(pressure, -rising, np.ones(4)).verdict == FALLS
    assert pressure_trend(pressure, 1 + noise, np.ones(4)).verdict == UNDETERMINED
    # Two maps show no trend, nor do maps without a load.
    assert pressure_trend(pressure[:2], rising[:2], rising[:2]).verdict == UNDETERMINED
    none = pressure_trend(np.full(4, np.nan), rising, rising)
    assert (none.verdict, none.beyond_random) == (UNDETERMINED, UNDETERMINED)
    # Other units of pressure shift the line, and nothing else.
    in_kpa = pressure_trend(1e3 * pressure, rising, np.ones(4))
    in_mpa = pressure_trend(pressure, rising, rising)
    assert in_kpa.line.slope.ends == pytest.approx(in_mpa.line.slope.ends)
