"""The way of a turn keeps the contacts, and rolls."""

import numpy as np
import pytest
from holdfast.hands import forward_kinematics
from holdfast.mjcf.squeeze.turn_path import turn_path, turned_pose
from holdfast.solver import Configuration, ContactManifold


def test_the_way_of_a_turn_keeps_the_contacts_and_rolls(tuning: Configuration) -> None:
    task, test = tuning.task, tuning.task.test
    way = list(turn_path(tuning, test, 5))
    assert len(way) == 5
    manifold = ContactManifold(task)
    slid = np.zeros(len(task.contacts))
    for k, (here, there) in enumerate(zip([tuning, *way], way, strict=False)):
        R, p = turned_pose(tuning.state, test, test.angle_rad * (k + 1) / 5)
        assert there.state.R_palm_object == pytest.approx(R, abs=1e-9)
        assert there.state.p_palm_object == pytest.approx(p, abs=1e-9)
        assert np.abs(manifold.residual(there.state)).max() < 1e-8
        assert np.all(task.limits[:, 0] - 1e-9 <= there.state.q)
        assert np.all(there.state.q <= task.limits[:, 1] + 1e-9)
        before, after = (forward_kinematics(task.hand, c.joint_vector) for c in (here, there))
        turn = there.state.T_palm_object @ np.linalg.inv(here.state.T_palm_object)
        for i, (contact, point) in enumerate(zip(task.contacts, here.contact_points, strict=True)):
            link = contact.hand.link
            moved = after[link] @ np.linalg.inv(before[link]) @ [*point.p_hand, 1.0]
            slid[i] += np.linalg.norm((moved - turn @ [*point.p_object, 1.0])[:3])
    # The contacts would slide by some 4 mm, a quarter of a radian at 15 mm, if the fingers stayed.
    assert slid.max() < 0.0015


def test_the_hinge_is_an_axis_of_the_turned_pose(tuning: Configuration) -> None:
    test, state = tuning.task.test, tuning.state
    R, p = turned_pose(state, test, 0.7)
    for along in (0.0, 0.1):
        point = np.array(test.hinge_point) + along * np.array(test.hinge_axis)
        there = state.R_palm_object @ point + state.p_palm_object
        assert R @ point + p == pytest.approx(there, abs=1e-12)
