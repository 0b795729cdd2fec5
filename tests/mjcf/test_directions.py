"""Sets of directions by name."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.mjcf import directions, preset_settings
from holdfast.objects import LiftTest, Task, load_task


@pytest.fixture(scope="module")
def task() -> Task:
    return load_task("upholding")


def test_directions_by_name(task: Task) -> None:
    assert len(directions("six", task)) == 6
    sphere = np.array(directions("sphere", task))
    assert sphere.shape == (26, 3)
    assert np.linalg.norm(sphere, axis=1) == pytest.approx(np.ones(26))
    assert len({tuple(np.round(d, 6)) for d in sphere}) == 26
    down = replace(task, test=LiftTest(directions=((0.0, 0.0, -1.0),)))
    assert directions("task", down) == ((0.0, 0.0, -1.0),)
    assert preset_settings("holdfast", down).directions == ((0.0, 0.0, -1.0),)
    assert len(preset_settings("holdfast", down, directions_name="sphere").directions) == 26
