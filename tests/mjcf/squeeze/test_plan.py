"""A squeeze does what it says: cones, balance and efforts are computed here once more, in other ways."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.hands import Axis, forward_kinematics
from holdfast.mjcf import Grasp, HoldSettings, NotHoldable, Obstacle, Squeeze, plan_squeeze
from holdfast.mjcf.squeeze.load_program import largest_load, load_program
from holdfast.mjcf.squeeze.pads import contact_pads
from holdfast.mjcf.squeeze.statics import grasp_statics
from holdfast.objects import Task
from holdfast.solver import Configuration

from ..conftest import servo_efforts

Wrench = tuple[np.ndarray, np.ndarray]


def states(squeeze: Squeeze) -> list[tuple[np.ndarray, np.ndarray]]:
    """Contact vectors (n, 4), each with the direction of gravity that it carries times the load factor.

    Of contacts that are points, where they act is known.
    """
    assert not squeeze.centres_m.any() and not squeeze.loaded_centres_m.any()
    directions = np.array(squeeze.settings.directions)
    return [
        (squeeze.preload, np.zeros(3)),
        *zip(squeeze.loaded, squeeze.load_factor * directions, strict=True),
    ]


def world_wrenches(grasp: Grasp, vector: np.ndarray) -> list[Wrench]:
    """Force and torque on the object by each contact, in the palm frame."""
    frames = grasp_statics(grasp.configuration).frames
    return [(f[:3] @ frame, f[3] * frame[0]) for f, frame in zip(vector, frames, strict=True)]


def test_contact_frames_point_into_the_object(grasp: Grasp) -> None:
    statics = grasp_statics(grasp.configuration)
    for frame, point in zip(statics.frames, grasp.configuration.contact_points, strict=True):
        assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)
        assert frame[0] == pytest.approx(-point.n_object, abs=1e-12)


def test_forces_lie_in_the_friction_cones(grasp: Grasp) -> None:
    obj, settings = grasp.configuration.task.object, grasp.squeeze.settings
    mu = settings.sliding_friction(obj)
    for vector, _ in states(grasp.squeeze):
        for (normal, first, second, torque), arm_m in zip(vector, grasp.squeeze.spin_arms_m, strict=True):
            assert normal > 0.0
            # The arms of the last plan but one, which these agree with to a tenth.
            assert np.hypot(np.hypot(first, second), torque / (1.12 * arm_m)) <= mu * normal * (1.0 + 1e-9)


def test_forces_balance_the_load(grasp: Grasp) -> None:
    configuration = grasp.configuration
    obj, state = configuration.task.object, configuration.state
    centre = state.T_palm_object[:3, :3] @ obj.inertia.centre + state.p_palm_object
    for vector, load in states(grasp.squeeze):
        force = obj.inertia.mass * grasp.squeeze.settings.gravity * load
        torque = np.zeros(3)
        wrenches = world_wrenches(grasp, vector)
        for (f, m), point in zip(wrenches, configuration.contact_points, strict=True):
            force = force + f
            torque = torque + m + np.cross(point.p_object - centre, f)
        assert np.abs(force).max() < 1e-5  # N
        assert np.abs(torque).max() < 1e-7  # N m


def virtual_work(
    configuration: Configuration, wrenches: list[Wrench], at: np.ndarray | None = None, step: float = 1e-6
) -> np.ndarray:
    """Efforts (n_independent,) as the work of the contacts' wrenches per motion of each independent joint.

    Args:
        configuration: the grasp.
        wrenches: of its contacts.
        at: joints (n_independent,) where the hand is, if not in the grasp.
        step: of the differences.
    """
    hand, q = configuration.task.hand, configuration.state.q if at is None else at
    rest = forward_kinematics(hand, configuration.joint_vector)
    here = forward_kinematics(hand, hand.expand(q))
    efforts = []
    for j in range(len(q)):
        ahead, behind = (
            forward_kinematics(hand, hand.expand(q + sign * step * np.eye(len(q))[j])) for sign in (1, -1)
        )
        work = 0.0
        contacts = zip(configuration.task.contacts, configuration.contact_points, wrenches, strict=True)
        for contact, point, (force, torque) in contacts:
            i = contact.hand.link
            local = np.linalg.inv(rest[i]) @ [*point.p_hand, 1.0]
            work += force @ ((ahead[i] - behind[i]) @ local)[:3]
            spin = (ahead[i] - behind[i])[:3, :3] @ here[i][:3, :3].T
            work += torque @ [spin[2, 1], spin[0, 2], spin[1, 0]]
        efforts.append(work / (2.0 * step))
    return np.array(efforts)


def test_efforts_are_the_work_of_the_forces(grasp: Grasp) -> None:
    wrenches = world_wrenches(grasp, grasp.squeeze.preload)
    efforts = virtual_work(grasp.configuration, wrenches, pressed_in(grasp))
    assert grasp.squeeze.efforts == pytest.approx(efforts, abs=1e-6)


def pressed_in(grasp: Grasp) -> np.ndarray:
    """The independent joints (n_independent,) where servos with the targets give the squeeze's efforts."""
    stiffness, _ = servos(grasp.configuration.task)
    return grasp.squeeze.targets - grasp.squeeze.efforts / stiffness


