"""What the recipes add works as it stands: an estimator, a solver, a scan format, a stage.

The figure is drawn in tests/figures, the job is run in tests/workflow.
"""

import numpy as np
import pytest
import xarray as xr
from code_blocks import run_code
from stage_names import STAGES

from contactlab.methods.registry import METHODS
from fractalcontact import HalfSpace
from fractalcontact.core.fitting import fit_line
from fractalcontact.scan.options import ScanOptions
from fractalcontact.surface.synthesis import self_affine


def test_the_estimator_finds_the_exponent_of_a_surface():
    package = "fractalcontact.roughness.estimators"
    estimator = run_code("docs/extending.md", "An estimator of Δ_g", package=package)["ESTIMATOR"]
    heights = self_affine((256, 256), 0.1, 0.8, rms=0.1, seed=1)
    curve = estimator.curves(heights, 0.1)["both"]
    near = curve.length < 3
    line = fit_line(np.log(curve.length[near]), np.log(curve.measure()[near]))
    expected = estimator.slope_at_zero + 0.8 * estimator.slope_per_hurst
    assert line.slope.value == pytest.approx(expected, abs=0.1)


def test_the_solver_agrees_with_elimination():
    module = run_code("docs/extending.md", "A solver method", package="contactlab.methods")
    (method,) = module["METHODS"]
    assert method.name not in METHODS
    heights = self_affine((16, 20), 0.5, 0.7, rms=0.1, seed=1)
    space = HalfSpace(heights.shape, 0.5, 30e3)
    state = method(heights, space, closure=0.1)
    expected = METHODS["dense"](heights, space, closure=0.1)
    assert state.force == pytest.approx(expected.force, rel=1e-6)
    np.testing.assert_array_equal(state.in_contact, expected.in_contact)


def test_the_scan_format_reads_what_its_writer_writes(tmp_path):
    module = run_code(
        "docs/extending_stages.md", "A scan format", package="fractalcontact.scan.readers"
    )
    heights = self_affine((12, 18), 0.1, 0.7, rms=0.1, seed=1)
    heights[3, 5] = np.nan
    said = module["_write_surfer"](tmp_path / "face.grd", heights, 0.1, 0.2)
    scan = module["FORMAT"].read(tmp_path / "face.grd", ScanOptions(**said))
    np.testing.assert_allclose(scan.values, heights, rtol=1e-12)
    assert scan.spacing == pytest.approx((0.1, 0.2))


def test_the_stage_counts_summits():
    module = run_code("docs/extending_stages.md", "A stage", package="fractalcontact.joint")
    y, x = np.meshgrid(*[np.linspace(0, 1, 41)] * 2, indexing="ij")

    def hills(*tops):
        return sum(np.exp(-50 * ((y - at[0]) ** 2 + (x - at[1]) ** 2)) for at in tops)

    one, four = hills((0.4, 0.6)), hills((0.2, 0.2), (0.2, 0.8), (0.8, 0.3), (0.7, 0.7))
    joints = xr.Dataset(
        {"composite": (("offset", "window_y", "window_x"), [one, four])},
        {"offset": ("offset", [0.1, 0.2], {"units": "mm", "long_name": "offset"})},
    )
    found = module["summits"](joints)["summits"]
    assert found.sel(offset=0.1) == 1
    assert found.sel(offset=0.2) == 4
    assert {"units", "long_name"} <= set(found.attrs)
    assert "summits" not in STAGES
