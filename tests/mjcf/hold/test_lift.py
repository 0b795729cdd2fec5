"""A lift begins at the pregrasp, and waits for contacts that come back."""

from dataclasses import replace
from itertools import pairwise

import holdfast.mjcf.hold.lift as lift_module
import mujoco
import numpy as np
import pytest
from holdfast.mjcf import (
    Grasp,
    HoldSettings,
    Outcome,
    find_margin,
    fingers_first,
    hold_test,
    shared_lift,
)
from holdfast.mjcf.hold.lift import Lift
from holdfast.mjcf.hold.squeezing import Squeezing

SHORT = HoldSettings(directions=((1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), hold_s=0.6)


def test_the_test_begins_at_the_pregrasp_of_the_approach(
    grasp: Grasp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In `close_s` the servos are driven along the approach's waypoints, to the grasp itself."""
    driven = []
    lift = Lift(grasp, SHORT)
    step = mujoco.mj_step

    def record(model: mujoco.MjModel, data: mujoco.MjData, count: int = 1) -> None:
        driven.append(np.array(data.ctrl))
        step(model, data, count)

    monkeypatch.setattr(mujoco, "mj_step", record)
    lift.squeeze()
    closing = np.array(driven[: round(SHORT.close_s / SHORT.timestep_s)])
    waypoints = grasp.approach.waypoints
    assert len(waypoints) > 2 and grasp.approach.reachable
    assert closing[-1] == pytest.approx(grasp.configuration.state.q, abs=1e-12)
    pace = np.abs(np.diff(closing, axis=0)).max(axis=1)
    assert pace.max() < 1.01 * np.abs(np.diff(waypoints, axis=0)).max(axis=1).sum() / len(closing)
    for targets in closing:
        # On one of the lines between waypoints.
        off = []
        for start, end in pairwise(waypoints):
            line = end - start
            share = np.clip((targets - start) @ line / (line @ line), 0.0, 1.0)
            off.append(np.abs(start + share * line - targets).max())
        assert min(off) < 1e-9


@pytest.mark.parametrize(("samples", "outcome"), [(0, Outcome.HELD), (5, Outcome.HELD), (99, Outcome.LET_GO)])
def test_a_contact_that_comes_back_at_once_is_not_lost(
    samples: int, outcome: Outcome, firm: Grasp, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One contact shows no force at so many samples from the end on."""
    lift = lift_module.Lift(firm, SHORT)
    lift.squeeze()
    real, seen = lift.simulation.normal_forces, []

    def flickering() -> np.ndarray:
        seen.append(True)
        return real() * (np.arange(len(real())) > 0 if len(seen) <= samples else 1.0)

    monkeypatch.setattr(lift.simulation, "normal_forces", flickering)
    assert lift.hold(SHORT.directions[0]).outcome is outcome


def test_a_squeeze_settles_until_the_object_is_at_rest(firm: Grasp) -> None:
    """Never for longer than it is given, and without `rest_s` for all of that time."""
    ends, poses = [], []
    for rest_s in (0.1, None):
        lift = Lift(firm, replace(SHORT, rest_s=rest_s, creep_budget_m_s=1e-3, creep_budget_rad_s=0.1))
        lift.squeeze()
        ends.append(lift.simulation.data.time)
        poses.append(lift.squeezed.pose)
    whole_s = SHORT.close_s + SHORT.squeeze_s + SHORT.settle_s
    assert ends[1] == pytest.approx(whole_s) and whole_s - SHORT.settle_s + 0.2 <= ends[0] + 1e-9 < whole_s
    assert np.abs(poses[0] - poses[1])[:3].max() < 1e-3 * SHORT.settle_s


def test_forces_are_those_of_mujoco_contact_by_contact(firm: Grasp) -> None:
    """By MuJoCo's own way from a contact to its force, and by the names of bodies."""
    lift = Lift(firm, SHORT)
    lift.squeeze()
    model, data = lift.simulation.model, lift.simulation.data
    task, force = firm.configuration.task, np.zeros(6)
    expected = dict.fromkeys((contact.hand.link for contact in task.contacts), 0.0)
    found = lift.simulation.normal_forces()
    for k in range(data.ncon):
        names = {model.body(model.geom_bodyid[geom]).name for geom in data.contact[k].geom}
        mujoco.mj_contactForce(model, data, k, force)
        for link in expected:
            if names == {"object", task.hand.links[link].name}:
                expected[link] += force[0]
    assert found.min() > 0.5
    assert found == pytest.approx([expected[contact.hand.link] for contact in task.contacts])
    assert np.array_equal(lift.simulation.contact_speeds()[0], found)


def test_looking_changes_nothing_of_what_comes(firm: Grasp) -> None:
    ends = []
    for looks in (False, True):
        lift = Lift(firm, SHORT)
        lift.squeeze()
        for _ in range(5):
            if looks:
                lift.simulation.normal_forces(), lift.simulation.contact_speeds()
            lift.simulation.step(3)
        ends.append(lift.simulation.full_state())
    assert np.array_equal(*ends)


def test_tests_that_share_a_lift_find_what_they_find_alone(leaning: Grasp) -> None:
    """To the bit, in whatever order, other squeezes and loads in between."""
    alone = hold_test(leaning, settings=SHORT)
    lift = shared_lift(leaning, settings=SHORT)
    assert lift is not None
    fingers = fingers_first(leaning, settings=SHORT, lift=lift)
    margin = find_margin(leaning, settings=SHORT, lift=lift)
    lift.squeeze_partly(0.5)
    again = hold_test(leaning, settings=SHORT, lift=lift)
    assert np.array_equal(alone.squeezed_normals_N, again.squeezed_normals_N)
    for one, other in zip(alone.directions, again.directions, strict=True):
        assert np.array_equal(one.qpos, other.qpos)
    assert fingers == fingers_first(leaning, settings=SHORT)
    assert margin == find_margin(leaning, settings=SHORT)
    assert set(margin.weakest) == set(SHORT.directions)
    # And one that goes on from the squeeze that a result hands on.
    later = shared_lift(leaning, settings=SHORT, usual=alone.usual)
    assert later is not None
    later.squeeze_partly(0.5)
    lift.squeeze_partly(0.5)
    assert np.array_equal(later.squeezed.state, lift.squeezed.state)
    further = hold_test(leaning, settings=SHORT, lift=later)
    for one, other in zip(alone.directions, further.directions, strict=True):
        assert np.array_equal(one.qpos, other.qpos)


def test_a_hand_that_closes_freely_does_so_for_other_squeezes(leaning: Grasp) -> None:
    """To the bit; where it touches anything on the way, nothing is handed on."""
    first, softer = Lift(leaning, SHORT), replace(leaning.squeeze, yields_m=2.0 * leaning.squeeze.yields_m)
    other = replace(leaning, squeeze=softer, known_approach=leaning.approach)
    alone = Lift(other, SHORT)
    assert first.squeezing.closed_freely is not None
    shared = shared_lift(other, settings=SHORT, other=first)
    assert shared is not None and shared.squeezing.closed is first.squeezing.closed
    alone.squeeze()
    shared.squeeze()
    assert np.array_equal(alone.squeezed.state, shared.squeezed.state)
    # On a way that leads on into the object.
    q, targets = leaning.configuration.state.q, leaning.squeeze.targets
    deeper = replace(leaning.approach, waypoints=np.vstack([leaning.approach.waypoints, targets, q]))
    assert Lift(replace(leaning, known_approach=deeper), SHORT).squeezing.closed_freely is None


@pytest.mark.parametrize("limit_m", [1.0, 1e-3, 1e-4, 1e-6])
def test_whether_a_squeeze_is_firm_is_known_no_later_than_it_is_over(limit_m: float, leaning: Grasp) -> None:
    settings = replace(SHORT, firm_limit_m=limit_m)
    whole, asked = Lift(leaning, settings), Lift(leaning, settings)
    whole.squeeze()
    is_firm = whole.result([]).is_firm
    assert asked.squeezes_firmly() is is_firm
    assert asked.simulation.data.time <= whole.simulation.data.time + 1e-9
    if whole.result([]).squeeze_slip_m > 10.0 * limit_m:
        assert asked.simulation.data.time < SHORT.close_s + SHORT.squeeze_s
    asked.squeeze()
    assert np.array_equal(whole.squeezed.state, asked.squeezed.state)


def test_forces_of_the_last_step_are_those_before_it(firm: Grasp) -> None:
    lift = Lift(firm, SHORT)
    lift.squeeze()
    simulation = lift.simulation
    simulation.restore(lift.squeezed.state)
    before = simulation.normal_forces()
    simulation.step(1)
    assert simulation.normal_forces_of_last_step() == pytest.approx(before, abs=1e-9)


@pytest.mark.parametrize("share", [0.5, 0.3125])
def test_a_part_of_the_squeeze_ends_where_one_with_targets_there_does(share: float, leaning: Grasp) -> None:
    """It has come on the way of the whole squeeze, at its pace; at any pace the forces are the same."""
    q, whole = leaning.configuration.state.q, leaning.squeeze
    weaker = replace(whole, targets=q + share * (whole.targets - q))
    paced = replace(SHORT, squeeze_s=share * SHORT.squeeze_s)
    ends = [Lift(leaning, SHORT), *(Lift(replace(leaning, squeeze=weaker), s) for s in (SHORT, paced))]
    ends[0].squeeze_partly(share)
    ends[1].squeeze()
    ends[2].squeeze()
    partly, slowly, alike = (lift.result([]) for lift in ends)
    assert np.allclose(ends[0].simulation.data.ctrl, weaker.targets, atol=1e-12)
    assert partly.squeezed_normals_N == pytest.approx(slowly.squeezed_normals_N, rel=0.02, abs=0.05)
    assert partly.squeeze_slip_m == pytest.approx(alike.squeeze_slip_m, abs=2e-6)
    ends[0].squeeze_partly(1.0)
    ends[0].result([])
    assert ends[0].simulation.data.ctrl == pytest.approx(whole.targets)


@pytest.mark.parametrize("load", [1.0, 1.8, 4.0, 40.0])
def test_the_verdict_alone_is_that_of_the_whole_test(load: float, leaning: Grasp) -> None:
    """And it is known no later: a lift that fails is left where it does."""
    lift = Lift(leaning, SHORT)
    lift.squeeze()
    for direction in SHORT.directions:
        whole = lift.hold(direction, load).held
        ended_s = lift.simulation.data.time
        for held in (lift.holds(direction, load), lift.hold(direction, load, while_held=True).held):
            assert held is whole
            assert lift.simulation.data.time <= ended_s + 1e-9


@pytest.mark.parametrize("when", ["_close", "_settle"])
def test_a_simulation_that_breaks_down_before_gravity_acts_is_called_so(
    firm: Grasp, monkeypatch: pytest.MonkeyPatch, when: str
) -> None:
    """MuJoCo then begins anew somewhere: what is seen of the object says nothing about the grasp."""
    usual = getattr(Squeezing, when)

    def broken(squeezing: Squeezing, **given: bool) -> None:
        usual(squeezing, **given)
        squeezing.simulation.data.qvel[0] = np.nan
        squeezing.simulation.step(1)

    monkeypatch.setattr(Squeezing, when, broken)
    result = hold_test(firm, settings=SHORT)
    assert {entry.outcome for entry in result.directions} == {Outcome.UNSTABLE}
    assert not result.held and str(result).startswith("not held: the simulation broke down")
    lift = Lift(firm, SHORT)
    lift.squeeze()
    assert not lift.squeezed.is_stable and not any(map(lift.holds, SHORT.directions))