def test_tips_go_straight_inwards_by_what_their_pads_yield(grasp: Grasp) -> None:
    configuration, hand = grasp.configuration, grasp.configuration.task.hand
    ends = [forward_kinematics(hand, hand.expand(q)) for q in (configuration.state.q, pressed_in(grasp))]
    contacts = zip(
        configuration.task.contacts, configuration.contact_points, grasp.squeeze.yields_m, strict=True
    )
    for contact, point, yield_m in contacts:
        local = np.linalg.inv(ends[0][contact.hand.link]) @ [*point.p_hand, 1.0]
        way = (ends[1][contact.hand.link] @ local)[:3] - point.p_hand
        assert yield_m > 1e-3
        assert way == pytest.approx(-yield_m * point.n_object, abs=1e-5)


def test_no_contact_presses_harder_than_the_task_allows(firm: Grasp) -> None:
    task = replace(firm.configuration.task, max_normal_force_N=15.0)
    squeeze = plan_squeeze(replace(firm.configuration, task=task))
    assert isinstance(squeeze, Squeeze)
    assert max(squeeze.preload[:, 0].max(), squeeze.loaded[..., 0].max()) <= 15.0 + 1e-6
    assert 0.0 < squeeze.load_factor < firm.squeeze.load_factor


def servos(task: Task) -> tuple[np.ndarray, np.ndarray]:
    hand = task.hand
    found = [hand.axes[i].actuator for i in hand.independent]
    return np.array([s.stiffness for s in found]), np.array([s.effort for s in found])


def test_servos_with_the_targets_press_with_the_efforts_in_the_grasp(grasp: Grasp) -> None:
    """By MuJoCo's servos, whose efforts the plan did not see."""
    efforts = servo_efforts(grasp.configuration, grasp.squeeze.targets, pressed_in(grasp))
    assert efforts == pytest.approx(grasp.squeeze.efforts, abs=1e-9)
    assert np.abs(efforts).max() > 0.1


def test_efforts_stay_within_the_planned_share(grasp: Grasp) -> None:
    _, effort = servos(grasp.configuration.task)
    share = grasp.squeeze.settings.planned_effort
    for vector, _ in states(grasp.squeeze):
        needed = virtual_work(grasp.configuration, world_wrenches(grasp, vector))
        assert np.all(np.abs(needed) <= share * effort + 1e-5)


def test_more_friction_carries_at_least_as_much(grasp: Grasp) -> None:
    loads = []
    for friction in (0.6, 0.7, 0.8):
        squeeze = plan_squeeze(
            grasp.configuration, settings=HoldSettings(friction=friction, planned_load=100.0)
        )
        loads.append(squeeze.load_factor)
    assert loads[0] < loads[1] < loads[2]


def test_a_heavier_plan_squeezes_harder(firm: Grasp) -> None:
    forces = []
    for planned in (0.2, 0.5, 0.9):
        # With the whole friction, as the plan takes more of it where it must.
        squeeze = plan_squeeze(
            firm.configuration, settings=HoldSettings(planned_load=planned, planned_friction=1.0)
        )
        assert isinstance(squeeze, Squeeze)
        assert squeeze.load_factor == pytest.approx(planned, rel=1e-5)
        forces.append(squeeze.preload[:, 0].sum())
    assert forces[0] < forces[1] < forces[2]


def test_without_friction_nothing_can_be_held(firm: Grasp) -> None:
    barely_rolls = HoldSettings(friction=0.05, rotation_limit_rad=0.01)
    outcome = plan_squeeze(firm.configuration, settings=barely_rolls)
    assert outcome == NotHoldable(Obstacle.FRICTION, outcome.load_factor)
    assert outcome.load_factor < 0.05


def by_weaker_servos(configuration: Configuration, share: float) -> Configuration:
    """The same grasp by a hand whose servos have this share of their strength."""

    def weaker(axis: Axis) -> Axis:
        servo = axis.actuator
        return axis if servo is None else replace(axis, actuator=replace(servo, effort=share * servo.effort))

    task = configuration.task
    links = tuple(replace(k, axes=tuple(weaker(axis) for axis in k.axes)) for k in task.hand.links)
    return replace(configuration, task=replace(task, hand=replace(task.hand, links=links)))


def test_weak_servos_are_named_as_the_obstacle(firm: Grasp) -> None:
    outcome = plan_squeeze(by_weaker_servos(firm.configuration, 0.001))
    assert isinstance(outcome, NotHoldable)
    assert outcome.obstacle is Obstacle.EFFORT


