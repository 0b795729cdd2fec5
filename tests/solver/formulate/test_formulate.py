"""The polynomial system says the same about a state as forward kinematics and the contact manifold."""

import dataclasses
from fractions import Fraction

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Cap, Patch, PointRegion, Region
from holdfast.geometry.transforms import rotation_exp
from holdfast.hands import HandRegion, forward_kinematics
from holdfast.objects import Contact, ObjectRegion, Task
from holdfast.solver import ContactManifold, State, solve
from holdfast.solver.certify.krawczyk import ExistenceTest
from holdfast.solver.enclosure.straight_line import StraightLineProgram
from holdfast.solver.formulate.formulate import formulate
from holdfast.solver.formulate.region_equations import UNIT_M
from holdfast.solver.tasks.certify import TaskCertifier

Z = np.array([0.0, 0.0, 1.0])
_TURN = np.linspace(-0.25, 0.25, 4)
_ALONG = np.linspace(-0.01, 0.01, 4)
_BULGE = [[[0.02 * np.sin(a), y, 0.02 * np.cos(a) + 3 * y * y] for y in _ALONG] for a in _TURN]


def bilinear(z: float, *lifts: float) -> Patch:
    """A square about the z axis at height `z`, its corners lifted."""
    a, b, c, d = (z + lift for lift in lifts)
    net = [[[-0.01, -0.02, a], [-0.01, 0.01, b]], [[0.012, -0.02, c], [0.012, 0.01, d]]]
    return Patch(BezierPatch(np.array(net)), off_surface=True)


REGIONS: dict[str, Region] = {
    "cap": Cap(np.array([0.0, 0.002, 0.01]), 0.008, Z, 1.5, off_surface=True),
    "flat": bilinear(0.012, 0.0, 0.0, 0.0, 0.0),
    "twisted": bilinear(0.012, 0.0, 0.002, 0.001, -0.001),
    "bicubic": Patch(BezierPatch(np.array(_BULGE)), off_surface=True),
    "point": PointRegion(np.array([0.001, 0.002, 0.012]), np.array([0.6, 0.0, 0.8]), off_surface=True),
}
# How many conditions a contact puts on the relative pose of its bodies, by the dimensions of its regions.
SURFACES = {"cap", "flat", "twisted", "bicubic"}
ALL_PAIRS = [(a, b) for a in REGIONS for b in REGIONS]


def conditions(hand: str, obj: str) -> int:
    return 5 - 2 * (hand in SURFACES) - 2 * (obj in SURFACES)


def one_contact(upholding: Task, hand: str, obj: str) -> Task:
    link = upholding.hand.link_index("index_distal")
    sides = HandRegion("h", link, REGIONS[hand]), ObjectRegion("o", REGIONS[obj])
    contact = Contact(*sides, align_within_deg=0.0)
    return dataclasses.replace(upholding, contacts=(contact,))


def on_manifold(task: Task, count: int, seed: int = 0) -> list[State]:
    """Random states at which the contact equations hold, whether or not caps and facing do."""
    manifold = ContactManifold(task)
    rng = np.random.default_rng(seed)
    out = []
    for _ in range(20 * count):
        q = rng.uniform(task.limits[:, 0], task.limits[:, 1])
        # Somewhere near the fingertip, or Newton's method has far to go.
        T = forward_kinematics(task.hand, task.hand.expand(q))[task.contacts[0].hand.link]
        p = T[:3, 3] + 0.02 * rng.normal(size=3)
        start = State(q, rotation_exp(2 * rng.normal(size=3)), p, rng.uniform(size=manifold.n_params))
        state = manifold.project(start, tolerance_m=1e-15, max_steps=40)
        if state is not None:
            out.append(state)
        if len(out) == count:
            break
    assert len(out) >= 0.5 * count
    return out


