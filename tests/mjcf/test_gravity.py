"""Names of directions of gravity."""

import numpy as np
import pytest
from holdfast.mjcf import DIRECTION_SETS, directions, gravity_names, main_axis
from holdfast.objects import load_task


@pytest.mark.parametrize("name", DIRECTION_SETS)
@pytest.mark.parametrize("task", ["upholding", "holding", "lid_lifting"])
def test_directions_of_a_test_have_names_of_their_own(name: str, task: str) -> None:
    given = directions(name, load_task(task))
    names = gravity_names(given)
    assert len(set(names)) == len(given)
    for direction, word in zip(given, names, strict=True):
        axis, backwards = main_axis(direction)
        assert word.startswith(("−" if backwards else "+") + axis)


def test_equal_directions_are_numbered_and_none_has_no_name() -> None:
    names = gravity_names([(0, 0, -9.81), (0, 0, -9.8), (0, 0, 0)])
    assert names == ["−z (1)", "−z (2)", ""]
    assert gravity_names([(0.5, 0.0, -0.8660254)]) == ["−z +x 30°"]


def test_a_cone_about_an_axis_needs_no_numbers() -> None:
    turns = np.arange(6) * np.pi / 3.0
    tilt = np.deg2rad(10.0)
    cone = [(np.sin(tilt) * np.cos(a), -np.cos(tilt), np.sin(tilt) * np.sin(a)) for a in turns]
    names = gravity_names([(0.0, -1.0, 0.0), *cone])
    assert names[:2] == ["−y", "−y +x 10°"] and len(set(names)) == 7
    assert not any("(" in name for name in names)