def test_weaker_servos_carry_less(firm: Grasp) -> None:
    settings = HoldSettings(planned_load=100.0)
    strong = plan_squeeze(firm.configuration, settings=settings)
    less = plan_squeeze(by_weaker_servos(firm.configuration, 0.8), settings=settings)
    assert less.load_factor < strong.load_factor


def test_where_no_plan_is_to_be_had_the_contacts_press_all_the_same(firm: Grasp) -> None:
    """Forces near by could carry the load, forces here can't, and the plan may use hardly any effort."""
    feeble = replace(HoldSettings(), planned_effort=1e-4)
    squeeze = plan_squeeze(firm.configuration, settings=feeble)
    assert isinstance(squeeze, Squeeze) and squeeze.load_factor == 0.0
    assert squeeze.preload[:, 0].min() > 0.0 and not squeeze.preload[:, 1:].any()
    _, effort = servos(firm.configuration.task)
    assert np.abs(squeeze.efforts / effort).max() == pytest.approx(1e-4, rel=0.01)


def test_forces_keep_off_the_edge_of_the_friction_cone_where_the_load_allows(firm: Grasp) -> None:
    """With 70 % of the friction in the plan, tangential forces stay below that share of the cone."""
    settings = HoldSettings(friction=0.9, planned_load=0.5)
    squeeze = plan_squeeze(firm.configuration, settings=settings)
    assert isinstance(squeeze, Squeeze) and squeeze.load_factor == pytest.approx(0.5, rel=1e-5)
    mu = settings.sliding_friction(firm.configuration.task.object)
    mu_t = 1.12 * mu * squeeze.spin_arms_m
    for vector in (squeeze.preload, *squeeze.loaded):
        f_n, f_1, f_2, tau = vector.T
        used = np.sqrt((f_1**2 + f_2**2) / mu**2 + (tau / mu_t) ** 2)
        assert np.all(used <= settings.planned_friction * f_n + 1e-6)


def test_every_contact_presses_where_the_load_allows(grasp: Grasp) -> None:
    assert grasp.squeeze.preload[:, 0].min() >= HoldSettings().planned_force_N - 1e-6


def test_cones_that_rolling_widens_have_their_say(firm: Grasp) -> None:
    """With a little too little friction, statics gives no balance, but a try is worth it."""
    rolls = HoldSettings(rotation_limit_rad=0.05)
    outcomes = {
        mu: plan_squeeze(firm.configuration, settings=replace(rolls, friction=mu)) for mu in (0.05, 0.3, 0.6)
    }
    assert isinstance(outcomes[0.05], NotHoldable)
    rolled, sure = outcomes[0.3], outcomes[0.6]
    assert isinstance(rolled, Squeeze) and isinstance(sure, Squeeze)
    assert rolled.load_factor < 0.05 < sure.load_factor
    assert rolled.settings.friction == 0.3


def test_an_object_that_gravity_always_pushes_one_way_is_squeezed_under_it(firm: Grasp) -> None:
    down = HoldSettings(directions=((0.0, 0.1, -0.995), (0.0, -0.1, -0.995)))
    assert down.resting_direction == pytest.approx((0.0, 0.0, -1.0))
    assert HoldSettings().resting_direction == (0.0, 0.0, 0.0)
    squeeze = plan_squeeze(firm.configuration, settings=down)
    assert isinstance(squeeze, Squeeze)
    force = sum(f for f, _ in world_wrenches(firm, squeeze.preload))
    weight = firm.configuration.task.object.inertia.mass * down.gravity
    assert force == pytest.approx([0.0, 0.0, squeeze.load_factor * weight], abs=1e-5)


def test_no_force_makes_an_arm_longer_than_the_largest(grasp: Grasp) -> None:
    """Else a friction that could carry the load might be passed over."""
    pads = contact_pads(grasp.configuration, grasp.squeeze.settings)
    for force_N in np.geomspace(0.01, 1e4, 25):
        arms_m = pads.spin_arms_m(np.full(len(pads.curvatures), force_N))
        assert np.all(arms_m <= pads.largest_arms_m() * (1.0 + 1e-12))


def test_longer_arms_of_spin_friction_carry_at_least_as_much(grasp: Grasp) -> None:
    configuration, settings = grasp.configuration, grasp.squeeze.settings
    statics = grasp_statics(configuration, settings)
    loads = []
    for arm_m in (0.0005, 0.002, 0.008):
        program = load_program(
            statics,
            configuration.task,
            configuration.state,
            settings,
            subdivisions=2,
            spin_arms_m=np.full(statics.n_contacts, arm_m),
        )
        loads.append(largest_load(program.rows.A_eq, program.rows.A_ub, program.rows.b_ub, 10.0))
    assert loads[0] <= loads[1] + 1e-7 and loads[1] <= loads[2] + 1e-7
