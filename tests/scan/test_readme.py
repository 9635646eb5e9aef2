"""scans/README.md: short, with complete examples."""

import yaml
from places import ROOT

from fractalcontact.scan.options import ScanOptions
from fractalcontact.scan.stated import Needs, required_keys

README = (ROOT / "scans/README.md").read_text()


def test_it_is_a_reference_of_two_hundred_lines():
    assert README.count("\n") <= 200


def test_the_keys_that_must_be_stated_are_named():
    matrix = required_keys(ScanOptions(layout="matrix"), Needs(text=True, table=True))
    points = required_keys(ScanOptions(layout="points"), Needs(text=True, table=True))
    section = README[README.index("## What describes itself") : README.index("## make describe")]
    for key in {*matrix, *points}:
        assert f"`{key}`" in section


def test_its_examples_are_complete_sidecars():
    example = README[README.index("An array in metres") :].split("\n\n")[1]
    options = ScanOptions(**yaml.safe_load(example))
    needs = Needs(table=True, arrays=["Z_grid", "Z"])
    assert all(getattr(options, key) is not None for key in required_keys(options, needs))
