"""Forces that contacts bring about without torque: known answers, scale laws, the statics of grasps."""

from dataclasses import replace

import numpy as np
import pytest
from holdfast.geometry import axis_rotation, cone_edges, even_directions, perpendicular
from holdfast.mjcf import preset_settings
from holdfast.mjcf.squeeze import grasp_statics
from holdfast.mjcf.squeeze.linear_program import largest_last
from holdfast.mjcf.squeeze.load_program import largest_load, load_program
from holdfast.mjcf.squeeze.statics import WRENCH_SCALE
from holdfast.objects import Task, load_task
from holdfast.objects.carrying import Places, carried_forces, least_multiple, most_multiple
from holdfast.solver import solve
from scipy.optimize import linprog

AXES = np.vstack([np.eye(3), -np.eye(3)])
ORIGIN = np.zeros(3)


def place(point, inward, largest_N=10.0, arm_m=0.002):
    """A contact at one point."""
    inward = np.array(inward, dtype=float)
    return Places(np.array([point]), inward[None] / np.linalg.norm(inward), largest_N, arm_m)


def pinch(half=0.02, **rest):
    """Two fingers that face each other along x."""
    return [place([half, 0.0, 0.0], [-1, 0, 0], **rest), place([-half, 0.0, 0.0], [1, 0, 0], **rest)]


def drawn(rng, count=3):
    """Contacts on a ball, somewhere, that press inwards nearly."""
    out = rng.normal(size=(count, 3))
    out /= np.linalg.norm(out, axis=1)[:, None]
    inward = -out + 0.3 * rng.normal(size=(count, 3))
    return [place(0.03 * p, n, float(rng.uniform(5, 20))) for p, n in zip(out, inward, strict=True)]


def largest_N(forces, directions):
    """The largest force in N along each of unit vectors (n, 3)."""
    return np.array([forces.best_turn(direction[None, None])[1] for direction in directions])


@pytest.mark.parametrize("seed", range(3))
def test_the_best_way_to_turn_is_that_of_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    forces = carried_forces([*pinch(), *drawn(rng)], ORIGIN, 0.6, even_directions(0))
    turned = rng.normal(size=(50, 4, 3))
    turned /= np.linalg.norm(turned, axis=2)[:, :, None]
    least = [min(largest_N(forces, directions)) for directions in turned]
    best, carried = forces.best_turn(turned)
    assert best == int(np.argmax(least)) and carried == pytest.approx(max(least)) and carried > 0.0


