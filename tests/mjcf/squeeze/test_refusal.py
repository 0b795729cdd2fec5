"""What is called not holdable: never what holds, or is planned for; ever more as the task gets harder."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from holdfast.hands import Axis
from holdfast.mjcf import Grasp, HoldSettings, NotHoldable, Obstacle, Squeeze, hold_test, plan_squeeze
from holdfast.mjcf.squeeze import refusal as refusals
from holdfast.mjcf.squeeze.potential_contacts import potential_contacts
from holdfast.mjcf.squeeze.press_unplanned import press_along_normals
from holdfast.mjcf.squeeze.refusal import why_not_holdable
from holdfast.mjcf.squeeze.statics import PointContact, grasp_statics
from holdfast.solver import Configuration

from ..conftest import solve

ONE_WAY = HoldSettings(directions=((0.0, 0.6, -0.8),), hold_s=0.5)


def share(configuration: Configuration, settings: HoldSettings) -> float:
    """Share of the load that forces anywhere near could carry, at most 1."""
    refusal = why_not_holdable(configuration, settings)
    return 1.0 if refusal is None else refusal.load_factor


def heavy(configuration: Configuration, times: float, settings: HoldSettings = ONE_WAY) -> HoldSettings:
    return replace(settings, object_mass_kg=times * configuration.task.object.inertia.mass)


def with_strength(configuration: Configuration, times: float) -> Configuration:
    """The same grasp by a hand whose servos are so many times as strong."""

    def changed(axis: Axis) -> Axis:
        servo = axis.actuator
        return axis if servo is None else replace(axis, actuator=replace(servo, effort=times * servo.effort))

    task = configuration.task
    links = tuple(replace(k, axes=tuple(changed(axis) for axis in k.axes)) for k in task.hand.links)
    return replace(configuration, task=replace(task, hand=replace(task.hand, links=links)))


@pytest.mark.parametrize("times", [1.0, 20.0, 60.0])
def test_what_holds_is_not_refused(times: float, firm: Grasp) -> None:
    settings = heavy(firm.configuration, times)
    for force in (10.0, 30.0):
        squeeze = press_along_normals(firm.configuration, force, settings=settings)
        held = hold_test(Grasp(firm.configuration, squeeze), settings=settings).held
        assert not held or why_not_holdable(firm.configuration, settings) is None


@pytest.mark.parametrize("times", [1.0, 4.0, 10.0])
def test_a_load_that_a_plan_carries_is_not_refused(times: float, grasp: Grasp) -> None:
    """The plan's forces lie within the cones, the efforts and the place of the grasp: they are among all."""
    settings = heavy(grasp.configuration, times)
    squeeze = plan_squeeze(grasp.configuration, settings=settings)
    carried = squeeze.load_factor if isinstance(squeeze, Squeeze) else 0.0
    assert share(grasp.configuration, settings) >= min(1.0, carried) - 1e-6


def test_a_refusal_stands_against_hands_that_press_all_the_same(firm: Grasp) -> None:
    settings = heavy(firm.configuration, 400.0)
    assert isinstance(plan_squeeze(firm.configuration, settings=settings), NotHoldable)
    for force in (3.0, 30.0):
        grasp = Grasp(firm.configuration, press_along_normals(firm.configuration, force, settings=settings))
        assert not hold_test(grasp, settings=settings).held


def test_harder_tests_leave_a_smaller_share(firm: Grasp) -> None:
    c = firm.configuration
    heavier = [share(c, heavy(c, times)) for times in (1.0, 100.0, 200.0, 400.0)]
    assert heavier[0] == 1.0 and heavier[1] > heavier[2] > heavier[3] > 0.0
    base = heavy(c, 200.0)
    assert share(c, base) > share(c, replace(base, friction=0.3))
    assert share(c, base) > share(c, replace(base, slip_limit_m=0.002))
    assert share(c, base) > share(c, replace(base, rotation_limit_rad=0.02))
    assert share(c, base) >= share(c, replace(base, directions=HoldSettings().directions))
    assert share(c, base) > share(with_strength(c, 0.5), base)


def test_the_share_is_that_of_the_strength_over_the_weight(firm: Grasp) -> None:
    """Twice the weight with servos twice as strong is the same problem in other units."""
    c = firm.configuration
    for times in (200.0, 400.0):
        expected = share(c, heavy(c, 200.0))
        assert share(with_strength(c, times / 200.0), heavy(c, times)) == pytest.approx(expected, rel=1e-4)


