"""Plateau of rigid dilatancy: lines of known slope, their trend, and where there is none."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.verdicts import FALLING, LEVEL, RISING
from fractalcontact.joint.plateau import (
    opposite_parts,
    relative_change,
    rigid_plateaus,
    second_half,
    undecided_plateaus,
)

V = np.linspace(0, 8, 41)


def plateaus(*rows, v=V, directions=None):
    names = [f"d{i}" for i in range(len(rows))] if directions is None else directions
    return xr.Dataset(rigid_plateaus(v, np.array(rows), names), coords={"direction": names})


def test_a_straight_line_has_its_own_slope_whatever_happens_before():
    rng = np.random.default_rng(1)
    line = 0.4 + 0.03 * V
    early = np.where(second_half(V), line, rng.normal(size=V.size))
    found = plateaus(early).squeeze()
    for end in ("", "_low", "_high"):
        assert found[f"plateau_slope{end}"].item() == pytest.approx(0.03)
        assert found[f"plateau_change{end}"].item() == pytest.approx(0.03 * 4 / (0.4 + 0.03 * 6))
    assert found["plateau_intercept"].item() == pytest.approx(0.4)
    assert found["plateau_level"].item() == pytest.approx(0.4 + 0.03 * 6)
    assert (found["plateau_offset_min"], found["plateau_offset_max"]) == (4, 8)
    assert found["no_plateau"].item() == ""


def test_the_interval_of_the_slope_holds_the_line_and_widens_with_the_scatter():
    rng = np.random.default_rng(2)
    scatter = rng.normal(size=V.size)
    narrow, wide = (plateaus(1 + 0.03 * V + of * scatter).squeeze() for of in (0.001, 0.01))
    widths = [float(x["plateau_slope_high"] - x["plateau_slope_low"]) for x in (narrow, wide)]
    assert widths[1] == pytest.approx(10 * widths[0])
    for found in (narrow, wide):
        ends = [float(found[f"plateau_change{end}"]) for end in ("_low", "", "_high")]
        assert ends == sorted(ends)


@pytest.mark.parametrize(
    ("change", "trend"),
    [(0.0, LEVEL), (0.09, LEVEL), (-0.09, LEVEL), (0.11, RISING), (-0.11, FALLING)],
)
@pytest.mark.parametrize("mean", [1e-3, 2.0, -2.0])
def test_the_trend_is_the_sign_of_a_change_of_more_than_a_tenth(change, trend, mean):
    """Where faces close as they slide the mean is negative: a rise is one all the same."""
    found = plateaus(mean + change * abs(mean) * (V - 6) / 4).squeeze()
    assert found["plateau_trend"].item() == trend
    assert found["plateau_change"].item() == pytest.approx(change, abs=1e-12)


def test_units_and_order_of_the_directions_change_no_trend():
    rows = [1 - np.exp(-V), 0.1 * V, 2 - 0.1 * V]
    found = plateaus(*rows)
    turned = plateaus(*rows[::-1])
    scaled = plateaus(*[1e3 * row for row in rows], v=1e3 * V)
    assert found["plateau_trend"].values.tolist() == [LEVEL, RISING, FALLING]
    assert turned["plateau_trend"].values.tolist() == [FALLING, RISING, LEVEL]
    assert scaled["plateau_trend"].values.tolist() == [LEVEL, RISING, FALLING]
    for end in ("", "_low", "_high"):
        for name in ("change", "slope"):
            np.testing.assert_allclose(
                scaled[f"plateau_{name}{end}"], found[f"plateau_{name}{end}"], rtol=1e-9, atol=1e-12
            )


def test_too_few_offsets_and_planes_have_a_reason_and_no_numbers():
    found = plateaus([0.0], [0.0], v=V[:1], directions=["none", "W"])
    assert found["no_plateau"].values.tolist() == [
        "an aperture map, or a surface against a plane, does not slide",
        "1 offsets in the second half, 3 needed",
    ]
    for name, values in found.data_vars.items():
        if name != "no_plateau":
            assert (values == "").all() if values.dtype.kind == "U" else np.isnan(values).all(), (
                name
            )


def test_faces_that_stay_flush_are_level():
    found = plateaus(np.zeros(V.size)).squeeze()
    assert (found["plateau_trend"].item(), found["plateau_level"].item()) == (LEVEL, 0)
    assert np.isnan(found["plateau_change"])
    assert np.isnan(relative_change(0.1, V, 0.0))


def parts_of(v, rows, names):
    return xr.Dataset(opposite_parts(v, np.array(rows), names), coords={"rigid_offset": v})


@pytest.mark.parametrize("tilt", [-0.1, 0.0, 0.03])
def test_a_tilt_is_in_the_odd_part_alone(tilt):
    v = np.linspace(0, 10, 41)
    grown = 0.4 * (1 - np.exp(-v))
    rows = [grown + tilt * v, 2 * grown, grown - tilt * v, 2 * grown]
    found = parts_of(v, rows, [*"ENWS"])
    assert found["axis"].values.tolist() == ["E-W", "N-S"]
    np.testing.assert_allclose(found["even_dilatancy"], [grown, 2 * grown])
    np.testing.assert_allclose(found["odd_dilatancy"], [tilt * v, 0 * v], atol=1e-15)
    np.testing.assert_allclose(found["odd_slope"], [tilt, 0], atol=1e-12)
    np.testing.assert_allclose(found["even_change"], 0, atol=0.02)


def test_directions_without_their_opposite_have_no_parts():
    v = np.linspace(0, 1, 11)
    found = parts_of(v, [v, v, v], ["E", "N", "S"])
    assert found["axis"].values.tolist() == ["N-S"]
    assert parts_of(v, [v], ["none"]).sizes["axis"] == 0


def test_a_trend_decides_on_a_plateau_only_beyond_the_correlation_of_the_faces():
    correlation = np.linspace(1, [0.49, 0.0, 0.0, np.nan], V.size).T
    lost = np.array([np.nan, 6.0, 3.0, np.nan])
    _, words, _ = undecided_plateaus(V, correlation, lost)["plateau_undecided"]
    assert words.tolist() == [
        "offsets end at 8 mm, where the faces still correlate (0.49)",
        "the faces still correlate up to 6 mm",
        "",
        "",
    ]
