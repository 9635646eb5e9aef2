"""Jobs of the test of the size effect: every surface once, of the lengths that its arm has."""

import pytest

from contactlab.experiments import size_tasks
from contactlab.experiments.size_tasks import size_tasks as tasks_of

RECIPE = {"hurst": [0.5, 0.8], "cut_off": 4, "roll_off": 16, "roll_off_fraction": 0.25}


@pytest.mark.parametrize("nodes_a_job", [1, 64**2, 3 * 64**2, 100 * 64**2])
def test_every_surface_has_one_job(monkeypatch, nodes_a_job):
    monkeypatch.setattr(size_tasks, "NODES_A_JOB", nodes_a_job)
    sizes, surfaces = [32, 64, 128], [11, 7, 2]
    arms = {
        "S1": {"sizes": sizes, "surfaces": surfaces},
        "W": {"sizes": sizes, "surfaces": surfaces},
    }
    found = {}
    for task in tasks_of(RECIPE | {"arms": arms}):
        numbers = found.setdefault((task.arm, task.hurst, task.size), [])
        numbers += range(task.first, task.first + task.surfaces)
        assert task.nodes <= nodes_a_job or task.surfaces == 1
    for (_, _, size), numbers in found.items():
        assert sorted(numbers) == list(range(surfaces[sizes.index(size)]))
    assert len(found) == 2 * 2 * 3


@pytest.mark.parametrize("arm", ["R", "S1", "S2", "S3"])
def test_roll_offs_stay_or_grow_with_the_side(arm):
    """In nodes at every size (S1), a fraction of the side, or none (S3)."""
    stated = {"sizes": [64, 128], "surfaces": [1, 1]}
    found = {task.size: task.roll_off for task in tasks_of(RECIPE | {"arms": {arm: stated}})}
    expected = {"S1": {64: 16, 128: 16}, "S3": {64: None, 128: None}}
    assert found == expected.get(arm, {64: 16, 128: 32})