def test_a_pinch_carries_friction_twice_across_and_its_normal_force_along() -> None:
    mu, force = 0.5, 10.0
    found = carried_forces(pinch(), ORIGIN, mu, AXES)
    # Along y and z: mu f at either finger. Along x one finger presses with all it has, the other not at all.
    assert found.along == pytest.approx([force, 2 * mu * force, 2 * mu * force] * 2, rel=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_another_program_finds_the_same(seed: int) -> None:
    rng = np.random.default_rng(seed)
    contacts, mu, centre = drawn(rng, 4), 0.7, 0.01 * rng.normal(size=3)
    found = carried_forces(contacts, centre, mu, AXES)
    columns, owners = [], []
    for i, contact in enumerate(contacts):
        (p,), (n,) = contact.points, contact.inward
        e1, e2 = perpendicular(n)
        for f_n, f_1, f_2, tau in cone_edges(mu, mu * contact.spin_arm_m, 1).T:
            force = f_n * n + f_1 * e1 + f_2 * e2
            columns.append([*force, *(np.cross(p - centre, force) + tau * n)])
            owners.append(i)
    W = np.array(columns).T
    sums = np.array([[owner == i for owner in owners] for i in range(4)], dtype=float)
    for direction, along in zip(AXES, found.along, strict=True):
        equal = np.column_stack([W, -np.append(direction, np.zeros(3))])
        answer = linprog(
            np.append(np.zeros(len(owners)), -1.0),
            np.column_stack([sums, np.zeros(4)]),
            [contact.largest_N for contact in contacts],
            equal,
            np.zeros(6),
        )
        assert along == pytest.approx(-answer.fun, rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("seed", range(4))
def test_halfspaces_bound_the_forces_in_directions_that_were_not_looked_at(seed: int) -> None:
    rng = np.random.default_rng(seed)
    contacts = [*pinch(), *drawn(rng)]
    rough = carried_forces(contacts, ORIGIN, 0.6, even_directions(0))
    others = rng.normal(size=(10, 3))
    others /= np.linalg.norm(others, axis=1)[:, None]
    exact = carried_forces(contacts, ORIGIN, 0.6, others)
    assert np.all(largest_N(rough, others) >= exact.along * (1 - 1e-9))
    assert largest_N(rough, rough.directions) == pytest.approx(rough.along)


@pytest.mark.parametrize("seed", range(4))
def test_more_of_anything_carries_no_less_and_twice_the_force_twice(seed: int) -> None:
    rng = np.random.default_rng(seed)
    contacts = [*pinch(), *drawn(rng)]
    usual = carried_forces(contacts, ORIGIN, 0.5, AXES).along
    assert np.all(carried_forces(contacts, ORIGIN, 0.6, AXES).along >= usual * (1 - 1e-9))
    assert np.all(carried_forces(contacts[:-1], ORIGIN, 0.5, AXES).along <= usual * (1 + 1e-9))
    stronger = [replace(contact, largest_N=2.0 * contact.largest_N) for contact in contacts]
    assert carried_forces(stronger, ORIGIN, 0.5, AXES).along == pytest.approx(2.0 * usual)
    one = [replace(contacts[0], largest_N=2.0 * contacts[0].largest_N), *contacts[1:]]
    assert np.all(carried_forces(one, ORIGIN, 0.5, AXES).along >= usual * (1 - 1e-9))


def test_cones_around_and_within_their_edges_bracket_the_truth() -> None:
    contacts = [*pinch(), *drawn(np.random.default_rng(3))]
    inside, outside = (
        carried_forces(contacts, ORIGIN, 0.5, AXES, subdivisions=2, outside=way).along
        for way in (False, True)
    )
    assert np.all(inside <= outside * (1 + 1e-9))
    assert np.all(outside < 1.1 * inside)


def test_what_turns_with_the_object_changes_nothing() -> None:
    R = axis_rotation(np.array([1.0, 2.0, -1.0]) / np.sqrt(6.0), 0.8)
    contacts = drawn(np.random.default_rng(5), 4)
    turned = [replace(c, points=c.points @ R.T, inward=c.inward @ R.T) for c in contacts]
    plain = carried_forces(contacts, ORIGIN, 0.6, AXES, subdivisions=2).along
    moved = carried_forces(turned, ORIGIN, 0.6, AXES @ R.T, subdivisions=2).along
    assert moved == pytest.approx(plain, rel=0.03)  # edges lie about the normal in another way


def test_contacts_that_cannot_balance_carry_nothing() -> None:
    beside = [place([0.02, 0.0, 0.0], [-1, 0, 0]), place([0.02, 0.01, 0.0], [-1, 0, 0])]
    found = carried_forces(beside, ORIGIN, 0.5, AXES)
    assert found.along.min() == 0.0
    assert least_multiple(found, 1.0) == 0.0


def test_a_palm_without_limit_carries_what_presses_on_it() -> None:
    contacts = [place([0.02, 0, 0], [-1, 0, 0]), place([-0.02, 0, 0], [1, 0, 0], largest_N=np.inf)]
    found = carried_forces(contacts, ORIGIN, 0.5, AXES)
    assert found.along[1] == pytest.approx(10.0, rel=1e-6)  # both press with 10 N across
    assert found.along[0] == np.inf  # nothing limits the palm along its normal


def test_multiples_are_those_of_the_worst_direction_and_of_the_best_way_to_turn() -> None:
    found = carried_forces(pinch(), ORIGIN, 0.3, even_directions(1))
    six = np.vstack([np.eye(3), -np.eye(3)])
    assert least_multiple(found, 2.0) == pytest.approx(least_multiple(found, 1.0) / 2.0)
    assert most_multiple(found, 2.0, six) == pytest.approx(most_multiple(found, 1.0, six) / 2.0)
    assert least_multiple(found, 1.0) <= most_multiple(found, 1.0, six) * (1 + 1e-9)
    assert most_multiple(found, 1.0, six) <= most_multiple(found, 1.0, six[:1]) * (1 + 1e-9)
    held = most_multiple(found, 1.0, six, np.eye(3))
    assert held == pytest.approx(6.0, rel=0.02)
    assert 0.9 * held <= most_multiple(found, 1.0, six)  # a way to turn near this one was looked at


def test_no_grasp_of_the_same_points_carries_more_than_they_do_alone() -> None:
    task = load_task("upholding")
    for configuration in solve(task, candidates=3, seed=2).configurations:
        statics = grasp_statics(configuration)
        arms = np.full(statics.n_contacts, 0.0025)
        mu = task.object.friction
        contacts = [
            Places(point[None], frame[:1], 20.0, 0.0025)
            for point, frame in zip(statics.points, statics.frames, strict=True)
        ]
        gravity = np.array(task.test.directions)
        found = carried_forces(contacts, statics.centre, mu, -gravity)
        edges = np.kron(np.eye(statics.n_contacts), cone_edges(mu, mu, 1))
        edges[3::4] *= arms[:, None]
        balance = WRENCH_SCALE[:, None] * (statics.G @ edges)
        for direction, along in zip(gravity, found.along, strict=True):
            load = np.append(direction, np.zeros(3))  # a newton
            limits = np.column_stack([edges[0::4], np.zeros(statics.n_contacts)])
            answer = largest_last(np.column_stack([balance, load]), limits, np.full(len(limits), 20.0), 1e4)
            assert answer is not None
            assert along == pytest.approx(answer.x[-1], rel=1e-6, abs=1e-6)


def test_no_squeeze_plan_carries_more_than_its_points_do_alone() -> None:
    """The plan's program has the same cones and limits, and besides servos and the hardness of the hand."""
    task = Task(
        hand="sa",
        object="family:mug:31",
        contacts={"index/tip": "body_left", "thumb/tip": "body_right"},
        max_normal_force_N=9.0,
    )
    settings, plans = preset_settings("holdfast", task), []
    for configuration in solve(task, candidates=12, seed=4).configurations:
        statics, arm_m = grasp_statics(configuration, settings), 0.003
        program = load_program(
            statics,
            task,
            configuration.state,
            settings,
            subdivisions=1,
            spin_arms_m=np.full(statics.n_contacts, arm_m),
        )
        plan = largest_load(program.rows.A_eq, program.rows.A_ub, program.rows.b_ub, 100.0)
        plans.append(plan)
        contacts = [
            Places(point[None], frame[:1], 9.0, arm_m)
            for point, frame in zip(statics.points, statics.frames, strict=True)
        ]
        gravity = np.array(settings.directions)
        found = carried_forces(contacts, statics.centre, task.object.friction, -gravity)
        weight = statics.mass * settings.gravity
        assert plan <= most_multiple(found, weight, gravity, np.eye(3)) * (1 + 1e-6)
    assert max(plans) > 0.1
