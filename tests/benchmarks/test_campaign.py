"""A campaign that is only measured: copies of a specimen's results are whole under other names."""

import os
import sys

import numpy as np
import xarray as xr
from places import BENCHMARKS

from fractalcontact.core import checksums
from fractalcontact.study.atlas import write_atlas
from fractalcontact.study.atlas_parts import Trees

sys.path.insert(0, str(BENCHMARKS))
import campaign

DONOR, NAME = "rough_twin_00003", "rough_twin_00827"


def test_a_copied_atlas_is_that_of_its_specimen_and_as_old_as_the_first(tmp_path):
    origin, results = tmp_path / "campaign_6", tmp_path / "campaign_1000"
    for folder in ("atlas", "cards"):
        (origin / folder).mkdir(parents=True)
    attrs = {"units": "MPa", "long_name": "nominal pressure"}
    curve = xr.Dataset({"nominal_pressure": ("load", np.array([1.0, 5.0]), attrs)})
    donor = origin / f"atlas/{DONOR}.nc"
    configuration = {"study": {}, "settings": {DONOR: {"label": "a twin"}}}
    write_atlas({"closure": {DONOR: curve}}, donor, study="x", configuration=configuration)
    os.utime(donor, (1e9, 1e9))
    (origin / f"cards/{DONOR}.json").write_text("{}")
    campaign._copy(origin, results, DONOR, NAME)
    copied = Trees(results / f"atlas/{NAME}.nc", {"closure"})
    subject = copied.closure(NAME)
    assert subject.settings == {"label": "a twin"}
    np.testing.assert_array_equal(subject["closure"]["nominal_pressure"], [1, 5])
    # A younger atlas would have its card and page made again.
    assert (results / f"atlas/{NAME}.nc").stat().st_mtime == 1e9
    assert (results / f"cards/{NAME}.json").samefile(origin / f"cards/{DONOR}.json")
    assert checksums.check(results).damaged == []
    assert Trees(donor, {"closure"}).closure(DONOR).settings == {"label": "a twin"}