@pytest.mark.parametrize(("hand", "obj"), ALL_PAIRS)
def test_equations_hold_at_states_in_contact(upholding, values, hand, obj):
    task = one_contact(upholding, hand, obj)
    formulation = formulate(task)
    system = formulation.system
    assert system.dimension == 3 + 6 - conditions(hand, obj)
    manifold = ContactManifold(task)
    feasible = 0
    for state in on_manifold(task, 60):
        if np.abs(manifold.residual(state)).max() > 1e-14:
            continue
        x = values(system, formulation.inputs_from_state(state))
        assert max(abs(e.evaluate(x)) for e in system.equations) < 1e-12
        slack = min(g.evaluate(x) for g in system.inequalities)
        # Caps and facing normals are the inequalities, and say the same as the manifold.
        margins = manifold.inequalities(state)[0]
        contact = manifold.contact_points(state)[0]
        facing = -contact.n_hand @ contact.n_object
        if min([facing, *margins]) > 1e-8:
            feasible += 1
            assert slack > -1e-12
            assert manifold.is_feasible(state)
            assert max(abs(e.evaluate(x)) for e in system.redundant) < 1e-11
            assert np.all((system.lower <= x) & (x <= system.upper))
        elif min([facing, *margins]) < -1e-8:
            assert slack < 0
    assert feasible >= 2


@pytest.mark.parametrize(("hand", "obj"), ALL_PAIRS)
def test_states_out_of_contact_miss_the_equations(upholding, values, hand, obj):
    task = one_contact(upholding, hand, obj)
    formulation = formulate(task)
    manifold = ContactManifold(task)
    for state in on_manifold(task, 5, seed=1):
        normal = manifold.contact_points(state)[0].n_object
        moved = State(state.q, state.R_palm_object, state.p_palm_object - 1e-5 * normal, state.params)
        x = values(formulation.system, formulation.inputs_from_state(moved))
        # The first contact decides the position: elsewhere the object can't be.
        assert np.abs(x[formulation.position] - moved.p_palm_object / UNIT_M).max() > 5e-6 / UNIT_M
        at_contact = formulation.state_from_inputs(x, moved.q)
        assert at_contact.p_palm_object == pytest.approx(state.p_palm_object, abs=1e-14)


def test_a_second_contact_that_is_missed_misses_the_equations(upholding, values):
    """A finger that moves alone, or a point that slides alone, takes its contact apart."""
    formulation = formulate(upholding)
    manifold = ContactManifold(upholding)
    system = formulation.system
    thumb_pip = upholding.hand.independent_names.index("thumb_pip")
    for configuration in solve(upholding, candidates=4).configurations:
        state = configuration.state
        x = values(system, formulation.inputs_from_state(state))
        assert max(abs(e.evaluate(x)) for e in system.equations) < 1e-12
        q, params = state.q.copy(), state.params.copy()
        q[thumb_pip] += 1e-4
        params[2] += 1e-3
        for moved in (
            State(q, state.R_palm_object, state.p_palm_object, state.params),
            State(state.q, state.R_palm_object, state.p_palm_object, params),
        ):
            x = values(system, formulation.inputs_from_state(moved))
            missed_m = np.abs(manifold.residual(moved)).max()
            assert missed_m > 1e-7
            assert max(abs(e.evaluate(x)) for e in system.equations) > 0.3 * missed_m / UNIT_M


@pytest.mark.parametrize(("hand", "obj"), ALL_PAIRS)
def test_feasible_states_are_certified(upholding, hand, obj):
    task = one_contact(upholding, hand, obj)
    certifier = TaskCertifier(task)
    manifold = certifier.manifold
    tried = certified = 0
    for state in on_manifold(task, 60):
        # Away from edges; there is a test of its own for states at limits.
        inside = np.all((state.params > 1e-3) & (state.params < 1 - 1e-3))
        inside &= np.all((state.q > task.limits[:, 0] + 1e-3) & (state.q < task.limits[:, 1] - 1e-3))
        if not (inside and manifold.is_feasible(state, tolerance=-1e-3)):
            continue
        tried += 1
        configuration = certifier.certify(state)
        certified += configuration.certified
        assert configuration.residual_m < 1e-12
        assert configuration.state.q == pytest.approx(state.q, abs=1e-9)
        assert configuration.state.T_palm_object == pytest.approx(state.T_palm_object, abs=1e-9)
    assert tried > 0
    assert certified == tried


