"""The object where it really is."""

import mujoco
import numpy as np
import pytest
from holdfast.geometry.transforms import axis_rotation, rotation_from_quaternion
from holdfast.mjcf import Grasp, HoldSettings
from holdfast.mjcf.hold.lift import Lift
from holdfast.mjcf.hold.placement import Placement

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def test_the_object_starts_where_it_is_placed(firm: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is shifted, and turned about the middle of its contact points."""
    begun = []
    step = mujoco.mj_step

    def record(model: mujoco.MjModel, data: mujoco.MjData, count: int = 1) -> None:
        begun.append(data.qpos[-7:].copy())
        step(model, data, count)

    monkeypatch.setattr(mujoco, "mj_step", record)
    turn = axis_rotation(np.array([0.0, 0.0, 1.0]), 0.1)
    shift = np.array([0.001, -0.002, 0.003])
    Lift(firm, SHORT, Placement(shift, turn)).squeeze()
    start = begun[0]
    state, points = firm.configuration.state, firm.configuration.contact_points
    R = rotation_from_quaternion(start[3:])
    assert pytest.approx(turn @ state.R_palm_object, abs=1e-12) == R
    middle = np.mean([point.p_object for point in points], axis=0)
    local = state.R_palm_object.T @ (middle - state.p_palm_object)
    assert R @ local + start[:3] - middle == pytest.approx(shift, abs=1e-12)
