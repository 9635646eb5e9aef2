"""Every estimator registers itself: found by its file, in the order that the files declare."""

from pathlib import Path

import fractalcontact.roughness.estimators as folder
from fractalcontact.roughness.registry import ESTIMATORS


def test_every_file_of_the_folder_is_an_estimator_of_its_name():
    files = {path.stem for path in Path(folder.__path__[0]).glob("*.py")} - {"__init__"}
    assert set(ESTIMATORS) == files


def test_estimators_come_in_the_order_they_declare():
    places = [estimator.place for estimator in ESTIMATORS.values()]
    assert places == sorted(set(places))
    assert list(ESTIMATORS)[:3] == ["variogram", "second_differences", "roughness_length"]