def test_round_trip_of_states(upholding, make_task):
    task = make_task(
        ("index/tip", REGIONS["bicubic"]), ("thumb/pad", REGIONS["cap"]), ("middle/pad", REGIONS["point"])
    )
    formulation = formulate(task)
    manifold = ContactManifold(task)
    rng = np.random.default_rng(2)
    for _ in range(20):
        state = State(
            rng.uniform(task.limits[:, 0], task.limits[:, 1]),
            rotation_exp(2 * rng.normal(size=3)),
            rng.normal(size=3) * 0.1,
            rng.uniform(size=manifold.n_params),
        )
        # The object is where the first contact has it.
        gap = manifold.residual(state)[:3]
        state = State(state.q, state.R_palm_object, state.p_palm_object + gap, state.params)
        back = formulation.state_from_inputs(formulation.inputs_from_state(state), state.q)
        assert back.q == pytest.approx(state.q, abs=1e-14)
        assert back.params == pytest.approx(state.params, abs=1e-15)
        assert back.T_palm_object == pytest.approx(state.T_palm_object, abs=1e-13)


def test_joints_of_fingers_without_a_contact_are_left_alone(upholding):
    formulation = formulate(upholding)
    names = upholding.hand.independent_names
    assert {names[j] for j in formulation.angle_inputs} == {
        "thumb_base", "thumb_abduction", "thumb_flexion", "thumb_pip",
        "index_abduction", "index_flexion", "index_pip",
    }  # fmt: skip
    q_free = np.linspace(0.01, 0.2, len(names))
    state = formulation.state_from_inputs(formulation.system.lower, q_free)
    for j in set(range(len(names))) - set(formulation.angle_inputs):
        assert state.q[j] == q_free[j]


def test_joints_beyond_half_a_turn_come_back_as_they_were(upholding):
    """A joint may have limits such as 150 to 250 degrees; a cosine and a sine alone do not tell the turn."""
    link = upholding.hand.links[upholding.hand.link_index("index_proximal")]
    far = tuple(dataclasses.replace(a, lower=2.6, upper=4.4) for a in link.axes[:1]) + link.axes[1:]
    links = tuple(
        dataclasses.replace(each, axes=far) if each is link else each for each in upholding.hand.links
    )
    hand = dataclasses.replace(upholding.hand, links=links)
    task = dataclasses.replace(upholding, hand=hand, limits=hand.limits)
    formulation = formulate(task)
    j = hand.independent_names.index("index_abduction")
    for angle in (2.6, 3.0, np.pi, 3.5, 4.4):
        q = np.clip(np.zeros(len(task.limits)), *task.limits.T)
        q[j] = angle
        state = State(q, np.eye(3), np.zeros(3), np.full(4, 0.5))
        assert formulation.state_from_inputs(formulation.inputs_from_state(state), q).q[j] == pytest.approx(
            angle
        )


def test_dimensions_of_tasks(upholding, make_task):
    # 13 unknowns of index, thumb and object less 3 - 2 conditions a contact and parameter pair.
    assert formulate(upholding).system.dimension == 7 + 6 - 2
    three = make_task(*((f"{finger}/tip", REGIONS["point"]) for finger in ("index", "thumb", "ring")))
    assert formulate(three).system.dimension == 10 + 6 - 9


def aligned_states(upholding: Task) -> tuple[Task, list[State]]:
    """Joints at zero and at limits, the object square to the palm, parameters in a corner of a patch."""
    task = one_contact(upholding, "cap", "bicubic")
    manifold = ContactManifold(task)
    out = []
    for q0 in (np.zeros(len(task.limits)), task.limits[:, 0], task.limits[:, 1]):
        q = np.clip(q0, *task.limits.T)
        T = forward_kinematics(task.hand, task.hand.expand(q))[task.contacts[0].hand.link]
        for params in ((0.5, 0.5), (0.0, 1.0), (1.0, 1.0), (0.0, 0.3)):
            patch = task.contacts[0].object.region.patch
            cap = task.contacts[0].hand.region
            centre = T[:3, :3] @ cap.centre + T[:3, 3]
            n = patch.unit_normal(*params)
            for R in (
                np.eye(3),
                np.diag([-1.0, 1.0, -1.0]),
                np.diag([1.0, -1.0, -1.0]),
                np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
            ):
                p = centre - R @ (patch.evaluate(*params) + cap.radius * n)
                state = State(q, R, p, np.array(params))
                if manifold.is_feasible(
                    state, tolerance=-1e-6 if min(params) > 0.0 and max(params) < 1.0 else 0.0
                ):
                    out.append(state)
    return task, out


