"""A squeeze with one finger first: what is done, what is measured, and what it leads to."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from holdfast.hands import finger_joints
from holdfast.mjcf import Grasp, HoldSettings, fingers_first
from holdfast.mjcf.hold.lift import Lift

from ..conftest import squeezed

QUICK = HoldSettings(timestep_s=0.004, noslip_iterations=0, impratio=1000.0)


def test_the_fingers_that_squeeze_have_their_turn(grasp: Grasp) -> None:
    found = fingers_first(grasp, settings=QUICK)
    assert {entry.finger for entry in found} == {"thumb", "index"}
    for entry in found:
        near = entry.slip_m < QUICK.slip_limit_m and entry.rotation_rad < QUICK.rotation_limit_rad
        assert entry.kept is near
        assert entry.finger in str(entry) and ("too far" in str(entry)) is not entry.kept


def test_one_finger_reaches_its_targets_before_the_others_begin(
    firm: Grasp, monkeypatch: pytest.MonkeyPatch
) -> None:
    lift, driven = Lift(firm, QUICK), []
    step = mujoco.mj_step

    def record(model: mujoco.MjModel, data: mujoco.MjData, count: int = 1) -> None:
        driven.append(np.array(data.ctrl))
        step(model, data, count)

    q, targets = firm.configuration.state.q, firm.squeeze.targets
    first = np.zeros(len(q), dtype=bool)
    first[finger_joints(firm.configuration.task.hand)["index"]] = True
    lift.squeeze()
    monkeypatch.setattr(mujoco, "mj_step", record)
    lift.squeeze(first=first)
    half = round(0.5 * QUICK.squeeze_s / QUICK.timestep_s)
    assert driven[half - 1] == pytest.approx(np.where(first, targets, q))
    assert all(targets[first] == pytest.approx(ctrl[first]) for ctrl in driven[half - 1 :])
    assert all(q[~first] == pytest.approx(ctrl[~first]) for ctrl in driven[:half])
    assert driven[-1] == pytest.approx(targets)


def test_it_ends_once_it_is_plain_whether_the_object_stays(grasp: Grasp) -> None:
    """The same is said as of the whole time, and never later."""
    ends, kept = [], []
    for settings in (QUICK, replace(QUICK, rest_s=None)):
        lift = Lift(grasp, settings)
        kept.append([entry.kept for entry in fingers_first(grasp, settings=settings, lift=lift)])
        ends.append(lift.simulation.data.time)
    assert kept[0] == kept[1]
    whole_s = QUICK.close_s + QUICK.squeeze_s + QUICK.settle_s
    assert ends[1] == pytest.approx(whole_s, abs=0.02) and ends[0] < whole_s - 0.05


def test_an_earlier_trial_leaves_no_trace(firm: Grasp) -> None:
    both = fingers_first(firm, settings=QUICK)
    lift = Lift(firm, QUICK)
    first = np.zeros(len(firm.squeeze.targets), dtype=bool)
    first[finger_joints(firm.configuration.task.hand)[both[-1].finger]] = True
    lift.squeeze(first=first)
    assert lift.result([]).squeeze_slip_m == both[-1].slip_m


def test_a_finger_alone_pushes_an_object_off_that_nothing_else_keeps(firm: Grasp) -> None:
    """The others' targets stay in the grasp, and their servos are strong: they hardly hold it back."""
    alone = np.zeros(len(firm.squeeze.targets), dtype=bool)
    alone[finger_joints(firm.configuration.task.hand)["index"]] = True
    targets = np.where(alone, firm.squeeze.targets, firm.configuration.state.q)
    pushed = replace(firm, squeeze=replace(firm.squeeze, targets=targets), known_approach=firm.approach)
    lift, whole = Lift(pushed, QUICK), Lift(firm, QUICK)
    for one in (lift, whole):
        one.squeeze()
    assert lift.result([]).squeeze_slip_m > 2.0 * whole.result([]).squeeze_slip_m


def test_it_ends_once_the_object_is_lost(firm: Grasp) -> None:
    """On the way, where limits are so small that it is far beyond them before all press."""
    ends = []
    for rest_s in (QUICK.rest_s, None):
        strict = replace(QUICK, slip_limit_m=1e-6, rest_s=rest_s)
        lift = Lift(firm, strict)
        assert not any(entry.kept for entry in fingers_first(firm, settings=strict, lift=lift))
        ends.append(lift.simulation.data.time - QUICK.close_s)
    assert ends[0] < QUICK.squeeze_s < ends[1]


def test_it_stops_at_the_first_finger_that_is_too_much(firm: Grasp) -> None:
    strict = replace(QUICK, slip_limit_m=1e-6)
    every = fingers_first(firm, settings=strict)
    assert len(every) == 2 and not any(entry.kept for entry in every)
    assert fingers_first(firm, settings=strict, until_lost=True) == every[:1]
    last = every[1].finger
    assert fingers_first(firm, settings=strict, until_lost=True, suspects=[last]) == every[1:]
    assert fingers_first(firm, settings=strict, suspects=[last]) == every


def test_a_hand_that_does_not_squeeze_has_no_first_finger(firm: Grasp) -> None:
    idle = replace(firm.squeeze, targets=firm.configuration.state.q)
    assert fingers_first(replace(firm, squeeze=idle, known_approach=firm.approach), settings=QUICK) == ()


def test_only_lifts_have_it() -> None:
    assert fingers_first(squeezed("playing")) == ()