def test_weak_servos_are_one_obstacle_and_slippery_contacts_another(firm: Grasp) -> None:
    weak = why_not_holdable(with_strength(firm.configuration, 0.001), ONE_WAY)
    assert weak is not None and weak.obstacle is Obstacle.EFFORT
    tight = replace(ONE_WAY, friction=0.02, rotation_limit_rad=0.002, slip_limit_m=1e-4)
    slippery = why_not_holdable(firm.configuration, tight)
    assert slippery is not None and slippery.obstacle is Obstacle.FRICTION


def one_named(configuration: Configuration) -> tuple[Configuration, HoldSettings]:
    """The grasp with its first contact alone named, and gravity along that contact's push."""
    task = configuration.task
    alone = replace(configuration, task=replace(task, contacts=task.contacts[:1]))
    alone = replace(alone, state=replace(alone.state, params=alone.state.params[:4]))
    push = grasp_statics(alone).frames[0][0]
    return alone, HoldSettings(directions=(tuple(push.tolist()),), friction=0.3)


def without_the_other(configuration: Configuration, alone: Configuration) -> Configuration:
    """The finger of the second contact turned away, the first one's left as it is."""
    hand = configuration.task.hand
    named, other = (hand.tree.moves[contact.hand.link] for contact in configuration.task.contacts)
    away = np.array([other[i] and not named[i] for i in hand.independent])
    q = np.where(away, np.clip(0.0, *configuration.task.limits.T), configuration.state.q)
    return replace(alone, state=replace(alone.state, q=q))


def test_contacts_on_one_side_hold_nothing_that_falls_away(firm: Grasp) -> None:
    """One contact alone, its normal turned as far as it may be, can't pull an object up from above."""
    alone, settings = one_named(firm.configuration)
    refusal = why_not_holdable(without_the_other(firm.configuration, alone), settings)
    assert refusal == NotHoldable(Obstacle.FRICTION, pytest.approx(0.0, abs=1e-6))


def test_a_link_that_touches_counts_though_it_is_not_named(firm: Grasp) -> None:
    alone, settings = one_named(firm.configuration)
    assert why_not_holdable(alone, settings) is None


def test_links_near_only_add_to_the_share(firm: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    c = firm.configuration
    near = potential_contacts(c, 0.02)
    assert len(near) > 2
    tests = [heavy(c, 200.0), heavy(c, 200.0, replace(ONE_WAY, friction=0.1, rotation_limit_rad=0.02))]
    for settings in tests:
        shares = []
        for count in (0, 1, 2, len(near)):
            monkeypatch.setattr(refusals, "potential_contacts", lambda *_, count=count: near[:count])
            shares.append(share(c, settings))
        assert all(b >= a - 1e-9 for a, b in pairwise(shares))
        assert shares[-1] > shares[0]


def test_a_palm_that_is_near_carries_without_effort(firm: Grasp, monkeypatch: pytest.MonkeyPatch) -> None:
    """With servos of no strength to speak of, an object rests on a palm below, and on nothing else."""
    weak = with_strength(firm.configuration, 1e-4)
    state, task = weak.state, weak.task
    centre = state.R_palm_object @ task.object.inertia.centre + state.p_palm_object
    down = np.array(ONE_WAY.directions[0])
    for link, carried in ((0, True), (task.contacts[0].hand.link, False)):
        touch = PointContact(link, centre + 0.01 * down, centre + 0.01 * down, -down)
        monkeypatch.setattr(refusals, "potential_contacts", lambda *_, touch=touch: [touch])
        assert (why_not_holdable(weak, ONE_WAY) is None) is carried


def test_without_a_limit_on_rotation_normals_may_lean_almost_to_the_side(firm: Grasp) -> None:
    limited, free = (
        heavy(firm.configuration, 200.0, replace(ONE_WAY, rotation_limit_rad=limit)) for limit in (0.2, None)
    )
    assert share(firm.configuration, free) > share(firm.configuration, limited)


def test_a_press_beyond_the_servos_is_refused() -> None:
    configuration = solve("playing")
    task = configuration.task
    verdicts = []
    for times in (1.0, 1000.0):
        test = replace(task.test, force_N=times * task.test.force_N)
        asked = replace(configuration, task=replace(task, test=test))
        verdicts.append(why_not_holdable(asked, HoldSettings()))
    assert verdicts[0] is None
    assert verdicts[1] is not None and verdicts[1].obstacle is Obstacle.EFFORT


def test_a_hinge_that_is_too_stiff_is_refused() -> None:
    configuration = solve("tuning")
    task = configuration.task
    stiff = replace(task, test=replace(task.test, friction_torque_Nm=100.0))
    assert why_not_holdable(configuration, HoldSettings()) is None
    refusal = why_not_holdable(replace(configuration, task=stiff), HoldSettings())
    assert refusal is not None and refusal.obstacle is Obstacle.EFFORT
    assert 0.0 < refusal.load_factor < 1.0