def test_states_at_limits_right_angles_and_corners_of_patches_are_certified(upholding):
    task, states = aligned_states(upholding)
    certifier = TaskCertifier(task)
    assert len(states) >= 6
    for state in states:
        assert np.abs(certifier.manifold.residual(state)).max() < 1e-15
        assert certifier.certify(state).certified


def test_fixed_joints_can_be_certified(upholding):
    """Limits that meet leave a joint no freedom, but no doubt either."""
    limits = upholding.limits.copy()
    j = upholding.hand.independent_names.index("index_abduction")
    limits[j] = 0.0
    task = dataclasses.replace(one_contact(upholding, "cap", "flat"), limits=limits)
    certifier = TaskCertifier(task)
    states = [s for s in on_manifold(task, 12) if certifier.manifold.is_feasible(s, tolerance=0.0)]
    assert states
    for state in states:
        assert state.q[j] == 0.0
        assert certifier.certify(state).certified


def test_a_pose_that_contacts_force_square_is_certified(upholding):
    """A flat of the palm on a flat of the object makes entries of the rotation exactly 0 and 1."""
    hand = upholding.hand
    region = HandRegion("flat", 0, REGIONS["flat"])
    task = dataclasses.replace(
        upholding, contacts=(Contact(region, ObjectRegion("o", REGIONS["flat"]), 0.0),)
    )
    R = np.diag([1.0, -1.0, -1.0])
    patch = REGIONS["flat"].patch
    params = np.array([0.5, 0.5, 0.25, 0.5])
    p = patch.evaluate(*params[:2]) - R @ patch.evaluate(*params[2:])
    certifier = TaskCertifier(task)
    state = State(np.clip(np.zeros(len(hand.independent)), *task.limits.T), R, p, params)
    assert np.abs(certifier.manifold.residual(state)).max() < 1e-16
    assert certifier.certify(state).certified


def test_a_fraction_is_enough_to_miss_a_limit(upholding):
    """One thousandth of a degree beyond a limit there is no certificate, whatever the contact."""
    task = one_contact(upholding, "cap", "bicubic")
    j = upholding.hand.independent_names.index("index_pip")
    certifier = TaskCertifier(task)
    state = next(
        s for s in on_manifold(task, 24)
        if certifier.manifold.is_feasible(s, tolerance=-1e-3) and certifier.certify(s).certified
    )  # fmt: skip
    for shift, expected in ((1e-6, False), (-1e-6, True)):
        limits = task.limits.copy()
        limits[j, 1] = state.q[j] - shift
        formulation = formulate(dataclasses.replace(task, limits=limits))
        proved = ExistenceTest(StraightLineProgram(formulation.system)).prove(
            formulation.inputs_from_state(state)
        )
        assert (proved is not None) is expected


def test_redundant_equations_follow_exactly_up_to_their_room(exact, upholding, make_task):
    """At rational solutions the redundant equations are off by rounded coefficients only."""
    rng = np.random.default_rng(3)
    formulation = formulate(make_task(("thumb/pad", REGIONS["flat"])))
    system = formulation.system
    x = [Fraction(0)] * system.size
    for cosine, sine in formulation.angle_inputs.values():
        t = Fraction(int(rng.integers(1, 30)), 37)
        x[cosine], x[sine] = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
    x[formulation.rotation_inputs[0]] = x[formulation.rotation_inputs[4]] = Fraction(1)
    exact.define(system, x)
    chain = [e for e in system.redundant if not e.variables & set(formulation.rotation_inputs.tolist())]
    # Those of the chain alone; the contact need not hold.
    closed = [e for e in chain if all(not system.names[i].startswith("contact") for i in e.variables)]
    assert len(closed) > 10
    assert max(abs(exact.polynomial(e, x)) for e in closed) < Fraction(1, 10**14)
