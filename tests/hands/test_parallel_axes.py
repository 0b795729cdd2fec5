"""Axes that decimals leave askew are made parallel; others are left as they are."""

import numpy as np
import pytest
from holdfast.geometry import MassProperties, pose, rotation_exp
from holdfast.hands.hand import Axis, Link
from holdfast.hands.models.parallel_axes import with_parallel_axes

MASS = MassProperties(0.1, np.zeros(3), 1e-5 * np.eye(3))


def chain(turns_rad: list[float]) -> list[Link]:
    """Links one on the other, each turned about x by so much against its parent, with an axis along its y."""
    out = []
    for k, angle in enumerate(turns_rad):
        T = pose(rotation_exp(np.array([angle, 0.0, 0.0])), np.array([0.0, 0.0, 0.03]))
        axis = Axis(f"q{k}", "revolute", np.array([0.0, 1.0, 0.0]), -1.0, 1.0, None, None)
        out.append(Link(f"link{k}", k - 1, T, (axis,), (), MASS))
    return out


def in_palm(links: list[Link]) -> np.ndarray:
    R, out = np.eye(3), []
    for link in links:
        R = R @ link.T_parent_link0[:3, :3]
        out.append(R @ link.axes[0].direction)
    return np.array(out)


def test_axes_askew_by_typed_decimals_become_parallel():
    links, notes = with_parallel_axes(chain([0.3, 1e-7, 1.5707964, -1.5707963, 2e-7]))
    axes = in_palm(links)
    sines = np.linalg.norm(np.cross(axes[[1, 3, 4]], axes[0]), axis=1)
    assert sines.max() < 1e-15
    assert len(notes) == 1 and notes[0].startswith("3 axes")
    for link in links:
        assert np.linalg.norm(link.axes[0].direction) == pytest.approx(1.0, abs=1e-15)
        assert np.linalg.norm(link.axes[0].direction - [0.0, 1.0, 0.0]) < 1e-6


@pytest.mark.parametrize("turns", [[0.3, 0.2], [0.3, 2e-6], [0.0, 0.0], [0.3, 0.0, 0.7]])
def test_others_stay_as_they_are(turns):
    before = chain(turns)
    links, notes = with_parallel_axes(before)
    assert notes == []
    assert all(
        np.array_equal(a.axes[0].direction, b.axes[0].direction) for a, b in zip(links, before, strict=True)
    )
